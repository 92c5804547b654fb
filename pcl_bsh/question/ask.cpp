// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/ask.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/depths/depths.h>
#include <pcl_bsh/depths/queried_part.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/query/record_distance.h>
#include <pcl_bsh/question/joined_answers.h>
#include <pcl_bsh/question/options.h>
#include <pcl_bsh/question/solids.h>
#include <pcl_bsh/question/unseen.h>
#include <pcl_bsh/question/warnings/hollow.h>
#include <pcl_bsh/trajectory/told_distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace pcl_bsh {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Compares measured distances with lengths. A record without a distance is farther than any length. A distance that
/// equals the length may be rounded: the coordinates decide.
class MeasuredDistances {
public:
  MeasuredDistances(const Placed& input, const Placed& obstacle, const PointDistances& found)
  : found_(found),
    exact_(input.hierarchy().view(), input.pose, obstacle.hierarchy().view(), obstacle.pose),
    sunk_(sunk(input.hierarchy().view(), radii_)),
    depth_(sunk_, input.pose, obstacle.hierarchy().view(), obstacle.pose)
  {
  }

  /// Sign of the record's distance less the length.
  int compare(std::uint32_t record, double length) const
  {
    const double distance = found_.distance[record];
    if (std::isnan(distance)) return 1;
    if (distance != length) return distance < length ? -1 : 1;
    const std::uint32_t nearest = found_.closest_point[record];
    if (exact_.ofTriangles() && distance < sunk_.ownRadius(record)) // a depth, which of triangles is not known exactly
      return sunk_.triangles ? 0 : -depth_.compare({record, nearest}, -length);
    return exact_.compare({record, nearest}, length);
  }

private:
  const DefaultFloatEnvironment environment_;
  const PointDistances& found_;
  const RecordDistance exact_;
  std::vector<float> radii_;
  const PointsView sunk_;
  const RecordDistance depth_;
};

/// One question, of two things that are built.
class QuestionRun {
public:
  QuestionRun(const Question& question, Shape& input, Shape& obstacle)
  : question_(question),
    wanted_(question.wanted),
    input_(input),
    obstacle_(obstacle),
    b_(obstacle.hierarchy(question.uncertaintyOfObstacle(), question.threads), question.pose),
    a_(input.hierarchy(question.uncertaintyOfInput(), question.threads), question.pose_of_input)
  {
    solids_.emplace(question, input, obstacle, a_, b_);
  }

  Answer answer()
  {
    if (alongPath())
      followPath();
    else if (wanted_.flags || wanted_.obstacle_flags)
      flag();
    if (wanted_.any) findAny();
    if (wanted_.indices || wanted_.obstacle_indices) list();
    if (wanted_.closest && !closest_is_known_) findClosest();
    if (wanted_.measures() && !question_.path) measure();
    if (question_.seen && wanted_.collisions()) {
      progress_.tellWhole(1.0); // all but this is done
      lookAround(question_, input_, obstacle_, answer_);
    }
    warn();
    return std::move(answer_);
  }

private:
  void flag()
  {
    const float* const spacings = question_.density ? guard() : nullptr;
    FlagsRequest request(question_.clearance.value_or(0.0),
                         !wanted_.flags           ? Flagged::b
                         : wanted_.obstacle_flags ? Flagged::both
                                                  : Flagged::a,
                         nextEffort());
    request.spacings_of_b = spacings;
    FlagsResult found = flags(std::move(request));
    answer_.sparse = found.sparse_a;
    if (wanted_.obstacle_flags) answer_.obstacle_flags = std::move(found.b);
    if (!wanted_.flags) return;
    answer_.collisions.flags = std::move(found.a);
    answer_.collisions.colliding = found.colliding_a;
    answer_.collisions.undecided = found.undecided_a;
  }

  FlagsResult flags(FlagsRequest request)
  {
    FlagsResult found = collisionFlags(a_, b_, solids_->request(std::move(request)));
    if (!solids_->none()) solids_->addTo(found);
    answer_.work += found.work;
    return found;
  }

  void findAny()
  {
    answer_.any = anyCollision(a_, b_, {question_.clearance.value_or(0.0), nextEffort()});
    solids_->addTo(answer_.any);
    answer_.work += answer_.any.work;
  }

  void list()
  {
    const FlagsRequest request(question_.clearance.value_or(0.0),
                               !wanted_.indices           ? Flagged::b
                               : wanted_.obstacle_indices ? Flagged::both
                                                          : Flagged::a,
                               nextEffort());
    if (solids_->none()) {
      answer_.indices = collidingIndices(a_, b_, request);
      answer_.work += answer_.indices.work;
      return;
    }
    const FlagsResult found = flags(request);
    const auto add = [](const std::vector<Verdict>& flags, Verdict verdict, std::vector<std::int32_t>& list) {
      for (std::size_t i = 0; i < flags.size(); ++i)
        if (flags[i] == verdict) list.push_back(static_cast<std::int32_t>(i));
    };
    if (wanted_.indices) add(found.a, Verdict::colliding, answer_.indices.a);
    if (wanted_.indices) add(found.a, Verdict::undecided, answer_.indices.undecided_a);
    if (wanted_.obstacle_indices) add(found.b, Verdict::colliding, answer_.indices.b);
    if (wanted_.obstacle_indices) add(found.b, Verdict::undecided, answer_.indices.undecided_b);
    answer_.indices.work = found.work;
  }

  /// Whether a query along a path answers, if only along one pose.
  bool alongPath() const { return question_.path || wanted_.contacts || wanted_.poses || wanted_.first_poses; }

  /// Returns how many queries report progress. Their order is: the spacings of a density guard, collisions, the closest
  /// pair, distances. Some may turn out not to be needed.
  int queries() const
  {
    const bool path = alongPath();
    const bool flags = wanted_.flags || wanted_.obstacle_flags;
    return (question_.density && flags) + (path || flags) + wanted_.any +
           (wanted_.indices || wanted_.obstacle_indices) + (wanted_.closest && !path) +
           (wanted_.measures() && !question_.path);
  }

  /// Returns the effort of the next query: that of the question, with the query's share of the progress.
  Effort nextEffort()
  {
    const double begun = begun_++, all = queries();
    Effort effort = question_;
    if (question_.progress)
      effort.progress = [this, begun, all](double done) {
        progress_.tellWhole((begun + done) / all);
        return true;
      };
    return effort;
  }

  /// Returns the spacings for the density guard; null where nothing is guarded.
  const float* guard()
  {
    if (obstacle_.isSurface()) {
      answer_.warnings.push_back({WarningKind::unguarded, obstacle_.name() +
                                                              ": is a surface, which has no holes: density guards "
                                                              "nothing"});
      return nullptr;
    }
    const Shape::Patches& patches = obstacle_.patches(question_.widest_gap, {question_.threads, nextEffort().progress});
    answer_.widest_gap = patches.gap;
    return patches.spacings.empty() ? nullptr : patches.spacings.data();
  }

  void followPath()
  {
    const bool measures = !wanted_.collisions(); // distances are wanted, or the closest alone
    TrajectoryRequest request;
    static_cast<Effort&>(request) = nextEffort();
    request.clearance = measures && wanted_.distances ? *question_.max_distance : question_.clearance.value_or(0.0);
    const bool flags = wanted_.flags || wanted_.contacts || wanted_.poses;
    request.flags = flags || !solids_->none();                                // addToPath() counts by them
    const bool closest = wanted_.closest && !question_.accuracy.stopsEarly(); // an early stop has no distance
    request.distances = request.closest_poses = wanted_.contacts || wanted_.distances || closest;
    request.first_poses = wanted_.contacts || wanted_.first_poses;
    request.pose_summaries = wanted_.poses && question_.swept == 0.0;
    request.swept = question_.sweptTolerance();
    answer_.collisions = collideAlong(a_, b_.hierarchy(), question_.poses(), request);
    answer_.work += answer_.collisions.work;
    solids_->addToPath(answer_.collisions, answer_.work);
    if (wanted_.poses) tellPoses(request);
    if (!flags) answer_.collisions.flags.clear();
    if (wanted_.closest) {
      answer_.closest = closestOf(answer_.collisions);
      closest_is_known_ = true;
    }
  }

  /// Sets the pair of each pose; swept, the whole summary of the motion from each pose to the next. Only records that
  /// collide somewhere, or may, are asked about: they are few.
  void tellPoses(TrajectoryRequest request)
  {
    const std::vector<Verdict>& flags = answer_.collisions.flags;
    const bool whole = question_.input_solid; // a part of a solid is no solid
    std::vector<std::uint32_t> some;
    for (std::uint32_t i = 0; i < flags.size(); ++i)
      if (flags[i] != Verdict::free) some.push_back(i);
    const QueriedPart part(a_.hierarchy(), whole ? std::vector<std::uint32_t>() : some);
    Shape input = whole ? input_ : Shape(input_.name(), {std::shared_ptr<const void>(), &part.queried().thing()});
    const Placed a(whole ? a_.hierarchy() : part.queried().thing(), a_.pose);
    const std::vector<Eigen::Isometry3d> poses = question_.poses();
    std::vector<PoseSummary>& told = answer_.collisions.poses;
    told.resize(poses.size());
    answer_.pose_pairs.assign(poses.size(), std::nullopt);
    if (some.empty()) return;
    Question motion = question_;
    request.progress = motion.progress = nullptr;
    request.distances = request.closest_poses = request.first_poses = true;
    request.pose_summaries = false;
    for (std::size_t k = 0; k < poses.size(); ++k) {
      DistanceResult closest;
      if (request.swept) {
        motion.path.emplace(poses.begin() + static_cast<std::ptrdiff_t>(k),
                            poses.begin() + static_cast<std::ptrdiff_t>(std::min(k + 2, poses.size())));
        const Solids solids(motion, input, obstacle_, a, b_);
        TrajectoryResult found = collideAlong(a, b_.hierarchy(), *motion.path, request);
        solids.addToPath(found, found.work);
        answer_.work += found.work;
        closest = closestOf(found);
        told[k] = {found.colliding > 0, found.colliding, found.undecided, closest.distance};
      }
      else if (told[k].colliding_points + told[k].undecided_points > 0) {
        closest = closestPair(a, {b_.hierarchy(), poses[k]});
        Solids(question_, input, obstacle_, a, b_).turn(closest, poses[k]);
        answer_.work += closest.work;
      }
      answer_.pose_pairs[k] = closest.pair;
      if (closest.pair && !whole) answer_.pose_pairs[k]->a = part.original(closest.pair->a);
    }
  }

  /// Finds the smallest distance, however large it is.
  void findClosest()
  {
    Effort effort = nextEffort();
    effort.threads = 1;
    DistanceResult found = closestPair(a_, b_, effort);
    answer_.work += found.work;
    answer_.closest = std::move(found);
    solids_->turn(answer_.closest);
  }

  /// Returns the greatest distance that has to be measured.
  double reach() const
  {
    const double told = question_.max_distance.value_or(unlimited);
    if (!wanted_.within) return told;
    const auto [least, most] = question_.limits;
    const double of_limits = std::isinf(most) ? least : most;
    return wanted_.distances ? std::max(told, of_limits) : std::max(of_limits, 0.0);
  }

  void measure()
  {
    PointDistancesRequest request;
    static_cast<Effort&>(request) = nextEffort();
    request.max_distance = reach();
    SymmetricDistances& found = answer_.distances;
    if (wanted_.both_ways)
      found = symmetricDistances(a_, b_, request);
    else
      found.a = pointDistances(a_, b_, request);
    answer_.work += found.a.work;
    answer_.work += found.b.work;
    solids_->turn(found, wanted_.both_ways);
    if (wanted_.within) compare(request.max_distance);
  }

  /// Compares distances with the limits, then with the greatest distance that is told.
  void compare(double reach)
  {
    PointDistances& found = answer_.distances.a;
    const PointsView& input = a_.hierarchy().view();
    const MeasuredDistances distance(a_, b_, found);
    const auto [least, most] = question_.limits;
    answer_.within.assign(input.count, 0);
    const double told = question_.max_distance.value_or(unlimited);
    std::vector<std::uint32_t> beyond;
    for (std::size_t i = 0; i < input.size(); ++i) {
      const std::uint32_t record = input.record(i);
      answer_.within[record] = isFinite(input.point(record)) && distance.compare(record, least) >= 0 &&
                               (std::isinf(most) || distance.compare(record, most) <= 0);
      if (reach > told && distance.compare(record, told) > 0) beyond.push_back(record);
    }
    for (const std::uint32_t record : beyond) found.distance[record] = std::numeric_limits<double>::quiet_NaN();
  }

  void warn()
  {
    const NamedCloud input = input_.facts(wanted_.spacings), obstacle = obstacle_.facts(wanted_.spacings);
    answer_.density = {input.spacing, obstacle.spacing};
    for (const Shape* const shape : {&input_, &obstacle_})
      if (shape->counted())
        answer_.warnings.push_back(warningOfIgnored(shape->name(), shape->ignored(), *shape->counted()));
    for (Warning& warning : warningsOf(question_, input, obstacle)) answer_.warnings.push_back(std::move(warning));
    for (Warning& hollow : warningsOfHollow(question_, nearestOf(question_, answer_), input_, obstacle_))
      answer_.warnings.push_back(std::move(hollow));
  }

  const Question& question_;
  Progress progress_{question_.progress}; ///< also of work outside queries: building, and contents of solids
  const Wanted& wanted_;
  Shape& input_;
  Shape& obstacle_;
  Placed b_, a_; ///< in this order: what is wrong with the obstacle is told first
  std::optional<Solids> solids_;
  bool closest_is_known_ = false;
  int begun_ = 0; ///< how many queries have begun
  Answer answer_;
};

/// Refuses options about points where the input is a surface.
void requireAnswerable(const Question& question, const Shape& input)
{
  if (!input.isSurface()) return;
  for (const char* const option : {"density", "seen"})
    if (option[0] == 'd' ? question.density : question.seen)
      throw InvalidOption(option, "is about points, and " + input.name() + " is a surface",
                          "give `vertices_only` to ask about its vertices, or leave it out");
}

} // namespace

Answer ask(const Question& question, Shape& input, Shape& obstacle)
{
  checkOptions(question);
  requireAnswerable(question, input);
  input.ignore(question.ignore_points);
  obstacle.ignore(question.obstacle_ignore_points);
  return QuestionRun(question, input, obstacle).answer();
}

void check(const Question& question)
{
  Question of_nothing = question;
  of_nothing.uncertainty.field.clear();
  of_nothing.obstacle_uncertainty.field.clear();
  of_nothing.sigmas = 1.0;
  of_nothing.ignore_points = of_nothing.obstacle_ignore_points = {};
  of_nothing.seen = of_nothing.solid = of_nothing.input_solid = false;
  of_nothing.limits = {}; // negative ones are of solids
  leaveOutWaiting(of_nothing);
  of_nothing.progress = nullptr;
  of_nothing.wanted.spacings = false;
  checkOptions(question);
  Shape input("the input", PointsView()), obstacle("the obstacle", PointsView());
  ask(of_nothing, input, obstacle);
}

} // namespace pcl_bsh

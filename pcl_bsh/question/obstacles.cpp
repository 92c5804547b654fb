// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/obstacles.h>

#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/question/options.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace pcl_bsh {
namespace {

bool isNearer(double one, double other)
{
  return std::isnan(other) ? !std::isnan(one) : one < other;
}

/// The earlier of two numbers of poses, of which those below 0 are none.
std::int32_t earlier(std::int32_t one, std::int32_t other)
{
  if (one < 0 || other < 0) return std::max(one, other);
  return std::min(one, other);
}

void setEarlier(std::optional<FirstContact>& one, const std::optional<FirstContact>& other)
{
  const auto at = [](const FirstContact& contact) { return static_cast<double>(contact.pose) + contact.fraction; };
  if (other && (!one || at(*other) < at(*one))) one = other;
}

/// Joins the answers about obstacles, one after another.
class JoinedAnswers {
public:
  JoinedAnswers(std::size_t records, const Wanted& wanted) : records_(records), wanted_(wanted) {}

  void add(std::uint32_t obstacle, const Answer& answer)
  {
    addCollisions(obstacle, answer.collisions);
    addDistances(obstacle, answer.distances.a, answer.within);
    addLists(answer.indices);
    Answer& all = joined_.all;
    if (answer.any.verdict != Verdict::free && graver(all.any.verdict, answer.any.verdict) != all.any.verdict)
      all.any = answer.any;
    if (answer.closest.pair && isNearer(answer.closest.distance, all.closest.distance)) {
      all.closest = answer.closest;
      joined_.closest = obstacle;
    }
    all.widest_gap = std::max(all.widest_gap, answer.widest_gap);
    if (!all.density.input) all.density = answer.density;
    all.work += answer.work;
    for (const Warning& warning : answer.warnings) {
      const auto same = [&](const Warning& known) { return known.text == warning.text; };
      if (std::none_of(all.warnings.begin(), all.warnings.end(), same)) all.warnings.push_back(warning);
    }
    joined_.each.push_back(summaryOf(answer));
  }

  /// Tells of the obstacle that was added last where it is nearest, if nothing collides with it.
  void setClosest(const DistanceResult& closest, std::int32_t pose)
  {
    ObstacleAnswer& one = joined_.each.back();
    one.closest = closest;
    one.closest_pose = pose;
    joined_.all.work += closest.work;
    if (!closest.pair || !isNearer(closest.distance, joined_.all.closest.distance)) return;
    joined_.all.closest = closest;
    joined_.closest = static_cast<std::uint32_t>(joined_.each.size() - 1);
  }

  /// @param moves whether there is a path
  ObstaclesAnswer finish(bool moves)
  {
    Answer& all = joined_.all;
    TrajectoryResult& found = all.collisions;
    found.colliding = countOf(found.flags, Verdict::colliding);
    found.undecided = countOf(found.flags, Verdict::undecided);
    all.sparse = countOf(found.flags, Verdict::sparse);
    if (joined_.each.size() > 1) summarise(all.distances.a);
    for (auto* const list : {&all.indices.a, &all.indices.undecided_a}) {
      std::sort(list->begin(), list->end());
      list->erase(std::unique(list->begin(), list->end()), list->end());
    }
    auto& perhaps = all.indices.undecided_a; // of one obstacle, what collides with another
    perhaps.erase(std::remove_if(perhaps.begin(), perhaps.end(),
                                 [&](std::int32_t record) {
                                   return std::binary_search(all.indices.a.begin(), all.indices.a.end(), record);
                                 }),
                  perhaps.end());
    if (!moves)
      for (ObstacleAnswer& one : joined_.each) one.closest_pose = -1;
    return std::move(joined_);
  }

  /// Adds an obstacle that is not asked about.
  void skip() { joined_.each.emplace_back().asked = false; }

  /// The answer has an entry for each record also where nothing was asked about the obstacles one by one.
  void fill(std::size_t poses)
  {
    TrajectoryResult& found = joined_.all.collisions;
    if (wanted_.poses) found.poses.resize(poses);
    if (wanted_.flags || wanted_.poses) found.flags.resize(records_, Verdict::free);
    if (wanted_.first_poses) found.first_pose.resize(records_, -1);
    if (!wanted_.contacts) return;
    found.flags.resize(records_, Verdict::free);
    found.distance.resize(records_, std::numeric_limits<float>::quiet_NaN());
    found.first_pose.resize(records_, -1);
    found.closest_pose.resize(records_, -1);
    found.closest_point.resize(records_, kNothing);
    joined_.closest_obstacle.resize(records_, kNothing);
  }

private:
  static ObstacleAnswer summaryOf(const Answer& answer)
  {
    ObstacleAnswer one;
    one.colliding = answer.collisions.colliding;
    one.undecided = answer.collisions.undecided;
    one.sparse = answer.sparse;
    one.unseen = answer.unseen.count;
    one.closest = answer.closest;
    const std::vector<std::int32_t>& poses = answer.collisions.closest_pose;
    if (one.closest.pair && one.closest.pair->a < poses.size()) one.closest_pose = poses[one.closest.pair->a];
    for (const auto& [count, verdict] : {std::pair{one.colliding, Verdict::colliding},
                                         {one.undecided, Verdict::undecided},
                                         {one.sparse, Verdict::sparse},
                                         {one.unseen, Verdict::unseen}})
      if (count > 0) one.verdict = graver(one.verdict, verdict);
    one.verdict = graver(one.verdict, answer.any.verdict);
    if (!answer.indices.undecided_a.empty()) one.verdict = graver(one.verdict, Verdict::undecided);
    if (!answer.indices.a.empty()) one.verdict = Verdict::colliding;
    return one;
  }

  void addCollisions(std::uint32_t obstacle, const TrajectoryResult& more)
  {
    TrajectoryResult& found = joined_.all.collisions;
    const auto grow = [](auto& all, const auto& one, auto nothing) {
      if (all.size() < one.size()) all.resize(one.size(), nothing);
    };
    grow(found.flags, more.flags, Verdict::free);
    for (std::size_t i = 0; i < more.flags.size(); ++i) found.flags[i] = graver(found.flags[i], more.flags[i]);
    grow(found.first_pose, more.first_pose, -1);
    for (std::size_t i = 0; i < more.first_pose.size(); ++i)
      found.first_pose[i] = earlier(found.first_pose[i], more.first_pose[i]);
    grow(found.certain_pose, more.certain_pose, -1);
    for (std::size_t i = 0; i < more.certain_pose.size(); ++i)
      found.certain_pose[i] = earlier(found.certain_pose[i], more.certain_pose[i]);
    grow(found.distance, more.distance, std::numeric_limits<float>::quiet_NaN());
    grow(found.closest_pose, more.closest_pose, -1);
    grow(found.closest_point, more.closest_point, kNothing);
    grow(joined_.closest_obstacle, more.distance, kNothing);
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    grow(found.interval, more.interval, Interval{unknown, unknown});
    for (std::size_t i = 0; i < more.distance.size(); ++i) {
      if (!isNearer(static_cast<double>(more.distance[i]), static_cast<double>(found.distance[i]))) continue;
      found.distance[i] = more.distance[i];
      if (i < more.closest_pose.size()) found.closest_pose[i] = more.closest_pose[i];
      if (i < more.closest_point.size()) found.closest_point[i] = more.closest_point[i];
      if (i < found.interval.size())
        found.interval[i] = i < more.interval.size() ? more.interval[i] : Interval{unknown, unknown};
      joined_.closest_obstacle[i] = obstacle;
    }
    if (found.poses.size() < more.poses.size()) found.poses.resize(more.poses.size());
    for (std::size_t k = 0; k < more.poses.size(); ++k) found.poses[k] += more.poses[k];
    setEarlier(found.first_contact, more.first_contact);
    setEarlier(found.certain_contact, more.certain_contact);
    found.work += more.work;
  }

  /// @param within of the record's distance from this obstacle; the nearest obstacle decides
  void addDistances(std::uint32_t obstacle, const PointDistances& more, const std::vector<std::uint8_t>& within)
  {
    PointDistances& all = joined_.all.distances.a;
    const bool is_first = all.distance.empty();
    if (is_first) {
      all = more;
      joined_.all.within = within;
      if (!more.distance.empty()) joined_.closest_obstacle.assign(more.distance.size(), kNothing);
    }
    for (std::size_t i = 0; i < more.distance.size(); ++i) {
      if (is_first ? std::isnan(more.distance[i]) : !isNearer(more.distance[i], all.distance[i])) continue;
      joined_.closest_obstacle[i] = obstacle;
      if (is_first) continue;
      all.distance[i] = more.distance[i];
      all.closest_point[i] = more.closest_point[i];
      if (!all.interval.empty()) all.interval[i] = more.interval[i];
      if (!within.empty()) joined_.all.within[i] = within[i];
    }
    if (!is_first) all.work += more.work;
  }

  /// Counts records that have a distance, and finds the greatest.
  void summarise(PointDistances& all) const
  {
    all.measured = 0;
    all.greatest = std::numeric_limits<double>::quiet_NaN();
    all.greatest_pair.reset();
    for (std::uint32_t i = 0; i < all.distance.size(); ++i) {
      if (std::isnan(all.distance[i])) continue;
      ++all.measured;
      if (all.distance[i] <= all.greatest) continue;
      all.greatest = all.distance[i];
      all.greatest_pair = PointPair{i, all.closest_point[i]};
    }
  }

  void addLists(const CollidingIndices& more)
  {
    CollidingIndices& all = joined_.all.indices;
    all.a.insert(all.a.end(), more.a.begin(), more.a.end());
    all.undecided_a.insert(all.undecided_a.end(), more.undecided_a.begin(), more.undecided_a.end());
    all.work += more.work;
  }

  const std::size_t records_;
  const Wanted& wanted_;
  ObstaclesAnswer joined_;
};

/// Refuses what has no meaning for several obstacles.
void requireSeveral(const Question& question, std::size_t obstacles)
{
  if (obstacles < 2) return;
  const Wanted& wanted = question.wanted;
  if (wanted.both_ways || wanted.obstacle_flags || wanted.obstacle_indices)
    throw InvalidInput(Input::points, "obstacles", "are several, and records of the obstacle are asked for",
                       "ask about one at a time");
  if (wanted.within && wanted.distances && question.max_distance.value_or(question.limits.most) < question.limits.most)
    throw InvalidOption("max_distance", "is below the limits, and obstacles are several",
                        "give no less than the limits");
}

/// Returns the wanted answers without those about collisions.
Wanted withoutCollisions(Wanted wanted)
{
  wanted.flags = wanted.obstacle_flags = wanted.any = wanted.indices = wanted.obstacle_indices = false;
  wanted.contacts = wanted.poses = wanted.first_poses = false;
  return wanted;
}

/// Whether anyCollision() at one pose may spare the rest: nothing but what collides is told of the records.
bool maySpare(const Question& question)
{
  return question.wanted.collisions() && !question.path && !question.seen && !question.density &&
         !question.accuracy.stopsEarly();
}

/// The progress of one of several equal parts: it never falls from one to the next.
std::function<bool(double)> progressOfPart(const std::function<bool(double)>& progress, std::size_t part,
                                           std::size_t parts)
{
  if (!progress) return nullptr;
  return [progress, part, parts](double done) {
    return progress((static_cast<double>(part) + done) / static_cast<double>(parts));
  };
}

/// Asks about one obstacle, whose records are not told where it is free.
Answer askOrSpare(const Question& question, Shape& input, Shape& obstacle)
{
  if (!maySpare(question)) return ask(question, input, obstacle);
  Question any = question;
  any.wanted = {};
  any.wanted.any = true;
  any.progress = progressOfPart(question.progress, 0, 2);
  const Answer found = ask(any, input, obstacle);
  Question rest = question;
  rest.progress = progressOfPart(question.progress, 1, 2);
  if (found.any.verdict == Verdict::free) rest.wanted = withoutCollisions(question.wanted);
  Answer answer = ask(rest, input, obstacle);
  answer.work += found.work;
  return answer;
}

/// The smallest distance at the pose, or at those of a path, and the first pose that has it. Motion between poses does
/// not count.
std::pair<DistanceResult, std::int32_t> closestAlong(const Question& question, Shape& input, Shape& obstacle)
{
  const Placed a(input.hierarchy(question.uncertaintyOfInput(), question.threads), question.pose_of_input);
  const SphereHierarchy& b = obstacle.hierarchy(question.uncertaintyOfObstacle(), question.threads);
  std::pair<DistanceResult, std::int32_t> best{{}, -1};
  DistanceRequest request;
  const std::vector<Eigen::Isometry3d> poses = question.poses();
  for (std::size_t k = 0; k < poses.size(); ++k) {
    request.max_distance = best.first.distance;
    DistanceResult found = closestPair(a, {b, poses[k]}, request);
    const Work work = found.work;
    if (found.pair && isNearer(found.distance, best.first.distance)) {
      std::swap(found.work, best.first.work);
      best = {std::move(found), static_cast<std::int32_t>(k)};
    }
    best.first.work += work;
  }
  return best;
}

} // namespace

Question questionOf(const Question& question, const PlacedShape& obstacle)
{
  Question one = question;
  if (!obstacle.pose.matrix().isIdentity(0.0)) {
    const auto place = [&](Eigen::Isometry3d& pose) {
      pose = pose.matrix().isIdentity(0.0) ? obstacle.pose : pose * obstacle.pose;
    };
    place(one.pose);
    if (one.path) std::for_each(one.path->begin(), one.path->end(), place);
  }
  if (obstacle.clearance) one.clearance = obstacle.clearance;
  if (obstacle.solid) one.solid = *obstacle.solid;
  if (obstacle.uncertainty) one.obstacle_uncertainty = *obstacle.uncertainty;
  return one;
}

ObstaclesAnswer ask(const Question& question, Shape& input, std::vector<PlacedShape>& obstacles, const AnswerOf& told)
{
  if (obstacles.empty()) throw InvalidInput(Input::points, "obstacles", "there are none", "give one at least");
  const Wanted& wanted = question.wanted;
  requireSeveral(question, obstacles.size());
  const std::size_t records = input.hierarchy(question.uncertaintyOfInput(), question.threads).view().count;
  JoinedAnswers joined(records, wanted);
  for (std::uint32_t i = 0; i < obstacles.size(); ++i) {
    if (obstacles[i].ignores_input) {
      joined.skip();
      continue;
    }
    Question one = questionOf(question, obstacles[i]);
    one.progress = progressOfPart(question.progress, i, obstacles.size());
    Answer answer =
        obstacles.size() == 1 ? ask(one, input, obstacles[i].shape) : askOrSpare(one, input, obstacles[i].shape);
    joined.add(i, answer);
    if (wanted.closest && !answer.closest.pair) {
      const auto [closest, pose] = closestAlong(one, input, obstacles[i].shape);
      joined.setClosest(closest, pose);
    }
    if (told) told(i, one, answer);
  }
  joined.fill(question.poses().size());
  return joined.finish(question.path.has_value());
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// How a moving object gives way: it stops, it slides, it follows the ground. Before it moves, the pairs of points that
// can meet on its way are collected; after that only they count, and each is followed by itself.
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/query/scene/state.h>
#include <pcl_bsh/query/scene/sweep.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace pcl_bsh {
namespace {

constexpr int kMostBounces = 32;           // of a slide: planes met one after the other
constexpr int kMostHalvings = 48;          // of a way on which too many points can meet
constexpr std::size_t kFewPairs = 1 << 11; // of points that can meet: a translation is followed at once
constexpr int kMostPortions = 256;         // of a translation

/// Two points that may meet: one of the mover, one of another object that stands.
struct Encounter {
  PointPair pair; ///< a: the mover's
  std::uint32_t part = 0;
  ObjectId other = 0;
  std::uint32_t other_part = 0;
  double reach = 0.0;     ///< the pair's clearance and the points' radii
  double clearance = 0.0; ///< the pair's alone
  Eigen::Vector3d apart;  ///< from the other's point to the mover's, at the pose they were collected at
};

/// Planes that a sliding object may not cross: it has met them and has not moved off since.
class Planes {
public:
  void forget() { count_ = 0; }

  /// What is left of a motion that must not enter the new plane nor those before it; 0 in a corner.
  Eigen::Vector3d add(const Eigen::Vector3d& normal, const Eigen::Vector3d& motion)
  {
    if (count_ < normals_.size()) normals_[count_++] = normal;
    Eigen::Vector3d along = motion - std::min(0.0, motion.dot(normal)) * normal;
    if (allowed(along)) return along;
    for (std::size_t i = 0; i + 1 < count_; ++i) {
      const Eigen::Vector3d edge = normal.cross(normals_[i]);
      if (edge.squaredNorm() < 1e-12) continue;
      along = edge * (motion.dot(edge) / edge.squaredNorm());
      if (allowed(along)) return along;
    }
    return Eigen::Vector3d::Zero();
  }

private:
  bool allowed(const Eigen::Vector3d& motion) const
  {
    const double slack = 1e-12 * motion.norm();
    for (std::size_t i = 0; i < count_; ++i)
      if (motion.dot(normals_[i]) < -slack) return false;
    return true;
  }

  std::array<Eigen::Vector3d, 8> normals_;
  std::size_t count_ = 0;
};

/// One object on its way among all the others, which stand still meanwhile.
class Mover {
public:
  Mover(Scene::State& state, ObjectId object, EffectCost& cost)
  : state_(state),
    body_(state.bodies[object]),
    object_(object),
    tolerance_(state.options.tolerance),
    cost_(cost)
  {
    outcome.object = object;
  }

  Outcome outcome;

  const Eigen::Isometry3d& pose() const { return body_.object.pose; }
  Eigen::Vector3d center() const
  {
    return body_.box.empty() ? Eigen::Vector3d(pose().translation()) : Eigen::Vector3d(pose() * body_.box.center());
  }
  void put(const Eigen::Isometry3d& pose) { state_.setPose(object_, pose); }

  /// To the target or to the first contact. @return whether it got there
  bool follow(const Eigen::Isometry3d& target) { return follow(target, kMostHalvings); }

  /// Straight on, or along what it meets: at once where few points can meet on the way, else in portions, each twice as
  /// long as the one before while nothing is met. @return whether it got there
  bool translate(const Eigen::Vector3d& shift, bool slide)
  {
    const double first = 0.5 * state_.rules.largestClearance() + 32 * tolerance_;
    Eigen::Isometry3d target = pose();
    target.translation() += shift;
    Eigen::Vector3d left = shift;
    const bool few = collect(Path(pose(), target, body_.box), kFewPairs);
    if (few) return advance(shift, slide);
    double portion = first;
    bool whole = true;
    for (int i = 0; i < kMostPortions && left != Eigen::Vector3d::Zero(); ++i) {
      const double length = left.norm();
      const bool last = length <= portion;
      const Eigen::Vector3d part = last ? left : Eigen::Vector3d(left * (portion / length));
      left = last ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : Eigen::Vector3d(left - part);
      if (collectAndAdvance(part, slide, kMostHalvings)) {
        portion *= 2;
        continue;
      }
      whole = false;
      if (!slide || outcome.stuck) return false;
      left -= std::min(0.0, left.dot(normal_)) * normal_; // what it has met does not go away
      if (left.norm() < 1e-6 * shift.norm()) break;
      portion = first;
    }
    if (whole && accept(target)) return true; // without the portions' rounding
    return whole;
  }

private:
  bool follow(const Eigen::Isometry3d& target, int halvings)
  {
    const Path path(pose(), target, body_.box);
    if (!collect(path, kMostPairs)) {
      if (halvings == 0 || path.speed() <= 0.5 * tolerance_) return halt();
      return follow(path.at(0.5), halvings - 1) && follow(target, halvings - 1);
    }
    if (outcome.stuck) return false;
    const Path still(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity(), Box3());
    double end = 1.0;
    const Encounter* met = nullptr;
    for (const Encounter& e : encounters_) {
      const ScenePart& part = body_.object.parts[e.part];
      const Point3 p = part.hierarchy->view().point(e.pair.a);
      const Point3 q = hierarchyOf(e).view().point(e.pair.b);
      const Eigen::Vector3d local = part.pose * Eigen::Vector3d(p[0], p[1], p[2]);
      const Eigen::Vector3d other = worldOf(e) * Eigen::Vector3d(q[0], q[1], q[2]);
      const auto s = meeting(path, local, still, other, {e.reach, tolerance_}, 0.0, end);
      if (!s) continue;
      end = *s;
      met = &e;
    }
    if (!met) return accept(target);
    touch(*met);
    accept(path.at(end));
    return false;
  }

  /// One portion of a translation.
  bool collectAndAdvance(const Eigen::Vector3d& shift, bool slide, int halvings)
  {
    Eigen::Isometry3d target = pose();
    target.translation() += shift;
    if (collect(Path(pose(), target, body_.box), kMostPairs)) return advance(shift, slide);
    if (halvings == 0 || shift.norm() <= 0.5 * tolerance_) return halt();
    const Eigen::Vector3d half = 0.5 * shift;
    if (collectAndAdvance(half, slide, halvings - 1)) return collectAndAdvance(half, slide, halvings - 1);
    if (slide) collectAndAdvance(half - std::min(0.0, half.dot(normal_)) * normal_, slide, halvings - 1);
    return false;
  }

  /// The same, once all that can meet on it is collected.
  bool advance(const Eigen::Vector3d& shift, bool slide)
  {
    const double length = shift.norm();
    if (length == 0.0) return true;
    Eigen::Isometry3d target = pose();
    target.translation() += shift;
    if (outcome.stuck) return false;
    if (encounters_.empty()) return accept(target);

    bool free = true;
    Planes planes;
    Eigen::Vector3d done = Eigen::Vector3d::Zero(), left = shift;
    for (int bounce = 0; bounce < kMostBounces && left.norm() > 1e-6 * length; ++bounce) {
      const Encounter* met = nullptr;
      double end = 1.0;
      for (const Encounter& e : encounters_) {
        const auto s = meeting(e.apart + done, left, {e.reach, tolerance_});
        if (!s || (met && *s >= end)) continue;
        end = *s;
        met = &e;
      }
      if (end * left.norm() > tolerance_) planes.forget();
      done += end * left;
      if (!met) break;
      free = false;
      touch(*met);
      if (!slide) break;
      normal_ = (met->apart + done).stableNormalized();
      left = planes.add(normal_, (1.0 - end) * left);
    }
    target = pose();
    target.translation() += done;
    return accept(target) && free;
  }

  /// All pairs of points that can meet on the path. @return false when there are more than `most` with one other part
  bool collect(const Path& path, std::size_t most)
  {
    encounters_.clear();
    if (body_.box.empty()) return true;
    const double length = path.speed() * (1.0 + 0x1p-40);
    Box3 swept = path.swept();
    swept.grow(state_.rules.largestClearance() * (1.0 + 0x1p-40) + tolerance_);
    state_.grid.around(swept, around_);
    for (const ObjectId other : around_) {
      if (other == object_) continue;
      const std::optional<double> clearance = state_.rules.clearanceOf(object_, other);
      if (!clearance || !swept.meets(state_.bodies[other].world_box)) continue;
      if (!collectFrom(other, *clearance, length, most)) return false;
    }
    return true;
  }

  bool collectFrom(ObjectId other, double clearance, double length, std::size_t most)
  {
    CollisionRequest request;
    request.clearance = clearance + length + tolerance_;
    for (std::uint32_t i = 0; i < body_.world.size(); ++i)
      for (std::uint32_t j = 0; j < state_.bodies[other].world.size(); ++j) {
        const Placed mine = state_.placed(object_, i), others = state_.placed(other, j);
        const PairsWithin found = pairsWithin(mine, others, request, most);
        ++cost_.pairs;
        cost_.work += found.work;
        if (!found.complete) {
          crowded_ = other;
          return false;
        }
        const ExactDistance exact(mine.pose, others.pose);
        const PointsView &a = mine.hierarchy.view(), &b = others.hierarchy.view();
        for (const PointPair pair : found.pairs) {
          const Point3 p = a.point(pair.a), q = b.point(pair.b);
          Encounter e{pair, i, other, j, clearance + a.radius(pair.a) + b.radius(pair.b), clearance, {}};
          e.apart = mine.pose * Eigen::Vector3d(p[0], p[1], p[2]) - others.pose * Eigen::Vector3d(q[0], q[1], q[2]);
          if (e.apart.norm() <= e.reach + 0.125 * tolerance_) {
            ++cost_.work.exact_decisions;
            if (exact.compare(p, q, clearance, a.radius(pair.a), b.radius(pair.b)) <= 0) {
              outcome.stuck = true;
              touch(e);
              return true;
            }
          }
          encounters_.push_back(e);
        }
      }
    return true;
  }

  /// Takes the pose, unless any of the pairs that can have met does collide there, in exact arithmetic.
  bool accept(const Eigen::Isometry3d& target)
  {
    const Eigen::Isometry3d before = pose();
    put(target);
    for (std::size_t i = 0; i < encounters_.size();) {
      const Encounter& first = encounters_[i];
      const ExactDistance exact(body_.world[first.part], worldOf(first));
      const PointsView &a = body_.object.parts[first.part].hierarchy->view(), &b = hierarchyOf(first).view();
      for (; i < encounters_.size(); ++i) {
        const Encounter& e = encounters_[i];
        if (e.part != first.part || e.other != first.other || e.other_part != first.other_part) break;
        if (distanceOf(e) > e.reach + 0.125 * tolerance_) continue; // far above what rounding takes
        ++cost_.work.exact_decisions;
        if (exact.compare(a.point(e.pair.a), b.point(e.pair.b), e.clearance, a.radius(e.pair.a), b.radius(e.pair.b)) >
            0)
          continue;
        put(before);
        touch(e);
        return false;
      }
    }
    return true;
  }

  double distanceOf(const Encounter& e) const
  {
    const Point3 p = body_.object.parts[e.part].hierarchy->view().point(e.pair.a);
    const Point3 q = hierarchyOf(e).view().point(e.pair.b);
    return (body_.world[e.part] * Eigen::Vector3d(p[0], p[1], p[2]) - worldOf(e) * Eigen::Vector3d(q[0], q[1], q[2]))
        .norm();
  }

  bool halt()
  {
    outcome.touched = true;
    outcome.against = crowded_;
    return false;
  }

  void touch(const Encounter& encounter)
  {
    outcome.touched = true;
    outcome.against = encounter.other;
  }

  const SphereHierarchy& hierarchyOf(const Encounter& e) const
  {
    return *state_.bodies[e.other].object.parts[e.other_part].hierarchy;
  }
  const Eigen::Isometry3d& worldOf(const Encounter& e) const { return state_.bodies[e.other].world[e.other_part]; }

  Scene::State& state_;
  Body& body_;
  ObjectId object_;
  double tolerance_;
  EffectCost& cost_;
  ObjectId crowded_ = 0;                             ///< whose points are too many to collect
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero(); ///< of the plane last met
  std::vector<ObjectId> around_;
  std::vector<Encounter> encounters_;
};

/// Turned as the target, about the centre of its box, but still where it is.
Eigen::Isometry3d turnedInPlace(const Body& body, const Eigen::Isometry3d& target)
{
  const Eigen::Vector3d center = body.box.empty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(body.box.center());
  Eigen::Isometry3d pose = target;
  pose.translation() = body.object.pose * center - target.linear() * center;
  return pose;
}

/// @return whether the target was reached
bool moveTo(Mover& mover, const Body& body, const Eigen::Isometry3d& target, Response response)
{
  if (response == Response::none) {
    mover.put(target);
    return true;
  }
  if (response == Response::stop && body.object.pose.linear() != target.linear()) return mover.follow(target);
  bool reached = true;
  if (body.object.pose.linear() != target.linear()) {
    reached = mover.follow(turnedInPlace(body, target));
    if (reached && !mover.outcome.touched) {
      // From here on only the translation is left, as exactly as the target has it.
      return mover.translate(target.translation() - mover.pose().translation(), true);
    }
    const Eigen::Vector3d center = body.box.empty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(body.box.center());
    return mover.translate(target * center - mover.pose() * center, true) && reached;
  }
  return mover.translate(target.translation() - mover.pose().translation(), response == Response::slide);
}

} // namespace

void Scene::State::respond(ObjectId object, const Eigen::Isometry3d& target)
{
  using Clock = std::chrono::steady_clock;
  const auto seconds = [](Clock::time_point since) {
    return std::chrono::duration<double>(Clock::now() - since).count();
  };
  Body& body = bodies[object];
  const Response response = options.effects.response;
  EffectCost unused; // what moves without a response costs nothing to speak of
  EffectCost& moving =
      response == Response::none ? unused : cost(response == Response::stop ? Effect::stop : Effect::slide);
  const Eigen::Isometry3d start = body.object.pose;

  auto begin = Clock::now();
  Mover mover(*this, object, moving);
  const Eigen::Vector3d from = mover.center();
  mover.outcome.wanted =
      (target * (body.box.empty() ? Eigen::Vector3d::Zero() : Eigen::Vector3d(body.box.center())) - from).norm();
  bool reached = moveTo(mover, body, target, response);
  moving.seconds += seconds(begin);

  if (options.effects.gravity && !mover.outcome.stuck) {
    EffectCost& spent = cost(Effect::gravity);
    begin = Clock::now();
    const double height = options.effects.gravity->step_height;
    const Eigen::Vector3d down = options.effects.gravity->down.normalized();
    const Eigen::Vector3d wanted = target.translation() - start.translation();
    const auto progress = [&](const Eigen::Vector3d& center) { return (center - from).dot(wanted); };
    const auto drop = [&](Mover& falling, double depth) {
      falling.outcome.touched = false;
      return !falling.translate(depth * down, false) && falling.outcome.touched;
    };
    Outcome outcome = mover.outcome;
    bool lifted_is_better = false;
    if (!reached && response != Response::none) {
      // Blocked at this height: it may be a step.
      const Eigen::Isometry3d plain = body.object.pose;
      const Eigen::Vector3d plain_center = mover.center();
      setPose(object, start);
      Mover climber(*this, object, spent);
      climber.translate(-height * down, false);
      const double lifted = (climber.center() - from).norm();
      Eigen::Isometry3d high_target = target;
      high_target.translation() -= lifted * down;
      climber.outcome = Outcome();
      moveTo(climber, body, high_target, response);
      Outcome climbing = climber.outcome;
      const bool grounded = drop(climber, lifted + height);
      lifted_is_better =
          grounded && progress(climber.center()) > progress(plain_center) + options.tolerance * wanted.norm();
      if (lifted_is_better) {
        outcome.touched = climbing.touched;
        outcome.against = climbing.touched ? climbing.against : climber.outcome.against;
        outcome.grounded = true;
      }
      else {
        setPose(object, plain);
      }
    }
    if (!lifted_is_better) {
      Mover faller(*this, object, spent);
      if (response == Response::none) { // it may have walked into a slope
        Eigen::Isometry3d raised = body.object.pose;
        raised.translation() -= height * down;
        const Eigen::Isometry3d level = body.object.pose;
        setPose(object, raised);
        outcome.grounded = drop(faller, 2 * height);
        if (faller.outcome.stuck) setPose(object, level);
        outcome.stuck = faller.outcome.stuck;
      }
      else {
        outcome.grounded = drop(faller, height);
      }
    }
    mover.outcome = outcome;
    spent.seconds += seconds(begin);
  }
  mover.outcome.object = object;
  mover.outcome.travelled = (mover.center() - from).norm();
  result.outcomes.push_back(mover.outcome);
  place(object);
}

void Scene::State::move(double dt)
{
  const bool responding = options.effects.response != Response::none || options.effects.gravity.has_value();
  if (responding) prepareGrid();
  const double before = time, after = time + dt;
  for (ObjectId i = 0; i < bodies.size(); ++i) {
    Body& body = bodies[i];
    if (std::holds_alternative<NoMotion>(body.object.motion)) continue;
    const Eigen::Isometry3d from = poseAt(body.object.motion, body.start, before - body.start_time);
    const Eigen::Isometry3d to = poseAt(body.object.motion, body.start, after - body.start_time);
    Eigen::Isometry3d target = to;
    if (!body.on_course) { // the same motion from where it stands
      target.translation() = body.object.pose.translation() + (to.translation() - from.translation());
      target.linear() = from.linear() == to.linear()
                            ? Eigen::Matrix3d(body.object.pose.linear())
                            : Eigen::Quaterniond(to.linear() * from.linear().transpose() * body.object.pose.linear())
                                  .normalized()
                                  .toRotationMatrix();
    }
    if (target.matrix() == body.object.pose.matrix() && !options.effects.gravity) continue;
    if (!responding) {
      setPose(i, target);
      continue;
    }
    respond(i, target);
    if (body.object.pose.matrix() != target.matrix()) body.on_course = false;
  }
  time = after;
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/record_corners.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/pair_reach.h>
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/scene/responses/mover.h>
#include <pcl_bsh/scene/responses/straight_ways.h>
#include <pcl_bsh/scene/swept/sweep.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace pcl_bsh {
namespace {

constexpr int kMostContacts = 256;                // of one translation
constexpr int kMostBounces = 32;                  // of these, before points are collected anew
constexpr std::size_t kFewPairs = 1 << 11;        // of points that may meet on a way: it is followed at once
constexpr std::uint64_t kFewLeafPairs = 1 << 8;   // compared for a way of which nothing is known
constexpr std::uint64_t kMostLeafPairs = 1 << 13; // and for another
constexpr double kShortWay = 4.0;                 // tolerances: on a shorter way, more points are followed, too
constexpr double kSlack = 0.125;                  // of a way: so far beside it, a slide may bend

} // namespace

Mover::Mover(Scene::State& state, ObjectId object, EffectCost& cost)
: state_(state),
  body_(state.bodies[object]),
  object_(object),
  tolerance_(state.options.tolerance),
  cost_(cost)
{
}

bool Mover::follow(const Eigen::Isometry3d& target, const Eigen::Vector3d& turn)
{
  Leg leg{pose(), target, body_.center(), turn};
  const ObjectMotion motion(leg, body_.box);
  double done = 0.0;
  const bool whole = follow(motion, 0.0, 1.0, done);
  if (done == 0.0) return whole;
  leg.to = pose();
  leg.turn *= done;
  legs.push_back(leg);
  return whole;
}

/// @param length of the ways @param first whether nothing is known of them: what lies on something is mostly held at
/// once, and a short part of the way shows that sooner
Mover::Passage Mover::passageOn(const StraightWays& ways, double length, bool first) const
{
  if (length <= kShortWay * tolerance_) return {ways, kMostPairs, std::numeric_limits<std::uint64_t>::max()};
  return {ways, kFewPairs, first ? kFewLeafPairs : kMostLeafPairs};
}

/// Along one motion from s = begin to end, in halves where too many points can meet; its first part is short then.
/// @param done s of the last pose taken
bool Mover::follow(const ObjectMotion& motion, double begin, double end, double& done)
{
  const double length = end - begin;
  const auto wayOf = [&motion](double part) { // no point goes farther in a part of the motion
    return (motion.shift().norm() * part + motion.turningReach(part)) * (1.0 + kDoubleMargin);
  };
  const double reach = wayOf(length);
  const bool first = begin == 0.0;
  const bool few = collect(motion.swept(), passageOn(waysOn(motion, begin, end), reach, first));
  if (outcome.stuck) return false;
  const bool wide = motion.angle() * length > kWideTurn && encounters_.size() > kFewToTurn;
  if (!few || wide) {
    if (reach > 0.25 * tolerance_) {
      const double share = first ? std::min(0.5, 0.5 * kShortWay * tolerance_ / reach) : 0.5;
      const double middle = begin + share * length;
      return follow(motion, begin, middle, done) && follow(motion, middle, end, done);
    }
    if (!few) return halt();
  }
  double last = end;
  const Encounter* met = nullptr;
  const auto look = [&](const Encounter& e) {
    if (const auto s = contactOn(motion, e, begin, last)) last = *s, met = &e;
  };
  // The nearest points first: where these meet, most of the others are too far apart to meet before them.
  const auto apart = [](const Encounter& e) { return e.of_points ? e.apart.norm() - e.reach : 0.0; };
  const auto nearest = std::min_element(encounters_.begin(), encounters_.end(),
                                        [&](const auto& l, const auto& r) { return apart(l) < apart(r); });
  if (nearest != encounters_.end()) look(*nearest);
  double way = wayOf(last - begin);
  for (auto e = encounters_.begin(); e != encounters_.end() && last > begin; ++e) {
    if (e == nearest || (e->of_points && apart(*e) > way + tolerance_)) continue;
    const double before = last;
    look(*e);
    if (last < before) way = wayOf(last - begin);
  }
  if (met) touch(*met);
  if (last > begin) {
    if (!accept(motion.at(last))) return false;
    done = last;
  }
  return met == nullptr;
}

bool Mover::translate(const Eigen::Isometry3d& target, bool slide)
{
  // At once where few points can meet, else a short portion, what is left, and then portions, each twice as long as the
  // one before while nothing is met.
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  Eigen::Vector3d left = target.translation() - pose().translation();
  const double negligible = 1e-6 * left.norm(); // of a path that has been bent
  double portion = unlimited, after_first = unlimited;
  bool straight = true; // nothing met so far
  bool first = true;    // way that is looked at
  ContactPlanes planes;
  for (int contacts = 0; contacts < kMostContacts;) {
    const double length = left.norm();
    if (length <= (straight ? 0.0 : negligible)) return straight;
    const bool last = length <= portion;
    const double most_travel = last ? length : portion;
    const Eigen::Vector3d way = left * (most_travel / length);
    const StraightWays ways = shiftedBy(way, pose(), slide ? kSlack * most_travel : 0.0);
    const Passage passage = passageOn(ways, most_travel, first);
    Box3 swept = body_.world_box;
    swept.merge({swept.low + way, swept.high + way});
    swept.grow(ways.stray);
    if (!collect(swept, passage)) {
      if (portion != unlimited && most_travel <= 0.25 * tolerance_) return halt();
      portion = 0.5 * most_travel;
      if (first) portion = std::min(portion, 0.5 * kShortWay * tolerance_);
      first = false;
      continue;
    }
    if (outcome.stuck) return false;
    const Walked walked = walk(left, passage, straight && last ? &target : nullptr, slide, planes);
    if (walked == Walked::blocked || (walked == Walked::met && !slide)) return false;
    if (walked == Walked::free) {
      const double next = std::max(2 * portion, std::exchange(after_first, 0.0));
      if (4 * near_ <= kFewPairs) portion = next; // else there would be too many
      continue;
    }
    first = false;
    straight = false;
    ++contacts;
  }
  return false;
}

/// How far a way leads before it leaves the passage. @param gone what the object went since it was collected
double Mover::roomIn(const Passage& passage, const Eigen::Vector3d& gone, const Eigen::Vector3d& direction)
{
  const double length = passage.length(), slack = passage.ways.stray;
  const Eigen::Vector3d axis = 2.0 * passage.ways.shift / length;
  const double along = gone.dot(axis), climb = direction.dot(axis);
  const Eigen::Vector3d beside = gone - along * axis, drift = direction - climb * axis;
  double room = climb > 0.0 ? (length - along) / climb : climb < 0.0 ? along / -climb : length;
  // |beside + t drift| = slack
  const double a = drift.squaredNorm(), b = beside.dot(drift);
  const double c = std::max(slack * slack - beside.squaredNorm(), 0.0);
  if (a > 0.0) room = std::min(room, (std::sqrt(b * b + a * c) - b) / a);
  return std::max(room, 0.0) * (1.0 - kDoubleMargin);
}

/// On from where points were collected, within the passage. @param left what is left of the motion, shortened and bent
/// by what is met @param target the pose at its end
Mover::Walked Mover::walk(Eigen::Vector3d& left, const Passage& passage, const Eigen::Isometry3d* target, bool slide,
                          ContactPlanes& planes)
{
  const Eigen::Isometry3d start = pose();
  double most_travel = passage.length();
  const double negligible = 1e-6 * most_travel;
  Eigen::Vector3d gone = Eigen::Vector3d::Zero();
  for (int bounce = 0; bounce < kMostBounces; ++bounce) {
    const double length = left.norm();
    if (bounce > 0 && (length <= negligible || most_travel <= negligible)) return Walked::met;
    const bool last = length <= most_travel * (1.0 + kDoubleMargin);
    const Eigen::Vector3d part = last ? left : Eigen::Vector3d(left * (most_travel / length));
    const Encounter* met = nullptr;
    double end = 1.0;
    Eigen::Isometry3d ahead = pose();
    ahead.translation() += part;
    const RigidMotion motion(pose(), ahead, body_.center(), Eigen::Vector3d::Zero());
    for (const Encounter& e : encounters_) {
      const ContactZone zone{e.reach, tolerance_};
      const Eigen::Vector3d apart = e.apart + gone;
      const bool is_quick = e.of_points && !zone.isNext(apart.norm() - tolerance_ / 16); // more than rounding takes
      const auto s = is_quick ? timeOfContact(apart, part, zone) : contactOn(motion, e, 0.0, end);
      if (!s || (met && *s >= end)) continue;
      end = *s;
      met = &e;
    }
    const Eigen::Vector3d moved = end * part;
    const double distance = moved.norm();
    if (distance > 0.0) {
      Eigen::Isometry3d next = start;
      next.translation() += gone + moved;
      const bool arrives = bounce == 0 && !met && last && target != nullptr; // straight, without rounding
      if (!go(arrives ? *target : next)) return Walked::blocked;
    }
    gone += moved;
    left = !met && last ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : Eigen::Vector3d(left - moved);
    if (!met) return bounce == 0 ? Walked::free : Walked::met;
    touch(*met);
    if (distance > tolerance_) planes.forget();
    left = planes.add(normalOf(*met), left);
    if (!slide) return Walked::met;
    if (left == Eigen::Vector3d::Zero()) return Walked::met;
    most_travel = roomIn(passage, gone, left.normalized());
  }
  return Walked::met;
}

/// Collects all pairs of points that can meet while the object is within `swept` and goes by the passage. @return false
/// where too many of one other part are near
bool Mover::collect(Box3 swept, const Passage& passage)
{
  encounters_.clear();
  near_ = 0;
  collected_at_ = pose();
  if (body_.box.empty()) return true;
  swept.grow(state_.rules.largestClearance() * (1.0 + kDoubleMargin) + tolerance_);
  state_.grid.around(swept, around_);
  for (const ObjectId other : around_) {
    if (other == object_) continue;
    const std::optional<double> clearance = state_.rules.clearanceOf(object_, other);
    if (!clearance || !swept.meets(state_.bodies[other].world_box)) continue;
    if (!collectFrom(other, *clearance, passage)) return false;
    if (outcome.stuck) return true;
  }
  return true;
}

bool Mover::collectFrom(ObjectId other, double clearance, const Passage& passage)
{
  for (std::uint32_t i = 0; i < body_.world.size(); ++i)
    for (std::uint32_t j = 0; j < state_.bodies[other].world.size(); ++j) {
      const Placed mine = state_.placed(object_, i), others = state_.placed(other, j);
      const MeantPlaces places = possiblePlaces(mine, others);
      const Reach farthest(clearance, mine.hierarchy().storage().uncertainty, others.hierarchy().storage().uncertainty,
                           places);
      constexpr double halting = 0.75; // tolerances beyond the reach: halts are at half of one
      const StraightWays ways = waysOf(passage.ways, body_.object.parts[i].pose);
      const PairsWithin found =
          pairsAlong(mine.hierarchy(), ways, others, {farthest.most + halting * tolerance_, passage.most},
                     passage.most_leaf_pairs);
      near_ = std::max(near_, found.pairs.size());
      ++cost_.pairs;
      cost_.work += found.work;
      if (!found.complete) {
        crowded_ = other;
        return false;
      }
      const PointsView &a = mine.hierarchy().view(), &b = others.hierarchy().view();
      const RecordDistance exact(a, mine.pose, b, others.pose);
      const PairReach reach_of_pairs(a, b, clearance, places);
      const bool of_points = !a.triangles && !b.triangles;
      const bool is_one = reach_of_pairs.isOne() && !a.radii && !b.radii;
      const double one_reach = is_one ? reachOf(reach_of_pairs.of({})) : 0.0;
      for (const PointPair pair : found.pairs) {
        const Point3 p = a.point(pair.a), q = b.point(pair.b);
        const Eigen::Vector3d at(p[0], p[1], p[2]);
        Encounter e{pair, i, other, j, is_one ? one_reach : reachOf(reach_of_pairs.of(pair)), clearance, of_points, {}};
        e.apart = mine.pose * at - others.pose * Eigen::Vector3d(q[0], q[1], q[2]);
        if (of_points) {
          const Eigen::Vector3d half = ways.half(at);
          if (leastOnWay(e.apart + half, half) > e.reach + ways.stray + halting * tolerance_) continue;
        }
        if ((of_points ? e.apart.norm() : separationOf(e).high) <= e.reach + 0.125 * tolerance_) {
          ++cost_.work.exact_decisions;
          if (reach_of_pairs.holds(exact, pair)) {
            outcome.stuck = true;
            touch(e);
            return true;
          }
        }
        encounters_.push_back(e);
      }
    }
  outcome.stuck = isInside(other);
  return true;
}

/// Whether the object begins inside of the other one, or round it. It has not met its surface since, so it is asked
/// once.
bool Mover::isInside(ObjectId other)
{
  if (state_.solids.none() || std::find(outside_of_.begin(), outside_of_.end(), other) != outside_of_.end())
    return false;
  for (std::uint32_t i = 0; i < body_.world.size(); ++i)
    for (std::uint32_t j = 0; j < state_.bodies[other].world.size(); ++j) {
      if (!state_.areSolid({object_, other, i, j})) continue;
      if (!state_.solids.find(state_.standing(object_, i), state_.standing(other, j), std::nullopt, cost_.work))
        continue;
      outcome.touched = true;
      outcome.against = other;
      return true;
    }
  outside_of_.push_back(other);
  return false;
}

/// Takes the pose, unless any of the pairs that can have met does collide there, in exact arithmetic.
bool Mover::accept(const Eigen::Isometry3d& target)
{
  const Eigen::Isometry3d before = pose();
  const bool turned = target.linear() != collected_at_.linear();
  const Eigen::Vector3d shift = target.translation() - collected_at_.translation();
  state_.setPose(object_, target);
  for (std::size_t i = 0; i < encounters_.size();) {
    const Encounter& first = encounters_[i];
    const SphereHierarchy &a = *body_.object.parts[first.part].hierarchy, &b = hierarchyOf(first);
    const RecordDistance exact(a.view(), body_.world[first.part], b.view(), worldOf(first));
    const PairReach reach_of_pairs(a.view(), b.view(), first.clearance, possiblePlaces({a}, {b}));
    for (; i < encounters_.size(); ++i) {
      const Encounter& e = encounters_[i];
      if (e.part != first.part || e.other != first.other || e.other_part != first.other_part) break;
      const double next = e.reach + 0.125 * tolerance_; // far above what rounding takes
      if (e.of_points && !turned && (e.apart + shift).norm() > next + tolerance_ / 16) continue;
      if (separationOf(e).high > next) continue;
      ++cost_.work.exact_decisions;
      if (!reach_of_pairs.holds(exact, e.pair)) continue;
      state_.setPose(object_, before);
      touch(e);
      return false;
    }
  }
  return true;
}

/// Accepts the end of a straight leg.
bool Mover::go(const Eigen::Isometry3d& target)
{
  const Eigen::Isometry3d before = pose();
  if (!accept(target)) return false;
  legs.push_back({before, target, body_.center(), Eigen::Vector3d::Zero()});
  return true;
}

/// When a pair meets while the object moves, and the other one stands still.
std::optional<double> Mover::contactOn(const RigidMotion& motion, const Encounter& e, double begin, double end) const
{
  static const RigidMotion still(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity(), Eigen::Vector3d::Zero(),
                                 Eigen::Vector3d::Zero());
  const ScenePart& part = body_.object.parts[e.part];
  return timeOfContact(motion, placedBy(part.pose, cornersOf(part.hierarchy->view(), e.pair.a)), still,
                       placedBy(worldOf(e), cornersOf(hierarchyOf(e).view(), e.pair.b)), {e.reach, tolerance_}, begin,
                       end);
}

/// At the object's pose.
Corners Mover::mineOf(const Encounter& e) const
{
  return placedBy(body_.world[e.part], cornersOf(body_.object.parts[e.part].hierarchy->view(), e.pair.a));
}

Corners Mover::othersOf(const Encounter& e) const
{
  return placedBy(worldOf(e), cornersOf(hierarchyOf(e).view(), e.pair.b));
}

Separation Mover::separationOf(const Encounter& e) const
{
  return pcl_bsh::separationOf(mineOf(e), othersOf(e));
}

/// Across a face, where that keeps them as far apart as they may pass each other: what comes over the edge between two
/// triangles of a floor meets no step there.
Eigen::Vector3d Mover::normalOf(const Encounter& e) const
{
  const Corners mine = mineOf(e), others = othersOf(e);
  Point3 normal = faceBetween(mine, others, ContactZone{e.reach, tolerance_}.inner());
  if (normal == Point3{0, 0, 0}) normal = pcl_bsh::separationOf(mine, others).direction;
  return {normal[0], normal[1], normal[2]};
}

bool Mover::halt()
{
  outcome.touched = true;
  outcome.against = crowded_;
  return false;
}

void Mover::touch(const Encounter& encounter)
{
  outcome.touched = true;
  outcome.against = encounter.other;
}

const SphereHierarchy& Mover::hierarchyOf(const Encounter& e) const
{
  return *state_.bodies[e.other].object.parts[e.other_part].hierarchy;
}

const Eigen::Isometry3d& Mover::worldOf(const Encounter& e) const
{
  return state_.bodies[e.other].world[e.other_part];
}

} // namespace pcl_bsh

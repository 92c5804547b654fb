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
constexpr std::uint64_t kMostLeafPairs = 1 << 13; // compared for a way
constexpr double kShortWay = 4.0;                 // tolerances: on a shorter way, more points are followed, too
constexpr double kFirstWay = 0.25;                // of the object's size: an object on a floor is mostly held at once
constexpr double kLonger = 16.0;                  // factor of the next way after one on which nothing was met
constexpr double kSlack = 0.125;                  // of a way's length: how far beside it a slide may bend

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
  const bool whole = follow(motion, 0.0, 1.0, firstWay(), done);
  if (done == 0.0) return whole;
  leg.to = pose();
  leg.turn *= done;
  legs.push_back(leg);
  return whole;
}

/// @param length of the ways
Mover::Passage Mover::passageOn(const StraightWays& ways, double length) const
{
  if (length <= kShortWay * tolerance_) return {ways, kMostPairs, std::numeric_limits<std::uint64_t>::max()};
  return {ways, kFewPairs, kMostLeafPairs};
}

double Mover::firstWay() const
{
  return std::max(kFirstWay * 2.0 * body_.box.half().norm(), kShortWay * tolerance_);
}

/// Follows one motion from s = begin to end, in halves where too many points can meet.
/// @param most how far a point may go in the first part @param done becomes s of the last pose taken
bool Mover::follow(const ObjectMotion& motion, double begin, double end, double most, double& done)
{
  const double length = end - begin;
  // No point goes farther.
  const double reach = (motion.shift().norm() * length + motion.turningReach(length)) * (1.0 + kDoubleMargin);
  if (reach > most) {
    const double middle = begin + length * (most / reach);
    return follow(motion, begin, middle, reach, done) && follow(motion, middle, end, kLonger * most, done);
  }
  Passage passage = passageOn(waysOn(motion, begin, end), reach);
  passage.until_met = FirstContact{&motion, begin, end};
  const bool few = collect(motion.swept(), passage);
  if (outcome.stuck) return false;
  const bool wide = motion.angle() * length > kWideTurn && encounters_.size() > kFewToTurn;
  if (!few || wide) {
    if (reach > 0.25 * tolerance_) {
      const double middle = 0.5 * (begin + end);
      return follow(motion, begin, middle, most, done) && follow(motion, middle, end, most, done);
    }
    if (!few) return halt();
  }
  double last = end;
  const Encounter* met = nullptr;
  for (const Encounter& e : encounters_)
    if (e.meets && (!met || *e.meets < last)) last = *e.meets, met = &e;
  if (met) touch(*met);
  if (last > begin) {
    if (!accept(motion.at(last))) return false;
    done = last;
  }
  return met == nullptr;
}

bool Mover::translate(const Eigen::Isometry3d& target, bool slide)
{
  // In portions to the first contact. A slide goes on at once where few points can meet, else in portions, too, each
  // twice as long as the one before while nothing is met.
  Eigen::Vector3d left = target.translation() - pose().translation();
  const double negligible = 1e-6 * left.norm(); // of a path that has been bent
  double portion = firstWay();
  const std::size_t legs_before = legs.size();
  bool straight = true; // nothing met so far: the first contact is sought
  ContactPlanes planes;
  for (int contacts = 0; contacts < kMostContacts;) {
    const double length = left.norm();
    if (length <= (straight ? 0.0 : negligible)) return straight;
    const bool last = length <= portion;
    const double most_travel = last ? length : portion;
    const Eigen::Vector3d way = left * (most_travel / length);
    Passage passage = passageOn(shiftedBy(way, pose(), straight ? 0.0 : kSlack * most_travel), most_travel);
    Eigen::Isometry3d ahead = pose();
    ahead.translation() += way;
    const RigidMotion motion(pose(), ahead, body_.center(), Eigen::Vector3d::Zero());
    if (straight) passage.until_met = FirstContact{&motion, 0.0, 1.0};
    Box3 swept = body_.world_box;
    swept.merge({swept.low + way, swept.high + way});
    swept.grow(passage.ways.stray);
    if (!collect(swept, passage)) {
      if (most_travel <= 0.25 * tolerance_) return halt();
      portion = 0.5 * most_travel;
      continue;
    }
    if (outcome.stuck) return false;
    const Walked walked = walk(left, passage, straight && last ? &target : nullptr, slide, planes);
    if (straight && legs.size() > legs_before + 1) { // portions of one straight leg
      legs[legs_before].to = legs.back().to;
      legs.resize(legs_before + 1);
    }
    if (walked == Walked::blocked || (walked == Walked::met && !slide)) return false;
    if (walked == Walked::free) {
      if (straight)
        portion *= kLonger;
      else if (4 * near_ <= kFewPairs) // else there would be too many
        portion *= 2.0;
      continue;
    }
    if (straight) portion = std::numeric_limits<double>::infinity();
    straight = false;
    ++contacts;
  }
  return false;
}

/// Returns how far a direction leads before it leaves the passage. @param gone the shift since pairs were collected
double Mover::roomIn(const Passage& passage, const Eigen::Vector3d& gone, const Eigen::Vector3d& direction)
{
  const double length = passage.length(), slack = passage.ways.stray;
  const Eigen::Vector3d axis = passage.ways.shift / length;
  const double along = gone.dot(axis), climb = direction.dot(axis);
  const Eigen::Vector3d beside = gone - along * axis, drift = direction - climb * axis;
  double room = climb > 0.0 ? (length - along) / climb : climb < 0.0 ? along / -climb : length;
  // |beside + t drift| = slack
  const double a = drift.squaredNorm(), b = beside.dot(drift);
  const double c = std::max(slack * slack - beside.squaredNorm(), 0.0);
  if (a > 0.0) room = std::min(room, (std::sqrt(b * b + a * c) - b) / a);
  return std::max(room, 0.0) * (1.0 - kDoubleMargin);
}

/// Moves on from where pairs were collected, within the passage.
/// @param left the rest of the motion; becomes shorter, and bent by what is met @param target the pose at its end
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
      const auto s = passage.until_met ? e.meets : contactOn(motion, part, e, gone, end);
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
    if (!slide || passage.until_met) return Walked::met;
    if (left == Eigen::Vector3d::Zero()) return Walked::met;
    most_travel = roomIn(passage, gone, left.normalized());
  }
  return Walked::met;
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

/// When a pair meets on a straight way. @param gone since the pair was collected
std::optional<double> Mover::contactOn(const RigidMotion& motion, const Eigen::Vector3d& way, const Encounter& e,
                                       const Eigen::Vector3d& gone, double end) const
{
  const ContactZone zone{e.reach, tolerance_};
  const Eigen::Vector3d apart = e.apart + gone;
  const bool is_quick = e.of_points && !zone.isNext(apart.norm() - tolerance_ / 16); // more than rounding takes
  return is_quick ? timeOfContact(apart, way, zone) : contactOn(motion, e, 0.0, end);
}

/// Returns the mover's record, at its pose.
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

/// Returns the direction across which a pair is in contact. It is the normal of a face, if the pair is as far apart
/// along it as pairs that pass each other have to be. So an object that slides over the edge between two triangles of a
/// floor meets no step there. Otherwise it is the direction between the nearest places.
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

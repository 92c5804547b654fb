// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/swept/conservative_advancement.h>

#include <pcl_bsh/geometry/exact/dyadic.h>
#include <pcl_bsh/geometry/triangle/vector3.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int kMostInside = 1024; // steps of a pair that starts within the zone and neither leaves nor enters it

/// The smallest h > 0 with gap + slope h - bend h^2 / 2 = 0, for a gap > 0; infinity where no such h exists.
double firstRoot(double gap, double slope, double bend)
{
  const double under = slope * slope + 2.0 * bend * gap;
  if (under < 0.0) return infinity;
  const double root = std::sqrt(under);
  if (slope <= 0.0) return root > slope ? 2.0 * gap / (root - slope) : infinity;
  return bend > 0.0 ? (root + slope) / bend : infinity; // the form that does not cancel here
}

/// Two points on their courses, seen from each other.
class MovingPointPair {
public:
  MovingPointPair(const PointMotion& a, const PointMotion& b, double end)
  : a_(a),
    b_(b),
    end_(end),
    turn_a_(a.angle * a.axis),
    turn_b_(b.angle * b.axis),
    shift_(a.shift - b.shift),
    center_(a.center - b.center),
    drift_(a.drift.norm() + b.drift.norm()),
    size_a_(a.spoke.norm() + a.drift.norm()),
    size_b_(b.spoke.norm() + b.drift.norm()),
    rim_a_(turn_a_.cross(a.spoke).norm() + a.angle * a.drift.norm()),
    rim_b_(turn_b_.cross(b.spoke).norm() + b.angle * b.drift.norm()),
    speed_((shift_.norm() + rim_a_ + rim_b_ + drift_) * kUp),
    bend_((a.angle * (rim_a_ + 2.0 * a.drift.norm()) + b.angle * (rim_b_ + 2.0 * b.drift.norm())) * kUp)
  {
    const double mixed = 4.0 * (shift_.cross(turn_a_).norm() * size_a_ + shift_.cross(turn_b_).norm() * size_b_) +
                         2.0 * (turn_a_ - turn_b_).norm() * (rim_a_ * size_b_ + size_a_ * rim_b_);
    square_bend_ = mixed * kUp - 2.0 * shift_.squaredNorm() * (1.0 - kDoubleMargin);
    const Eigen::Vector3d last = center_ + end * shift_;
    last_a_ = turn_a_.cross(last).norm();
    last_b_ = turn_b_.cross(last).norm();
  }

  double distance = 0.0;
  double closing = 0.0; ///< how fast it shrinks per unit of s; negative: how fast it grows
  double speed() const { return speed_; }

  void look(double s)
  {
    s_ = s;
    spoke_a_ = a_.spokeAt(s);
    spoke_b_ = b_.spokeAt(s);
    middle_ = center_ + s * shift_;
    apart_ = middle_ + spoke_a_ - spoke_b_;
    rim_ = turn_a_.cross(spoke_a_) - turn_b_.cross(spoke_b_);
    distance = apart_.norm();
    closing = distance > 0.0 ? -apart_.dot(shift_ + rim_) / distance : 0.0;
  }

  /// For this long the points stay farther apart than `limit`. Three bounds, each true by itself; the longest step
  /// counts.
  double safeStep(double limit) const
  {
    const double gap = distance - limit;
    if (!(gap > 0.0)) {
      // They move off, or not at all. The motion back to this distance is as safe as standing still.
      const double leaving = -(closing + drift_);
      return leaving > 0.0 ? 2.0 * leaving / bend_ : 0.0;
    }
    // No farther than both can go.
    double step = gap / speed_;
    // The distance of two points in straight motion is convex; turning bends it by no more than this.
    step = std::max(step, firstRoot(gap, -(closing + drift_), bend_));
    // The squared distance by its own second derivative, which is small where both turn about one axis: a ring about a
    // shaft stays as near as it is. Invalid for the drift, which is added to the limit for the whole motion.
    const double least = limit + drift_ * (end_ - s_);
    const double square_gap = (distance - least) * (distance + least);
    if (square_gap > 0.0) {
      const double slope = 2.0 * (middle_.dot(shift_ + rim_) + shift_.dot(spoke_a_ - spoke_b_) -
                                  (turn_a_ - turn_b_).dot(spoke_a_.cross(spoke_b_)));
      const double bend = square_bend_ + 2.0 * kUp *
                                             (std::max(last_a_, turn_a_.cross(middle_).norm()) * rim_a_ +
                                              std::max(last_b_, turn_b_.cross(middle_).norm()) * rim_b_);
      step = std::max(step, firstRoot(square_gap, slope, bend));
    }
    return step;
  }

private:
  static constexpr double kUp = 1.0 + 0x1p-40;

  const PointMotion &a_, &b_;
  double end_, s_ = 0.0;
  Eigen::Vector3d turn_a_, turn_b_, shift_, center_;
  double drift_;           // of both, per unit of s
  double size_a_, size_b_; // no spoke is longer
  double rim_a_, rim_b_;   // no spoke's end turns faster
  double speed_, bend_;
  double square_bend_ = 0.0, last_a_ = 0.0, last_b_ = 0.0;
  Eigen::Vector3d spoke_a_, spoke_b_, middle_, apart_, rim_;
};

Eigen::Vector3d vectorOf(const Point3& p)
{
  return {p[0], p[1], p[2]};
}

/// Corners of a body on their courses. All of them share the shift, the turn, and the centre, if there is a turn.
class CornersMotion {
public:
  CornersMotion(const RigidMotion& motion, const Corners& corners) : count_(corners.count)
  {
    for (std::uint32_t i = 0; i < count_; ++i) {
      courses_[i] = motion.motionOf(vectorOf(corners.at[i]));
      const double drift = courses_[i].drift.norm();
      const double rim =
          (courses_[i].angle * courses_[i].axis).cross(courses_[i].spoke).norm() + courses_[i].angle * drift;
      drift_ = std::max(drift_, drift);
      rim_ = std::max(rim_, rim);
      bend_ = std::max(bend_, courses_[i].angle * (rim + 2.0 * drift));
    }
    turn_ = courses_[0].angle * courses_[0].axis;
  }

  const Eigen::Vector3d& center() const { return courses_[0].center; }
  const Eigen::Vector3d& shift() const { return courses_[0].shift; }
  double drift() const { return drift_; }      ///< of any corner, per unit of s
  double turningSpeed() const { return rim_; } ///< of any corner at most
  double bend() const { return bend_; }        ///< no acceleration is larger

  /// Returns the corners at an instant, in coordinates that have the centre at `from`.
  Corners at(double s, const Eigen::Vector3d& from) const
  {
    Corners corners{{}, count_};
    for (std::uint32_t i = 0; i < count_; ++i) {
      const Eigen::Vector3d place = from + (courses_[i].center - center()) + courses_[i].spokeAt(s);
      corners.at[i] = {place[0], place[1], place[2]};
    }
    return corners;
  }

  /// Returns the velocity by the turn, of a place at this vector from the centre.
  Eigen::Vector3d velocityAt(const Eigen::Vector3d& spoke) const { return turn_.cross(spoke); }

private:
  std::uint32_t count_;
  PointMotion courses_[3];
  Eigen::Vector3d turn_;
  double drift_ = 0.0, rim_ = 0.0, bend_ = 0.0;
};

/// Two records on their courses, at least one of them a triangle, seen from the second's centre.
class MovingCornersPair {
public:
  MovingCornersPair(const CornersMotion& a, const CornersMotion& b)
  : a_(a),
    b_(b),
    shift_(a.shift() - b.shift()),
    center_(a.center() - b.center()),
    drift_(a.drift() + b.drift()),
    speed_((shift_.norm() + a.turningSpeed() + b.turningSpeed() + drift_) * kUp),
    bend_((a.bend() + b.bend()) * kUp)
  {
  }

  double distance = 0.0;
  double closing = 0.0; ///< how fast it shrinks per unit of s; negative: how fast it grows
  double speed() const { return speed_; }

  void look(double s)
  {
    middle_ = center_ + s * shift_;
    places_a_ = a_.at(s, middle_);
    places_b_ = b_.at(s, Eigen::Vector3d::Zero());
    apart_ = separationOf(places_a_, places_b_);
    distance = apart_.high;
    closing = -vectorOf(apart_.direction).dot(velocityOfA(apart_.place_a) - velocityOfB(apart_.place_b));
  }

  /// For this long they stay farther apart than `limit`, or than now if that is less. Each pair of corners stays
  /// that far apart along the present direction between the records, though the motion turns.
  double safeStep(double limit) const
  {
    const double gap = distance - limit;
    const Eigen::Vector3d direction = vectorOf(apart_.direction);
    double step = infinity;
    for (std::uint32_t i = 0; i < places_a_.count; ++i)
      for (std::uint32_t j = 0; j < places_b_.count; ++j) {
        const Eigen::Vector3d p = vectorOf(places_a_.at[i]), q = vectorOf(places_b_.at[j]);
        const double between = direction.dot(p - q) - std::min(limit, apart_.low);
        const double leaving = direction.dot(velocityOfA(places_a_.at[i]) - velocityOfB(places_b_.at[j])) - drift_;
        step = std::min(step, stepOf(between, leaving));
      }
    return gap > 0.0 ? std::max(step, gap / speed_) : step;
  }

private:
  static constexpr double kUp = 1.0 + 0x1p-40;

  double stepOf(double gap, double slope) const
  {
    if (gap > 0.0) return firstRoot(gap, slope, bend_);
    if (bend_ > 0.0) return slope > 0.0 ? 2.0 * slope / bend_ : 0.0;
    return slope >= 0.0 ? infinity : 0.0;
  }

  Eigen::Vector3d velocityOfA(const Point3& place) const { return shift_ + a_.velocityAt(vectorOf(place) - middle_); }
  Eigen::Vector3d velocityOfB(const Point3& place) const { return b_.velocityAt(vectorOf(place)); }

  const CornersMotion &a_, &b_;
  Eigen::Vector3d shift_, center_;
  double drift_;        // of both, per unit of s
  double speed_, bend_; // no two places approach faster; nor is their acceleration larger
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  Corners places_a_ = {}, places_b_ = {};
  Separation apart_;
};

/// The most that rounding may take of a distance of places that are moved: some forty roundings of the largest
/// coordinate that goes into each, as ObjectMotion::rounding() has it.
double roundingOf(const RigidMotion& motion, const Corners& corners)
{
  double largest = std::max({motion.from().translation().lpNorm<1>(), motion.to().translation().lpNorm<1>(),
                             motion.pivot().lpNorm<1>(), motion.shift().lpNorm<1>()});
  for (std::uint32_t i = 0; i < corners.count; ++i) largest = std::max(largest, vectorOf(corners.at[i]).lpNorm<1>());
  return 64 * kDoubleUnit * largest;
}

/// Whether two points that go straight come nearer, and within the reach at any s from `begin` to `end`, in exact
/// arithmetic.
bool comeWithin(const RigidMotion& motion_a, const Point3& p, const RigidMotion& motion_b, const Point3& q,
                double reach, double begin, double end)
{
  using Vector = Vector3<Dyadic>;
  const auto first = [](const RigidMotion& motion, const Point3& at) {
    const auto pose = [&](std::size_t row, std::size_t column) {
      return motion.from().matrix()(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column));
    };
    return placedBy<Dyadic>(pose, at);
  };
  const auto way = [](const RigidMotion& motion) {
    Vector shift;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      shift[k] = Dyadic(motion.to().translation()[axis]) - Dyadic(motion.from().translation()[axis]);
    }
    return shift;
  };
  const Vector shift = way(motion_a) - way(motion_b), start = first(motion_a, p) - first(motion_b, q);
  const Vector apart = start + Dyadic(begin) * shift, last = start + Dyadic(end) * shift;
  const Dyadic square = Dyadic(reach) * Dyadic(reach), along = dot(apart, shift);
  if (along.sign() >= 0) return false;
  if (dot(last, shift).sign() <= 0) return (dot(last, last) - square).sign() <= 0; // nearest at the end
  return ((dot(apart, apart) - square) * dot(shift, shift) - along * along).sign() <= 0;
}

/// Finds the first contact, in steps that certainly have no contact before their end.
/// @param rounding bounds the rounding of a distance
template <class MovingPair>
std::optional<double> advance(MovingPair& moving, const ContactZone& zone, double rounding, double begin, double end)
{
  moving.look(begin);
  if (moving.distance <= zone.reach + rounding && moving.closing > 0.0) return begin;
  bool inside = moving.distance <= zone.outer(); // from the start
  // Steps lead to between this and outer, so that a halted pair still has some distance to inner.
  const double halt = zone.reach + 0.4375 * zone.tolerance;
  double limit = inside ? zone.floor(moving.distance) : halt;
  if (moving.distance < zone.reach - 0.0625 * zone.tolerance) return begin;
  int steps_inside = 0;
  for (double s = begin;;) {
    if (inside) {
      const bool at_limit = moving.distance - limit <= zone.tolerance / 64;
      if (at_limit && moving.closing > 0x1p-40 * moving.speed()) return s;
      if (++steps_inside > kMostInside) return s; // a halt too early, at a distance that a halt may have
    }
    const double step = moving.safeStep(limit);
    s = std::max(s + step, std::nextafter(s, infinity));
    if (!(s < end)) return std::nullopt;
    moving.look(s);
    if (inside && moving.distance > zone.outer()) {
      inside = false;
      limit = halt;
    }
    if (!inside && moving.distance <= zone.outer()) return s;
  }
}

} // namespace

std::optional<double> timeOfContact(const Eigen::Vector3d& apart, const Eigen::Vector3d& shift, const ContactZone& zone)
{
  const double along = apart.dot(shift), length2 = shift.squaredNorm();
  if (!(along < 0.0) || length2 == 0.0) return std::nullopt; // no nearer than now
  const double now = apart.norm();
  const bool inside = now <= zone.outer();
  const double pass = inside ? zone.floor(now) : zone.inner(), halt = inside ? pass : zone.outer();
  const double closest = -along / length2;
  if ((apart + std::min(1.0, closest) * shift).squaredNorm() >= pass * pass) return std::nullopt;
  // Back from the closest approach by half a chord. The usual root of |apart + s shift| = halt takes a difference of
  // squares of the whole length, which is mostly rounding where that is long and the zone thin.
  const double across = (apart + closest * shift).norm();
  const double half = std::sqrt(std::max(0.0, (halt - across) * (halt + across) / length2));
  return std::clamp(closest - half, 0.0, 1.0);
}

Corners placedBy(const Eigen::Isometry3d& pose, const Corners& corners)
{
  Corners placed{{}, corners.count};
  for (std::uint32_t i = 0; i < corners.count; ++i) {
    const Eigen::Vector3d place = pose * vectorOf(corners.at[i]);
    placed.at[i] = {place[0], place[1], place[2]};
  }
  return placed;
}

std::optional<double> timeOfContact(const RigidMotion& motion_a, const Corners& a, const RigidMotion& motion_b,
                                    const Corners& b, const ContactZone& zone, double begin, double end)
{
  const double rounding = roundingOf(motion_a, a) + roundingOf(motion_b, b);
  if (a.count > 1 || b.count > 1) {
    const CornersMotion moving_a(motion_a, a), moving_b(motion_b, b);
    MovingCornersPair moving(moving_a, moving_b);
    return advance(moving, zone, rounding, begin, end);
  }
  const Eigen::Vector3d p = vectorOf(a.at[0]), q = vectorOf(b.at[0]);
  if (!motion_a.turns() && !motion_b.turns()) {
    const Eigen::Vector3d apart = motion_a.at(begin) * p - motion_b.at(begin) * q;
    if (zone.isNext(apart.norm() - rounding) &&
        comeWithin(motion_a, a.at[0], motion_b, b.at[0], zone.reach, begin, end))
      return begin;
    const auto s = timeOfContact(apart, (end - begin) * (motion_a.shift() - motion_b.shift()), zone);
    if (!s) return std::nullopt;
    return begin + *s * (end - begin);
  }
  const PointMotion course_a = motion_a.motionOf(p), course_b = motion_b.motionOf(q);
  MovingPointPair moving(course_a, course_b, end);
  return advance(moving, zone, rounding, begin, end);
}

} // namespace pcl_bsh

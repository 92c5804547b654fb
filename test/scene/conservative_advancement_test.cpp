// SPDX-License-Identifier: BSD-3-Clause
// When two moving points meet, judged in exact integers where they go straight, and in extended precision at many
// instants where they turn.
#include <pcl_bsh/scene/swept/conservative_advancement.h>
#include <pcl_bsh/scene/swept/object_motion.h>

#include "support/random.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pcl_bsh {
namespace {

Corners pointAt(const Eigen::Vector3d& p)
{
  return Corners::of(Point3{p[0], p[1], p[2]});
}

using test::Random;
using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;

constexpr double pi = std::numbers::pi;
constexpr double offsets[] = {1e-3, 0.15, 0.3, 0.9, 1.0, 1.2}, reaches[] = {0.0, 0.01, 0.5};
constexpr double angles[] = {0.0, 1e-15, 1e-9, 0.01, 1.0, 3.0, pi, 4.0, 2 * pi, 20.0, 150.0};

/// x 2^240, exactly: for numbers whose last bit is no smaller.
Integer scaled(double x)
{
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  const int shift = exponent - 53 + 240;
  EXPECT_TRUE(x == 0.0 || shift >= 0) << x;
  return Integer(static_cast<std::int64_t>(std::ldexp(mantissa, 53))) << std::max(shift, 0);
}

using Vector = std::array<Integer, 3>;

Integer dot(const Vector& a, const Vector& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Two points in straight motion: apart + s shift, s in [0, 1].
struct StraightPair {
  Vector apart, shift;

  /// Whether they are farther apart than this at all s from 0 to `end`.
  bool staysBeyond(double reach, double end) const
  {
    const Integer limit = scaled(reach) * scaled(reach), one = Integer(1) << 240, last = scaled(end);
    const Integer along = dot(apart, shift), length2 = dot(shift, shift);
    if (along >= 0 || length2 == 0) return dot(apart, apart) > limit;
    if (-along * one >= last * length2) return square(end) > limit * one * one;
    return dot(apart, apart) * length2 - along * along > limit * length2; // closest approach
  }

  bool isWithin(double reach, double s) const
  {
    const Integer one = Integer(1) << 240;
    return square(s) <= scaled(reach) * scaled(reach) * one * one;
  }

private:
  /// Square of the distance at s, times 2^960.
  Integer square(double s) const
  {
    Vector at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = (apart[k] << 240) + scaled(s) * shift[k];
    return dot(at, at);
  }
};

Eigen::Vector3d direction(Random& random)
{
  return random.rotation() * Eigen::Vector3d::UnitX();
}

/// Points that pass each other at an offset of about the zone's size, in the middle of a long way, far from the origin.
struct Passing {
  Leg a, b;
  Eigen::Vector3d p, q;
  ContactZone zone{};

  Passing(Random& random, double away, double length, double clearance, double tolerance) : zone{clearance, tolerance}
  {
    const auto somewhere = [&](double size) -> Eigen::Vector3d { return random.uniform(0, size) * direction(random); };
    const Eigen::Vector3d way = length * direction(random), middle = somewhere(away);
    const Eigen::Vector3d across =
        way.cross(direction(random)).normalized() * random.pick(offsets) * (clearance + tolerance);
    p = somewhere(1.0);
    q = somewhere(1.0);
    const Eigen::Vector3d both = random.chance(0.5) ? somewhere(length) : Eigen::Vector3d(Eigen::Vector3d::Zero());
    const double t = random.uniform(-0.1, 1.1); // of the closest approach
    a.from.translation() = middle - t * (way + both) + across - p;
    a.to.translation() = a.from.translation() + way + both;
    b.from.translation() = middle - t * both - q;
    b.to.translation() = b.from.translation() + both;
  }

  /// From the numbers as they are.
  StraightPair exact() const
  {
    StraightPair pair;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const auto from = [&](const Leg& leg) { return scaled(leg.from.translation()[k]); };
      const auto to = [&](const Leg& leg) { return scaled(leg.to.translation()[k]); };
      pair.apart[i] = from(a) + scaled(p[k]) - from(b) - scaled(q[k]);
      pair.shift[i] = (to(a) - from(a)) - (to(b) - from(b));
    }
    return pair;
  }
};

TEST(ConservativeAdvancement, StraightWaysAreJudgedExactly)
{
  struct Setting {
    double away, length, clearance, tolerance;
    int cases;
  };
  const Setting settings[] = {{1, 500, 0.0, 1e-6, 8000},    {1, 500, 0.05, 1e-6, 3000},  {1e5, 500, 0.0, 1e-4, 4000},
                              {1e5, 1e5, 0.05, 1e-4, 3000}, {1e5, 1e5, 0.0, 1e-6, 1000}, {1, 1e-3, 5.0, 1e-6, 500},
                              {500, 1e-9, 1e-3, 1e-6, 500}};
  int met = 0, passed = 0;
  for (const Setting& setting : settings) {
    Random random(static_cast<std::uint64_t>(setting.cases) + 17);
    for (int i = 0; i < setting.cases; ++i) {
      const Passing passing(random, setting.away, setting.length, setting.clearance, setting.tolerance);
      const StraightPair exact = passing.exact();
      const double reach = setting.clearance;
      if (!exact.staysBeyond(reach, 0.0)) continue;
      const auto s = timeOfContact(ObjectMotion(passing.a, Box3()), pointAt(passing.p), ObjectMotion(passing.b, Box3()),
                                   pointAt(passing.q), passing.zone, 0, 1);
      ASSERT_TRUE(exact.staysBeyond(reach, s.value_or(1.0))) << i << " at " << setting.length;
      if (s) {
        ++met;
        ASSERT_TRUE(exact.isWithin(reach + setting.tolerance, *s)) << i << " at " << setting.length << ", " << *s;
      }
      else {
        ++passed;
      }
    }
  }
  EXPECT_GT(met, 6000);
  EXPECT_GT(passed, 3000);
}

/// Pairs that begin and end a rounding of their coordinates beyond the reach, and are nearer between.
TEST(ConservativeAdvancement, StraightWaysNextToTheReachAreJudgedExactly)
{
  int met = 0, passed = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Random random(seed);
    const double away = random.pick({0.0, 1.0, 1e3, 5e6}), reach = random.pick({0.05, 1.0, 3.0});
    const Eigen::Vector3d middle = random.uniform(0.1, 1.0) * away * direction(random), across = direction(random);
    const Eigen::Vector3d way = across.cross(direction(random)).normalized() * std::exp(random.uniform(-17.0, -9.0));
    Passing pair(random, 1.0, 1.0, reach, 1e-4);
    pair.p = pair.q = Eigen::Vector3d::Zero();
    const double unit = std::nextafter(std::max(away, reach), 1e300) - std::max(away, reach);
    const Eigen::Vector3d beyond = (reach + random.integer(-2, 4) * unit) * across;
    pair.a.from.translation() = middle + beyond - way;
    pair.a.to.translation() = middle + beyond + way;
    pair.b.from.translation() = pair.b.to.translation() = middle;
    const StraightPair exact = pair.exact();
    if (!exact.staysBeyond(reach, 0.0) || exact.isWithin(reach, 1.0)) continue;
    const auto s = timeOfContact(ObjectMotion(pair.a, Box3()), pointAt(pair.p), ObjectMotion(pair.b, Box3()),
                                 pointAt(pair.q), pair.zone, 0, 1);
    ASSERT_TRUE(exact.staysBeyond(reach, s.value_or(1.0))) << seed;
    const Eigen::Vector3d back = 2 * across + 0.3 * way.normalized(), aside = 2 * across.cross(way).normalized();
    const Corners tip =
        Corners::of(std::array<Point3, 3>{Point3{0, 0, 0},
                                          {back.x(), back.y(), back.z()},
                                          {back.x() + aside.x(), back.y() + aside.y(), back.z() + aside.z()}});
    const auto of_triangle = timeOfContact(ObjectMotion(pair.a, Box3()), tip, ObjectMotion(pair.b, Box3()),
                                           pointAt(pair.q), pair.zone, 0, 1);
    ASSERT_TRUE(exact.staysBeyond(reach, of_triangle.value_or(1.0))) << seed << ", of a triangle's corner";
    if (!exact.staysBeyond(reach, 1.0)) ++met;
    if (!s) ++passed;
  }
  EXPECT_GT(met, 150);
  EXPECT_GT(passed, 150);
}

// --- turning ---

using Real = long double;
using RealVector = Eigen::Matrix<Real, 3, 1>;

RealVector placeOn(const Leg& leg, const Eigen::Vector3d& point, Real s)
{
  const Eigen::Matrix<Real, 3, 1> center = leg.center.cast<Real>(), turn = leg.turn.cast<Real>();
  const Real angle = turn.norm();
  const RealVector spoke = leg.from.linear().cast<Real>() * (point.cast<Real>() - center);
  RealVector turned = spoke;
  if (angle > 0) turned = Eigen::AngleAxis<Real>(s * angle, turn / angle).toRotationMatrix() * spoke;
  const RealVector begin = leg.from.linear().cast<Real>() * center + leg.from.translation().cast<Real>();
  const RealVector end = leg.to.linear().cast<Real>() * center + leg.to.translation().cast<Real>();
  return begin + s * (end - begin) + turned;
}

Leg turningLeg(Random& random, double size, double angle)
{
  Leg leg;
  leg.from = random.pose(size);
  leg.center = random.uniform(0, 1) * direction(random);
  leg.turn = angle * direction(random);
  leg.to = leg.from;
  leg.to.linear() = (angle == 0.0 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                  : Eigen::AngleAxisd(angle, leg.turn / angle).toRotationMatrix()) *
                    leg.from.linear();
  leg.to.translation() =
      leg.from * leg.center + random.uniform(0, 2) * direction(random) - leg.to.linear() * leg.center;
  return leg;
}

TEST(ConservativeAdvancement, TurningWaysAreWatchedDensely)
{
  int met = 0, passed = 0;
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const double far_away = seed % 3 == 0 ? 1e4 : 2.0, tolerance = seed % 3 == 0 ? 1e-4 : 1e-6;
    Leg a = turningLeg(random, far_away, random.pick(angles)), b = turningLeg(random, far_away, random.pick(angles));
    const Eigen::Vector3d p = 2 * random.uniform(0, 1) * direction(random),
                          q = random.uniform(0, 1) * direction(random);
    const double reach = random.pick(reaches);
    const ContactZone zone{reach, tolerance};
    // They come as near as a few tolerances at some instant, which grazes where their motions are alike then.
    const double when = random.uniform(0, 1);
    const RealVector between = placeOn(b, q, when) - placeOn(a, p, when);
    const Eigen::Vector3d moved =
        between.cast<double>() + (reach + random.uniform(-3, 3) * tolerance) * direction(random);
    a.from.translation() += moved;
    a.to.translation() += moved;
    const auto distance = [&](Real s) { return (placeOn(a, p, s) - placeOn(b, q, s)).norm(); };
    if (distance(0) <= reach + tolerance) continue;
    const auto s = timeOfContact(ObjectMotion(a, Box3()), pointAt(p), ObjectMotion(b, Box3()), pointAt(q), zone, 0, 1);
    const double last = s.value_or(1.0);
    for (int i = 0; i < 300; ++i) ASSERT_GT(distance(last * i / Real(300)), reach) << i;
    for (int i = -300; i <= 300; ++i) { // around the nearest instant
      const Real t = when + Real(1e-9) * i * std::abs(i);
      if (t < 0 || t >= last) continue;
      ASSERT_GT(distance(t), reach) << i;
    }
    if (s) {
      ++met;
      ASSERT_LE(distance(*s), reach + tolerance);
    }
    else {
      ++passed;
    }
  }
  EXPECT_GT(met, 500);
  EXPECT_GT(passed, 50);
}

/// Also where they move off. From half the tolerance on they are let go.
TEST(ConservativeAdvancement, WhatIsWithinReachWhereItBeginsMeetsThere)
{
  const double begin = 0.25, reach = 0.5, tolerance = 0.125;
  Leg turning, still;
  turning.turn = {0, 0, 1.0};
  turning.to = Eigen::Isometry3d(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitZ()));
  const ObjectMotion motion(turning, Box3()), rest(still, Box3());
  const Eigen::Vector3d p(1, 0, 0), now = motion.at(begin) * p, off = Eigen::Vector3d::UnitZ().cross(now);
  const auto at = [](const Eigen::Vector3d& v) { return Point3{v[0], v[1], v[2]}; };
  for (const bool triangle : {false, true})
    for (const auto& [distance, met] : {std::pair(0.25, true), {0.49, true}, {0.55, false}, {0.6, false}}) {
      const Eigen::Vector3d q = now - distance * off;
      const Corners other =
          triangle ? Corners{{at(q), at(q - off + Eigen::Vector3d::UnitZ()), at(q - off - Eigen::Vector3d::UnitZ())}, 3}
                   : Corners::of(at(q));
      const auto s = timeOfContact(motion, Corners::of(at(p)), rest, other, {reach, tolerance}, begin, 1.0);
      EXPECT_EQ(s, met ? std::optional(begin) : std::nullopt) << triangle << ' ' << distance;
    }
}

TEST(ConservativeAdvancement, PathsHaveNoJumpsAndPassThroughBothPoses)
{
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    Leg leg = turningLeg(random, 5, random.pick(angles));
    if (seed % 2 == 0) { // poses may be off rigid by 1e-6
      leg.from.linear() *= 1 + 2e-7;
      leg.to.linear() *= 1 - 2e-7;
    }
    const Box3 box{{-1, -2, -1}, {2, 2, 1}};
    leg.center = box.center();
    const ObjectMotion path(leg, box);
    EXPECT_EQ(path.at(0).matrix(), leg.from.matrix());
    EXPECT_EQ(path.at(1).matrix(), leg.to.matrix());
    EXPECT_LT((path.at(1e-12).matrix() - leg.from.matrix()).norm(), 1e-8);
    EXPECT_LT((path.at(1 - 1e-12).matrix() - leg.to.matrix()).norm(), 1e-8);
    Eigen::Isometry3d last = leg.from;
    const Box3 swept = path.swept();
    for (int i = 1; i <= 200; ++i) {
      const Eigen::Isometry3d now = path.at(i / 200.0);
      for (int c = 0; c < 8; ++c) {
        const Eigen::Vector3d corner(c & 1 ? box.low.x() : box.high.x(), c & 2 ? box.low.y() : box.high.y(),
                                     c & 4 ? box.low.z() : box.high.z());
        const PointMotion course = path.motionOf(corner);
        const Eigen::Vector3d place = now * corner;
        EXPECT_LT((course.center + i / 200.0 * course.shift + course.spokeAt(i / 200.0) - place).norm(), 1e-12);
        EXPECT_LE((place - last * corner).norm(), path.speed() / 200 + 1e-12);
        EXPECT_LE((place - last * corner).norm(), path.shift().norm() / 200 + path.turningReach(1 / 200.0) + 1e-12);
        EXPECT_LE((place - leg.from * corner).norm(), path.shift().norm() + path.turningReach(1) + 1e-12);
        EXPECT_TRUE((place.array() >= swept.low.array()).all() && (place.array() <= swept.high.array()).all());
      }
      last = now;
    }
  }
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// The model of motion against its definition in extended precision, and what trajectories, waypoints and scenes make of
// it.
#include <pcl_bsh/geometry/polar_decomposition.h>
#include <pcl_bsh/geometry/rigid_motion.h>
#include <pcl_bsh/scene/motion.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pcl_bsh {
namespace {

using test::Random;

using Real = long double;
using RealMatrix = Eigen::Matrix<Real, 3, 3>;
using RealVector = Eigen::Matrix<Real, 3, 1>;

constexpr double pi = std::numbers::pi;
constexpr double angles[] = {0.0, 1e-9, 0.01, 1.0, 3.0, pi, 4.0, 2 * pi, 20.0, 150.0};
constexpr double asked_angles[] = {0.0, 1e-9, 1.0, pi, 2 * pi, 40.0, 6000.0};
constexpr double shorter_angles[] = {0.0, 1e-12, 1e-6, 1.0, 3.0, pi - 1e-12},
                 deviations[] = {0.0, 1e-16, 1e-9, 1e-6, 2e-5};

Eigen::Vector3d direction(Random& random)
{
  return random.rotation() * Eigen::Vector3d::UnitX();
}

/// A rotation, off rigid by as much as queries take.
Eigen::Matrix3d nearRotation(Random& random, double deviation)
{
  Eigen::Matrix3d matrix = random.rotation().toRotationMatrix();
  for (int i = 0; i < 9; ++i) matrix.data()[i] += deviation * random.uniform(-1, 1);
  return matrix;
}

RealMatrix rotationNearest(RealMatrix m)
{
  for (int i = 0; i < 6; ++i) m = (0.5L * (m + m.inverse().transpose())).eval();
  return m;
}

struct TestMotion {
  Eigen::Isometry3d from, to;
  Eigen::Vector3d pivot, turn;
};

TestMotion anyMotion(Random& random, double angle)
{
  TestMotion motion;
  motion.from = motion.to = random.pose(5);
  motion.from.linear() = nearRotation(random, random.chance(0.5) ? 1e-7 : 0.0);
  motion.pivot = 2 * direction(random);
  motion.turn = angle * direction(random);
  motion.to.linear() = rotationBy(motion.turn) * motion.from.linear();
  if (random.chance(0.5)) motion.to.linear() *= 1 + 1e-7;
  motion.to.translation() += 3 * direction(random);
  return motion;
}

/// By definition: the pivot in a straight line, the turn at constant speed, what it leaves of the last pose linearly.
RealVector placeOf(const TestMotion& m, const Eigen::Vector3d& point, Real s)
{
  const RealMatrix first = m.from.linear().cast<Real>(), last = m.to.linear().cast<Real>();
  const RealVector pivot = m.pivot.cast<Real>(), turn = m.turn.cast<Real>();
  const Real angle = turn.norm();
  const auto turned = [&](Real part) -> RealMatrix {
    if (angle == 0) return RealMatrix::Identity();
    return Eigen::AngleAxis<Real>(part * angle, turn / angle).toRotationMatrix();
  };
  const RealMatrix linear = turned(s) * (first + s * (turned(-1) * last - first));
  const RealVector begin = first * pivot + m.from.translation().cast<Real>();
  const RealVector end = last * pivot + m.to.translation().cast<Real>();
  return begin + s * (end - begin) + linear * (point.cast<Real>() - pivot);
}

TEST(RigidMotion, IsTheOneOfItsDefinitionWithinItsBounds)
{
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TestMotion given = anyMotion(random, random.pick(angles));
    const RigidMotion motion(given.from, given.to, given.pivot, given.turn);
    EXPECT_EQ(motion.at(0).matrix(), given.from.matrix());
    EXPECT_EQ(motion.at(-1).matrix(), given.from.matrix());
    EXPECT_EQ(motion.at(1).matrix(), given.to.matrix());
    EXPECT_EQ(motion.at(2).matrix(), given.to.matrix());
    const double radius = 2.0;
    const Eigen::Vector3d point = given.pivot + radius * direction(random);
    const PointMotion alone = motion.motionOf(point);
    for (int i = 0; i < 60; ++i) {
      const double s = random.uniform(0, 1), length = random.uniform(0, 1 - s);
      const RealVector place = placeOf(given, point, s), later = placeOf(given, point, s + length);
      ASSERT_LT((motion.at(s) * point - place.cast<double>()).norm(), 2e-13);
      ASSERT_LT((alone.center + s * alone.shift + alone.spokeAt(s) - place.cast<double>()).norm(), 2e-13);
      const auto gone = static_cast<double>((later - place).norm());
      ASSERT_LE(gone, (motion.shift().norm() + motion.turningSpeed(radius)) * length + 1e-13);
      ASSERT_LE(gone, motion.shift().norm() * length + motion.turningReach(radius, length) + 1e-13);
    }
  }
}

TEST(RigidMotion, SeenByTheBodyAPointAtRestStraysNoFartherThanItsBow)
{
  double highest = 0.0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Random random(seed);
    TestMotion given = anyMotion(random, random.pick(angles));
    given.from.linear() = rotationNearest(given.from.linear().cast<Real>()).cast<double>();
    const RealMatrix first = given.from.linear().cast<Real>();
    const RealVector turn = given.turn.cast<Real>();
    const Real angle = turn.norm();
    const auto rotation = [&](Real s) -> RealMatrix {
      if (angle == 0) return first;
      return Eigen::AngleAxis<Real>(s * angle, turn / angle).toRotationMatrix() * first;
    };
    const RealVector begin = (given.from * given.pivot).cast<Real>();
    const RealVector end = seed % 2 == 0 ? begin : (given.to * given.pivot).cast<Real>(); // on the spot, or moving
    const RealVector rest = begin + random.uniform(0, 10) * direction(random).cast<Real>();
    const auto seen = [&](Real s) -> RealVector {
      return rotation(s).transpose() * (rest - (begin + s * (end - begin)));
    };
    const Bow bow = bowSeenByBody(given.turn.norm(), static_cast<double>((end - begin).norm()));
    const double away = static_cast<double>(std::max((rest - begin).norm(), (rest - end).norm()));
    const double bound = bow.drift + bow.turn * away;
    for (int i = 1; i < 20; ++i) {
      const Real s = i / 20.0L;
      const auto strays = static_cast<double>((seen(s) - ((1 - s) * seen(0) + s * seen(1))).norm());
      ASSERT_LE(strays, bound + 1e-13) << seed;
      if (bound > 1e-6) highest = std::max(highest, strays / bound);
    }
  }
  EXPECT_GT(highest, 0.97) << "the bound is not loose";
}

TEST(RigidMotion, TrajectoriesWaypointsAndLegsMoveAlike)
{
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed);
    Eigen::Isometry3d from = random.pose(5), to = random.pose(5);
    if (seed % 3 == 0) to.linear() = from.linear();
    if (seed % 2 == 0) from.linear() *= 1 + 2e-7;
    const Eigen::Vector3d turn = shorterTurn(from.linear(), to.linear());
    const double fraction = random.uniform(0, 1);
    const Eigen::Isometry3d between = poseBetween(from, to, fraction);
    EXPECT_EQ(between.matrix(), (Leg{from, to, Eigen::Vector3d::Zero(), turn}.at(fraction).matrix()));
    const WaypointMotion waypoints{{0.0, 1.0}, {from, to}};
    const Eigen::Isometry3d at_waypoints = poseAt(waypoints, Eigen::Isometry3d::Identity(), fraction);
    EXPECT_LT((between.matrix() - at_waypoints.matrix()).norm(), seed % 2 == 0 ? 1e-6 : 5e-15);
    EXPECT_LT((at_waypoints.linear() * at_waypoints.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 5e-15);
    EXPECT_LT((turnOf(waypoints, 0.0, 1.0) - turn).norm(), 1e-15);
  }
}

TEST(RigidMotion, TheShorterTurnArrivesAndHalfATurnIsKnown)
{
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Random random(seed);
    const Eigen::Matrix3d from = nearRotation(random, 2e-7);
    const double angle = random.pick(shorter_angles);
    const Eigen::Vector3d asked = angle * direction(random);
    const Eigen::Matrix3d to = rotationBy(asked) * from;
    const Eigen::Vector3d turn = shorterTurn(from, to);
    EXPECT_LT((turn - asked).norm(), 1e-14);
    EXPECT_LE(turn.norm(), pi);
    EXPECT_FALSE(isHalfTurn(turn));
    EXPECT_EQ(shorterTurn(from, from), Eigen::Vector3d::Zero());
    EXPECT_TRUE(isHalfTurn(shorterTurn(from, rotationBy(pi * direction(random)) * from)));
  }
}

TEST(RigidMotion, TheTurnNearestToWhatWasAskedForArrives)
{
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Matrix3d from = random.rotation().toRotationMatrix();
    const Eigen::Vector3d asked = random.pick(asked_angles) * direction(random);
    const Eigen::Matrix3d to = rotationBy(asked) * from;
    EXPECT_LT((turnNearestTo(asked, from, to) - asked).norm(), 1e-9);
    EXPECT_LE(shorterTurn(from, to).norm(), pi * (1 + 1e-12));
    // Something else has turned it as well.
    const Eigen::Matrix3d other = random.rotation().toRotationMatrix() * to;
    const Eigen::Vector3d turn = turnNearestTo(asked, from, other);
    EXPECT_LT((rotationBy(turn) * from - other).norm(), 1e-9);
    for (const double more : {-2 * pi, 2 * pi})
      EXPECT_LE((turn - asked).norm(), (turn + more * turn.normalized() - asked).norm() + 1e-9);
  }
}

TEST(RigidMotion, FullTurnsAreKeptWhereTheBodyArrivesAsItWas)
{
  const Eigen::Matrix3d same = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, -2) / 3.0;
  for (const double turns : {0.4, 0.6, 1.4, 1.6, 3.2}) // something else turned the rest of it back
    EXPECT_LT((turnNearestTo(2 * pi * turns * axis, same, same) - 2 * pi * std::round(turns) * axis).norm(), 1e-12)
        << turns;
}

TEST(PolarDecomposition, IsRightToRoundingAsFarFromRigidAsFourDigitsLeaveAMatrix)
{
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    const Eigen::Matrix3d given = nearRotation(random, random.pick(deviations));
    const PolarDecomposition parts(given);
    const RealMatrix rotation = rotationNearest(given.cast<Real>());
    EXPECT_LT((parts.rotation - rotation.cast<double>()).norm(), 2e-15);
    EXPECT_LT((parts.rotation * parts.stretch - given).norm(), 2e-15);
    EXPECT_EQ(parts.stretch, parts.stretch.transpose().eval());
  }
}

} // namespace
} // namespace pcl_bsh

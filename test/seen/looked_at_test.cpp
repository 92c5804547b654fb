// SPDX-License-Identifier: BSD-3-Clause
// Which beams matter to a model, against the angles between them and its points.
#include <pcl_bsh/seen/looked_at.h>

#include "support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;

Eigen::Vector3d vectorOf(const Point3& p)
{
  return Eigen::Vector3d(p.data());
}

TEST(LookedAt, HoldsTheBeamsThatSpeakForTheModelAndFewOthers)
{
  constexpr double kCoarse = 0.02; // two cells
  Random random(1);
  int held = 0, left_out = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const double size = random.uniform(0.1, 2), clearance = random.uniform(0, 0.3), angle = random.uniform(1e-3, 0.1);
    std::vector<Point3> points;
    for (int i = 0; i < 30; ++i) points.push_back(random.point([&] { return size * random.uniform(-1, 1); }));
    const SphereHierarchy model(viewOf(points[0].data(), points.size()));
    const Point3 origin = random.point([&] { return random.uniform(-9, 9); });
    const Eigen::Vector3d from = vectorOf(origin);
    const Eigen::Isometry3d pose = Eigen::Translation3d(from) * random.pose(5.0);
    LookedAt looked(origin, angle);
    looked.add({model, pose}, clearance);
    std::vector<Eigen::Vector3d> ways;
    for (const Point3& p : points) ways.push_back(pose * vectorOf(p) - from);
    const auto isIn = [&](const Eigen::Vector3d& way) { return way.norm() <= clearance; };
    if (std::any_of(ways.begin(), ways.end(), isIn)) {
      EXPECT_TRUE(looked.holds({9, 9, 9})) << "all of them";
      continue;
    }
    // By how much a direction is beside a cone and the beams that say something of it: those up to 0.334 and 1.2 angles
    // from it. Negative: within both.
    const auto beside = [&](const Eigen::Vector3d& direction, const Eigen::Vector3d& way, double radius) {
      const double between = std::atan2(direction.cross(way).norm(), direction.dot(way));
      return between - std::asin(std::min(1.0, radius / way.norm())) - 1.534 * angle;
    };
    const Eigen::Vector3d middle = pose.translation() - from;
    const double whole = std::sqrt(3.0) * size + clearance; // leaves are looked at as balls
    for (int i = 0; i < 300; ++i) {
      Eigen::Vector3d way = vectorOf(random.point([&] { return random.uniform(-1, 1); }));
      if (i % 2 == 0) way = ways[static_cast<std::size_t>(i) % ways.size()].normalized() + 0.3 * way;
      const Eigen::Vector3d end = from + random.uniform(0.1, 20) * way;
      const Point3 at = {end.x(), end.y(), end.z()};
      const double radius = random.uniform(0, 0.02) * (end - from).norm();
      const bool counts = std::any_of(ways.begin(), ways.end(), [&](const Eigen::Vector3d& of_point) {
        return beside(way, of_point, clearance) < -1e-9;
      });
      const double apart = whole < middle.norm() ? beside(way, middle, whole) : -1.0;
      if (counts) {
        EXPECT_TRUE(looked.holds(at)) << trial;
      }
      if (looked.holds(at)) {
        EXPECT_TRUE(looked.holdsSome(at, radius));
        EXPECT_LT(apart, kCoarse) << trial;
      }
      if (looked.holdsSome(at, radius)) {
        EXPECT_LT(apart, 2 * kCoarse) << trial;
      }
      held += counts, left_out += apart > kCoarse;
    }
    EXPECT_FALSE(looked.holds(origin)) << "no beam";
  }
  EXPECT_GT(held, 500);
  EXPECT_GT(left_out, 500);
}

/// Its square overflows, with the ball about it.
TEST(LookedAt, HoldsAllOfWhatCannotBeMeasured)
{
  const Point3 far = {1.2e154, 0, 0}, beside = {-5, 0, 0};
  LookedAt looked({0, 0, 0}, 0.1);
  EXPECT_FALSE(looked.holds(beside));
  EXPECT_TRUE(looked.holdsSome(far, 0.5e154));
  EXPECT_FALSE(looked.holdsSome(far, 0.05e154));
  looked.add({SphereHierarchy(PointsView())}, 0.1);
  EXPECT_FALSE(looked.holds(beside)) << "nothing is looked at";
  const SphereHierarchy model(viewOf(far.data(), 1));
  looked.add({model}, 0.05e154);
  EXPECT_FALSE(looked.holds(beside));
  looked.add({model}, 0.5e154);
  EXPECT_TRUE(looked.holds(beside));
  EXPECT_TRUE(looked.holdsSome(beside, 1.0));
}

} // namespace
} // namespace pcl_bsh

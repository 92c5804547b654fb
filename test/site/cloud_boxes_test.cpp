// SPDX-License-Identifier: BSD-3-Clause
// The boxes that say which tiles are read: they hold what they stand for, and little more.
#include <pcl_bsh/site/tiles/cloud_boxes.h>
#include <pcl_bsh/site/tiles/path_boxes.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace pcl_bsh::site {
namespace {

using test::Cloud;
using test::Random;

constexpr double infinity = std::numeric_limits<double>::infinity();

bool holds(const Bounds& box, const Eigen::Vector3d& p)
{
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = p[static_cast<Eigen::Index>(k)];
    if (x < box.low[k] || x > box.high[k]) return false;
  }
  return true;
}

Bounds boxOf(const Point3& center, double half)
{
  return {{center[0] - half, center[1] - half, center[2] - half},
          {center[0] + half, center[1] + half, center[2] + half}};
}

Point3 anywhere(Random& random, double reach)
{
  return random.point([&] { return random.uniform(-reach, reach); });
}

TEST(Bounds, MovedHoldsAllPlacesWithinReachAndTouchesThem)
{
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const double far = random.chance(0.5) ? 1.0 : 1e6, reach = random.chance(0.3) ? 0.0 : 0.25;
    Bounds box{anywhere(random, far), {}};
    for (std::size_t k = 0; k < 3; ++k) box.high[k] = box.low[k] + random.uniform(0, 2);
    const Eigen::Isometry3d pose = random.chance(0.3) ? Eigen::Isometry3d::Identity() : random.pose(far);
    const Bounds found = moved(box, pose, reach);
    std::optional<Bounds> corners;
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d p((corner & 1) != 0 ? box.high[0] : box.low[0],
                              (corner & 2) != 0 ? box.high[1] : box.low[1],
                              (corner & 4) != 0 ? box.high[2] : box.low[2]);
      const Eigen::Vector3d q = pose * p;
      extend(corners, {q.x() - reach, q.y() - reach, q.z() - reach});
      extend(corners, {q.x() + reach, q.y() + reach, q.z() + reach});
    }
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LE(found.low[k], corners->low[k]);
      EXPECT_GE(found.high[k], corners->high[k]);
      EXPECT_NEAR(found.low[k], corners->low[k], 1e-4);
      EXPECT_NEAR(found.high[k], corners->high[k], 1e-4);
    }
  }
  const Bounds huge = moved({{-1e308, 0, 0}, {1e308, 1, 1}}, Eigen::Isometry3d::Identity(), 1e308);
  EXPECT_EQ(huge.low[0], -infinity) << "what overflows may be anywhere";
  EXPECT_EQ(huge.high[0], infinity);
  EXPECT_LT(huge.high[1], infinity);
}

TEST(Bounds, MovedHoldsAPlaceAtTheOrigin)
{
  const Bounds found = moved(boxOf({0, 0, 0}, 0.0), Eigen::Isometry3d::Identity(), 0.0);
  EXPECT_TRUE(holds(found, Eigen::Vector3d::Zero()));
}

TEST(Bounds, OverlapWhereTheyTouch)
{
  const Bounds box = boxOf({0, 0, 0}, 1.0);
  EXPECT_TRUE(overlap(box, boxOf({0.5, 0.5, 0}, 0.25))) << "one in the other";
  for (std::size_t k = 0; k < 3; ++k)
    for (const double side : {-1.0, 1.0}) {
      Point3 at = {0, 0, 0};
      at[k] = 2 * side;
      EXPECT_TRUE(overlap(box, boxOf(at, 1.0)));
      EXPECT_NEAR(leastDistance(box, boxOf(at, 1.0)), 0.0, 1e-15);
      at[k] = 2.125 * side;
      EXPECT_FALSE(overlap(box, boxOf(at, 1.0)));
      EXPECT_FALSE(overlap(boxOf(at, 1.0), box));
      EXPECT_NEAR(leastDistance(box, boxOf(at, 1.0)), 0.125, 1e-14);
      EXPECT_LT(leastDistance(box, boxOf(at, 1.0)), 0.125);
    }
  EXPECT_NEAR(leastDistance(box, boxOf({5, 6, -14}, 1.0)), 13.0, 1e-12) << "3 4 12";
  const Bounds both = joined(box, boxOf({4, -3, 0}, 0.5));
  EXPECT_EQ(both.low, (Point3{-1, -3.5, -1}));
  EXPECT_EQ(both.high, (Point3{4.5, 1, 1}));
}

/// Never missed: a point whose place is within the distance of the box, along each axis.
TEST(PointsNear, AreThoseInTheGrownBox)
{
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Isometry3d pose = random.pose(random.chance(0.5) ? 1.0 : 1e5);
    const double distance = random.uniform(0, 0.5);
    const Eigen::Vector3d middle = pose * Eigen::Vector3d(0.25, 0, 0);
    const Bounds box = boxOf({middle.x(), middle.y(), middle.z()}, 0.5), points = boxOf({0, 0, 0}, 2.0);
    const PointsNear near(box, distance, points, pose);
    for (int point = 0; point < 50; ++point) {
      const Point3 p = anywhere(random, 2.0);
      const Eigen::Vector3d off = (pose * Eigen::Vector3d(p[0], p[1], p[2]) - middle).cwiseAbs();
      const double beyond = off.maxCoeff() - 0.5 - distance;
      if (std::abs(beyond) < 1e-5) continue;
      EXPECT_EQ(near(p), beyond < 0.0);
    }
    EXPECT_FALSE(near({0, 0, std::nan("")}));
  }
  const Eigen::Isometry3d turned(Eigen::Quaterniond(2, 1, 1, 1).normalized()); // rows add up to 11 / 7
  const PointsNear any(boxOf({0, 0, 0}, 1.0), 0.0, boxOf({0, 0, 0}, 1.7e308), turned);
  EXPECT_TRUE(any({1.7e308, 1.7e308, 1.7e308})) << "places may overflow: any may be near";
}

TEST(PointsNear, HoldTheOnePlaceOfABox)
{
  for (const double side : {-1.0, 1.0}) {
    const Point3 place = {0x1p-10 * side, 0x1p-11 * side, 0x1p-12 * side};
    const Bounds box = boxOf(place, 0.0);
    const PointsNear near(box, 0.0, box, Eigen::Isometry3d::Identity());
    EXPECT_TRUE(near(place));
    EXPECT_FALSE(near({0, 0, 0}));
  }
}

TEST(CloudBoxes, HoldAllPointsWithTheirRadiiAndUncertainties)
{
  Random random(4);
  for (int i = 0; i < 20; ++i) {
    const double far = i % 2 == 0 ? 0.0 : 4e5;
    std::vector<Point3> points =
        test::makePoints(i % 3 == 0 ? test::Shape::plane : test::Shape::clusters, 200, 1.0, random);
    for (Point3& p : points) p[1] += far;
    points[7] = {std::nan(""), 0, 0};
    Cloud cloud(points, {Scalar::float64});
    std::vector<float> radii(200), own(200);
    for (float& radius : radii) radius = static_cast<float>(random.integer(0, 4)) / 64;
    for (float& length : own) length = static_cast<float>(random.integer(0, 4)) / 64;
    cloud.setRadii(radii);
    cloud.setUncertainties(0.0625, own);
    const CloudBoxes boxes(cloud.view());
    EXPECT_EQ(boxes.largestRadius(), double{*std::max_element(radii.begin(), radii.end())});
    std::vector<std::optional<Bounds>> exact(boxes.parts().size());
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (p == 7) continue;
      const double reach = double{radii[p]} + double{own[p]} + 0.0625;
      const Bounds ball = boxOf(points[p], reach);
      std::size_t holding = 0;
      for (const Bounds& part : boxes.parts())
        holding += holds(part, Eigen::Vector3d(ball.low.data())) && holds(part, Eigen::Vector3d(ball.high.data()));
      EXPECT_GE(holding, 1U) << p;
      EXPECT_TRUE(holds(boxes.whole(), Eigen::Vector3d(ball.low.data())));
      EXPECT_TRUE(holds(boxes.whole(), Eigen::Vector3d(ball.high.data())));
    }
    for (const Bounds& part : boxes.parts()) // an eighth of the longest side, and twice the longest reach
      for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(part.high[k] - part.low[k], 2.0 / 8 + 2 * 0.1875 + 1e-3);
    EXPECT_GT(boxes.parts().size(), 3U);
    EXPECT_EQ(boxesOf(cloud.view(), true).parts().size(), 1U);
    EXPECT_EQ(boxesOf(cloud.view(), false).parts().size(), boxes.parts().size());
  }
}

TEST(CloudBoxes, OfFewPoints)
{
  EXPECT_TRUE(CloudBoxes(Cloud({}).view()).empty());
  EXPECT_TRUE(CloudBoxes(Cloud({{std::nan(""), 0, 0}}).view()).empty());
  EXPECT_TRUE(boxesOf(Cloud({}).view(), true).empty());
  const Cloud one({{1, 2, 3}, {1, 2, 3}});
  const CloudBoxes boxes(one.view());
  ASSERT_EQ(boxes.parts().size(), 1U);
  EXPECT_TRUE(holds(boxes.whole(), {1, 2, 3}));
  EXPECT_NEAR(boxes.whole().high[2] - boxes.whole().low[2], 0.0, 1e-12);
  const Cloud line({{0, 0, 0}, {8, 0, 0}, {4, 0, 0}, {4.5, 0, 0}});
  EXPECT_EQ(CloudBoxes(line.view()).parts().size(), 3U) << "cells of 1 along it, and one across";
}

/// No grid divides what is longer than any number.
TEST(CloudBoxes, OfPointsAsFarApartAsNumbersGo)
{
  const double far = 1.7e308;
  const double ends[] = {-far, 1, 2, far, 1, 2, 0, 1, 2};
  const CloudBoxes boxes(viewOf(ends, 3));
  ASSERT_EQ(boxes.parts().size(), 1U);
  EXPECT_LE(boxes.whole().low[0], -far);
  EXPECT_GE(boxes.whole().high[0], far);
}

/// A box is reached where a point of the model is within the distance of a place in it, at a pose or on the way.
TEST(PathBoxes, MissNothingAtPosesAndBetween)
{
  Random random(5);
  std::size_t reached = 0, left_out = 0;
  for (int i = 0; i < 60; ++i) {
    const Cloud cloud(test::makePoints(test::Shape::uniform, 40, 0.5, random), {Scalar::float64});
    const CloudBoxes model(cloud.view());
    std::vector<Eigen::Isometry3d> poses;
    for (int k = random.integer(1, 9); k > 0; --k) {
      poses.push_back(random.pose(4.0));
      if (k % 2 == 0 && poses.size() > 1) poses.back().linear() = poses[poses.size() - 2].linear();
    }
    PathReach reach;
    reach.distance = random.uniform(0, 0.5);
    reach.moves = i % 2 == 0;
    const PathBoxes path(model, poses, reach);
    std::vector<Eigen::Vector3d> places;
    const auto add = [&](const Eigen::Isometry3d& pose) {
      for (std::uint32_t p = 0; p < 40; ++p) places.push_back(pose * Eigen::Vector3d(cloud.view().point(p).data()));
    };
    for (std::size_t k = 0; k < poses.size(); ++k) {
      add(poses[k]);
      for (int step = 1; step < 16 && reach.moves && k + 1 < poses.size(); ++step)
        add(poseBetween(poses[k], poses[k + 1], step / 16.0, Point3{}));
    }
    for (int box = 0; box < 20; ++box) {
      const Point3 at = anywhere(random, 5.0);
      double nearest = infinity;
      for (const Eigen::Vector3d& place : places)
        nearest = std::min(nearest, (place - Eigen::Vector3d(at.data())).norm());
      const bool may = path.mayReach(boxOf(at, 0.0));
      EXPECT_TRUE(may || nearest > reach.distance) << "path " << i;
      reached += may ? 1 : 0;
      left_out += may ? 0 : 1;
    }
  }
  EXPECT_GT(reached, 100U);
  EXPECT_GT(left_out, 300U);
}

TEST(PathBoxes, LeaveOutWhatIsBesideEachPose)
{
  const Cloud dot({{0, 0, 0}}, {Scalar::float64});
  const CloudBoxes model(dot.view());
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < 5; ++k) poses.emplace_back(Eigen::Translation3d(2.0 * k, 0, 0));
  PathReach reach;
  reach.distance = 0.25;
  for (const bool moves : {false, true}) {
    reach.moves = moves;
    const PathBoxes path(model, poses, reach);
    for (int k = 0; k < 5; ++k) {
      EXPECT_TRUE(path.mayReach(boxOf({2.0 * k, 0, 0}, 0.0)));
      EXPECT_TRUE(path.mayReach(boxOf({2.0 * k, 0.25, 0}, 0.0)));
      EXPECT_FALSE(path.mayReach(boxOf({2.0 * k, 0.27, 0}, 0.0)));
      EXPECT_EQ(path.mayReach(boxOf({2.0 * k + 1.0, 0, 0}, 0.0)), moves && k < 4);
    }
    EXPECT_TRUE(path.mayReach(boxOf({5, 1.0, 0}, 1.0)));
  }
  EXPECT_FALSE(PathBoxes(model, {}, reach).mayReach(boxOf({0, 0, 0}, 9.0))) << "no pose";
  const CloudBoxes nothing(Cloud({}).view());
  EXPECT_FALSE(PathBoxes(nothing, poses, reach).mayReach(boxOf({0, 0, 0}, 9.0)));
}

} // namespace
} // namespace pcl_bsh::site

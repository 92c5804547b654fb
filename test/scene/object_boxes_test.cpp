// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/scene/pairs/object_boxes.h>

#include "scene_worlds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace pcl_bsh {
namespace {

constexpr double greatest = std::numeric_limits<double>::max(), infinity = std::numeric_limits<double>::infinity();

Eigen::Vector3d cornerOf(const Box3& box, int c)
{
  return {c & 1 ? box.high.x() : box.low.x(), c & 2 ? box.high.y() : box.low.y(), c & 4 ? box.high.z() : box.low.z()};
}

bool holds(const Box3& box, const Eigen::Vector3d& p)
{
  return (p.array() >= box.low.array()).all() && (p.array() <= box.high.array()).all();
}

TEST(ObjectBoxes, OfAMovedBoxHoldItsCornersAndLittleMore)
{
  test::Random random(8);
  for (int i = 0; i < 500; ++i) {
    const double size = random.uniform(0.0, 3.0), away = i % 3 == 0 ? 1e6 : 2.0;
    Box3 box;
    box.low = Eigen::Vector3d(-1, 2, 0.5) * random.uniform(0, 1);
    box.high = box.low + size * Eigen::Vector3d(1, 0.5, 2);
    const Eigen::Isometry3d pose = random.pose(away), other = random.pose(away);
    const Box3 there = moved(box, pose);
    Eigen::Vector3d low = Eigen::Vector3d::Constant(infinity), high = -low;
    double way = 0.0;
    for (int c = 0; c < 8; ++c) {
      const Eigen::Vector3d corner = pose * cornerOf(box, c);
      EXPECT_TRUE(holds(there, corner));
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
      way = std::max(way, (corner - other * cornerOf(box, c)).norm());
    }
    EXPECT_LT((there.low - low).norm() + (there.high - high).norm(), 1e-12 * (away + 10));
    EXPECT_GE(motionBound(box, pose, other), way);
    EXPECT_LE(motionBound(box, pose, other), (other * box.center() - pose * box.center()).norm() + 4 * size + 1e-6);
    EXPECT_LT(motionBound(box, pose, pose), 1e-12 * (away + 10));
  }
}

TEST(ObjectBoxes, OfNothingAreNothing)
{
  const Box3 nothing;
  EXPECT_TRUE(nothing.empty());
  EXPECT_TRUE(moved(nothing, test::at(1, 2, 3)).empty());
  EXPECT_EQ(motionBound(nothing, test::at(0, 0, 0), test::at(1, 2, 3)), 0.0);
  Box3 flat{{0, 0, 0}, {1, 1, 0}};
  EXPECT_FALSE(flat.empty());
  EXPECT_TRUE(flat.meets(Box3{{1, 1, 0}, {2, 2, 2}})) << "they touch";
  EXPECT_FALSE(flat.meets(Box3{{1, 1, 0x1p-1074}, {2, 2, 2}}));
  flat.high.z() = -0x1p-1074;
  EXPECT_TRUE(flat.empty());
}

/// A box beyond all numbers may be anywhere, on either side.
TEST(ObjectBoxes, BeyondAllNumbersAreEverywhere)
{
  for (const double x : {greatest, -greatest}) {
    const Box3 there = moved({{0, 0, 0}, {1, 1, 1}}, test::at(x, 0, 0));
    EXPECT_EQ(there.low, Eigen::Vector3d::Constant(-infinity)) << x;
    EXPECT_EQ(there.high, Eigen::Vector3d::Constant(infinity)) << x;
  }
}

} // namespace
} // namespace pcl_bsh

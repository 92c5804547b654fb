// SPDX-License-Identifier: BSD-3-Clause
// Leaves that are told to be apart along an axis against all their pairs in exact arithmetic, and the states in which
// nothing may be told.
#include <pcl_bsh/flags/axis_gap.h>

#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

namespace pcl_bsh {
namespace {

using Eigen::Isometry3d;
using test::Cloud;
using test::Layout;
using test::Random;

/// Some records of a cloud.
struct Leaf {
  std::uint32_t begin, count;
  const void* voxel;

  std::uint32_t record(std::uint32_t i) const { return begin + i; }
};

/// Triangles about a plane across an axis, leaves of them.
Cloud sheet(Random& random, std::size_t axis, double height, double thickness, std::size_t count, Scalar scalar)
{
  std::vector<Point3> vertices;
  for (std::size_t i = 0; i < 3 * count; ++i) {
    Point3 p = random.point([&] { return random.uniform(-1, 1); });
    p[axis] = height + thickness * random.uniform(-1, 1);
    vertices.push_back(p);
  }
  Cloud cloud(vertices, Layout{scalar, 0, 0});
  std::vector<std::uint32_t> corners(3 * count);
  std::iota(corners.begin(), corners.end(), 0u);
  cloud.setTriangles(std::move(corners));
  return cloud;
}

const float* normalAlong(std::size_t axis)
{
  static const float normals[3][3] = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
  return normals[axis];
}

/// Two clouds of triangles as a query of flags has them.
struct Pair {
  Pair(const Cloud& a, const Cloud& b, const Isometry3d& pose_a, const Isometry3d& pose_b, double clearance,
       Places places = Places::measured)
  : of_a(a.view()),
    of_b(b.view()),
    placed_a(of_a, pose_a),
    placed_b(of_b, pose_b),
    pairs(placed_a, placed_b, clearance, places),
    query{placed_a, placed_b, pairs, {pose_a, pose_b}, {pairs.reach, {}}, nullptr, {pairs.reach, {}}}
  {
  }

  bool areBeyond(const Leaf& own, const Leaf& other)
  {
    for (std::uint32_t i = 0; i < own.count; ++i)
      for (std::uint32_t j = 0; j < other.count; ++j)
        if (pairs.collide({own.record(i), other.record(j)}, work)) return false;
    return true;
  }

  const SphereHierarchy of_a, of_b;
  const Placed placed_a, placed_b;
  const PointPairs pairs;
  const FlagQuery query;
  Work work;
};

Isometry3d shiftBy(const Point3& by)
{
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(by[0], by[1], by[2]);
  return pose;
}

/// One leaf of a against several of b, asked again along other axes.
TEST(AxisGap, IsOfLeavesThatAreBeyond)
{
  Random random(1);
  constexpr double kFar[] = {0.0, 3.7, 5402650.25};
  int beyond = 0, missed = 0, within = 0;
  for (int i = 0; i < 600; ++i) {
    const auto axis = static_cast<std::size_t>(i % 3);
    const double far = random.pick(kFar), gap = std::exp2(random.integer(-6, 0));
    constexpr double kThick[] = {0.0, 0.0, 1e-7, 0.1};
    const double thickness = gap * random.pick(kThick);
    const Scalar scalar = random.chance(0.5) ? Scalar::float32 : Scalar::float64;
    const Cloud a = sheet(random, axis, 8.0, thickness, 4, scalar),
                b = sheet(random, axis, 8.0 + gap, thickness, 12, scalar);
    const Point3 shift = random.point([&] { return far * random.uniform(-1, 1); });
    Point3 other_shift = shift;
    if (random.chance(0.3)) other_shift[axis] -= 2 * gap; // b lies on the other side
    const double last_bits = std::ldexp(random.integer(-2, 2), -52);
    const double clearance = gap * (1.0 + (random.chance(0.5) ? last_bits : random.uniform(-0.3, 0.1)));
    Pair pair(a, b, shiftBy(shift), shiftBy(other_shift), clearance);
    const Leaf own{0, 4, &a};
    AxisGap<Leaf> asked(pair.query, own);
    for (int k = 0; k < 6; ++k) {
      const Leaf other{static_cast<std::uint32_t>(4 * (k % 3)), 4, &b};
      const bool told = asked.isBeyond(normalAlong(k < 4 ? axis : (axis + 1) % 3), other, pair.work);
      const bool is = pair.areBeyond(own, other);
      ASSERT_FALSE(told && !is) << i << ' ' << k;
      ++(told ? beyond : is ? missed : within);
    }
  }
  EXPECT_GT(beyond, 700);
  EXPECT_GT(within, 700);
  EXPECT_LT(missed, 700);
}

/// At just the reach they touch; a last bit less is beyond, whatever the translation takes of the coordinates.
TEST(AxisGap, TouchingIsNotBeyond)
{
  Random random(2);
  const Cloud a = sheet(random, 2, 0.0, 0.0, 4, Scalar::float64), b = sheet(random, 2, 0.0, 0.0, 4, Scalar::float64);
  const Leaf own{0, 4, &a}, other{0, 4, &b};
  for (const double up : {1.0, -1.0}) {
    const double height = 5402650.25;
    const auto told = [&](double clearance, double tiny) {
      Pair pair(a, b, shiftBy({0, 0, height + up * 0.75}), shiftBy({0, 0, height + tiny}), clearance);
      return AxisGap<Leaf>(pair.query, own).isBeyond(normalAlong(2), other, pair.work);
    };
    EXPECT_FALSE(told(0.75, 0.0));
    EXPECT_TRUE(told(std::nextafter(0.75, 0.0), 0.0));
    EXPECT_FALSE(told(std::nextafter(0.75, 1.0), 0.0));
  }
}

/// Reaches of uncertain places are longer than the clearance.
TEST(AxisGap, TakesTheLongestReach)
{
  Random random(3);
  const Cloud a = sheet(random, 2, 0.0, 0.0, 4, Scalar::float64);
  Cloud b = sheet(random, 2, 1.0, 0.0, 4, Scalar::float64);
  const Leaf own{0, 4, &a}, other{0, 4, &b};
  const auto told = [&](Places places) {
    Pair pair(a, b, Isometry3d::Identity(), Isometry3d::Identity(), 0.75, places);
    return AxisGap<Leaf>(pair.query, own).isBeyond(normalAlong(2), other, pair.work);
  };
  EXPECT_TRUE(told(Places::possible));
  b.setUncertainties(0.0, {0.0f, 0.0f, 0.5f, 0.0f}); // of one of them
  EXPECT_FALSE(told(Places::possible));
  EXPECT_TRUE(told(Places::certain));
  b.setUncertainties(0.25, {});
  EXPECT_FALSE(told(Places::possible));
}

/// Turned clouds have other axes, by the last bit, too; and triangles that lie aslant, or across no axis, have none.
TEST(AxisGap, NeedsAnAxisOfBoth)
{
  Random random(4);
  const Cloud a = sheet(random, 2, 0.0, 0.0, 4, Scalar::float64), b = sheet(random, 2, 1.0, 0.0, 4, Scalar::float64);
  const Leaf own{0, 4, &a}, other{0, 4, &b};
  const auto told = [&](const Isometry3d& pose_a, const Isometry3d& pose_b, const float* normal) {
    Pair pair(a, b, pose_a, pose_b, 0.5);
    return AxisGap<Leaf>(pair.query, own).isBeyond(normal, other, pair.work);
  };
  const Isometry3d unturned = Isometry3d::Identity();
  EXPECT_TRUE(told(unturned, unturned, normalAlong(2)));
  Isometry3d upside_down = unturned, by_a_bit = unturned;
  upside_down.linear() = Eigen::AngleAxisd(3.14, Eigen::Vector3d::UnitX()).toRotationMatrix();
  by_a_bit.linear()(2, 0) = 0x1p-60;
  for (const Isometry3d& turned : {upside_down, by_a_bit}) {
    EXPECT_FALSE(told(turned, unturned, normalAlong(2)));
    EXPECT_FALSE(told(unturned, turned, normalAlong(2)));
    EXPECT_FALSE(told(turned, turned, normalAlong(2)));
  }
  const float aslant[3] = {0.6f, 0.0f, 0.8f}, none[3] = {0, 0, 0}, no_number[3] = {NAN, NAN, NAN};
  for (const float* normal : {aslant, none, no_number}) EXPECT_FALSE(told(unturned, unturned, normal));
}

/// What one leaf was told is not told of the next: neither of another place in the voxel, nor of another voxel.
TEST(AxisGap, IsOfTheLeafAskedAbout)
{
  Random random(5);
  const Cloud a = sheet(random, 2, 0.0, 0.0, 4, Scalar::float64), far = sheet(random, 2, 1.0, 0.0, 4, Scalar::float64);
  Pair pair(a, far, Isometry3d::Identity(), Isometry3d::Identity(), 0.5);
  const Leaf own{0, 4, &a}, first{0, 2, &far};
  AxisGap<Leaf> asked(pair.query, own);
  EXPECT_TRUE(asked.isBeyond(normalAlong(2), first, pair.work));
  const std::uint64_t once = pair.work.exact_decisions;
  EXPECT_TRUE(asked.isBeyond(normalAlong(2), first, pair.work));
  EXPECT_EQ(pair.work.exact_decisions, once);
  EXPECT_TRUE(asked.isBeyond(normalAlong(2), {2, 2, &far}, pair.work));
  EXPECT_EQ(pair.work.exact_decisions, once + 1);
  EXPECT_TRUE(asked.isBeyond(normalAlong(2), {2, 2, &a}, pair.work)); // of another voxel
  EXPECT_EQ(pair.work.exact_decisions, once + 2);
}

} // namespace
} // namespace pcl_bsh

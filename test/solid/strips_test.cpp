// SPDX-License-Identifier: BSD-3-Clause
// Long triangles that a ray may meet are listed, with few others that meet at one end, or lie side by side.
#include <pcl_bsh/solid/strips.h>

#include <pcl_bsh/solid/columns.h>
#include <pcl_bsh/solid/labels.h>
#include <pcl_bsh/solid/solid.h>

#include "support/brute_force/labels.h"

#include "meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;

/// A place of a triangle's shadow.
Point3 placeOn(const Triangle3& t, Random& random)
{
  double u = random.uniform(0, 1), v = random.uniform(0, 1);
  if (random.chance(0.3)) u = random.integer(0, 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  Point3 p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = t[0][k] * (1 - u - v) + u * t[1][k] + v * t[2][k];
  return p;
}

TEST(Strips, ListWhatIsAboveAPlace)
{
  constexpr double sizes[] = {1.0, 1e-3, 1e9, 1e300, 1e-300};
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const double size = random.pick(sizes);
    const auto anywhere = [&] { return random.point([&] { return size * random.uniform(-1, 1); }); };
    const Point3 apex = anywhere();
    std::vector<Triangle3> triangles;
    const int count = random.integer(1, 600);
    for (int i = 0; i < count; ++i) {
      const Point3 p = random.chance(0.5) ? apex : anywhere(), q = anywhere();
      Point3 r = random.chance(0.2) ? anywhere() : q;
      if (random.chance(0.8)) r[0] += 1e-6 * size;
      triangles.push_back({p, q, r});
    }
    std::vector<std::uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    const Strips strips(order.data(), order.data() + order.size(), [&](std::uint32_t i) { return triangles[i]; });
    std::vector<std::uint32_t> found, sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i);
    for (int i = 0; i < 100; ++i) {
      const auto named = static_cast<std::uint32_t>(random.integer(0, count - 1));
      const double error = random.pick({0x1p-50, 0.01}) * size;
      Point3 at = placeOn(triangles[named], random);
      for (double& x : at) x += random.uniform(-0.9, 0.9) * error;
      found.clear();
      strips.collect(order.data(), at, error, found);
      ASSERT_NE(std::find(found.begin(), found.end(), named), found.end()) << trial;
      std::sort(found.begin(), found.end());
      ASSERT_EQ(std::adjacent_find(found.begin(), found.end()), found.end()) << "each once";
    }
  }
}

double listedOf(const test::ClosedMesh& mesh)
{
  constexpr int kPlaces = 500;
  const Columns columns(mesh.view());
  Random random(3);
  std::vector<std::uint32_t> several;
  double listed = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const Columns::Range range = columns.above(
        columns.seen({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}), 1e-12, several);
    listed += static_cast<double>(range.last - range.first) / kPlaces;
  }
  return listed;
}

TEST(Strips, OfAFanListAsManyHoweverManyThereAre)
{
  EXPECT_LT(listedOf(test::fanMesh(4000)), 200);
  EXPECT_LT(listedOf(test::fanMesh(100000)), 200) << "of 200,000 triangles";
  const test::ClosedMesh fan = test::fanMesh(4000);
  test::ClosedMesh mixed = fan;
  const std::size_t count = fan.view().count;
  for (std::size_t i = 0; i < count; ++i) // 4099 has no divisor in common with their number
    std::copy_n(&fan.corners[3 * (i * 4099 % count)], 3, &mixed.corners[3 * i]);
  EXPECT_LT(listedOf(mixed), 60) << "in whichever order";
}

TEST(Strips, OfAFanHaveTheLabelsOfBruteForce)
{
  const test::ClosedMesh mesh = test::fanMesh(4000);
  Random random(4);
  std::vector<double> xyz = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0.5, 0, 0.5, 0, 0, 0.5};
  for (int i = 0; i < 600; ++i)
    for (const double most : {1.1, 1.1, 1.0})
      xyz.push_back(i % 2 == 0 ? random.uniform(-most, most) : 0.125 * random.integer(-8, 8));
  const SphereHierarchy points(viewOf(xyz.data(), xyz.size() / 3));
  const Solid solid(mesh.view());
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  turned.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  for (const Eigen::Isometry3d& pose : {Eigen::Isometry3d(Eigen::Isometry3d::Identity()), turned})
    EXPECT_EQ(labelPoints({points, pose}, solid).labels, brute_force::labelPoints({points, pose}, solid).labels);
}

/// Few of many long triangles are marked by themselves.
TEST(Strips, NoPlaceOfAFanIsClear)
{
  const test::ClosedMesh mesh = test::fanMesh(20000);
  const Columns columns(mesh.view());
  Random random(5);
  int clear = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto named = static_cast<std::uint32_t>(random.integer(0, static_cast<int>(mesh.view().count) - 1));
    ASSERT_FALSE(columns.isClear(placeOn(columns.seenTriangle(named), random), 0.0)) << named;
    const double turn = random.uniform(0, 6.28), far = random.uniform(0.2, 0.8), up = 0.5 * (1.0 - far);
    clear += columns.isClear(columns.seen({far * std::cos(turn), far * std::sin(turn), up}), 0.0);
  }
  EXPECT_GT(clear, 18000) << "midway between the cone and what closes it";
}

} // namespace
} // namespace pcl_bsh

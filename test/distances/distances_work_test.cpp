// SPDX-License-Identifier: BSD-3-Clause
// How the work of distances grows with clouds that are hard for bounding volumes.
#include <pcl_bsh/distances/point_distances.h>

#include "support/adversarial_clouds.h"
#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace pcl_bsh {
namespace {

using test::Cloud;
using namespace test::adversarial;

using Points = std::vector<Point3>;

struct Corner {
  const char* name;
  std::function<Points(std::size_t)> a, b;
  double growth; ///< at most, of the work of both directions, where points are four times as many; linear work has 4
};

Points circle(std::size_t n)
{
  return helix(n, 1.0, 0.0);
}

Points strayed(Points points)
{
  constexpr double far = std::numeric_limits<float>::max();
  points.back() = {far, far, far};
  return points;
}

std::uint64_t stepsOf(const Work& work)
{
  return work.node_pairs + 16 * work.leaf_pairs + work.exact_decisions;
}

std::uint64_t workOf(const Points& one, const Points& other)
{
  const Cloud cloud_a(one), cloud_b(other);
  const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
  const SymmetricDistances found = symmetricDistances(a, b);
  EXPECT_EQ(found.a.measured, a.size());
  EXPECT_EQ(found.b.measured, b.size());
  return stepsOf(found.a.work) + stepsOf(found.b.work);
}

std::uint64_t hausdorffWorkOf(const Points& one, const Points& other)
{
  const Cloud cloud_a(one), cloud_b(other);
  const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
  return stepsOf(hausdorffDistance(a, b).work);
}

std::function<Points(std::size_t)> shellOf(double radius, std::size_t count = 1)
{
  return [=](std::size_t n) {
    Points points = shells(n, count, 0.1);
    for (Point3& p : points) p = scaled(p, radius);
    return points;
  };
}

/// Linear work, apart from the depth of trees: at most 25 times the steps for 16 times the points. Both directions, and
/// the Hausdorff distance alone.
TEST(PointDistances, TakeWorkThatGrowsAsTheClouds)
{
  const Corner corners[] = {
      {"center and shell",
       [](std::size_t) {
         return Points{{0, 0, 0}};
       },
       shellOf(1), 25},
      {"beside the center",
       [](std::size_t) {
         return Points{{1e-3, 2e-3, -1e-3}};
       },
       shellOf(1), 25},
      {"one place",
       [](std::size_t n) {
         return Points(n, {1, 2, 3});
       },
       shellOf(1), 25},
      {"shifted sheets", [](std::size_t n) { return sheet(n, 0, 0); },
       [](std::size_t n) { return sheet(n, 0.25, 0.5); }, 25},
      {"sheets ten spacings apart", [](std::size_t n) { return sheet(n, 0, 0); },
       [](std::size_t n) { return sheet(n, 0.5, 10); }, 25},
      {"double helix", [](std::size_t n) { return helix(n, 30, 0.05); },
       [](std::size_t n) { return helix(n, 30, 0.05, 0.5); }, 25},
  };
  for (const Corner& corner : corners)
    for (const auto& work : {workOf, hausdorffWorkOf}) {
      const std::uint64_t few = work(corner.a(1'000), corner.b(1'000)), many = work(corner.a(16'000), corner.b(16'000));
      EXPECT_LE(static_cast<double>(many), corner.growth * static_cast<double>(few) + 1000.0) << corner.name;
    }
}

/// The spheres of a shell's leaves are far larger than the nodes of a ball within: the leaves' points bound what these
/// do not. Took 46 million steps.
TEST(PointDistances, AskThePointsOfLeavesThatAreLargeBesideANode)
{
  const Cloud cloud_a(shellOf(1e-3)(16'000)), cloud_b(shellOf(1)(16'000));
  const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
  EXPECT_LT(stepsOf(pointDistances(a, b).work), 5e6);
}

/// Where nearly all pairs are at nearly one distance, work is quadratic. A shell and a ball in it is one such pair: the
/// ball's spheres are too small beside the shell's. An axis and its circle is another: all pairs are ties within
/// rounding, and take exact comparisons. Shells, combs and octaves are between. Strays at the end of the range of
/// floats cost as much as any point. None may become worse.
TEST(PointDistances, TakeNoMoreWorkOfGrowingCornersThanKnown)
{
  const Points center = {{0, 0, 0}};
  const auto at_height = [](double z) { return [z](std::size_t n) { return sheet(n, 0.25, z); }; };
  const auto at_scale = [](std::uint64_t seed, double count) {
    return [=](std::size_t n) { return octaves(n, count, seed); };
  };
  const Corner corners[] = {
      {"center and shell", [&](std::size_t) { return center; }, shellOf(1), 5.0},
      {"concentric shells", shellOf(1), shellOf(1.5), 7.0},
      {"five shells in five", shellOf(1, 5), shellOf(1.05, 5), 7.0},
      {"ball in a shell", shellOf(1e-3), shellOf(1), 16.0},
      {"circle and axis", circle, [](std::size_t n) { return axis(n, 1); }, 16.5},
      {"sheets half a spacing apart", at_height(0), at_height(0.5), 6.0},
      {"sheets ten spacings apart", at_height(0), at_height(10), 7.0},
      {"sheets a hundred spacings apart", at_height(0), at_height(100), 16.0},
      {"combs", [](std::size_t n) { return comb(n, 0); }, [](std::size_t n) { return comb(n, 0.5); }, 7.0},
      {"octaves", at_scale(1, 40), at_scale(2, 40), 13.0},
      {"one place",
       [](std::size_t n) {
         return Points(n, {1, 2, 3});
       },
       shellOf(1), 4.5},
      {"one stray", [](std::size_t n) { return strayed(cube(n, 1)); }, [](std::size_t n) { return cube(n, 2); }, 5.5},
      {"one stray at 1e20",
       [](std::size_t n) {
         return with(cube(n, 1), {{1e20, 0, 0}});
       },
       [](std::size_t n) { return cube(n, 2); }, 5.5},
      {"two strays", [](std::size_t n) { return strayed(cube(n, 1)); },
       [](std::size_t n) { return strayed(cube(n, 2)); }, 6.0},
  };
  for (const Corner& corner : corners) {
    SCOPED_TRACE(corner.name);
    std::uint64_t before = 0;
    for (const std::size_t n : {250u, 1'000u, 4'000u}) {
      const std::uint64_t work = workOf(corner.a(n), corner.b(n));
      const double growth = before != 0 ? static_cast<double>(work) / static_cast<double>(before) : 0.0;
      EXPECT_LE(growth, corner.growth) << n << " points: " << work;
      before = work;
    }
  }
}

} // namespace
} // namespace pcl_bsh

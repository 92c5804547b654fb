// SPDX-License-Identifier: BSD-3-Clause
// What searches for neighbours cost on clouds that are hard for them, as the clouds grow.
#include <pcl_bsh/neighbors/neighbors.h>

#include "../query/adversarial_clouds.h"
#include "../query/random_clouds.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include <functional>

namespace pcl_bsh {
namespace {

/// Everything that is done more often for more points.
double stepsOf(const Work& work)
{
  return static_cast<double>(work.node_pairs + 16 * work.leaf_pairs + work.exact_decisions + work.ranked / 8);
}

double stepsOfNearest(const test::HardCloud& hard, std::size_t k)
{
  const test::Cloud cloud(hard.points);
  const SphereHierarchy hierarchy(cloud.view());
  Neighbors found;
  Work work;
  for (const Point3& query : hard.queries) nearestKSearch(hierarchy, query, k, found, &work);
  return stepsOf(work);
}

TEST(NeighborsWork, GrowsAsTheShellAroundTheQuery)
{
  // All points are nearest within rounding, so that all have to be looked at: once, not once for each few others.
  for (const double off : {0.0, 1e-6, 1e-3}) {
    for (const std::size_t k : {1, 2, 10, 100}) {
      const auto steps = [&](std::size_t n) {
        return stepsOfNearest({test::adversarial::shells(n, 1, 0), {{off, 0, 0}}}, k);
      };
      const double few = steps(3000), some = steps(12000), many = steps(48000);
      EXPECT_LE(some, 5 * few) << "k = " << k << ", " << off << " from the centre";
      EXPECT_LE(many, 5 * some) << "k = " << k << ", " << off << " from the centre";
    }
  }
}

/// 200 places near points of the cube.
std::vector<Point3> placesInCube()
{
  return test::adversarial::cube(200, 7);
}

TEST(NeighborsWork, StraysDoNotSpoilTheOthers)
{
  // One coordinate that is no measurement, far outside of what a float's squares can hold, and six of 1e20.
  constexpr double sentinel = std::numeric_limits<float>::max();
  const std::vector<std::vector<Point3>> strays = {
      {},
      {{1e6, 0, 0}},
      {{1e12, 1e12, 0}},
      {{sentinel, sentinel, sentinel}},
      std::vector<Point3>(6, Point3{1e20, 1e20, 1e20}),
      {{1e20, 0, 0}, {-1e20, 0, 0}, {0, 1e20, 0}, {0, -1e20, 0}, {0, 0, 1e20}, {0, 0, -1e20}}};
  for (std::size_t n : {3000, 12000, 48000}) {
    for (const std::size_t k : {1, 2, 10}) {
      const auto steps = [&](const std::vector<Point3>& far) {
        return stepsOfNearest({test::adversarial::with(test::adversarial::cube(n, 3), far), placesInCube()}, k);
      };
      const double none = steps({});
      for (const auto& far : strays)
        EXPECT_LE(steps(far), 2.5 * none) << n << " points, k = " << k << ", strays: " << far.size();
    }
  }
}

} // namespace
} // namespace pcl_bsh

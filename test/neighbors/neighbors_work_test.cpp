// SPDX-License-Identifier: BSD-3-Clause
// Costs of searches for neighbours on clouds that are hard for them, as the clouds grow.
#include <pcl_bsh/neighbors/neighbors.h>

#include "support/adversarial_clouds.h"
#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>
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
    for (const std::size_t k : {1u, 2u, 10u, 100u}) {
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
  for (std::size_t n : {3000u, 12000u, 48000u}) {
    for (const std::size_t k : {1u, 2u, 10u}) {
      const auto steps = [&](const std::vector<Point3>& far) {
        return stepsOfNearest({test::adversarial::with(test::adversarial::cube(n, 3), far), placesInCube()}, k);
      };
      const double none = steps({});
      for (const auto& far : strays)
        EXPECT_LE(steps(far), 2.5 * none) << n << " points, k = " << k << ", strays: " << far.size();
    }
  }
}

/// Places at a distance from some of the points, in any direction.
std::vector<Point3> placesBeside(const std::vector<Point3>& points, double distance)
{
  test::Random random(5);
  std::vector<Point3> places;
  for (std::size_t i = 0; i < 100; ++i) {
    const Point3& p = points[i * points.size() / 100];
    const Point3 aside = test::adversarial::scaled(test::adversarial::direction(random), distance);
    places.push_back({p[0] + aside[0], p[1] + aside[1], p[2] + aside[2]});
  }
  return places;
}

/// Steps of all queries for neighbours.
std::map<std::string, double> stepsOfEach(const test::HardCloud& hard)
{
  const test::Cloud cloud(hard.points);
  const SphereHierarchy hierarchy(cloud.view());
  const auto total = [&](const auto& query) {
    Neighbors found;
    Work work;
    for (const Point3& place : hard.queries) query(place, found, work);
    return stepsOf(work);
  };
  std::map<std::string, double> steps;
  for (const std::size_t k : {1u, 2u, 10u})
    steps["the " + std::to_string(k) + " nearest"] =
        total([&](const Point3& at, Neighbors& found, Work& work) { nearestKSearch(hierarchy, at, k, found, &work); });
  steps["at most 3 within"] = total([&](const Point3& at, Neighbors& found, Work& work) {
    radiusSearch(hierarchy, at, hard.radius, found, {3, true}, &work);
  });
  steps["all within"] = total([&](const Point3& at, Neighbors& found, Work& work) {
    radiusSearch(hierarchy, at, hard.radius, found, {}, &work);
  });
  steps["any within"] =
      total([&](const Point3& at, Neighbors&, Work& work) { anyInRadius(hierarchy, at, hard.radius, &work); });
  return steps;
}

TEST(NeighborsWork, GrowsAtMostAsTheRootOfTheCloud)
{
  using namespace test::adversarial;
  struct Named {
    const char* name;
    std::function<test::HardCloud(std::size_t)> make;
  };
  const auto beside = [](std::vector<Point3> points, double distance, double radius) {
    const std::vector<Point3> places = placesBeside(points, distance);
    return test::HardCloud{std::move(points), places, radius};
  };
  const Named catalogue[] = {
      {"a cube", [&](std::size_t n) { return beside(cube(n, 3), 0.01, 0.2 / std::cbrt(n)); }},
      {"a comb", [&](std::size_t n) { return beside(comb(n, 0), 0.5, 0.5); }},
      {"a line", [&](std::size_t n) { return beside(axis(n, 1), 0.5, 0.49); }},
      {"one place",
       [&](std::size_t n) {
         return beside(std::vector<Point3>(n, Point3{1, 2, 3}), 0.5, 0.4);
       }},
      {"a cube and strays", [&](std::size_t n) {
         const std::vector<Point3> strays = {{1e20, 0, 0}, {-1e20, 0, 0}, {0, 1e20, 0}, {0, -1e20, 0}};
         return test::HardCloud{with(cube(n, 3), strays), cube(100, 7), 0.2 / std::cbrt(n)};
       }}};
  for (const Named& hard : catalogue) {
    const auto few = stepsOfEach(hard.make(4000)), many = stepsOfEach(hard.make(64000));
    for (const auto& [query, steps] : few) EXPECT_LE(many.at(query), 5 * steps + 1000) << hard.name << ": " << query;
  }
}

TEST(NeighborsWork, GrowsAtMostAsTheCloudWhereAllPointsAreAsNear)
{
  // No search can tell which of them are nearest without a look at each.
  using namespace test::adversarial;
  struct Named {
    const char* name;
    std::function<test::HardCloud(std::size_t)> make;
  };
  const Named catalogue[] = {{"concentric shells",
                              [](std::size_t n) {
                                return test::HardCloud{shells(n, 20, 0.01), {{1e-3, 0, 0}}, 1.0};
                              }},
                             {"a circle from its axis",
                              [](std::size_t n) {
                                return test::HardCloud{helix(n, 1, 0), axis(16, 1), 1.0};
                              }},
                             {"a helix from its axis", [](std::size_t n) {
                                return test::HardCloud{helix(n, 100, 0.01), axis(16, 1), 1.0};
                              }}};
  for (const Named& hard : catalogue) {
    const auto few = stepsOfEach(hard.make(4000)), many = stepsOfEach(hard.make(64000));
    for (const auto& [query, steps] : few) EXPECT_LE(many.at(query), 25 * steps + 1000) << hard.name << ": " << query;
  }
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// Pairs of surfaces of which all triangles are equally near.
#pragma once

#include "support/made_meshes.h"
#include "support/random.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace pcl_bsh::test {

inline void append(TestMesh& mesh, TestMesh other)
{
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (Triangle t : other.triangles) {
    for (std::uint32_t& corner : t) corner += first;
    mesh.triangles.push_back(t);
  }
}

inline void shuffle(TestMesh& mesh, std::uint64_t seed)
{
  std::mt19937_64 order(seed);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), order);
}

/// Needles about a tip at `at`; the circle where they end is `height` above it and turned a little.
inline TestMesh cone(std::uint32_t sides, double radius, double height, const Point3& at, double turn = 0.0)
{
  TestMesh mesh = fanMesh(sides, radius, 0.0, false);
  mesh.move(Eigen::Translation3d(at[0], at[1], at[2] + height) *
            Eigen::Isometry3d(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ())));
  mesh.vertices[0] = at;
  return mesh;
}

/// A cone whose triangles are in rings about its tip, in any order.
inline TestMesh ringedCone(std::uint32_t sides, double radius, double height, const Point3& at, std::uint64_t seed)
{
  TestMesh mesh = cone(sides, radius, height, at);
  append(mesh, gridMesh(sides, 3, [&](double u, double v) -> Point3 {
           const double turn = 2 * std::numbers::pi * u;
           return {at[0] + (1 + v) * radius * std::cos(turn), at[1] + (1 + v) * radius * std::sin(turn),
                   at[2] + (1 + v) * height};
         }));
  shuffle(mesh, seed);
  return mesh;
}

/// Pages about one long edge, along x at a height of `at`; they open upwards for 1, downwards for -1.
inline TestMesh book(std::uint32_t pages, double up, double at)
{
  TestMesh mesh;
  for (std::uint32_t i = 0; i < pages; ++i) {
    const double turn = std::numbers::pi * (0.05 + 0.9 * i / pages);
    mesh.add({-1, 0, at}, {1, 0, at}, {0.3, std::cos(turn), at + up * std::sin(turn)});
  }
  return mesh;
}

struct TiedPair {
  TestMesh a, b;
  Eigen::Isometry3d pose_a = Eigen::Isometry3d::Identity(), pose_b = Eigen::Isometry3d::Identity();
  double gap = 0.0; ///< of most of both, within rounding
};

/// Pairs in which nearly all of one is tied with all of the other: tips, discs, sheets, and some of it spoilt.
inline TiedPair anyTies(std::uint64_t seed)
{
  Random random(seed);
  const double gap = random.pick({0.0, 0.25, 0.3, 1e-3});
  const double heights[] = {0.0, 0.125, 0.5, 3.0};
  const auto part = [&](double up, double at) {
    const auto sides = static_cast<std::uint32_t>(random.integer(3, 40));
    const double height = up * random.pick(heights), radius = random.pick({0.5, 1.0, 2.0});
    const Point3 tip = {random.pick({0.0, 0.0, 0.0, 0.1, 0.5}), 0.0, at};
    if (random.chance(0.2)) return ringedCone(sides, radius, height, tip, seed);
    if (random.chance(0.2))
      return gridMesh(4, 4, [&](double u, double v) -> Point3 { return {2 * u - 1, 2 * v - 1, at}; });
    return cone(sides, radius, height, tip, random.uniform(0, 1));
  };
  TiedPair pair{part(-1.0, 0.0), part(1.0, gap)};
  if (random.chance(0.3)) append(pair.a, part(-1.0, 0.0)); // a second tip, as near as the first or not
  if (random.chance(0.3)) append(pair.b, part(1.0, gap));
  pair.gap = gap;
  if (random.chance(0.2)) { // one triangle is nearer
    const double at = gap * (1 - random.pick({1e-12, 1e-9, 1e-6, 0.5})), x = random.uniform(-0.5, 0.5);
    pair.b.add({x, 0, at}, {x + 0.1, 0, gap + 1}, {x, 0.1, gap + 1});
  }
  if (random.chance(0.2)) { // so that no plane is between the two
    append(pair.a, cone(7, 1, -1, {50, 0, 5}));
    append(pair.b, cone(7, 1, 1, {50, 0, -5}));
  }
  shuffle(pair.a, seed), shuffle(pair.b, seed + 1);
  Eigen::Isometry3d quarter = Eigen::Isometry3d::Identity();
  quarter.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  quarter.translation() << 1, -2, 0.5;
  switch (random.integer(0, 3)) {
  case 0:
    break;
  case 1:
    pair.pose_a = pair.pose_b = quarter;
    break;
  case 2:
    pair.pose_a = pair.pose_b = random.pose(3);
    break;
  default: // the same place in other coordinates, up to rounding
    pair.pose_b = random.pose(3);
    pair.b.move(pair.pose_b.inverse());
  }
  return pair;
}

/// A clearance that pairs at a distance are hardly beyond, touch, or are hardly within; not below 0.
inline double clearanceAbout(double distance, Random& random)
{
  const double least = std::nextafter(distance, -1.0), most = std::nextafter(distance, 1e9);
  const double off = random.pick({-1e-6, -1e-9, -1e-12, 0.0, 0.0, 1e-12, 1e-9, 1e-6});
  const double clearance = off != 0.0 ? distance * (1 + off) : random.pick({distance, least, most});
  return std::max(0.0, clearance);
}

/// A tied pair of n sides.
struct Tied {
  const char* name;
  std::function<TiedPair(std::uint32_t)> make;
};

inline const std::vector<Tied>& tied()
{
  static const std::vector<Tied> all = {
      {"cones tip to tip",
       [](std::uint32_t n) {
         return TiedPair{cone(n, 1, -1, {0, 0, 0}), cone(n, 1, 1, {0, 0, 0.3}, 0.1)};
       }},
      {"discs that face each other",
       [](std::uint32_t n) {
         return TiedPair{cone(n, 1, 0, {0, 0, 0}), cone(n, 1, 0, {0, 0, 0.3}, 0.1)};
       }},
      {"cones of rings",
       [](std::uint32_t n) {
         return TiedPair{ringedCone(n, 0.2, -0.2, {0, 0, 0}, 1), ringedCone(n, 0.2, 0.2, {0, 0, 0.3}, 2)};
       }},
      {"a disc below a cone",
       [](std::uint32_t n) {
         return TiedPair{cone(n, 1, 0, {0, 0, 0}), cone(n, 1, 1, {0.5, 0, 0.3})};
       }},
      {"a cone below a disc",
       [](std::uint32_t n) {
         return TiedPair{cone(n, 1, -1, {0.5, 0, 0}), cone(n, 1, 0, {0, 0, 0.3})};
       }},
      {"books back to back",
       [](std::uint32_t n) {
         return TiedPair{book(n, -1, 0), book(n, 1, 0.3)};
       }},
      {"cones, no plane between all of them", [](std::uint32_t n) {
         TiedPair pair{cone(n, 1, -1, {0, 0, 0}), cone(n, 1, 1, {0, 0, 0.3}, 0.1)};
         append(pair.a, cone(n, 1, 1, {9, 0, 2.5}));
         append(pair.b, cone(n, 1, -1, {9, 0, 1.5}));
         shuffle(pair.a, 1), shuffle(pair.b, 2);
         return pair;
       }}};
  return all;
}

} // namespace pcl_bsh::test

// SPDX-License-Identifier: BSD-3-Clause
// Made-up meshes.
#pragma once

#include "support/random.h"

#include <pcl_bsh/hierarchy/triangles_view.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <vector>

namespace pcl_bsh::test {

struct TestMesh {
  std::vector<Point3> vertices;
  std::vector<Triangle> triangles;

  PointsView view() const { return viewOf(vertices.empty() ? nullptr : vertices[0].data(), vertices.size()); }

  TrianglesView trianglesView() const
  {
    return {view(), triangles.empty() ? nullptr : triangles[0].data(), triangles.size()};
  }

  void add(const Point3& a, const Point3& b, const Point3& c)
  {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), {a, b, c});
    triangles.push_back({first, first + 1, first + 2});
  }

  void move(const Eigen::Isometry3d& pose)
  {
    for (Point3& p : vertices) {
      const Eigen::Vector3d q = pose * Eigen::Vector3d(p[0], p[1], p[2]);
      p = {q.x(), q.y(), q.z()};
    }
  }
};

/// A grid of columns x rows cells, two triangles each, at what `place(u, v)` gives for u and v in [0, 1].
template <class Place>
TestMesh gridMesh(std::uint32_t columns, std::uint32_t rows, const Place& place)
{
  TestMesh mesh;
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i) mesh.vertices.push_back(place(double(i) / columns, double(j) / rows));
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

/// A box of this size with a corner at the origin, twelve triangles that share eight corners.
inline TestMesh boxMesh(double x, double y, double z)
{
  TestMesh mesh;
  for (int k = 0; k < 8; ++k) mesh.vertices.push_back({(k & 1) * x, (k >> 1 & 1) * y, (k >> 2) * z});
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 7, 5}, {4, 6, 7}, {0, 5, 1}, {0, 4, 5},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return mesh;
}

/// Needles that share a corner above the origin and end side by side on a circle about it; closed by as many below.
/// @param height of that corner, and depth of the one below
inline TestMesh fanMesh(std::uint32_t sides, double radius, double height, bool closed)
{
  TestMesh mesh;
  mesh.vertices = {{0, 0, height}, {0, 0, -height}};
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double turn = 2 * std::numbers::pi * i / sides;
    mesh.vertices.push_back({radius * std::cos(turn), radius * std::sin(turn), 0});
  }
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t here = 2 + i, next = 2 + (i + 1) % sides;
    mesh.triangles.push_back({0, here, next});
    if (closed) mesh.triangles.push_back({1, next, here});
  }
  return mesh;
}

inline TestMesh sphereMesh(double radius, std::uint32_t columns)
{
  return gridMesh(columns, columns / 2, [&](double u, double v) -> Point3 {
    const double turn = 2 * std::numbers::pi * u, tilt = std::numbers::pi * v;
    return {radius * std::sin(tilt) * std::cos(turn), radius * std::sin(tilt) * std::sin(turn),
            radius * std::cos(tilt)};
  });
}

/// Triangles of any shape within a cube, each with corners of its own: some thin, some without area.
inline TestMesh soup(std::uint64_t seed, int count, double reach, double size)
{
  Random random(seed);
  TestMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Point3 a = random.point([&] { return random.uniform(-reach, reach); });
    const double thin = random.pick({1.0, 1.0, 1e-3, 1e-9, 0.0});
    Point3 b = a, c = a;
    const double share = random.pick({0.0, 0.5, 1.0});
    const double length = random.chance(0.05) ? 0.0 : size * random.uniform(0, 1);
    for (std::size_t k = 0; k < 3; ++k) {
      const double step = length * random.uniform(-1, 1);
      b[k] += step;
      c[k] += share * step + thin * length * random.uniform(-1, 1);
    }
    mesh.add(a, b, c);
  }
  return mesh;
}

} // namespace pcl_bsh::test

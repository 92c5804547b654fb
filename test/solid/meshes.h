// SPDX-License-Identifier: BSD-3-Clause
// Closed meshes that tests of solids make.
#pragma once

#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include "support/random.h"

#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace pcl_bsh::test {

struct ClosedMesh {
  std::vector<double> xyz;
  std::vector<std::uint32_t> corners;

  std::uint32_t vertex(double x, double y, double z)
  {
    xyz.insert(xyz.end(), {x, y, z});
    return static_cast<std::uint32_t>(xyz.size() / 3 - 1);
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { corners.insert(corners.end(), {a, b, c}); }

  void add(const ClosedMesh& other, double scale = 1.0, const Point3& shift = {0, 0, 0}, bool flip = false)
  {
    const auto first = static_cast<std::uint32_t>(xyz.size() / 3);
    for (std::size_t i = 0; i < other.xyz.size(); ++i) xyz.push_back(other.xyz[i] * scale + shift[i % 3]);
    for (std::size_t i = 0; i < other.corners.size(); i += 3)
      triangle(first + other.corners[i], first + other.corners[i + (flip ? 2 : 1)],
               first + other.corners[i + (flip ? 1 : 2)]);
  }

  TrianglesView view() const { return {viewOf(xyz.data(), xyz.size() / 3), corners.data(), corners.size() / 3}; }
};

inline ClosedMesh boxMesh(double edge = 1.0)
{
  ClosedMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertex((i & 1) * edge, (i >> 1 & 1) * edge, (i >> 2 & 1) * edge);
  for (const auto& q : {std::array<std::uint32_t, 4>{0, 2, 3, 1},
                        {4, 5, 7, 6},
                        {0, 1, 5, 4},
                        {2, 6, 7, 3},
                        {0, 4, 6, 2},
                        {1, 3, 7, 5}}) {
    mesh.triangle(q[0], q[1], q[2]);
    mesh.triangle(q[0], q[2], q[3]);
  }
  return mesh;
}

/// A cone over a polygon of so many corners on a circle of radius 1, and the fan that closes it.
inline ClosedMesh fanMesh(std::uint32_t around)
{
  ClosedMesh mesh;
  const std::uint32_t top = mesh.vertex(0, 0, 1), middle = mesh.vertex(0, 0, 0);
  for (std::uint32_t i = 0; i < around; ++i)
    mesh.vertex(std::cos(2 * M_PI * i / around), std::sin(2 * M_PI * i / around), 0);
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t a = 2 + i, b = 2 + (i + 1) % around;
    mesh.triangle(top, a, b);
    mesh.triangle(middle, b, a);
  }
  return mesh;
}

/// A bumpy ball in [0, 1]^3, rows x 2 rows.
inline ClosedMesh bumpyMesh(std::uint32_t rows, double bumps)
{
  ClosedMesh mesh;
  const std::uint32_t columns = 2 * rows;
  const std::uint32_t north = mesh.vertex(0.5, 0.5, 0.9), south = mesh.vertex(0.5, 0.5, 0.1);
  for (std::uint32_t i = 1; i < rows; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const double t = M_PI * i / rows, p = 2 * M_PI * j / columns;
      const double r = 0.4 * (1 + bumps * std::sin(9 * t) * std::cos(11 * p));
      mesh.vertex(0.5 + r * std::sin(t) * std::cos(p), 0.5 + r * std::sin(t) * std::sin(p), 0.5 + r * std::cos(t));
    }
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return i == 0 ? north : i == rows ? south : 2 + (i - 1) * columns + j % columns;
  };
  for (std::uint32_t i = 0; i < rows; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      if (i > 0) mesh.triangle(at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + 1 < rows) mesh.triangle(at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
    }
  return mesh;
}

/// Tetrahedra anywhere on a lattice of so many steps from 0 to 1, of either sense: they overlap and cross each other,
/// share corners, and some are flat.
inline ClosedMesh latticeMesh(int tetrahedra, int steps, std::uint64_t seed)
{
  Random random(seed);
  ClosedMesh mesh;
  for (int i = 0; i < tetrahedra; ++i) {
    std::uint32_t v[4];
    for (std::uint32_t& name : v) {
      const auto some = [&] { return random.integer(0, steps) / static_cast<double>(steps); };
      const double x = some(), y = some(), z = some();
      name = mesh.vertex(x, y, z);
    }
    mesh.triangle(v[0], v[2], v[1]);
    mesh.triangle(v[0], v[1], v[3]);
    mesh.triangle(v[1], v[2], v[3]);
    mesh.triangle(v[2], v[0], v[3]);
  }
  return mesh;
}

/// The mesh's surface in more triangles: so many times one of them, and not its neighbour, is cut in two at the middle
/// of an edge, or in four. So corners lie within edges, and exactly so where coordinates have few digits.
inline ClosedMesh cutMesh(const ClosedMesh& mesh, int cuts, std::uint64_t seed)
{
  Random random(seed);
  ClosedMesh cut = mesh;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto at = [&](std::size_t k) { return 0.5 * cut.xyz[3 * a + k] + 0.5 * cut.xyz[3 * b + k]; };
    const double x = at(0), y = at(1), z = at(2);
    return cut.vertex(x, y, z);
  };
  for (int i = 0; i < cuts; ++i) {
    const auto first = static_cast<std::size_t>(3 * random.integer(0, static_cast<int>(cut.corners.size() / 3) - 1));
    const auto turn = static_cast<std::size_t>(random.integer(0, 2));
    std::uint32_t t[3];
    for (std::size_t k = 0; k < 3; ++k) t[k] = cut.corners[first + (k + turn) % 3];
    const std::uint32_t half = middle(t[0], t[1]);
    const auto replace = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      cut.corners[first] = a, cut.corners[first + 1] = b, cut.corners[first + 2] = c;
    };
    if (random.chance(0.5)) {
      replace(t[0], half, t[2]);
      cut.triangle(half, t[1], t[2]);
      continue;
    }
    const std::uint32_t next = middle(t[1], t[2]), last = middle(t[2], t[0]);
    replace(half, next, last);
    cut.triangle(t[0], half, last);
    cut.triangle(half, t[1], next);
    cut.triangle(last, next, t[2]);
  }
  return cut;
}

/// Points of which most are near the surface, on it, or at its corners and on its edges.
inline std::vector<double> pointsAbout(const ClosedMesh& mesh, std::size_t count, double spread, std::uint64_t seed)
{
  Random random(seed);
  const TrianglesView view = mesh.view();
  std::vector<double> points;
  for (std::size_t i = 0; i < count; ++i) {
    const auto t = view.triangle(static_cast<std::uint32_t>(random.integer(0, static_cast<int>(view.count) - 1)));
    const int kind = random.integer(0, 4);
    double u = kind == 0 ? 0 : random.integer(0, 4) / 4.0, v = kind <= 1 ? 0 : random.integer(0, 4) / 4.0;
    if (u + v > 1) u = 1 - u, v = 1 - v;
    for (std::size_t k = 0; k < 3; ++k) {
      const double on = t[0][k] + u * (t[1][k] - t[0][k]) + v * (t[2][k] - t[0][k]);
      points.push_back(kind == 4 ? on + random.uniform(-spread, spread) : on);
    }
  }
  return points;
}

} // namespace pcl_bsh::test

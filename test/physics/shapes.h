// SPDX-License-Identifier: BSD-3-Clause
// Things that fall, and what they fall on.
#pragma once

#include "support/made_meshes.h"
#include "support/random.h"

#include <Eigen/Geometry>

#include <cmath>
#include <vector>

namespace pcl_bsh::test {

constexpr double kGravity = 9.81;
constexpr double kStep = 1.0 / 240.0;

inline Eigen::Isometry3d at(double x, double y, double z)
{
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

inline TestMesh planeMesh(double reach = 20.0)
{
  return gridMesh(1, 1, [&](double u, double v) -> Point3 { return {reach * (2 * u - 1), reach * (2 * v - 1), 0}; });
}

/// Its middle is the origin.
inline TestMesh crateMesh(double x, double y, double z)
{
  TestMesh mesh = boxMesh(x, y, z);
  mesh.move(at(-0.5 * x, -0.5 * y, -0.5 * z));
  return mesh;
}

/// x y z of a hilly square of 4 m.
inline std::vector<float> terrainPoints(Random& random, int count = 40000)
{
  std::vector<float> xyz;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-2, 2), y = random.uniform(-2, 2);
    xyz.insert(xyz.end(), {float(x), float(y), float(0.1 * std::sin(3 * x) * std::cos(2 * y))});
  }
  return xyz;
}

/// x y z of an ellipsoid, 0.8 m wide and 0.48 m high.
inline std::vector<float> stonePoints(Random& random, int count = 3000)
{
  std::vector<float> xyz;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    const double r = std::sqrt(x * x + y * y + z * z) / 0.4;
    xyz.insert(xyz.end(), {float(x / r), float(y / r), float(0.6 * z / r)});
  }
  return xyz;
}

} // namespace pcl_bsh::test

// SPDX-License-Identifier: BSD-3-Clause
// A solid box.
#pragma once

#include <pcl_bsh/robot/robot.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::robots {

inline double roundness(const Box&)
{
  return 0.0;
}

inline double enclosingRadius(const Box& box)
{
  return 0.5 * box.size.norm();
}

inline double signedDistance(const Box& box, const Eigen::Vector3d& p)
{
  const Eigen::Vector3d over = p.cwiseAbs() - 0.5 * box.size;
  return over.cwiseMax(0.0).norm() + std::min(over.maxCoeff(), 0.0);
}

inline Eigen::Vector3d support(const Box& box, const Eigen::Vector3d& direction)
{
  Eigen::Vector3d corner;
  for (int k = 0; k < 3; ++k) corner[k] = std::copysign(0.5 * box.size[k], direction[k]);
  return corner;
}

inline std::array<double, 3> sizesOf(const Box& box)
{
  return {box.size.x(), box.size.y(), box.size.z()};
}

} // namespace pcl_bsh::robots

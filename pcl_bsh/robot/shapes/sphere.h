// SPDX-License-Identifier: BSD-3-Clause
// A sphere is a point with a radius.
#pragma once

#include <pcl_bsh/robot/robot.h>

namespace pcl_bsh::robots {

inline double roundness(const Sphere& ball)
{
  return ball.radius;
}

inline double enclosingRadius(const Sphere& ball)
{
  return ball.radius;
}

inline double signedDistance(const Sphere& ball, const Eigen::Vector3d& p)
{
  return p.norm() - ball.radius;
}

inline Eigen::Vector3d support(const Sphere&, const Eigen::Vector3d&)
{
  return Eigen::Vector3d::Zero();
}

inline std::array<double, 3> sizesOf(const Sphere& ball)
{
  return {ball.radius, ball.radius, ball.radius};
}

} // namespace pcl_bsh::robots

// SPDX-License-Identifier: BSD-3-Clause
// The bodies of a URDF that are solid: boxes, cylinders and spheres.
#pragma once

#include "robot.h"

#include <variant>

namespace pcl_bsh::self_filter {

using Solid = std::variant<Box, Cylinder, Sphere>;

/// How far a point in the solid's frame lies from it, m; 0 inside. But for a few roundings of double.
double distanceTo(const Solid& solid, const Eigen::Vector3d& point);

/// A cylinder about an axis of the solid's frame, centred, that encloses a box or a cylinder. Of a sphere, which lies
/// within the radius of its centre, the length is 0.
struct Rod {
  int axis = 2;
  double radius = 0.0, half_length = 0.0; ///< m
};

Rod rodAround(const Solid& solid);

/// @throws std::runtime_error for a size that is not finite, not above 0, or beyond what a float holds
void requireSize(const Solid& solid);

} // namespace pcl_bsh::self_filter

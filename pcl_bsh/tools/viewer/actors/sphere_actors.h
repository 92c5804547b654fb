// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "actors.h"

namespace pcl_bsh::viewer {

/// Adds translucent spheres, outlined where they are not too many. @param spheres points with an array `radius`
/// @param colors one per sphere
void addSpheres(PropGroup& group, vtkPolyData& spheres, const Eigen::Isometry3d& pose, const std::vector<Color>& colors,
                double opacity);

} // namespace pcl_bsh::viewer

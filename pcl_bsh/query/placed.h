// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <Eigen/Geometry>

namespace pcl_bsh {

/// A cloud's hierarchy and where it stands. The hierarchy is borrowed, and builds its voxels as queries visit them.
struct Placed {
  const SphereHierarchy& hierarchy;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_world_cloud; rigid within 1e-6
};

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// A cloud and its pose: what queries ask about.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <Eigen/Geometry>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// A cloud's hierarchy and where it stands. The hierarchy is borrowed, and builds its voxels as queries visit them.
class Placed {
public:
  /// The hierarchy must outlive this.
  Placed(const SphereHierarchy& hierarchy, const Eigen::Isometry3d& T_world_cloud = Eigen::Isometry3d::Identity())
  : pose(T_world_cloud),
    hierarchy_(&hierarchy)
  {
  }

  const SphereHierarchy& hierarchy() const noexcept { return *hierarchy_; } ///< of the cloud, in its own frame

  Eigen::Isometry3d pose; ///< T_world_cloud; rigid within 1e-6

private:
  const SphereHierarchy* hierarchy_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/obstacle_settings.h>

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

namespace pcl_bsh {

SphereHierarchy ObstacleSettings::hierarchyOf(const PointsView& input) const
{
  HierarchyOptions options;
  options.threads = threads_;
  return SphereHierarchy(input, options);
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/obstacle_settings.h>

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <pcl/console/print.h>

#include <utility>

namespace pcl_bsh {

SphereHierarchy ObstacleSettings::hierarchyOf(const PointsView& input) const
{
  HierarchyOptions options;
  options.threads = threads_;
  return SphereHierarchy(input, options);
}

void ObstacleSettings::warnOf(const SphereHierarchy& input, const SurfaceCover* surface,
                              const SphereHierarchy& obstacle, std::vector<Eigen::Isometry3d> poses,
                              std::optional<double> clearance)
{
  const bool measures = clearance && !std::exchange(measured_, true);
  const auto named = measures ? measuredCloud : namedCloud;
  const Question question{named("the input", input, surface),
                          named("the obstacle", obstacle, obstacle_.surface().get()), std::move(poses), clearance};
  for (const Warning& warning : warnings_.unheard(warningsOf(question))) {
    if (warn_)
      warn_(warning.text);
    else
      PCL_WARN("[pcl_bsh] %s.\n", warning.text.c_str());
  }
}

} // namespace pcl_bsh

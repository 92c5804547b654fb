// SPDX-License-Identifier: BSD-3-Clause
// How densely is a surface sampled? A collision can hide in a hole wider than the clearance.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>

#include <cstddef>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Distances from points to the nearest point at another place, in the cloud's unit. In double arithmetic, from the
/// coordinates as given.
struct Spacing {
  std::size_t samples = 0; ///< points that were asked
  double median = 0.0;     ///< 0 when no two places are sampled
  double wide = 0.0;       ///< nine of ten are no farther from a neighbour
};

/// Asks at most 1,024 points, in 32 groups that are evenly spaced through the cloud's voxels, so that few voxels are
/// built for it; all points of a cloud that has no more. Every call gives an equal result.
Spacing spacingOf(const SphereHierarchy& cloud);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

// SPDX-License-Identifier: BSD-3-Clause
// What of a cloud matters to those who ask about it, wherever its points are: in memory, or in files of a site.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/neighbors/spacing.h>
#include <pcl_bsh/surface/surface_cover.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// A cloud, or a surface, by the name that its user knows it by. Lengths are in the clouds' own unit.
struct NamedCloud {
  std::string name;                ///< of a file, or such as "the input"
  std::uint64_t points = 0;        ///< records; of a surface, the balls that stand for it
  std::uint64_t finite = 0;        ///< of these; as many as there are where nobody knows
  Eigen::AlignedBox3d box;         ///< holds the finite points, in the cloud's frame; empty: there are none
  double coordinate_spacing = 0.0; ///< as SphereHierarchy::coordinateSpacing() has it; of a surface, of its corners
  std::uint64_t loose = 0;         ///< of a surface, vertices that no triangle names
  std::optional<Spacing> spacing;  ///< of the points; none of a surface, and where nobody has measured it
};

/// Facts that cost nothing, so not the spacing.
/// @param cover null, or the surface that the points are the balls of
NamedCloud namedCloud(std::string name, const SphereHierarchy& points, const SurfaceCover* cover = nullptr);

/// With the spacing, unless it is a surface. Better after a query than before: it builds a few voxels.
NamedCloud measuredCloud(std::string name, const SphereHierarchy& points, const SurfaceCover* cover = nullptr);

/// Holds a box at each of these poses. @param poses where it is, in the frame of the answer
Eigen::AlignedBox3d boxAlong(const Eigen::AlignedBox3d& box, const std::vector<Eigen::Isometry3d>& poses);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

// SPDX-License-Identifier: BSD-3-Clause
// Facts about a cloud that warnings depend on. The points may be in memory or in files of a site.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/neighbors/spacing.h>

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
  bool is_surface = false;         ///< its records are triangles
  std::uint64_t points = 0;        ///< records
  std::uint64_t finite = 0;        ///< of these; `points` where nobody has counted them
  Eigen::AlignedBox3d box;         ///< holds the finite points, in the cloud's frame; empty: there are none
  double coordinate_spacing = 0.0; ///< as SphereHierarchy::coordinateSpacing() has it
  std::uint64_t loose = 0;         ///< of a surface, vertices that no triangle names
  std::optional<Spacing> spacing;  ///< of the points; none of a surface, nor where nobody has measured it
};

/// Returns the facts without the spacing, which costs more than the others.
NamedCloud namedCloud(std::string name, const SphereHierarchy& points);

/// Returns the facts with the spacing, unless it is a surface. Better after a query than before: it builds a few
/// voxels.
NamedCloud measuredCloud(std::string name, const SphereHierarchy& points);

/// Returns a box that holds the box at each of these poses. @param poses where it is, in the frame of the answer
Eigen::AlignedBox3d boxAlong(const Eigen::AlignedBox3d& box, const std::vector<Eigen::Isometry3d>& poses);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

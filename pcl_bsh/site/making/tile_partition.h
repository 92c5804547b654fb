// SPDX-License-Identifier: BSD-3-Clause
// Which voxels become one tile.
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh::site {

/// An undivided voxel, with the points counted in it, of which there may be none.
struct CountedVoxel {
  Point3 middle = {};           ///< of the box about its points; without points, of the voxel
  std::uint64_t points = 0;     ///< counted in it
  std::uint32_t above = 0;      ///< index of the smallest divided voxel that holds it
  std::uint64_t most_above = 0; ///< points counted in all voxels that hold it, before they were divided
};

/// A voxel that was divided.
struct DividedVoxel {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint64_t points = 0;   ///< counted in it before; it is not known which of its parts they lie in
  std::uint32_t above = none; ///< index of the smallest divided voxel that holds it; none: no voxel does
};

/// Cuts the voxels in two along the longest side of the box about them, and so on. A part is a tile if it is one voxel,
/// or has at most tile_points wherever the points counted in voxels above it lie. So tiles are compact, and nearly
/// full.
/// @return of each voxel its tile, counted from 0; neighbours have neighbouring numbers
std::vector<std::uint32_t> tilesOf(const std::vector<CountedVoxel>& voxels, const std::vector<DividedVoxel>& above,
                                   std::uint64_t tile_points);

} // namespace pcl_bsh::site

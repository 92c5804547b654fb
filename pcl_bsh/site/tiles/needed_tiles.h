// SPDX-License-Identifier: BSD-3-Clause
// Which tiles of a site can matter to a question, told by boxes alone: a tile that is left out cannot.
#pragma once

#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/search/uncertainty.h>
#include <pcl_bsh/site/site.h>
#include <pcl_bsh/site/tiles/path_boxes.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace pcl_bsh::site {

/// Refuses an uncertainty that the points of the site cannot have, also where no tile will be read.
/// @throws std::invalid_argument as withUncertainty() does. @throws files::FileError for a field of which site.json
///   does not say how large its values are
void requireUncertainty(const Site& site, const Uncertainty& uncertainty);

/// Returns an upper bound of the distance from a point of a tile as measured to where it may truly be. @pre the tile
/// has a box
double straying(const Tile& tile, const Uncertainty& uncertainty);

/// The box about wherever the points of a tile may truly be. @pre it has one
Bounds trueBounds(const Tile& tile, const Uncertainty& uncertainty);

/// Returns boxes about the parts of a cloud where it stands. Each is grown by a bound of the rounding.
std::vector<Bounds> placedParts(const CloudBoxes& boxes, const Eigen::Isometry3d& pose);

/// Tiles that the model may come near to on its way, wherever points truly are.
std::vector<std::uint32_t> tilesAlong(const Site& site, const CloudBoxes& model,
                                      const std::vector<Eigen::Isometry3d>& poses, const PathReach& reach,
                                      const Uncertainty& uncertainty);

} // namespace pcl_bsh::site

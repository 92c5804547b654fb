// SPDX-License-Identifier: BSD-3-Clause
// Which tiles of a site can matter to a question, told by boxes alone: a tile that is left out cannot.
#pragma once

#include <pcl_bsh/filters/uncertainty.h>
#include <pcl_bsh/query/placed.h>
#include <pcl_bsh/site/site.h>
#include <pcl_bsh/site/tiles/path_boxes.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace pcl_bsh::site {

/// Refuses an uncertainty that the points of the site cannot have, although no tile may be read.
/// @throws std::invalid_argument as withUncertainty() does. @throws files::FileError for a field of which site.json
///   does not say how large its values are
void requireUncertainty(const Site& site, const Uncertainty& uncertainty);

/// The box about wherever the points of a tile may truly be. @pre it has one
Bounds trueBounds(const Tile& tile, const Uncertainty& uncertainty);

/// Tiles that may have a point within the distance of b, wherever points truly are.
std::vector<std::uint32_t> tilesWithin(const Site& site, const Placed& b, double distance,
                                       const Uncertainty& uncertainty = {});

/// All tiles with points where b has any, too.
std::vector<std::uint32_t> tilesWithPoints(const Site& site, const Placed& b);

/// The same, those first that may be nearest to b, each with a lower bound of its distance.
std::vector<std::pair<double, std::uint32_t>> tilesByDistance(const Site& site, const Placed& b);

/// Tiles that the model may come near to on its way, wherever points truly are.
std::vector<std::uint32_t> tilesAlong(const Site& site, const SphereHierarchy& model,
                                      const std::vector<Eigen::Isometry3d>& poses, const PathReach& reach,
                                      const Uncertainty& uncertainty);

} // namespace pcl_bsh::site

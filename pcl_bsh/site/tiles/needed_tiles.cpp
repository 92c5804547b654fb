// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>

#include <algorithm>
#include <limits>

namespace pcl_bsh::site {

namespace {

/// Boxes about parts of a cloud where it stands. Two steps of rounding are paid for by each of both.
std::vector<Bounds> placedParts(const CloudBoxes& boxes, const Eigen::Isometry3d& pose)
{
  std::vector<Bounds> parts;
  for (const Bounds& part : boxes.parts()) parts.push_back(moved(part, pose, 0.0));
  return parts;
}

} // namespace

Bounds trueBounds(const Tile& tile, const Uncertainty& uncertainty)
{
  double length = uncertainty.length;
  if (!uncertainty.field.empty()) {
    constexpr double rounding_up = 1.0 + 1e-6; // of a float
    const auto greatest = tile.greatest.find(uncertainty.field);
    length = greatest == tile.greatest.end() ? 0.0 : std::max(0.0, greatest->second * uncertainty.sigmas * rounding_up);
  }
  return length == 0.0 ? *tile.bounds : moved(*tile.bounds, Eigen::Isometry3d::Identity(), length);
}

void requireUncertainty(const Site& site, const Uncertainty& uncertainty)
{
  withUncertainty(PointsView{}, site.fields, site.folder.string(), uncertainty);
  if (uncertainty.field.empty()) return;
  for (const Tile& tile : site.tiles) {
    if (!tile.bounds || tile.greatest.count(uncertainty.field) != 0) continue;
    throw files::FileError(site.folder / site_file_name,
                           "does not say how large '" + uncertainty.field + "' is in " + tile.file,
                           "make the site again, of clouds that have it as floating-point numbers; or give a length");
  }
}

std::vector<std::uint32_t> tilesWithin(const Site& site, const Placed& b, double distance,
                                       const Uncertainty& uncertainty)
{
  const std::vector<Bounds> parts = placedParts(CloudBoxes(b.hierarchy().view()), b.pose);
  std::vector<std::uint32_t> tiles;
  for (std::uint32_t i = 0; i < site.tiles.size(); ++i) {
    if (!site.tiles[i].bounds) continue;
    const Bounds tile = trueBounds(site.tiles[i], uncertainty);
    const auto is_near = [&](const Bounds& part) { return leastDistance(tile, part) <= distance; };
    if (std::any_of(parts.begin(), parts.end(), is_near)) tiles.push_back(i);
  }
  return tiles;
}

std::vector<std::uint32_t> tilesWithPoints(const Site& site, const Placed& b)
{
  std::vector<std::uint32_t> tiles;
  for (std::uint32_t i = 0; i < site.tiles.size() && !b.hierarchy().empty(); ++i)
    if (site.tiles[i].bounds) tiles.push_back(i);
  return tiles;
}

std::vector<std::pair<double, std::uint32_t>> tilesByDistance(const Site& site, const Placed& b)
{
  const CloudBoxes boxes(b.hierarchy().view());
  const std::vector<Bounds> parts = placedParts(boxes, b.pose);
  std::vector<std::pair<double, std::uint32_t>> tiles;
  for (const std::uint32_t i : tilesWithPoints(site, b)) {
    double least = std::numeric_limits<double>::infinity();
    for (const Bounds& part : parts) least = std::min(least, leastDistance(*site.tiles[i].bounds, part));
    // Where boxes overlap, a point may be inside a ball of b.
    tiles.emplace_back(least > 0.0 ? least : -boxes.largestRadius(), i);
  }
  std::sort(tiles.begin(), tiles.end());
  return tiles;
}

std::vector<std::uint32_t> tilesAlong(const Site& site, const SphereHierarchy& model,
                                      const std::vector<Eigen::Isometry3d>& poses, const PathReach& reach,
                                      const Uncertainty& uncertainty)
{
  const CloudBoxes boxes(model.view());
  const PathBoxes path(boxes, poses, reach);
  std::vector<std::uint32_t> tiles;
  for (std::uint32_t i = 0; i < site.tiles.size(); ++i)
    if (site.tiles[i].bounds && path.mayReach(trueBounds(site.tiles[i], uncertainty))) tiles.push_back(i);
  return tiles;
}

} // namespace pcl_bsh::site

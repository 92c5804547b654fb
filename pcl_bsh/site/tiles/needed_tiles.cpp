// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/ball_about_box.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>

#include <algorithm>

namespace pcl_bsh::site {

std::vector<Bounds> placedParts(const CloudBoxes& boxes, const Eigen::Isometry3d& pose)
{
  std::vector<Bounds> parts;
  for (const Bounds& part : boxes.parts()) parts.push_back(moved(part, pose, 0.0));
  return parts;
}

double straying(const Tile& tile, const Uncertainty& uncertainty)
{
  double length = uncertainty.length;
  if (!uncertainty.field.empty()) {
    constexpr double rounding_up = 1.0 + 1e-6; // of a float
    const auto greatest = tile.greatest.find(uncertainty.field);
    length = greatest == tile.greatest.end() ? 0.0 : std::max(0.0, greatest->second * uncertainty.sigmas * rounding_up);
  }
  // A point of the tile turns no farther than a ball that holds all of them.
  const BoxBall ball = ballAboutBox(tile.bounds->low, tile.bounds->high);
  return length + (uncertainty.pose.length + uncertainty.pose.turned(ball.center, ball.radius)) * (1.0 + 1e-6);
}

Bounds trueBounds(const Tile& tile, const Uncertainty& uncertainty)
{
  const double length = straying(tile, uncertainty);
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

std::vector<std::uint32_t> tilesAlong(const Site& site, const CloudBoxes& model,
                                      const std::vector<Eigen::Isometry3d>& poses, const PathReach& reach,
                                      const Uncertainty& uncertainty)
{
  const PathBoxes path(model, poses, reach);
  std::vector<std::uint32_t> tiles;
  for (std::uint32_t i = 0; i < site.tiles.size(); ++i)
    if (site.tiles[i].bounds && path.mayReach(trueBounds(site.tiles[i], uncertainty))) tiles.push_back(i);
  return tiles;
}

} // namespace pcl_bsh::site

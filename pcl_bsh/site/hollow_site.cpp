// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/warnings/hollow.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/answers/question_part.h>

#include <algorithm>
#include <vector>

namespace pcl_bsh::site {
namespace {

constexpr std::size_t most_tiles = 4;
constexpr std::size_t most_poses = 16; // at which tiles are chosen

bool meets(const Tile& tile, const Eigen::AlignedBox3d& box)
{
  return tile.bounds && box.intersects(Eigen::AlignedBox3d(Eigen::Vector3d(tile.bounds->low.data()),
                                                           Eigen::Vector3d(tile.bounds->high.data())));
}

std::optional<Point3> placeWithin(Shape& surface, const Site& site,
                                  const std::vector<Eigen::Isometry3d>& T_site_surface)
{
  const Eigen::AlignedBox3d box = surface.facts(false).box;
  if (box.isEmpty() || !surface.isClosed()) return std::nullopt;
  std::vector<Eigen::Isometry3d> poses;
  for (const Eigen::Isometry3d& pose : T_site_surface) poses.push_back(pose.inverse());
  const std::size_t step = std::max<std::size_t>(1, T_site_surface.size() / most_poses);
  std::size_t left = most_tiles;
  for (const Tile& tile : site.tiles) {
    bool is_near = false;
    for (std::size_t k = 0; k < T_site_surface.size() && !is_near; k += step)
      is_near = meets(tile, boxAlong(box, {T_site_surface[k]}));
    if (!is_near) continue;
    const pcl::PCLPointCloud2 points = readTile(site, tile);
    if (const auto place = pcl_bsh::placeWithin(surface, SphereHierarchy(viewOf(points)), poses)) return place;
    if (--left == 0) break;
  }
  return std::nullopt;
}

} // namespace

std::optional<Warning> warningOfHollow(const QuestionPart& part, const std::string& name, std::optional<double> nearest)
{
  if (!part.shape || !part.shape->isSurface() || part.question.solid) return std::nullopt;
  Shape& obstacle = *part.shape;
  if (nearest && *nearest <= nearTo(obstacle)) return std::nullopt;
  const std::optional<Point3> place = placeWithin(obstacle, part.site, part.question.poses());
  if (!place) return std::nullopt;
  if (!nearest) {
    QuestionPart exact = part;
    exact.question.accuracy = {};
    exact.question.progress = nullptr;
    SiteAnswer answer;
    findClosest(exact, answer);
    nearest = answer.closest.distance;
  }
  if (*nearest <= nearTo(obstacle)) return std::nullopt;
  return pcl_bsh::warningOfHollow(obstacle.name(), "solid", name, *place);
}

} // namespace pcl_bsh::site

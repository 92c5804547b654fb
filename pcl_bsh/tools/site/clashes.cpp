// SPDX-License-Identifier: BSD-3-Clause
#ifdef PCL_BSH_SITE_QUERIES
#include "clashes.h"

#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/search/cloud_view.h>

#include <utility>

namespace pcl_bsh::cli {
namespace {

io::ClashQuestion questionOf(const SiteOptions& options)
{
  return {options.question, options.site.string(), options.obstacle.string()};
}

std::optional<Extent> extentOf(const std::optional<site::Bounds>& bounds)
{
  return bounds ? std::optional(Extent{bounds->low, bounds->high}) : std::nullopt;
}

} // namespace

SiteClashList::SiteClashList(const site::Site& site, const SiteOptions& options) : site_(site), options_(options)
{
  if (options.clashes.empty()) return;
  for (const std::filesystem::path& list : options.clashes) {
    io::requireClashFormat(list);
    files::requireWritable(list);
  }
  Spacing spacing;
  spacing.median = site::spacingOf(site);
  distance_ = options.cluster_distance > 0 ? options.cluster_distance
                                           : io::clusterDistanceFor(*options.question.clearance, spacing);
  finder_.emplace(site, distance_);
  if (!options.previous) return;
  earlier_ = io::readClashes(*options.previous);
  warnings_ = io::requireComparable(*options.previous, earlier_, questionOf(options));
}

void SiteClashList::finish(const SphereHierarchy& obstacle, const io::Obstacle* surface, const site::SiteAnswer& found,
                           Json& report)
{
  const std::vector<Eigen::Isometry3d> poses = options_.question.poses();
  write(
      finder_->finish(), obstacle.view(), surface, found, nullptr,
      [&](FormerPlaces& former, const TrajectoryRequest& motion) { former.visit(obstacle, poses, motion); }, report);
}

void SiteClashList::finish(const site::Site& obstacle, const site::SiteAnswer& found, Json& report)
{
  const std::vector<Eigen::Isometry3d> poses = options_.question.poses();
  site::SiteClashes clashes = finder_->finish();
  const std::vector<site::MetPoint> met = clashes.met;
  std::vector<Point3> places;
  for (const site::MetPoint& point : met) places.push_back(point.place);
  write(
      std::move(clashes), viewOf(places.empty() ? nullptr : places.front().data(), places.size()), nullptr, found,
      [&](std::uint32_t i) {
        return io::SourcePoint{obstacle.sources.at(met[i].point.source).file, met[i].point.record};
      },
      [&](FormerPlaces& former, const TrajectoryRequest& motion) {
        for (const site::Tile& tile : obstacle.tiles) {
          if (!tile.bounds || !former.mayVisit({tile.bounds->low, tile.bounds->high}, poses, motion)) continue;
          const pcl::PCLPointCloud2 cloud = site::readTile(obstacle, tile);
          former.visit(SphereHierarchy(viewOf(cloud)), poses, motion);
        }
      },
      report);
}

void SiteClashList::write(site::SiteClashes clashes, const PointsView& model, const io::Obstacle* surface,
                          const site::SiteAnswer& found, std::function<io::SourcePoint(std::uint32_t)> model_source_of,
                          const Visit& visit, Json& report)
{
  const std::vector<Eigen::Isometry3d> poses = options_.question.poses();
  const PointsView places =
      viewOf(clashes.places.empty() ? nullptr : clashes.places.front().data(), clashes.places.size());
  io::ClashReport list{.question = questionOf(options_),
                       .cluster_distance = distance_,
                       .clashes = std::move(clashes.clashes),
                       .scan = places,
                       .model = model,
                       .poses = poses,
                       .found = found.collisions,
                       .survey = {poses, extentOf(site_.bounds)},
                       .unit = options_.unit,
                       .coordinate_system = site::coordinateSystemOf(site_),
                       .surface = surface,
                       .unseen = options_.question.seen ? &found.unseen : nullptr,
                       .source_of =
                           [&](std::uint32_t i) {
                             const site::SitePoint& point = clashes.points[i];
                             return io::SourcePoint{site_.sources.at(point.source).file, point.record};
                           },
                       .model_source_of = std::move(model_source_of)};
  warnings_.clear();
  io::listUnseen(list);
  report["clashes"] = list.present() - list.perhaps();
  report["clashes_perhaps"] = list.perhaps();
  if (site::rankHere() != 0) return;
  if (options_.previous) compare(list, visit);
  for (const std::filesystem::path& file : options_.clashes)
    for (std::string& remark : io::writeClashes(file, list)) warnings_.push_back(std::move(remark));
  counts_ = io::clashCounts(list);
}

void SiteClashList::compare(io::ClashReport& list, const Visit& visit)
{
  TrajectoryRequest motion;
  motion.swept = options_.question.sweptTolerance();
  motion.threads = options_.question.threads;
  warnings_ = io::compareWithList(list, *options_.previous, earlier_, [&](FormerPlaces& former) {
    visit(former, motion);
    for (const site::Tile& tile : site_.tiles)
      if (tile.bounds && former.mayScan({tile.bounds->low, tile.bounds->high}))
        former.scan(viewOf(site::readTile(site_, tile)));
  });
}

} // namespace pcl_bsh::cli
#endif

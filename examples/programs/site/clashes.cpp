// SPDX-License-Identifier: BSD-3-Clause
#ifdef PCL_BSH_SITE_QUERIES
#include "clashes.h"

#include <pcl_bsh/files/replace_file.h>

#include <utility>

namespace pcl_bsh::cli {

SiteClashList::SiteClashList(const sites::Site& site, const SiteOptions& options) : site_(site), options_(options)
{
  if (options.clashes.empty()) return;
  for (const std::filesystem::path& list : options.clashes) {
    io::requireClashFormat(list);
    files::requireWritable(list);
  }
  Spacing spacing;
  spacing.median = sites::spacingOf(site);
  distance_ =
      options.cluster_distance > 0 ? options.cluster_distance : io::clusterDistanceFor(options.clearance, spacing);
  finder_.emplace(site, distance_);
  if (!options.previous) return;
  const io::ClashList list = io::readClashes(*options.previous);
  warnings_ =
      io::requireComparable(*options.previous, list,
                            {options.site.string(), options.obstacle.string(), options.clearance, options.swept, {}});
  earlier_ = list.clashes;
}

void SiteClashList::addTo(sites::SiteRequest& request)
{
  if (!isWanted()) return;
  request.clashes = &*finder_;
  request.pose_summaries = !options_.swept;
}

std::size_t SiteClashList::finish(const SphereHierarchy& obstacle, const io::Obstacle* surface,
                                  const std::vector<Eigen::Isometry3d>& poses, const sites::SitePassage& found)
{
  return write(finder_->finish(), obstacle.view(), surface, poses, found, nullptr);
}

std::size_t SiteClashList::finish(const sites::Site& obstacle, const std::vector<Eigen::Isometry3d>& poses,
                                  const sites::SitePassage& found)
{
  sites::SiteClashes clashes = finder_->finish();
  const std::vector<sites::MetPoint> met = clashes.met;
  std::vector<Point3> places;
  for (const sites::MetPoint& point : met) places.push_back(point.place);
  return write(std::move(clashes), viewOf(places.empty() ? nullptr : places.front().data(), places.size()), nullptr,
               poses, found, [&](std::uint32_t i) {
                 return io::SourcePoint{obstacle.sources.at(met[i].point.source).file, met[i].point.record};
               });
}

std::size_t SiteClashList::write(sites::SiteClashes clashes, const PointsView& model, const io::Obstacle* surface,
                                 const std::vector<Eigen::Isometry3d>& poses, const sites::SitePassage& found,
                                 std::function<io::SourcePoint(std::uint32_t)> model_source_of)
{
  const PointsView places =
      viewOf(clashes.places.empty() ? nullptr : clashes.places.front().data(), clashes.places.size());
  TrajectoryResult of_places;
  of_places.colliding = found.colliding;
  of_places.poses = found.poses;
  of_places.distance = std::move(clashes.distance);
  of_places.closest_pose = std::move(clashes.closest_pose);
  io::ClashReport list{options_.site.string(),
                       options_.obstacle.string(),
                       options_.clearance,
                       distance_,
                       {},
                       std::move(clashes.clashes),
                       places,
                       model,
                       poses,
                       of_places,
                       options_.swept,
                       surface,
                       [&](std::uint32_t i) {
                         const sites::SitePoint& point = clashes.points[i];
                         return io::SourcePoint{site_.sources.at(point.source).file, point.record};
                       },
                       std::move(model_source_of)};
  if (options_.previous) {
    list.previous = options_.previous->string();
    compareWithEarlier(list.clashes, earlier_, distance_);
  }
  if (sites::rankHere() == 0)
    for (const std::filesystem::path& file : options_.clashes) io::writeClashes(file, list);
  return list.clashes.size() - list.count(ClashStatus::resolved);
}

} // namespace pcl_bsh::cli
#endif

// SPDX-License-Identifier: BSD-3-Clause
#ifdef PCL_BSH_SITE_QUERIES
#include "clashes.h"

#include <pcl_bsh/search/cloud_view.h>

#include <utility>

namespace pcl_bsh::cli {
namespace {

std::optional<Extent> extentOf(const std::optional<site::Bounds>& bounds)
{
  return bounds ? std::optional(Extent{bounds->low, bounds->high}) : std::nullopt;
}

PointsView viewOfPlaces(const std::vector<Point3>& places)
{
  return viewOf(places.empty() ? nullptr : places.front().data(), places.size());
}

} // namespace

SiteClashList::SiteClashList(const site::Site& site, const SiteOptions& options, ObstacleFiles* obstacles)
: site_(site),
  options_(options)
{
  if (options.clashes.empty()) return;
  options.requireWritable();
  std::vector<io::ComparedObstacle> other; // the obstacle, if it is a site
  if (!obstacles) other.push_back({"", options.obstacle.string(), {}, {}, options.question});
  std::vector<io::ComparedObstacle>& all = obstacles ? obstacles->all : other;
  listing_.input = options.site.string();
  listing_.unit = options.unit;
  listing_.coordinate_system = site::coordinateSystemOf(site);
  listing_.previous = options.previous;
  if (options.cluster_distance > 0) listing_.cluster_distance = options.cluster_distance;
  listing_.readEarlier(all, warnings_);
  if (listing_.kept) listing_.keep(all, options.ignoredPairs(), extentOf(site.bounds), warnings_);
  Spacing spacing;
  spacing.median = site::spacingOf(site);
  distance_ = listing_.cluster_distance.value_or(io::clusterDistanceFor(io::greatestClearance(all), spacing));
  for (std::size_t i = 0; i < all.size(); ++i) finders_.push_back(std::make_unique<site::ClashFinder>(site, distance_));
}

std::vector<site::ClashFinder*> SiteClashList::finders() const
{
  std::vector<site::ClashFinder*> all;
  for (const auto& finder : finders_) all.push_back(finder.get());
  return all;
}

SiteClashList::Listed SiteClashList::listed(ObstacleFiles& obstacles, std::size_t i,
                                            const TrajectoryResult& found) const
{
  io::ComparedObstacle& one = obstacles.all[i];
  const SphereHierarchy& model = obstacles.shapes[i].shape.hierarchy();
  const auto visit = [&model, poses = one.question.poses()](FormerPlaces& former, const TrajectoryRequest& motion) {
    former.visit(model, poses, motion);
  };
  return {.question = {one.question, options_.site.string(), one.file},
          .clashes = finders_[i]->finish(),
          .model = model.view(),
          .found = found,
          .visit = visit,
          .surface = one.loaded.isSurface() ? &one.loaded : nullptr,
          .name = one.name};
}

void SiteClashList::finish(ObstacleFiles& obstacles, const site::SiteAnswer& found, Json& report)
{
  std::deque<Listed> all;
  all.push_back(listed(obstacles, 0, found.collisions));
  if (options_.question.seen) all.front().unseen = &found.unseen;
  write(all, {}, report);
}

void SiteClashList::finish(ObstacleFiles& obstacles, const site::SiteObstaclesAnswer& found,
                           const std::vector<io::BetweenObstacles>& between, Json& report)
{
  std::deque<Listed> all;
  for (std::size_t i = 0; i < found.each.size(); ++i) {
    const site::SiteObstacleAnswer& one = found.each[i];
    if (!one.asked) obstacles.shapes[i].shape.hierarchy(obstacles.all[i].question.uncertaintyOfObstacle(), 1);
    all.push_back(listed(obstacles, i, one.found));
    Listed& listed = all.back();
    if (obstacles.all[i].kept) listed.kept = &obstacles.all[i];
    listed.answer = one;
    if (options_.question.seen) listed.unseen = &one.not_seen;
    if (!one.pair) continue;
    listed.answer->closest.pair->a = static_cast<std::uint32_t>(listed.clashes.points.size());
    listed.clashes.points.push_back(one.pair->a);
    listed.clashes.places.push_back(one.place);
  }
  write(all, between, report);
}

void SiteClashList::finish(const site::Site& obstacle, const site::SiteAnswer& found, Json& report)
{
  const std::vector<Eigen::Isometry3d> poses = options_.question.poses();
  site::SiteClashes clashes = finders_.front()->finish();
  const std::vector<site::MetPoint> met = clashes.met;
  std::vector<Point3> places;
  for (const site::MetPoint& point : met) places.push_back(point.place);
  std::deque<Listed> all;
  all.push_back({.question = {options_.question, options_.site.string(), options_.obstacle.string()},
                 .clashes = std::move(clashes),
                 .model = viewOfPlaces(places),
                 .found = found.collisions,
                 .visit =
                     [&](FormerPlaces& former, const TrajectoryRequest& motion) {
                       for (const site::Tile& tile : obstacle.tiles) {
                         if (!tile.bounds || !former.mayVisit({tile.bounds->low, tile.bounds->high}, poses, motion))
                           continue;
                         const pcl::PCLPointCloud2 cloud = site::readTile(obstacle, tile);
                         former.visit(SphereHierarchy(viewOf(cloud)), poses, motion);
                       }
                     },
                 .unseen = options_.question.seen ? &found.unseen : nullptr,
                 .model_source_of =
                     [&](std::uint32_t i) {
                       return io::SourcePoint{obstacle.sources.at(met[i].point.source).file, met[i].point.record};
                     }});
  write(all, {}, report);
}

void SiteClashList::write(std::deque<Listed>& all, const std::vector<io::BetweenObstacles>& between, Json& report)
{
  io::ClashLists lists;
  for (Listed& one : all) {
    if (one.kept) {
      lists.obstacles.push_back(listing_.keptReport(*one.kept, distance_, extentOf(site_.bounds)));
      continue;
    }
    one.question.progress = nullptr;
    one.poses = one.question.poses();
    one.scan = viewOfPlaces(one.clashes.places);
    lists.obstacles.push_back({.question = one.question,
                               .cluster_distance = distance_,
                               .clashes = std::move(one.clashes.clashes),
                               .scan = one.scan,
                               .model = one.model,
                               .poses = one.poses,
                               .found = one.found,
                               .survey = {one.poses, extentOf(site_.bounds)},
                               .unit = listing_.unit,
                               .coordinate_system = listing_.coordinate_system,
                               .surface = one.surface,
                               .unseen = one.unseen,
                               .source_of =
                                   [this, &one](std::uint32_t i) {
                                     const site::SitePoint& point = one.clashes.points[i];
                                     return io::SourcePoint{site_.sources.at(point.source).file, point.record};
                                   },
                               .model_source_of = one.model_source_of,
                               .name = one.name,
                               .answer = one.answer ? &*one.answer : nullptr});
    io::listUnseen(lists.obstacles.back());
  }
  warnings_.clear();
  report["clashes"] = lists.present() - lists.perhaps();
  report["clashes_perhaps"] = lists.perhaps();
  if (site::rankHere() != 0) return;
  compare(lists, all);
  listing_.between = between;
  listing_.complete(lists, warnings_);
  options_.write(lists, warnings_);
  counts_ = io::clashCounts(lists);
}

void SiteClashList::compare(io::ClashLists& lists, const std::deque<Listed>& all)
{
  TrajectoryRequest motion;
  motion.swept = options_.question.sweptTolerance();
  motion.threads = options_.question.threads;
  for (std::size_t i = 0; i < all.size(); ++i) {
    io::ClashReport& list = lists.obstacles[i];
    if (list.kept) continue;
    const auto look = [&](FormerPlaces& former) {
      all[i].visit(former, motion);
      for (const site::Tile& tile : site_.tiles)
        if (tile.bounds && former.mayScan({tile.bounds->low, tile.bounds->high}))
          former.scan(viewOf(site::readTile(site_, tile)));
    };
    const auto compared = [&](const io::ClashList& before) {
      return io::compareWithList(list, *options_.previous, before, look);
    };
    listing_.compare(list, compared, warnings_);
  }
}

} // namespace pcl_bsh::cli
#endif

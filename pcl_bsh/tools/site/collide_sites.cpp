// SPDX-License-Identifier: BSD-3-Clause
#ifdef PCL_BSH_SITE_QUERIES
#include "collide_sites.h"
#include "warnings.h"

#include <pcl_bsh/tools/cli/program.h>

#include <pcl_bsh/io/files/free_space.h>

#include <pcl_bsh/tools/cli/program.h>

#include <pcl_bsh/io/files/free_space.h>

namespace pcl_bsh::cli {

namespace {

/// The tiles of both sites.
template <typename Found>
void putBoth(Json& report, const Found& found, MeasuredRun& run)
{
  put(report, found.tiles, run);
  putTiles(report, "tiles_of_obstacle", found.tiles_b);
}

/// Flags of both sides: each in tiles of its own.
void askFlags(const site::Site& site, const site::PlacedSite& obstacle, const SiteOptions& options, SiteOutput& out,
              Json& report, MeasuredRun& run, Step* step)
{
  std::optional<site::ResultSite> obstacle_out;
  if (!options.obstacle_out.empty()) {
    const std::vector fields = {collisionField()};
    if (!options.out.empty()) { // which has checked alone that there is room for it
      files::requireSpace({{options.out, site::spaceWanted(site, options.out, fields)},
                           {options.obstacle_out, site::spaceWanted(obstacle.site, options.obstacle_out, fields)}});
    }
    obstacle_out.emplace(obstacle.site, options.obstacle_out, fields);
    const auto lines = droppedBy(*obstacle_out, "--obstacle-out", options.obstacle_out, obstacle.site, fields);
    if (step != nullptr) warn(site_program, lines);
  }
  site::SiteRequest request = requestOf(options, step);
  request.answers = out.answers();
  const site::SitePairFlags found = site::collisionFlags(site, obstacle, request, out.flags());
  report["colliding"] = found.colliding;
  report["undecided"] = found.undecided;
  putBoth(report, found, run);
  if (!obstacle_out) return;
  request.answers = nullptr; // those are of the tiles of the site
  const site::SitePairFlags of_obstacle = site::collisionFlagsOfB(
      site, obstacle, request, [&](const site::Tile& tile, const pcl::PCLPointCloud2& cloud, const FlagsResult& flags) {
        obstacle_out->write(tile, cloud, {flags.a.data()});
      });
  obstacle_out->finish();
  report["colliding_of_obstacle"] = of_obstacle.colliding;
  report["undecided_of_obstacle"] = of_obstacle.undecided;
}

} // namespace

Json askOfSite(const site::Site& site, const Poses& poses, const SiteOptions& options, SiteOutput& out,
               SiteClashList& clashes, MeasuredRun& run, Step* step, std::vector<std::string>& told)
{
  const site::Site other = site::readSite(options.obstacle);
  const site::PlacedSite obstacle{other, options.pose, options.obstacle_uncertainty};
  site::SiteRequest request = requestOf(options, step);
  request.answers = out.answers();
  told = warningsOf(site, namedSite(other), poses, options);
  Json report = beginReport(site, options);
  report["points_of_obstacle"] = other.points;
  switch (options.question) {
  case SiteQuestion::any: {
    const site::SitePairAny found = site::anyCollision(site, obstacle, request);
    report["collides"] = found.verdict == Verdict::colliding;
    report["undecided"] = found.verdict == Verdict::undecided;
    putBoth(report, found, run);
    break;
  }
  case SiteQuestion::flags:
    askFlags(site, obstacle, options, out, report, run, step);
    break;
  case SiteQuestion::closest: {
    const site::SitePairClosest found = site::closestPair(site, obstacle, request);
    report["distance"] = orNull(found.distance);
    report["distance_interval"] = {orNull(found.interval.lower), orNull(found.interval.upper)};
    if (found.point) {
      report["point"] = named(site, *found.point);
      report["point_of_obstacle"] = named(other, *found.point_b);
    }
    putBoth(report, found, run);
    break;
  }
  case SiteQuestion::distances: {
    const site::SitePairDistances found =
        site::pointDistances(site, obstacle, options.max_distance, request, out.distancesOfSites());
    report["max_distance"] = orNull(options.max_distance);
    report["measured"] = found.measured;
    report["greatest"] = orNull(found.greatest);
    putBoth(report, found, run);
    break;
  }
  case SiteQuestion::path: {
    clashes.addTo(request);
    const site::SitePairPassage found =
        site::collideAlong(site, other, options.obstacle_uncertainty, poses, request, out.passage());
    putPassage(report, found, poses.size(), options);
    if (clashes.isWanted()) clashes.finish(other, poses, found, report);
    putBoth(report, found, run);
    break;
  }
  }
  return report;
}

} // namespace pcl_bsh::cli
#endif

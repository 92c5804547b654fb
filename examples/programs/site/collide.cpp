// SPDX-License-Identifier: BSD-3-Clause
#include "collide.h"

#include "cli/program.h"

#include <stdexcept>

#ifdef PCL_BSH_SITE_QUERIES
#include <pcl_bsh/files/replace_file.h>
#include <pcl_bsh/filters/cloud_files/cloud_file.h>
#include <pcl_bsh/filters/pose_files/pose_file.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/collide_site.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <iostream>
#endif

namespace pcl_bsh::cli {

#ifdef PCL_BSH_SITE_QUERIES
namespace {

using Json = nlohmann::ordered_json;

/// NaN has no place in JSON.
Json orNull(double number)
{
  return std::isfinite(number) ? Json(number) : Json(nullptr);
}

void put(Json& report, const sites::TilesRead& tiles)
{
  report["tiles"] = {{"all", tiles.tiles}, {"needed", tiles.needed}, {"read", tiles.read}};
}

/// The answer, the same on all ranks.
Json ask(const sites::Site& site, const Placed& obstacle, const SiteOptions& options)
{
  sites::SiteRequest request;
  request.clearance = options.clearance;
  request.threads = options.threads;
  request.memory = options.memory;
  Json report = {{"site", options.site.string()}, {"obstacle", options.obstacle.string()}, {"points", site.points}};
  const bool has_clearance = options.question != SiteQuestion::closest && options.question != SiteQuestion::distances;
  if (has_clearance) report["clearance"] = options.clearance;
  switch (options.question) {
  case SiteQuestion::any: {
    const sites::SiteAny found = sites::anyCollision(site, obstacle, request);
    report["collides"] = found.verdict == Verdict::colliding;
    put(report, found.tiles);
    break;
  }
  case SiteQuestion::flags: {
    const sites::SiteFlags found = sites::collisionFlags(site, obstacle, Side::both, request);
    report["colliding"] = found.colliding;
    report["colliding_of_obstacle"] = found.colliding_b;
    put(report, found.tiles);
    break;
  }
  case SiteQuestion::closest: {
    const sites::SiteClosest found = sites::closestPair(site, obstacle, request);
    report["distance"] = orNull(found.distance);
    if (found.point) {
      report["point"] = {{"source", site.sources.at(found.point->source).file}, {"record", found.point->record}};
      report["point_of_obstacle"] = found.b;
    }
    put(report, found.tiles);
    break;
  }
  case SiteQuestion::distances: {
    const sites::SiteDistances found = sites::pointDistances(site, obstacle, options.max_distance, request);
    report["max_distance"] = orNull(options.max_distance);
    report["measured"] = found.measured;
    report["greatest"] = orNull(found.greatest);
    put(report, found.tiles);
    break;
  }
  case SiteQuestion::path: {
    const auto poses = io::readPoses(options.trajectory);
    request.swept = options.swept;
    const sites::SitePassage found = sites::collideAlong(site, obstacle.hierarchy(), poses, request);
    report["poses"] = poses.size();
    report["colliding"] = found.colliding;
    report["distance"] = orNull(double{found.distance});
    report["first_pose"] = found.first_pose < 0 ? Json(nullptr) : Json(found.first_pose);
    if (options.swept) report["swept"] = *options.swept;
    if (found.first_contact)
      report["first_contact"] = {{"pose", found.first_contact->pose}, {"fraction", found.first_contact->fraction}};
    put(report, found.tiles);
    break;
  }
  }
  return report;
}

int answer(const SiteOptions& options)
{
  const bool tells = sites::rankHere() == 0;
  if (tells) warn(site_program, options.warnings);
  if (tells) files::requireWritable(options.report);
  const sites::Site site = sites::readSite(options.site);
  const pcl::PCLPointCloud2 cloud = io::readCloud(options.obstacle);
  HierarchyOptions building;
  building.threads = options.threads;
  const SphereHierarchy hierarchy(viewOf(cloud), building);
  const Json report = ask(site, {hierarchy, options.pose}, options);
  if (!tells) return 0;
  const std::string text = report.dump(2, ' ', false, Json::error_handler_t::replace);
  files::replaceFile(options.report, [&](std::ostream& out) { out << text << '\n'; });
  return 0;
}

} // namespace

int collideSite(const SiteOptions& options)
{
  try {
    return answer(options);
  }
  catch (const std::exception& error) {
    if (sites::ranks() == 1) throw;
    std::cerr << site_program << ": rank " << sites::rankHere() << ": " << error.what() << '\n';
    sites::endAllRanks();
  }
}

#else
int collideSite(const SiteOptions&)
{
  throw std::logic_error("collide: this build has no DIY or MPI: install libopenmpi-dev and build again");
}
#endif

} // namespace pcl_bsh::cli

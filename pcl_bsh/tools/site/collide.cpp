// SPDX-License-Identifier: BSD-3-Clause
#include "collide.h"

#include <pcl_bsh/tools/cli/json_output.h>
#include <pcl_bsh/tools/cli/obstacle.h>
#include <pcl_bsh/tools/cli/program.h>

#include <stdexcept>

#ifdef PCL_BSH_SITE_QUERIES
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/geometry/counted.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/site/collide_site.h>

#include "clashes.h"
#include "collide_sites.h"
#include "output.h"
#include "report.h"
#include "warnings.h"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <optional>
#include <string>
#include <vector>
#endif

namespace pcl_bsh::cli {

#ifdef PCL_BSH_SITE_QUERIES
namespace {

/// The answer, the same on all ranks. @param told what users should know of the question
Json askOfFile(const site::Site& site, const ObstacleFile& file, const Poses& poses, const SiteOptions& options,
               SiteOutput& out, SiteClashList& clashes, MeasuredRun& run, Step* step, std::vector<std::string>& told)
{
  HierarchyOptions building;
  building.threads = options.threads;
  const SphereHierarchy hierarchy(withUncertainty(file.obstacle.view(), file.obstacle.points().fields,
                                                  options.obstacle.string(), options.obstacle_uncertainty),
                                  building);
  const Placed obstacle(hierarchy, options.pose);
  const io::Obstacle* const surface = file.surface();
  site::SiteRequest request = requestOf(options, step);
  request.answers = out.answers();
  if (surface != nullptr) request.surface = surface->tolerance();
  Json report = beginReport(site, options);
  report["surface"] = io::surfaceJson(surface, besideSurface(options.accuracy, options.swept.has_value()));
  switch (options.question) {
  case SiteQuestion::any: {
    const site::SiteAny found = site::anyCollision(site, obstacle, request);
    report["collides"] = found.verdict == Verdict::colliding;
    report["undecided"] = found.verdict == Verdict::undecided;
    put(report, found.tiles, run);
    break;
  }
  case SiteQuestion::flags: {
    // Which triangles collide is known where each has balls of its own.
    const bool of_both = surface == nullptr || surface->cover()->triangles_apart;
    const site::SiteFlags found =
        site::collisionFlags(site, obstacle, of_both ? Side::both : Side::a, request, out.flags());
    report["colliding"] = found.colliding;
    report["undecided"] = found.undecided;
    report["colliding_of_obstacle"] = nullptr;
    report["undecided_of_obstacle"] = nullptr;
    if (of_both) {
      const std::vector<std::uint8_t> flags = file.flagsOfParts(found.b);
      file.write(flags, options);
      report["colliding_of_obstacle"] = std::count(flags.begin(), flags.end(), flagOf(Verdict::colliding));
      report["undecided_of_obstacle"] = std::count(flags.begin(), flags.end(), flagOf(Verdict::undecided));
    }
    put(report, found.tiles, run);
    break;
  }
  case SiteQuestion::closest: {
    const site::SiteClosest found = site::closestPair(site, obstacle, request);
    report["distance"] = orNull(found.distance);
    report["distance_interval"] = {orNull(found.interval.lower), orNull(found.interval.upper)};
    if (found.point) {
      report["point"] = named(site, *found.point);
      report[std::string(file.obstacle.partName()) + "_of_obstacle"] = file.obstacle.partOf(found.b);
    }
    put(report, found.tiles, run);
    break;
  }
  case SiteQuestion::distances: {
    const site::SiteDistances found =
        site::pointDistances(site, obstacle, options.max_distance, request, out.distances());
    report["max_distance"] = orNull(options.max_distance);
    report["measured"] = found.measured;
    report["greatest"] = orNull(found.greatest);
    put(report, found.tiles, run);
    break;
  }
  case SiteQuestion::path: {
    clashes.addTo(request);
    const site::SitePassage found = site::collideAlong(site, obstacle.hierarchy(), poses, request, out.passage());
    putPassage(report, found, poses.size(), options);
    if (clashes.isWanted()) clashes.finish(obstacle.hierarchy(), surface, poses, found, report);
    put(report, found.tiles, run);
    break;
  }
  }
  const SurfaceCover* const cover = surface != nullptr ? surface->cover().get() : nullptr;
  told = warningsOf(site, measuredCloud(options.obstacle.string(), hierarchy, cover), poses, options);
  return report;
}

/// @param keeps set where what is found stays in --out although the run fails
int answer(const SiteOptions& options, bool& keeps)
{
  const auto begin = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  const bool tells = site::rankHere() == 0;
  options.files.requireApart();
  std::vector<std::string> warnings;
  const auto warn_of = [&](const std::vector<std::string>& lines) {
    if (tells) warn(site_program, lines);
    warnings.insert(warnings.end(), lines.begin(), lines.end());
  };
  warn_of(options.warnings);
  const bool reports = !options.report.empty();
  if (tells && reports) files::requireWritable(options.report);
  const site::Site site = site::readSite(options.site);
  SiteClashList clashes(site, options);
  warn_of(clashes.warnings());
  std::optional<ObstacleFile> file;
  if (!options.obstacleIsSite()) {
    file.emplace(options);
    warn_of(warningsOf(file->obstacle, options.obstacle));
  }
  std::vector<std::string> of_poses, of_question;
  const Poses poses = options.trajectory.empty() ? Poses{options.pose} : io::readPoses(options.trajectory, &of_poses);
  warn_of(of_poses);
  SiteOutput output(site, file ? &*file : nullptr, poses, clashes.clusterDistance(), options);
  warn_of(output.warnings());
  keeps = output.answers() != nullptr;
  MeasuredRun run;
  Json report;
  std::optional<Step> shown;
  if (tells) shown.emplace("Asking about tiles");
  Step* const step = tells ? &*shown : nullptr;
  if (file)
    report = askOfFile(site, *file, poses, options, output, clashes, run, step, of_question);
  else
    report = askOfSite(site, poses, options, output, clashes, run, step, of_question);
  if (tells) shown->done(counted(report["tiles"]["read"].get<std::uint64_t>(), "tile") + " read");
  warn_of(of_question);
  if (clashes.isWanted()) warn_of(clashes.warnings());
  run.seconds = seconds();
  output.finish();
  run.copying = seconds() - run.seconds;
  if (!options.out.empty()) report["out"] = options.out.string();
  report["warnings"] = warnings;
  if (!tells) return 0;
  std::ostream& summary = options.files.summary();
  if (clashes.isWanted()) summary << clashes.counts() << '\n';
  if (file && file->surface() != nullptr) summary << report["surface"]["promise"].get<std::string>() << '\n';
  if (!options.obstacle_out.empty())
    summary << "wrote which points of the obstacle collide to " << options.obstacle_out.string() << '\n';
  if (!options.out.empty()) summary << "wrote what was found of each point to " << options.out.string() << '\n';
  if (!reports) return 0;
  run.ranks = site::ranks();
  if (!options.plan.empty()) putPlan(report, options.plan, run);
  writeJson(options.report, report);
  return 0;
}

} // namespace

int collideSite(const SiteOptions& options)
{
  bool keeps = false;
  try {
    return answer(options, keeps);
  }
  catch (const Cancelled&) {
    throw;
  }
  catch (const std::exception& error) {
    if (site::ranks() == 1) {
      if (!keeps || site::answersIn(options.out) == 0) throw;
      throw std::runtime_error(std::string(error.what()) + "; " + what_stays);
    }
    std::cerr << site_program << ": rank " << site::rankHere() << ": " << error.what() << '\n';
    site::endAllRanks();
  }
}

#else
int collideSite(const SiteOptions&)
{
  throw std::logic_error("collide: this build has no DIY or MPI: install libopenmpi-dev and build again");
}
#endif

} // namespace pcl_bsh::cli

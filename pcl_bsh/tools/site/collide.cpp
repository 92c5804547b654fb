// SPDX-License-Identifier: BSD-3-Clause
#include "collide.h"

#include <pcl_bsh/tools/cli/json_output.h>
#include <pcl_bsh/tools/cli/obstacle.h>
#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/cli/question_options.h>

#include <pcl_bsh/question/ask.h>

#include <stdexcept>

#ifdef PCL_BSH_SITE_QUERIES
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/files/free_space.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/site/collide_site.h>
#include <pcl_bsh/site/hollow_site.h>
#include <pcl_bsh/site/see_site.h>

#include "clashes.h"
#include "output.h"
#include "report.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <iostream>
#include <limits>
#include <optional>
#include <string>
#include <vector>
#endif

namespace pcl_bsh::cli {

#ifdef PCL_BSH_SITE_QUERIES
namespace {

/// A question about a site, and the answer, which is the same on all ranks.
struct Asking {
  const site::Site& site;
  const std::vector<Eigen::Isometry3d>& poses;
  const SiteOptions& options;
  SiteOutput& out;
  SiteClashList& clashes;
  std::function<void(const std::vector<std::string>&)> warn;
  site::SiteRequest request;
  Json report;
  site::TilesRead tiles = {};
};

/// The number of points that collide, or are undecided, of the one or of the other.
void putCounts(Json& report, const std::string& of, const Json& colliding, const Json& undecided)
{
  report["colliding" + of] = colliding;
  report["undecided" + of] = undecided;
}

/// A cloud or a mesh in memory.
class FileObstacle {
public:
  FileObstacle(const ObstacleFile& file, Asking& asking)
  : file_(file),
    surface_(file.surface()),
    shape_(file.obstacle.shape(asking.options.obstacle.string())),
    hierarchy_(cli::named([&]() -> const SphereHierarchy& {
      const Question& question = asking.options.question;
      return shape_.hierarchy(question.uncertaintyOfObstacle(), question.threads);
    })),
    placed_(hierarchy_, asking.options.question.pose)
  {
    asking.report["surface"] = io::surfaceJson(surface_, asking.options.question.solid);
    if (!asking.options.question.solid) return;
    solid_ = Shape(file.obstacle.shape(asking.options.obstacle.string()).name(),
                   std::shared_ptr<const SphereHierarchy>(std::shared_ptr<const void>(), &hierarchy_));
    cli::named([&] {
      if (!solid_.isSurface())
        throw InvalidOption("solid", solid_.name() + " has no faces", "give a mesh that closes, or leave it out");
      solid_.solid(); // refused before a tile is read
    });
    asking.request.solid = &solid_;
  }
  FileObstacle(const FileObstacle&) = delete;

  const Placed& placed() const { return placed_; }

  NamedCloud facts() const { return shape_.facts(true); }

  std::optional<Warning> hollow(const Asking& asking, std::optional<double> nearest) const
  {
    Shape shape = shape_;
    return site::warningOfHollow(asking.site, namedSite(asking.site).name, asking.options.question, nearest, shape);
  }

  site::SiteFlags flags(Asking& asking) const
  {
    const site::SiteFlags found =
        site::collisionFlags(asking.site, placed_, Side::both, asking.request, asking.out.flags());
    putCounts(asking.report, "", found.colliding, found.undecided);
    const std::optional<site::SiteUnseen> unseen = lookAround(asking);
    const std::vector<Verdict>& verdicts = unseen ? unseen->verdicts : found.b;
    file_.write(verdicts, asking.options);
    putCounts(asking.report, "_of_obstacle", countOf(verdicts, Verdict::colliding),
              countOf(verdicts, Verdict::undecided));
    return found;
  }

  void putNearest(Json& report, const site::SiteClosest& found) const
  {
    report[std::string(file_.obstacle.partName()) + "_of_obstacle"] = found.b;
  }

  site::SitePassage along(const Asking& asking) const
  {
    return site::collideAlong(asking.site, hierarchy_, asking.poses, asking.request, asking.out.passage());
  }

  void finish(Asking& asking, const site::SitePassage& found) const
  {
    const std::optional<site::SiteUnseen> unseen = lookAround(asking);
    if (unseen) file_.write(unseen->verdicts, asking.options);
    if (!asking.clashes.isWanted()) return;
    asking.clashes.finish(hierarchy_, surface_, asking.poses, found, unseen ? &unseen->unseen : nullptr, asking.report);
  }

  void putTilesOf(Json& /*report*/, const site::TilesRead& /*tiles*/) const {}

private:
  std::optional<site::SiteUnseen> lookAround(Asking& asking) const
  {
    const Question& question = asking.options.question;
    if (!question.seen) return std::nullopt;
    site::SiteUnseen found = site::unseenAlong(asking.site, {question.origin, question.seen_angle.value_or(0.0)},
                                               hierarchy_, asking.poses, asking.request);
    asking.report["unseen"] = io::unseenJson(found.unseen);
    asking.report["unseen"]["beams"] = found.beams;
    putTiles(asking.report, "tiles_of_beams", found.tiles_of_beams);
    return found;
  }

  const ObstacleFile& file_;
  const io::Obstacle* surface_;
  Shape shape_;
  const SphereHierarchy& hierarchy_;
  Placed placed_;
  Shape solid_;
};

/// Another site.
class SiteObstacle {
public:
  explicit SiteObstacle(Asking& asking)
  : site_(site::readSite(asking.options.obstacle)),
    placed_{site_, asking.options.question.pose, asking.options.question.uncertaintyOfObstacle()}
  {
    asking.report["points_of_obstacle"] = site_.points;
  }

  const site::PlacedSite& placed() const { return placed_; }
  NamedCloud facts() const { return namedSite(site_); }
  std::optional<Warning> hollow(const Asking& /*asking*/, std::optional<double> /*nearest*/) const { return {}; }

  /// Flags of both sides: each in tiles of its own.
  site::SiteFlags flags(Asking& asking) const
  {
    const SiteOptions& options = asking.options;
    std::optional<site::ResultSite> obstacle_out;
    if (!options.obstacle_out.empty()) {
      const std::vector fields = {collisionField()};
      if (!options.out.empty()) { // which has checked alone that there is room for it
        files::requireSpace({{options.out, site::spaceWanted(asking.site, options.out, fields)},
                             {options.obstacle_out, site::spaceWanted(site_, options.obstacle_out, fields)}});
      }
      obstacle_out.emplace(site_, options.obstacle_out, fields);
      asking.warn(droppedBy(*obstacle_out, "--obstacle-out", options.obstacle_out, site_, fields));
    }
    const site::SiteFlags found = site::collisionFlags(asking.site, placed_, asking.request, asking.out.flags());
    putCounts(asking.report, "", found.colliding, found.undecided);
    if (!obstacle_out) return found;
    asking.request.answers = nullptr; // those are of the tiles of the site
    const site::SiteFlags of_obstacle =
        site::collisionFlagsOfB(asking.site, placed_, asking.request,
                                [&](const site::Tile& tile, const pcl::PCLPointCloud2& cloud,
                                    const FlagsResult& flags) { obstacle_out->write(tile, cloud, {flags.a.data()}); });
    obstacle_out->finish();
    putCounts(asking.report, "_of_obstacle", of_obstacle.colliding, of_obstacle.undecided);
    return found;
  }

  void putNearest(Json& report, const site::SiteClosest& found) const
  {
    report["point_of_obstacle"] = cli::named(site_, *found.point_b);
  }

  site::SitePassage along(const Asking& asking) const
  {
    return site::collideAlong(asking.site, site_, placed_.uncertainty, asking.poses, asking.request,
                              asking.out.passage());
  }

  void finish(Asking& asking, const site::SitePassage& found) const
  {
    if (asking.clashes.isWanted()) asking.clashes.finish(site_, asking.poses, found, asking.report);
  }

  void putTilesOf(Json& report, const site::TilesRead& tiles) const { putTiles(report, "tiles_of_obstacle", tiles); }

private:
  site::Site site_;
  site::PlacedSite placed_;
};

/// @return what users should know of the question
template <typename Obstacle>
std::vector<std::string> ask(Asking& asking, const Obstacle& obstacle)
{
  auto& [site, poses, options, out, clashes, warn, request, report, tiles] = asking;
  const Question& question = options.question;
  std::optional<double> nearest; // where the answer tells
  const auto nearest_of = [](bool collides) { return collides ? 0.0 : std::numeric_limits<double>::infinity(); };
  const auto put_tiles = [&](const auto& found) {
    asking.tiles = found.tiles;
    putTiles(report, "tiles", found.tiles);
    obstacle.putTilesOf(report, found.tiles_b);
  };
  switch (options.kind) {
  case SiteQuestion::any: {
    const site::SiteAny found = site::anyCollision(site, obstacle.placed(), request);
    report["collides"] = found.verdict == Verdict::colliding;
    report["undecided"] = found.verdict == Verdict::undecided;
    nearest = nearest_of(found.verdict != Verdict::free);
    put_tiles(found);
    break;
  }
  case SiteQuestion::flags: {
    const site::SiteFlags found = obstacle.flags(asking);
    nearest = nearest_of(found.colliding + found.undecided > 0);
    put_tiles(found);
    break;
  }
  case SiteQuestion::closest: {
    const site::SiteClosest found = site::closestPair(site, obstacle.placed(), request);
    nearest = found.distance;
    report["distance"] = io::orNull(found.distance);
    report["distance_interval"] = {io::orNull(found.interval.lower), io::orNull(found.interval.upper)};
    if (found.point) {
      report["point"] = named(site, *found.point);
      obstacle.putNearest(report, found);
    }
    put_tiles(found);
    break;
  }
  case SiteQuestion::distances: {
    const double most = question.max_distance.value_or(std::numeric_limits<double>::infinity());
    const site::SiteDistances found = site::pointDistances(site, obstacle.placed(), most, request, out.distances());
    report["max_distance"] = io::orNull(most);
    report["measured"] = found.measured;
    report["greatest"] = io::orNull(found.greatest);
    put_tiles(found);
    break;
  }
  case SiteQuestion::path: {
    clashes.addTo(request);
    const site::SitePassage found = obstacle.along(asking);
    putPassage(report, found, question);
    nearest = nearest_of(found.colliding + found.undecided > 0);
    obstacle.finish(asking, found);
    put_tiles(found);
    break;
  }
  }
  std::vector<std::string> told;
  addTexts(warningsOf(question, namedSite(site), obstacle.facts()), told);
  if (const auto hollow = obstacle.hollow(asking, nearest)) addOnce(hollow->text, told);
  return told;
}

/// @param keeps set where what is found stays in --out although the run fails
int answer(SiteOptions options, bool& keeps)
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
  std::vector<std::string> of_poses;
  if (!options.trajectory.empty()) options.question.path = io::readPoses(options.trajectory, &of_poses);
  const std::vector<Eigen::Isometry3d> poses = options.question.poses();
  warn_of(of_poses);
  SiteOutput output(site, file ? &*file : nullptr, clashes.clusterDistance(), options);
  warn_of(output.warnings());
  keeps = output.answers() != nullptr;
  std::optional<Step> shown;
  if (tells) shown.emplace("Asking about tiles");
  Step* const step = tells ? &*shown : nullptr;
  Asking asking{site, poses, options, output, clashes, warn_of, requestOf(options, step), beginReport(site, options)};
  asking.request.answers = output.answers();
  const std::vector<std::string> told =
      file ? ask(asking, FileObstacle(*file, asking)) : ask(asking, SiteObstacle(asking));
  Json& report = asking.report;
  if (tells) shown->done(counted(report["tiles"]["read"].get<std::uint64_t>(), "tile") + " read");
  warn_of(told);
  if (clashes.isWanted()) warn_of(clashes.warnings());
  MeasuredRun run;
  run.tiles = std::move(asking.tiles.costs);
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

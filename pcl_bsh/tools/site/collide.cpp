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
#include <pcl_bsh/site/ask_site.h>

#include "clashes.h"
#include "output.h"
#include "site_report.h"

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

/// Flags of an obstacle that is a site, as a site.
class ObstacleOutput {
public:
  ObstacleOutput(const site::Site& site, const site::Site& obstacle, const SiteOptions& options)
  {
    const std::vector fields = {collisionField()};
    if (!options.out.empty()) { // which has checked alone that there is room for it
      files::requireSpace({{options.out, site::spaceWanted(site, options.out, fields)},
                           {options.obstacle_out, site::spaceWanted(obstacle, options.obstacle_out, fields)}});
    }
    out_.emplace(obstacle, options.obstacle_out, fields);
    warnings = droppedBy(*out_, "--obstacle-out", options.obstacle_out, obstacle, fields);
  }

  site::TileReceiver receiver()
  {
    return [this](const site::Tile& tile, const pcl::PCLPointCloud2& cloud, const Answer& found) {
      out_->write(tile, cloud, {found.obstacle_flags.data()});
    };
  }

  void finish() { out_->finish(); }

  std::vector<std::string> warnings;

private:
  std::optional<site::ResultSite> out_;
};

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
  std::optional<ObstacleFiles> memory;
  if (!options.obstacleIsSite()) {
    memory.emplace(options);
    std::vector<std::string> of_files;
    for (const io::ComparedObstacle& one : memory->all)
      for (std::string& remark : warningsOf(one.loaded, one.file)) addOnce(std::move(remark), of_files);
    warn_of(of_files);
  }
  std::optional<site::Site> other;
  if (!memory) other = site::readSite(options.obstacle);
  std::vector<std::string> of_poses;
  Question& question = options.question;
  if (!options.trajectory.empty()) question.path = io::readPoses(options.trajectory, &of_poses);
  warn_of(of_poses);
  if (memory) memory->setQuestion(question);
  SiteClashList clashes(site, options, memory ? &*memory : nullptr);
  warn_of(clashes.warnings());
  SiteOutput output(site, memory ? &*memory : nullptr, clashes.clusterDistance(), options);
  warn_of(output.warnings());
  keeps = output.answers() != nullptr;
  std::optional<ObstacleOutput> obstacle_out;
  if (other && !options.obstacle_out.empty()) {
    obstacle_out.emplace(site, *other, options);
    warn_of(obstacle_out->warnings);
  }
  std::optional<Step> shown;
  if (tells) {
    shown.emplace("Asking about tiles");
    question.progress = [&shown](double done) {
      shown->share(done);
      return true;
    };
  }
  Json report = beginReport(site, options);
  const bool several = memory && memory->haveNames();
  if (!memory)
    report["points_of_obstacle"] = other->points;
  else if (!several)
    report["surface"] = io::surfaceJson(memory->surface(), question.solid);
  const std::vector<site::ClashFinder*> finders = clashes.finders();
  const site::SiteMeans means = {options.memory, output.answers(), finders.empty() ? nullptr : finders.front(),
                                 output.receiver(), obstacle_out ? obstacle_out->receiver() : nullptr};
  site::SiteObstaclesAnswer of_each;
  const auto ask = [&] {
    if (!memory) return site::ask(question, site, *other, means);
    if (!several) return site::ask(question, site, memory->shapes.front().shape, means);
    of_each = site::ask(question, site, memory->shapes, means, finders);
    for (std::size_t i = 0; i < of_each.each.size(); ++i) memory->all[i].found = of_each.each[i];
    return of_each.all;
  };
  site::SiteAnswer found = cli::named(ask, question, {options.trajectory.empty() ? "--pose" : "--trajectory"});
  std::vector<io::BetweenObstacles> between;
  if (options.between && tells) between = io::askBetween(question, memory->shapes, memory->all, options.ignoredPairs());
  if (obstacle_out) obstacle_out->finish();
  if (memory && !several) memory->write(found.obstacle_flags, options);
  putAnswer(report, site, other ? &*other : nullptr, memory && !several ? memory->only().partName() : "point", options,
            found);
  if (several) putObstacles(report, site, *memory, of_each, between);
  if (clashes.isWanted()) {
    if (several)
      clashes.finish(*memory, of_each, between, report);
    else if (memory)
      clashes.finish(*memory, found, report);
    else
      clashes.finish(*other, found, report);
  }
  putTiles(report, "tiles", found.tiles);
  if (other) putTiles(report, "tiles_of_obstacle", found.obstacle_tiles);
  if (tells) shown->done(counted(found.tiles.read, "tile") + " read");
  std::vector<std::string> told;
  addTexts(found.warnings, told);
  warn_of(told);
  if (clashes.isWanted()) warn_of(clashes.warnings());
  MeasuredRun run;
  run.tiles = std::move(found.tiles.costs);
  run.seconds = seconds();
  output.finish();
  run.copying = seconds() - run.seconds;
  if (!options.out.empty()) report["out"] = options.out.string();
  report["warnings"] = warnings;
  if (!tells) return 0;
  std::ostream& summary = options.files.summary();
  if (several) summary << io::summaryOf(memory->all, between, "point");
  if (clashes.isWanted()) summary << clashes.counts() << '\n';
  if (memory && !several && memory->surface() != nullptr)
    summary << report["surface"]["promise"].get<std::string>() << '\n';
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

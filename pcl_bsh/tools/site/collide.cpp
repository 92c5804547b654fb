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
#include <memory>
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
    if (!options.out.empty()) { // the space for --out was checked alone
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

/// The thing that the site is compared with: each kind is asked, told and listed in its own way.
class Compared {
public:
  virtual ~Compared() = default;

  virtual ObstacleFiles* files() { return nullptr; } ///< null where it is a site

  /// Begins the report, and what is written beside it. @return warnings for users, a line each
  virtual std::vector<std::string> begin(Json& /*report*/) { return {}; }

  virtual site::SiteAnswer ask(site::SiteMeans means, const std::vector<site::ClashFinder*>& finders) = 0;

  /// Writes lists and flags, and adds the answer to the report.
  virtual void finish(const site::SiteAnswer& found, SiteClashList& clashes, Json& report) = 0;

  virtual void summarise(std::ostream& /*summary*/) const {}

protected:
  Compared(const site::Site& site, const SiteOptions& options) : site_(site), options_(options) {}

  const site::Site& site_;
  const SiteOptions& options_; ///< with the question that is asked
};

/// An obstacle in memory.
class OneObstacle : public Compared {
public:
  OneObstacle(const site::Site& site, const SiteOptions& options) : Compared(site, options), files_(options) {}

  ObstacleFiles* files() override { return &files_; }

  std::vector<std::string> begin(Json& report) override
  {
    report["surface"] = io::surfaceJson(files_.surface(), options_.question.solid);
    return {};
  }

  site::SiteAnswer ask(site::SiteMeans means, const std::vector<site::ClashFinder*>& finders) override
  {
    means.clashes = finders.empty() ? nullptr : finders.front();
    return site::ask(options_.question, site_, files_.shapes.front().shape, means);
  }

  void finish(const site::SiteAnswer& found, SiteClashList& clashes, Json& report) override
  {
    files_.write(found.obstacle_flags, options_);
    putAnswer(report, site_, nullptr, files_.only().partName(), options_, found);
    if (clashes.isWanted()) clashes.finish(files_, found, report);
  }

  void summarise(std::ostream& summary) const override
  {
    if (files_.surface()) summary << io::promiseOf(*files_.surface(), options_.question.solid) << '\n';
  }

private:
  ObstacleFiles files_;
};

/// Several obstacles in memory, with names.
class NamedObstacles : public Compared {
public:
  NamedObstacles(const site::Site& site, const SiteOptions& options) : Compared(site, options), files_(options) {}

  ObstacleFiles* files() override { return &files_; }

  site::SiteAnswer ask(site::SiteMeans means, const std::vector<site::ClashFinder*>& finders) override
  {
    found_ = site::ask(options_.question, site_, files_.shapes, means, finders);
    for (std::size_t i = 0; i < found_.each.size(); ++i)
      if (files_.all[i].asked) files_.all[i].found = found_.each[i];
    return found_.all;
  }

  void finish(const site::SiteAnswer& found, SiteClashList& clashes, Json& report) override
  {
    if (options_.between && site::rankHere() == 0)
      between_ = io::askBetween(options_.question, files_.shapes, files_.all, options_.ignoredPairs());
    putAnswer(report, site_, nullptr, "point", options_, found);
    putObstacles(report, site_, files_, found_, between_);
    if (clashes.isWanted()) clashes.finish(files_, found_, between_, report);
  }

  void summarise(std::ostream& summary) const override { summary << io::summaryOf(files_.all, between_, "point"); }

private:
  ObstacleFiles files_;
  site::SiteObstaclesAnswer found_;
  std::vector<io::BetweenObstacles> between_;
};

/// Another site.
class AnotherSite : public Compared {
public:
  AnotherSite(const site::Site& site, const SiteOptions& options)
  : Compared(site, options),
    other_(site::readSite(options.obstacle))
  {
  }

  std::vector<std::string> begin(Json& report) override
  {
    report["points_of_obstacle"] = other_.points;
    if (options_.obstacle_out.empty()) return {};
    out_.emplace(site_, other_, options_);
    return out_->warnings;
  }

  site::SiteAnswer ask(site::SiteMeans means, const std::vector<site::ClashFinder*>& finders) override
  {
    means.clashes = finders.empty() ? nullptr : finders.front();
    if (out_) means.obstacle_receiver = out_->receiver();
    return site::ask(options_.question, site_, other_, means);
  }

  void finish(const site::SiteAnswer& found, SiteClashList& clashes, Json& report) override
  {
    if (out_) out_->finish();
    putAnswer(report, site_, &other_, "point", options_, found);
    if (clashes.isWanted()) clashes.finish(other_, found, report);
  }

private:
  const site::Site other_;
  std::optional<ObstacleOutput> out_;
};

std::unique_ptr<Compared> comparedWith(const site::Site& site, const SiteOptions& options)
{
  if (options.obstacleIsSite()) return std::make_unique<AnotherSite>(site, options);
  if (options.obstacles.empty()) return std::make_unique<OneObstacle>(site, options);
  return std::make_unique<NamedObstacles>(site, options);
}

/// @param keeps set to whether what is found stays in --out if the run fails
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
  const std::unique_ptr<Compared> compared = comparedWith(site, options);
  ObstacleFiles* const memory = compared->files();
  std::vector<std::string> of_files, of_poses;
  if (memory)
    for (const io::ComparedObstacle& one : memory->all)
      for (std::string& remark : warningsOf(one.loaded, one.file)) addOnce(std::move(remark), of_files);
  warn_of(of_files);
  Question& question = options.question;
  if (!options.trajectory.empty()) question.path = io::readPoses(options.trajectory, &of_poses);
  warn_of(of_poses);
  if (memory) memory->setQuestion(question);
  SiteClashList clashes(site, options, memory);
  warn_of(clashes.warnings());
  SiteOutput output(site, memory, clashes.clusterDistance(), options);
  warn_of(output.warnings());
  keeps = output.answers() != nullptr;
  Json report = beginReport(site, options);
  warn_of(compared->begin(report));
  std::optional<Step> shown;
  if (tells) {
    shown.emplace("Asking about tiles");
    question.progress = [&shown](double done) { return shown->share(done); };
  }
  const auto ask = [&] {
    return compared->ask({.memory = options.memory, .answers = output.answers(), .receiver = output.receiver()},
                         clashes.finders());
  };
  site::SiteAnswer found = cli::named(ask, question, {options.trajectory.empty() ? "--pose" : "--trajectory"});
  compared->finish(found, clashes, report);
  putTiles(report, "tiles", found.tiles);
  if (!memory) putTiles(report, "tiles_of_obstacle", found.obstacle_tiles);
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
  compared->summarise(summary);
  if (clashes.isWanted()) summary << clashes.counts() << '\n';
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

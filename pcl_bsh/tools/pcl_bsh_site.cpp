// SPDX-License-Identifier: BSD-3-Clause
// Clouds that are larger than memory: makes a folder of tiles of them, checks it, and writes clouds again.
#include <pcl_bsh/tools/cli/interruption.h>
#include <pcl_bsh/tools/cli/json_output.h>
#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/site/collide.h>
#include <pcl_bsh/tools/site/site_options.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/one_line.h>
#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/site/check_site.h>
#include <pcl_bsh/site/export_site.h>
#include <pcl_bsh/site/export_vtk.h>
#include <pcl_bsh/site/make_site.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <optional>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;
using namespace pcl_bsh;
using cli::SiteCommand;
using Options = cli::SiteOptions;

double shareOf(std::uint64_t done, std::uint64_t all)
{
  return all == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(all);
}

std::string rated(std::uint64_t points, double seconds)
{
  const double millions = static_cast<double>(points) / std::max(seconds, 1e-3) / 1e6;
  return counted(points, "point") + ", " + std::to_string(std::floor(millions * 10) / 10).substr(0, 5) +
         " million a second";
}

/// Shows each step of site::makeSite() as a step of the program.
class MakeSteps {
public:
  bool operator()(site::MakeStep step, std::uint64_t done, std::uint64_t all)
  {
    static constexpr std::array names = {"Counting points", "Dealing points to tiles", "Measuring tiles"};
    if (!shown_ || step != step_) {
      shown_.emplace(names[static_cast<std::size_t>(step)]);
      step_ = step;
      begin_ = std::chrono::steady_clock::now();
    }
    shown_->share(shareOf(done, all));
    if (done == all) {
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin_;
      shown_->done(rated(all, seconds.count()));
    }
    return true;
  }

private:
  std::optional<cli::Step> shown_;
  site::MakeStep step_ = site::MakeStep::count;
  std::chrono::steady_clock::time_point begin_;
};

int make(const Options& options)
{
  MakeSteps steps;
  site::MakeOptions wanted;
  wanted.memory = options.memory;
  wanted.tile_points = options.tile_points;
  wanted.threads = options.make_threads;
  wanted.vertices_only = options.question.vertices_only;
  wanted.columns = [&](const std::filesystem::path& file) { return options.reading.columns.of(file); };
  wanted.allow_scale = options.reading.allow_scale;
  wanted.scan = options.reading.scan;
  wanted.crs = options.reading.input_crs;
  wanted.to_crs = options.reading.to_crs;
  if (options.clouds_unit) wanted.unit = io::nameOf(*options.clouds_unit);
  if (options.to_unit) wanted.to_unit = io::nameOf(*options.to_unit);
  wanted.remark = [](const std::filesystem::path& file, const std::vector<std::string>& remarks) {
    cli::warnOfFile(cli::site_program, file, remarks);
  };
  constexpr auto goes_on = "what is done was noted, and the same command goes on";
  wanted.progress = [&](site::MakeStep step, std::uint64_t done, std::uint64_t all) {
    if (step != site::MakeStep::count && all >= wanted.save_points) cli::setWhatStays(goes_on);
    return steps(step, done, all);
  };
  const site::Site site = [&] {
    try {
      return site::makeSite(options.clouds, options.site, wanted);
    }
    catch (const files::FileError& error) {
      if (!site::isBegun(options.site)) throw;
      throw std::runtime_error(std::string(error.what()) + "; " + goes_on);
    }
  }();
  std::cout << "wrote a site of " << counted(site.points, "point") << " in " << counted(site.tiles.size(), "tile")
            << " to " << options.site.string() << '\n';
  return 0;
}

std::string texted(const Point3& point)
{
  std::string text;
  for (const double number : point) text += (text.empty() ? "" : " ") + std::to_string(number);
  return text;
}

/// The smallest and the greatest numbers of points and spacings of a site's tiles.
struct TileRange {
  std::uint64_t least = 0, most = 0;   ///< points
  double finest = 0.0, coarsest = 0.0; ///< spacings, of tiles that have one
};

TileRange rangeOf(const site::Site& site)
{
  TileRange range;
  range.least = site.points;
  for (const site::Tile& tile : site.tiles) {
    range.most = std::max(range.most, tile.points);
    range.least = std::min(range.least, tile.points);
    if (tile.spacing > 0) {
      range.finest = range.finest > 0 ? std::min(range.finest, tile.spacing) : tile.spacing;
      range.coarsest = std::max(range.coarsest, tile.spacing);
    }
  }
  return range;
}

using Json = nlohmann::ordered_json;

Json infoJson(const site::Site& site)
{
  const TileRange range = rangeOf(site);
  Json json = {{"site", site.folder.string()},
               {"points", site.points},
               {"tiles", {{"count", site.tiles.size()}, {"least_points", range.least}, {"most_points", range.most}}},
               {"spacing", {{"finest", range.finest}, {"coarsest", range.coarsest}}},
               {"bounds", nullptr},
               {"fields", Json::array()},
               {"sources", Json::array()}};
  if (site.bounds) json["bounds"] = {{"low", site.bounds->low}, {"high", site.bounds->high}};
  for (const auto& field : site.fields) json["fields"].push_back(field.name);
  for (const site::Source& source : site.sources)
    json["sources"].push_back({{"file", source.file}, {"points", source.points}});
  return json;
}

int info(const Options& options)
{
  const site::Site site = site::readSite(options.site);
  if (options.json) {
    cli::writeJson(std::cout, infoJson(site));
    return 0;
  }
  const TileRange range = rangeOf(site);
  std::cout << "points:  " << site.points << '\n'
            << "tiles:   " << site.tiles.size() << ", of " << range.least << " to " << counted(range.most, "point")
            << '\n'
            << "spacing: " << range.finest << " to " << range.coarsest << " (medians of tiles)\n";
  if (site.bounds) std::cout << "bounds:  " << texted(site.bounds->low) << " to " << texted(site.bounds->high) << '\n';
  std::cout << "fields: ";
  for (const auto& field : site.fields) std::cout << ' ' << files::oneLine(field.name);
  std::cout << "\nsources:\n";
  for (const site::Source& source : site.sources)
    std::cout << "  " << files::oneLine(source.file) << ": " << source.points << '\n';
  return 0;
}

/// The site, with its tiles checked. @throws an error that tells why it is not sound
site::Site checkedSite(const Options& options)
{
  site::Site site = site::readSite(options.site);
  cli::Step step("Checking tiles");
  site::checkSite(site, [&](std::uint64_t done, std::uint64_t all) { return step.share(shareOf(done, all)); });
  step.done(counted(site.tiles.size(), "tile"));
  return site;
}

int validate(const Options& options)
{
  const std::string name = options.site.string();
  const site::Site site =
      cli::checkTold(options.json, {{"site", name}, {"sound", false}}, [&] { return checkedSite(options); });
  if (options.json)
    cli::writeJson(std::cout, {{"site", name}, {"sound", true}, {"points", site.points}, {"tiles", site.tiles.size()}});
  else
    std::cout << "sound: each of " << counted(site.points, "point") << " is there once, in its tile\n";
  return 0;
}

/// A file for each source, named as it: NAME.pcd, and with its number where several have one name.
std::vector<fs::path> filesOfSources(const site::Site& site, const fs::path& folder)
{
  std::vector<fs::path> names;
  std::set<std::string> used;
  for (std::size_t i = 0; i < site.sources.size(); ++i) {
    std::string name = fs::path(site.sources[i].file).stem().string();
    if (name.empty()) name = "source";
    if (!used.insert(io::inSmallLetters(name)).second) {
      name += "_" + std::to_string(i);
      used.insert(io::inSmallLetters(name));
    }
    names.push_back(folder / (name + ".pcd"));
  }
  return names;
}

void requireNew(const fs::path& path)
{
  std::error_code error;
  if (fs::exists(path, error)) throw files::FileError(path, "is there already", "name a new one");
}

int writePieces(const site::Site& site, const fs::path& file)
{
  requireNew(file);
  cli::Step step("Writing " + file.string());
  site::exportPieces(site, file, [&](std::uint64_t done, std::uint64_t all) { return step.share(shareOf(done, all)); });
  step.done(std::to_string(site.tiles.size()) + " pieces");
  std::cout << "wrote " << file.string() << " in " << site.tiles.size() << " pieces\n";
  return 0;
}

int write(const Options& options)
{
  const site::Site site = site::readSite(options.site);
  if (io::extensionOf(options.out) == ".pvtp") return writePieces(site, options.out);
  const bool one_cloud = io::extensionOf(options.out) == ".pcd";
  std::optional<files::OutputFolder> folder;
  std::vector<fs::path> names = {options.out};
  if (!one_cloud) {
    folder.emplace(options.out);
    names = filesOfSources(site, options.out);
  }
  for (const fs::path& name : names) requireNew(name);
  for (std::size_t i = 0; i < names.size(); ++i) {
    cli::Step step("Writing " + names[i].string());
    site::ExportOptions wanted;
    wanted.memory = options.memory;
    wanted.progress = [&](std::uint64_t done, std::uint64_t all) { return step.share(shareOf(done, all)); };
    if (one_cloud)
      site::exportCloud(site, names[i], wanted);
    else
      site::exportSource(site, i, names[i], wanted);
    step.done(counted(one_cloud ? site.points : site.sources[i].points, "point"));
    std::cout << "wrote " << names[i].string() << '\n';
  }
  return 0;
}

int run(const Options& options)
{
  switch (options.command) {
  case SiteCommand::make:
    return make(options);
  case SiteCommand::info:
    return info(options);
  case SiteCommand::validate:
    return validate(options);
  case SiteCommand::write:
    return write(options);
  case SiteCommand::collide:
    return cli::collideSite(options);
  }
  return 1;
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(cli::site_program, cli::parseSiteOptions, run, argc, argv);
}

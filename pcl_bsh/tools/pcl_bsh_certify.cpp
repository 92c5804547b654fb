// SPDX-License-Identifier: BSD-3-Clause
// Does every bounding sphere of a cloud's hierarchy hold its points, and how much larger is it than it need be?
// The program is under GPL-3.0-or-later once compiled: see pcl_bsh/certify/LICENSE.
#include <pcl_bsh/tools/cli/command_line.h>
#include <pcl_bsh/tools/cli/json_output.h>
#include <pcl_bsh/tools/cli/reading.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/cli/used_files.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/certify/certify.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/formats.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/search/cloud_view.h>

#include <cstddef>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;
using namespace pcl_bsh;
using Json = nlohmann::ordered_json;

constexpr auto program = "pcl_bsh_certify";
constexpr auto footer =
    R"(Every sphere is checked against every point below it in exact arithmetic. Its radius is compared with that of the
smallest sphere around the same points, also exact, as CGAL finds it.
Reads {read}, pipes, and standard input as -; --report - is standard output.
Exit code: 0 all points are in their spheres; 1 some are not, or failed; 2 command line not understood; 130 stopped by Ctrl-C.
This program is under the GPL-3.0-or-later, because it contains CGAL's Bounding_volumes.

Example: how tight are the spheres over a hall, by each way of fitting?
  pcl_bsh_certify hall.ply --report hall.json)";

/// The fits, with the names that they have on the command line.
const std::vector<std::pair<std::string, SphereFit>> fits = {
    {"box", SphereFit::box_center}, {"ritter", SphereFit::ritter}, {"minimal", SphereFit::minimal}};

struct Options {
  fs::path cloud;
  std::optional<fs::path> report;
  std::vector<std::pair<std::string, SphereFit>> wanted = fits;
  CertifyOptions certify;
  cli::ReadChoice reading;
  cli::CommandFiles files;
};

Json toJson(const RadiusRatios& ratios)
{
  Json json = {{"measured", ratios.measured}, {"one_place", ratios.one_place}};
  json["mean"] = nullptr;
  json["worst"] = nullptr;
  if (ratios.measured > 0) {
    json["mean"] = ratios.mean();
    json["worst"] = ratios.worst;
  }
  json["histogram"] = {{"below", RadiusRatios::edges}, {"spheres", ratios.histogram}}; // last: above all edges
  return json;
}

Json toJson(const LevelCertificate& level, const std::string& name)
{
  return {{"level", name},          {"spheres", level.spheres},
          {"checks", level.checks}, {"exact_checks", level.exact_checks},
          {"leaks", level.leaks},   {"radius_ratio", toJson(level.ratio)}};
}

void printRow(std::ostream& out, const std::string& fit, const std::string& name, const LevelCertificate& level)
{
  std::ostringstream row;
  row << std::fixed << std::setprecision(4) << std::left << std::setw(9) << fit << std::setw(9) << name << std::right
      << std::setw(9) << level.spheres << std::setw(11) << level.checks << std::setw(7) << level.leaks << std::setw(9)
      << level.ratio.measured;
  if (level.ratio.measured > 0)
    row << std::setw(9) << level.ratio.mean() << std::setw(9) << level.ratio.worst;
  else
    row << std::setw(9) << '-' << std::setw(9) << '-';
  for (const std::size_t count : level.ratio.histogram) row << std::setw(8) << count;
  out << row.str() << '\n';
}

/// "cloud 2", "voxel" or "node 3".
std::string nameOf(const SphereLevel& level)
{
  switch (level.kind) {
  case SphereLevel::above_voxels:
    return "cloud " + std::to_string(level.depth);
  case SphereLevel::voxel:
    return "voxel";
  case SphereLevel::in_voxel:
    break;
  }
  return "node " + std::to_string(level.depth);
}

Json toJson(const Certificate& certificate)
{
  Json json;
  json["holds"] = certificate.holds();
  json["missing_points"] = certificate.missing;
  json["total"] = toJson(certificate.total, "all");
  json["levels"] = Json::array();
  for (const LevelCertificate& level : certificate.levels) json["levels"].push_back(toJson(level, nameOf(level.level)));
  json["leaks"] = Json::array(); // the first hundred
  for (const Leak& leak : certificate.leaks) {
    json["leaks"].push_back({{"level", nameOf(leak.level)},
                             {"voxel", leak.voxel},
                             {"node", leak.node},
                             {"child", leak.child},
                             {"point", leak.record},
                             {"excess", leak.excess}});
  }
  return json;
}

void printTableHead(std::ostream& out)
{
  std::ostringstream head;
  head << "Ratio: stored radius / smallest radius. Checks: points looked at, all exact. Other columns: spheres.\n";
  head << std::left << std::setw(9) << "fit" << std::setw(9) << "level" << std::right << std::setw(9) << "spheres"
       << std::setw(11) << "checks" << std::setw(7) << "leaks" << std::setw(9) << "measured" << std::setw(9) << "mean"
       << std::setw(9) << "worst";
  for (const double edge : RadiusRatios::edges) {
    std::ostringstream below;
    below << '<' << edge;
    head << std::setw(8) << below.str();
  }
  head << std::setw(8) << "more" << '\n';
  out << head.str();
}

/// A row for each level, and one for all.
void printRows(std::ostream& out, const std::string& fit, const Certificate& certificate)
{
  for (const LevelCertificate& level : certificate.levels) printRow(out, fit, nameOf(level.level), level);
  printRow(out, fit, "all", certificate.total);
}

void check(const Options& options)
{
  options.files.requireApart();
  if (options.report) files::requireWritable(*options.report);
}

pcl::PCLPointCloud2 load(const fs::path& path, const Options& options)
{
  cli::Step step("Loading " + path.string());
  io::CloudFacts facts;
  pcl::PCLPointCloud2 cloud = io::readCloud(path, &facts, options.reading.of(path), options.certify.threads);
  step.done(counted(std::size_t{cloud.width} * cloud.height, "point"));
  cli::warnOfFile(program, path, facts.remarks);
  return cloud;
}

SphereHierarchy build(const PointsView& view, SphereFit fit, const Options& options, const std::string& name)
{
  cli::Step step("Building (" + name + ")");
  HierarchyOptions wanted;
  wanted.fit = fit;
  wanted.threads = options.certify.threads;
  SphereHierarchy hierarchy(view, wanted);
  if (hierarchy.empty()) {
    throw std::runtime_error(options.cloud.string() + ": has no finite point: there is nothing to certify");
  }
  hierarchy.buildAll(options.certify.threads);
  step.done(counted(hierarchy.statistics().voxels, "voxel"));
  return hierarchy;
}

/// @param seconds gets the time that certifying took
Certificate certifyTold(const SphereHierarchy& hierarchy, CertifyOptions options, const std::string& name,
                        double& seconds)
{
  cli::Step step("Certifying (" + name + ")");
  options.progress = [&](double share) { step.share(share); };
  Certificate certificate = certify(hierarchy, options);
  seconds = step.done(std::to_string(certificate.total.checks) + " checks");
  return certificate;
}

void complain(const Options& options, const std::string& name, const Certificate& certificate)
{
  std::cerr << program << ": " << options.cloud.string() << ": fit " << name << ": ";
  if (certificate.missing > 0) std::cerr << counted(certificate.missing, "point is", "points are") << " in no leaf";
  if (certificate.missing > 0 && certificate.total.leaks > 0) std::cerr << ", ";
  if (certificate.total.leaks > 0) {
    const Leak& first = certificate.leaks.front();
    std::cerr << counted(certificate.total.leaks, "point sticks", "points stick")
              << " out of their spheres, first point " << first.record << ", by " << first.excess << ", out of child "
              << first.child << " of node " << first.node << " on level " << nameOf(first.level) << " of voxel "
              << first.voxel;
  }
  std::cerr << ": report this cloud as a defect of pcl_bsh\n";
}

int run(const Options& options)
{
  check(options);
  const pcl::PCLPointCloud2 cloud = load(options.cloud, options);
  const PointsView view = viewOf(cloud);

  bool holds = true;
  Json report;
  report["cloud"] = {{"file", options.cloud.string()}, {"points", view.count}};
  report["fits"] = Json::array();
  for (const auto& [name, fit] : options.wanted) {
    const SphereHierarchy hierarchy = build(view, fit, options, name);
    double seconds = 0.0;
    const Certificate certificate = certifyTold(hierarchy, options.certify, name, seconds);
    if (report["fits"].empty()) printTableHead(options.files.summary());
    printRows(options.files.summary(), name, certificate);
    if (!certificate.holds()) complain(options, name, certificate);
    holds = holds && certificate.holds();

    Json of_fit = {{"fit", name}, {"finite", hierarchy.size()}, {"seconds", seconds}};
    of_fit.update(toJson(certificate));
    report["fits"].push_back(std::move(of_fit));
  }
  report["holds"] = holds;
  if (options.report) cli::writeJson(*options.report, report);
  options.files.summary() << (holds ? "Certified: every point is in every sphere above it.\n" : "Not certified.\n");
  return holds ? 0 : 1;
}

/// The options, checked; none when only help was asked for. @throws UsageError
std::optional<Options> parse(int argc, char** argv)
{
  Options options;
  std::optional<SphereFit> fit;
  options.certify.threads = 0;
  CLI::App app("Proves that no point of a cloud lies outside the bounding spheres above it.", program);
  app.footer(io::withFormats(footer));
  app.add_option("CLOUD", options.cloud, "cloud whose hierarchy is built and certified")->type_name("")->required();
  app.add_option("--fit", fit, "box, ritter or minimal: how centres are chosen (default: each in turn)")
      ->type_name("FIT")
      ->transform(cli::choice(fits));
  app.add_option("--sample", options.certify.sample,
                 "on each level, compare N spheres with the smallest (default: 1000); all:\n"
                 "every one. Containment is always checked for all")
      ->type_name("N")
      ->transform(cli::number<std::uint64_t>("give a number of spheres, or all"))
      ->transform(CLI::Validator(
          [](std::string& text) {
            if (text == "all") text = std::to_string(CertifyOptions::all);
            return std::string();
          },
          "")); // CLI11 calls the one added last first
  cli::addThreads(app, options.certify.threads, "0: all of the machine's (default); any number gives the same result");
  cli::ReadOptions reading;
  reading.addTo(app);
  app.add_option("--report", options.report, "JSON file for the results")->type_name("FILE");
  if (!cli::understood(app, program, argc, argv)) return std::nullopt;

  if (fit) std::erase_if(options.wanted, [&](const auto& named) { return named.second != *fit; });
  options.reading = reading.read({options.cloud});
  options.files.reads("CLOUD", options.cloud).writes("--report", options.report.value_or(""));
  return options;
}

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(program, parse, run, argc, argv);
}

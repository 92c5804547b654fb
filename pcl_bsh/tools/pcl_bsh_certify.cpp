// SPDX-License-Identifier: BSD-3-Clause
// Does every bounding sphere of a cloud's hierarchy hold its points, and how much larger is it than it need be?
// The program is under GPL-3.0-or-later once compiled: see pcl_bsh/certify/LICENSE.
#include <pcl_bsh/tools/certify/certify_report.h>
#include <pcl_bsh/tools/cli/command_line.h>
#include <pcl_bsh/tools/cli/json_output.h>
#include <pcl_bsh/tools/cli/reading.h>
#include <pcl_bsh/tools/cli/step.h>
#include <pcl_bsh/tools/cli/used_files.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/formats.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/search/cloud_view.h>

#include <cstdint>
#include <iostream>
#include <optional>
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

/// The fits by the names that users know them by.
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

/// @param seconds that certifying took
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
              << first.child << " of node " << first.node << " on level " << cli::nameOf(first.level) << " of voxel "
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
    if (report["fits"].empty()) cli::printTableHead(options.files.summary());
    cli::printRows(options.files.summary(), name, certificate);
    if (!certificate.holds()) complain(options, name, certificate);
    holds = holds && certificate.holds();

    Json of_fit = {{"fit", name}, {"finite", hierarchy.size()}, {"seconds", seconds}};
    of_fit.update(cli::toJson(certificate));
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
          "")); // the last is the first to be called
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

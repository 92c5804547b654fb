// SPDX-License-Identifier: BSD-3-Clause
// Does every bounding sphere of a cloud's hierarchy hold its points, and how much larger is it than it need be?
// The program is under GPL-3.0-or-later once compiled: see pcl_bsh/certify/LICENSE.
#include <pcl_bsh/tools/certify/certify_options.h>
#include <pcl_bsh/tools/certify/certify_report.h>
#include <pcl_bsh/tools/cli/json_output.h>
#include <pcl_bsh/tools/cli/program.h>
#include <pcl_bsh/tools/cli/step.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/search/cloud_view.h>

#include <iostream>
#include <optional>
#include <string>

namespace {

namespace fs = std::filesystem;
using namespace pcl_bsh;
using Options = cli::CertifyProgramOptions;
using Json = nlohmann::ordered_json;

constexpr auto program = cli::certify_program;

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

} // namespace

int main(int argc, char** argv)
{
  return cli::runProgram(program, [&] {
    const std::optional<Options> options = cli::parseCertifyOptions(argc, argv);
    return options ? run(*options) : 0;
  });
}

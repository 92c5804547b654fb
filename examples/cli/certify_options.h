// SPDX-License-Identifier: BSD-3-Clause
// The command line of pcl_bsh_certify.
#pragma once

#include "command_line.h"
#include "used_files.h"

#include <pcl_bsh/certify/certify.h>
#include <pcl_bsh/filters/cloud_files/field_type.h>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::cli {

inline constexpr auto certify_program = "pcl_bsh_certify";

/// The fits by the names that users know them by.
inline const std::vector<std::pair<std::string, SphereFit>> fits = {
    {"box", SphereFit::box_center}, {"ritter", SphereFit::ritter}, {"minimal", SphereFit::minimal}};

struct CertifyProgramOptions {
  std::filesystem::path cloud;
  std::optional<std::filesystem::path> report;
  CommandFiles files;
  std::vector<std::pair<std::string, SphereFit>> wanted = fits;
  CertifyOptions certify;
};

inline constexpr auto certify_footer =
    R"(Every sphere is checked against every point below it in exact arithmetic. Its radius is compared with that of the
smallest sphere around the same points, also exact, as CGAL finds it. Reads .pcd .ply .obj .off .xyz .txt, pipes, and
standard input as -; --report - is standard output.
Exit code: 0 all points are in their spheres; 1 some are not, or failed; 2 command line not understood.
This program is under the GPL-3.0-or-later, for it contains CGAL's Bounding_volumes.

Example: how tight are the spheres over a hall, by each way of fitting?
  pcl_bsh_certify hall.ply --report hall.json)";

inline std::vector<std::pair<std::string, SphereFit>> parseFit(const std::string& text)
{
  for (const auto& fit : fits) {
    if (fit.first == text) return {fit};
  }
  throw UsageError("--fit: '" + text + "' is unknown: give box, ritter or minimal");
}

template <typename Number>
Number parseCount(const std::string& option, const std::string& text, const char* remedy)
{
  try {
    return io::parseNumber<Number>(text);
  }
  catch (const io::FormatError& error) {
    throw UsageError(option + ": " + error.what() + ": " + remedy);
  }
}

/// The options, checked one by one; none when only help was asked for.
inline std::optional<CertifyProgramOptions> parseCertifyOptions(int argc, char** argv)
{
  std::string cloud, fit, sample, report, threads = "0";
  CLI::App app("Proves that no point of a cloud lies outside the bounding spheres above it.", certify_program);
  app.footer(certify_footer);
  app.add_option("CLOUD", cloud, "cloud whose hierarchy is built and certified")->type_name("")->required();
  app.add_option("--fit", fit, "box, ritter or minimal: how centres are chosen (default: each in turn)")
      ->type_name("FIT");
  app.add_option("--sample", sample,
                 "on each level, compare N spheres with the smallest (default: 1000); all:\n"
                 "every one. Containment is always checked for all")
      ->type_name("N");
  app.add_option("--threads", threads, "0: all of the machine's (default); any number gives the same result")
      ->type_name("N");
  app.add_option("--report", report, "JSON file for what was found")->type_name("FILE");
  if (!understood(app, certify_program, argc, argv)) return std::nullopt;

  CertifyProgramOptions options;
  options.cloud = cloud;
  options.files.reads("CLOUD", cloud).writes("--report", report);
  if (!report.empty()) options.report = report;
  if (!fit.empty()) options.wanted = parseFit(fit);
  if (sample == "all")
    options.certify.sample = CertifyOptions::all;
  else if (!sample.empty())
    options.certify.sample = parseCount<std::uint64_t>("--sample", sample, "give a number of spheres, or all");
  options.certify.threads = parseCount<unsigned>("--threads", threads, "give a number of threads, 0 for all");
  return options;
}

} // namespace pcl_bsh::cli

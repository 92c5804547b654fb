// SPDX-License-Identifier: BSD-3-Clause
// The command line of pcl_bsh_gauge.
#pragma once

#include <pcl_bsh/tools/cli/reading.h>
#include <pcl_bsh/tools/cli/used_files.h>

#include <pcl_bsh/io/reports/gauge_run.h>
#include <pcl_bsh/io/tracks/axis_file.h>
#include <pcl_bsh/io/tracks/profile_file.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

inline constexpr auto gauge_program = "pcl_bsh_gauge";

struct GaugeAxis {
  std::string name; ///< of its track; empty where it is the only one
  std::filesystem::path file;
  io::AxisSettings settings = {};
};

struct GaugeOptions {
  std::filesystem::path input, output; ///< each may be empty
  std::vector<GaugeAxis> axes;         ///< at least one
  std::vector<io::EnvelopeFiles> profiles;
  std::optional<double> profile_unit;
  double limit = 0.0, step = 1.0, cluster_distance = 0.5, thickness = 0.1;
  AxisReach reach;
  io::GaugeFiles written;
  std::filesystem::path previous, sections, poses, origin_path;
  std::string time_field; ///< empty: the usual ones
  double seen_spacing = SeenCells().spacing;
  bool pictures = false;  ///< of sections, beside their drawings
  std::vector<double> at; ///< chainages of sections
  double pivots = 0.0;
  std::string unit;
  unsigned threads = 0;
  ReadChoice reading;
  CommandFiles files;

  /// Whether INPUT is a folder, as sites are.
  bool isSite() const { return std::filesystem::is_directory(input); }
  bool draws() const { return !sections.empty() || !written.page.empty(); }
};

/// The options, checked; none when only help was asked for. @throws UsageError
std::optional<GaugeOptions> parseGaugeOptions(int argc, char** argv);

} // namespace pcl_bsh::cli

// SPDX-License-Identifier: BSD-3-Clause
// The options of programs that list clashes, and the files of the lists.
#pragma once

#include "used_files.h"

#include <pcl_bsh/io/reports/clash_report.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

struct ClashOptions {
  std::vector<std::filesystem::path> clashes; ///< files for the lists, .json .csv .html .bcf .bcfzip
  double cluster_distance = 0;                ///< 0: from clearance and spacing
  std::optional<std::filesystem::path> previous;
  std::string unit; ///< of the clouds, for reports; empty: not known

  /// @param unit_of the outputs that tell the unit, for the help
  void addTo(CLI::App& app, const std::string& unit_of);

  /// @throws UsageError for an option without --clashes
  void requireConsistent() const;

  void addTo(CommandFiles& files) const;

  /// Fails before anything is done. @throws UsageError for an unknown format, files::FileError
  void requireWritable() const;

  /// Writes all lists. @param warnings gets what users should know of them
  void write(const io::ClashLists& lists, std::vector<std::string>& warnings) const;
};

} // namespace pcl_bsh::cli

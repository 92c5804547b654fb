// SPDX-License-Identifier: BSD-3-Clause
// How command lines say how files of points are read.
#pragma once

#include <pcl_bsh/io/clouds/read_settings.h>

#include <CLI/CLI.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// The settings of each file that a program reads.
struct ReadChoice {
  io::ColumnChoice columns;
  bool allow_scale = false;
  std::optional<std::size_t> scan = {}; ///< of files that may have several

  io::ReadSettings of(const std::filesystem::path& file) const;
};

/// --columns, --allow-scale and --scan as they are written.
class ReadOptions {
public:
  void addTo(CLI::App& app);

  /// @param files that the program reads clouds from
  /// @throws UsageError for what is no list of names, for names that none of the files can have, and for a scan where
  /// none may have several
  ReadChoice read(const std::vector<std::filesystem::path>& files) const;

private:
  std::vector<std::string> given_;
  bool allow_scale_ = false;
  std::optional<std::size_t> scan_;
};

} // namespace pcl_bsh::cli

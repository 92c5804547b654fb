// SPDX-License-Identifier: BSD-3-Clause
// How command lines say what the columns of text files are.
#pragma once

#include <pcl_bsh/io/text/column_names.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// --columns as it is written.
class ColumnOptions {
public:
  void addTo(CLI::App& app);

  /// @param files that the program reads clouds from
  /// @throws UsageError for what is no list of names, and for names that none of the files can have
  io::ColumnChoice read(const std::vector<std::filesystem::path>& files) const;

private:
  std::vector<std::string> given_;
};

} // namespace pcl_bsh::cli

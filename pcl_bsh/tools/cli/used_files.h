// SPDX-License-Identifier: BSD-3-Clause
// The files of a command, by the options that name them.
#pragma once

#include <pcl_bsh/io/files/used_files.h>

#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// All files that a command reads and writes. Empty names are left out.
class CommandFiles {
public:
  CommandFiles& reads(std::string option, const std::filesystem::path& file);

  /// @param replaces the option whose file this one may replace
  CommandFiles& writes(std::string option, const std::filesystem::path& file, std::string replaces = {});

  /// Names an output of a program that prints its results to standard output. @throws UsageError for `-`
  CommandFiles& writesFile(std::string option, const std::filesystem::path& file);

  /// The value of an option for a pose, where it names a file.
  CommandFiles& readsPose(std::string option, const std::string& text);

  /// @throws UsageError naming two options that name the same file, where one of them writes it
  void requireApart() const;

  /// Where the program prints its summary: stderr when standard output is one of the files.
  std::ostream& summary() const;

private:
  std::vector<files::UsedFile> files_;
};

} // namespace pcl_bsh::cli

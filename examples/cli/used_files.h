// SPDX-License-Identifier: BSD-3-Clause
// The files of a command, and what it says of them.
#pragma once

#include "program.h"

#include <pcl_bsh/files/used_files.h>

#include <filesystem>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::cli {

/// All files that a command reads and writes, by the options that name them.
class CommandFiles {
public:
  CommandFiles& reads(std::string option, const std::filesystem::path& file)
  {
    if (!file.empty()) files_.push_back({std::move(option), file, files::Use::read});
    return *this;
  }

  /// @param replaces the option whose file this one may replace
  CommandFiles& writes(std::string option, const std::filesystem::path& file, std::string replaces = {})
  {
    if (!file.empty()) files_.push_back({std::move(option), file, files::Use::written, std::move(replaces)});
    return *this;
  }

  /// The same in a program whose standard output is taken by what it tells.
  CommandFiles& writesFile(std::string option, const std::filesystem::path& file)
  {
    if (file == files::standard_stream)
      throw UsageError(option + ": -: this program needs standard output: name a file");
    return writes(std::move(option), file);
  }

  /// The text behind an option for a pose, which may name a file.
  CommandFiles& readsPose(std::string option, const std::string& text)
  {
    return !text.empty() && std::filesystem::exists(text) ? reads(std::move(option), text) : *this;
  }

  /// @throws UsageError naming two options whose files are one, and one is written
  void requireApart() const
  {
    const auto clash = files::findClash(files_);
    if (!clash) return;
    const files::UsedFile& file = files_[clash->file];
    throw UsageError(file.name + ": " + file.path.string() + ": " + clash->wrong);
  }

  /// Where to tell what was done: stderr when standard output is one of the files.
  std::ostream& summary() const
  {
    for (const files::UsedFile& file : files_)
      if (file.use == files::Use::written && file.path == files::standard_stream) return std::cerr;
    return std::cout;
  }

private:
  std::vector<files::UsedFile> files_;
};

} // namespace pcl_bsh::cli

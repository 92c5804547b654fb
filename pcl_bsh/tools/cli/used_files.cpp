// SPDX-License-Identifier: BSD-3-Clause
#include "used_files.h"

#include "program.h"

#include <iostream>
#include <utility>

namespace pcl_bsh::cli {

CommandFiles& CommandFiles::reads(std::string option, const std::filesystem::path& file)
{
  if (!file.empty()) files_.push_back({std::move(option), file, files::Use::read});
  return *this;
}

CommandFiles& CommandFiles::writes(std::string option, const std::filesystem::path& file, std::string replaces)
{
  if (!file.empty()) files_.push_back({std::move(option), file, files::Use::written, std::move(replaces)});
  return *this;
}

CommandFiles& CommandFiles::writesFile(std::string option, const std::filesystem::path& file)
{
  if (file == files::standard_stream) throw UsageError(option + ": -: this program needs standard output: name a file");
  return writes(std::move(option), file);
}

CommandFiles& CommandFiles::readsPose(std::string option, const std::string& text)
{
  return !text.empty() && std::filesystem::exists(text) ? reads(std::move(option), text) : *this;
}

void CommandFiles::requireApart() const
{
  const auto clash = files::findClash(files_);
  if (!clash) return;
  const files::UsedFile& file = files_[clash->file];
  throw UsageError(file.name + ": " + file.path.string() + ": " + clash->wrong);
}

std::ostream& CommandFiles::summary() const
{
  for (const files::UsedFile& file : files_)
    if (file.use == files::Use::written && file.path == files::standard_stream) return std::cerr;
  return std::cout;
}

} // namespace pcl_bsh::cli

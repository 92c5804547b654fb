// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stage_names.h>

#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>

namespace pcl_bsh::pipeline {

std::vector<std::string> typeNames()
{
  std::vector<std::string> names;
  for (const StageType& type : stageTypes()) {
    names.push_back(type.name);
    names.insert(names.end(), type.aliases.begin(), type.aliases.end());
  }
  return names;
}

const StageType* typeOfFile(const std::string& file, bool written)
{
  const std::string extension = io::extensionOf(file);
  for (const StageType& type : stageTypes()) {
    const bool can = written ? type.isWriter() : type.isReader();
    if (can && std::find(type.extensions.begin(), type.extensions.end(), extension) != type.extensions.end()) {
      return &type;
    }
  }
  return nullptr;
}

std::string knownExtensions(bool written)
{
  std::string list;
  for (const StageType& type : stageTypes()) {
    if (!(written ? type.isWriter() : type.isReader())) continue;
    for (const std::string& extension : type.extensions) list += (list.empty() ? "" : " ") + extension;
  }
  return list;
}

} // namespace pcl_bsh::pipeline

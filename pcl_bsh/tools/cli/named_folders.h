// SPDX-License-Identifier: BSD-3-Clause
// Values NAME=FOLDER of an option that may be given several times.
#pragma once

#include "program.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// The folder of each name. @throws UsageError for a value without a name
inline std::map<std::string, std::filesystem::path> namedFolders(const std::string& option,
                                                                 const std::vector<std::string>& values)
{
  std::map<std::string, std::filesystem::path> folders;
  for (const std::string& value : values) {
    const std::size_t equals = value.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw UsageError(option + ": '" + value + "' is no package with a folder: give NAME=FOLDER");
    folders[value.substr(0, equals)] = value.substr(equals + 1);
  }
  return folders;
}

} // namespace pcl_bsh::cli

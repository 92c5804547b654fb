// SPDX-License-Identifier: BSD-3-Clause
// Lists of clashes of one obstacle without a name.
#pragma once

#include <pcl_bsh/io/reports/clash_list.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace pcl_bsh::io {

inline ClashList parseClashes(std::string_view text, const std::string& name)
{
  return parseClashLists(text, name).front();
}

inline ClashList readClashes(const std::filesystem::path& path)
{
  return readClashLists(path).front();
}

} // namespace pcl_bsh::io

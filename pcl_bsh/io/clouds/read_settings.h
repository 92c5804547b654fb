// SPDX-License-Identifier: BSD-3-Clause
// Settings of how a file of points is read, beside what the file says itself.
#pragma once

#include <pcl_bsh/io/text/column_names.h>

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <utility>

namespace pcl_bsh::io {

struct ReadSettings {
  ReadSettings() = default;
  ReadSettings(ColumnNames names, bool scale = false, std::optional<std::size_t> one = {})
  : columns(std::move(names)),
    allow_scale(scale),
    scan(one)
  {
  }
  ReadSettings(std::initializer_list<const char*> names) : columns(names.begin(), names.end()) {}

  ColumnNames columns;                  ///< of .xyz, .txt and .csv; empty: as the file says
  bool allow_scale = false;             ///< transforms of a .ptx may scale uniformly (rigid_pose.h)
  std::optional<std::size_t> scan = {}; ///< of a .ptx or .e57 only that one, from 0; of a .ptx as an organised cloud
};

/// Whether files with this extension, in small letters, may have several scans.
inline bool mayHaveScans(std::string_view extension)
{
  return extension == ".ptx" || extension == ".e57";
}

} // namespace pcl_bsh::io

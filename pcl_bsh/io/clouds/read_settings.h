// SPDX-License-Identifier: BSD-3-Clause
// Settings of how a file of points is read, beside what the file says itself.
#pragma once

#include <pcl_bsh/io/text/column_names.h>

#include <initializer_list>
#include <utility>

namespace pcl_bsh::io {

struct ReadSettings {
  ReadSettings() = default;
  ReadSettings(ColumnNames names, bool scale = false) : columns(std::move(names)), allow_scale(scale) {}
  ReadSettings(std::initializer_list<const char*> names) : columns(names.begin(), names.end()) {}

  ColumnNames columns;      ///< of .xyz, .txt and .csv; empty: as the file says
  bool allow_scale = false; ///< transforms of a .ptx may scale uniformly (rigid_pose.h)
};

} // namespace pcl_bsh::io

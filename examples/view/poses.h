// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/pose.h"

#include <filesystem>
#include <string>
#include <vector>

namespace pcl_bsh::view {

/// A pose per line, the twelve numbers of its matrix row by row. @throws io::CloudFileError
inline std::vector<Eigen::Isometry3d> readPoses(const std::filesystem::path& path)
{
  const io::FileBytes file(path);
  std::vector<Eigen::Isometry3d> poses;
  try {
    io::TextCursor cursor(file.view(), '#', ",;");
    while (cursor.nextLine()) {
      std::vector<double> n;
      while (!cursor.line().empty()) n.push_back(cursor.number<double>());
      if (n.empty()) continue;
      if (n.size() != 12) throw io::FormatError("a pose has " + std::to_string(n.size()) + " numbers");
      Eigen::Isometry3d& pose = poses.emplace_back(Eigen::Isometry3d::Identity());
      for (Eigen::Index i = 0; i < 12; ++i) pose.matrix()(i / 4, i % 4) = n[static_cast<std::size_t>(i)];
    }
  }
  catch (const io::FormatError& error) {
    throw io::CloudFileError(path, error.what(), "give the 12 numbers of a pose's matrix on each line");
  }
  if (poses.empty()) throw io::CloudFileError(path, "holds no pose", "give a pose per line");
  return poses;
}

} // namespace pcl_bsh::view

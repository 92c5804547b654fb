// SPDX-License-Identifier: BSD-3-Clause
// Obstacles that are not asked about again. Their clashes in an earlier list are listed once more, as if a new run had
// found them unchanged.
#pragma once

#include <pcl_bsh/io/reports/clash_list.h>
#include <pcl_bsh/question/obstacles.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// An obstacle as the earlier list tells of it. Clashes that were new persist, and resolved ones are left out; the
/// others are as they were. If the input is several files, its records are indices into `sources`.
struct KeptObstacle {
  ClashList list;
  ObstacleAnswer answer;
  TrajectoryResult counts; ///< of the answer
  Json surface;            ///< surfaceJson()
  std::vector<SourcePoint> sources;
  std::map<std::string, Point3> places; ///< of the obstacle's point of the closest pair, by the ids of present clashes

  const char* partName() const { return surface.is_null() ? "point" : "triangle"; }
};

struct KeptObstacles {
  std::filesystem::path file;
  double cluster_distance = 0.0;
  std::string unit, coordinate_system; ///< empty: not known
  std::map<std::string, KeptObstacle> by_name;

  /// Requires that the list answers the question that is asked about an obstacle now, of the same scan. Lists tell
  /// scans apart by name, extent, unit and coordinate system.
  /// @param ignores_input whether it is compared with other obstacles alone
  /// @throws files::FileError where it is not
  void requireSame(const std::string& name, const ClashQuestion& now, bool ignores_input, const Survey& survey,
                   const std::string& unit_now, const std::string& coordinate_system_now) const;
};

/// @param path of the earlier list. @param text, lists what it says. @param names of the obstacles that are kept
/// @throws as readClashLists(); files::FileError where the list does not tell of one
KeptObstacles keptObstacles(const std::filesystem::path& path, const ListText& text,
                            const std::vector<ClashList>& lists, const std::vector<std::string>& names);

} // namespace pcl_bsh::io

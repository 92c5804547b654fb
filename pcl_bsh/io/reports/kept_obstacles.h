// SPDX-License-Identifier: BSD-3-Clause
// Obstacles that are not asked about again: what an earlier list tells of them is listed once more, as a run would that
// finds nothing changed.
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
/// others are as they were. Records of an input that is several files are numbers of `sources`.
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

  /// Whether the list is of the question that is asked about an obstacle now. It must be of the same scan, as far as
  /// lists tell: a scan of one name, extent, unit and coordinate system.
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

// SPDX-License-Identifier: BSD-3-Clause
// The results of a comparison of two clouds, and what they cost, for people and for programs.
#pragma once

#include "collide_options.h"

#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/reports/compared_obstacles.h>
#include <pcl_bsh/io/reports/distance_report.h>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

struct CloudReport {
  std::string file;
  std::size_t points = 0;
  std::size_t finite = 0;
  std::size_t ignored = 0;
};

struct Seconds {
  double load = 0;
  double build = 0; ///< sorting into voxels; their trees are built by the query that visits them
  double query = 0;
  double distances = 0;
  double clashes = 0;
  double write = 0;
};

struct CollisionReport {
  CloudReport input;
  CloudReport obstacle;                        ///< of a surface, its vertices
  std::optional<io::Obstacle> surface;         ///< the obstacle, where it is one
  std::vector<io::ComparedObstacle> obstacles; ///< the only one, or several that have names
  std::vector<io::BetweenObstacles> between;   ///< where several are compared with each other
  std::uint32_t closest_obstacle = kNothing;   ///< of several, that of the closest pair
  bool input_is_surface = false;               ///< then its records are triangles
  std::string unit;                            ///< of all lengths, where it is known; else empty
  std::string coordinate_system;               ///< of the input, where its file names one; else empty
  Question question;
  Answer answer;
  std::optional<nlohmann::ordered_json> distances; ///< the report of --distances
  std::size_t voxels_total = 0;
  Seconds seconds;
  std::vector<std::string> warnings;

  bool haveNames() const { return !obstacles.front().name.empty(); }
  bool mayLeaveUndecided() const { return question.accuracy.stopsEarly() || question.isUncertain(); }
};

/// Where `surface` is not null, records of the obstacle are triangles.
/// `distance` and `closest_pair` are null when a cloud has no finite point, or nothing collides along a path.
/// `distance_interval` is null along a path that does not tell it; each of its ends is null where it is not known.
nlohmann::ordered_json toJson(const CollisionReport& report);

/// Tells people in a sentence what was found, after the warnings.
/// @param clashes how many there are, as io::clashCounts() tells it; empty where none were asked for
void summarise(const CollideOptions& options, const CollisionReport& report, const std::string& clashes,
               const std::optional<io::DistanceReport>& distances);

} // namespace pcl_bsh::cli

// SPDX-License-Identifier: BSD-3-Clause
// The results of a comparison of two clouds, and what they cost, for people and for programs.
#pragma once

#include <pcl_bsh/tools/cli/obstacle.h>

#include <pcl_bsh/filters/uncertainty.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/question/warnings.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

struct CloudReport {
  std::string file;
  std::size_t points = 0;
  std::size_t finite = 0;
};

/// What is known only along a path.
struct PathReport {
  std::size_t poses = 0;
  std::optional<double> swept;
  std::vector<PoseSummary> table;            ///< one per pose; none when swept
  std::optional<FirstContact> first_contact; ///< swept only
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
  CloudReport obstacle;                ///< of a surface, its vertices
  std::optional<io::Obstacle> surface; ///< the obstacle, where it is one
  std::optional<double> input_surface; ///< the tolerance, where the input is one: its numbers are those of triangles
  std::string coordinate_system;       ///< of the input, where its file names one; else empty
  double clearance = 0;
  Accuracy accuracy;
  Uncertainty input_uncertainty, obstacle_uncertainty;
  std::size_t colliding = 0; ///< points of the input
  std::size_t undecided = 0; ///< likewise
  std::size_t sparse = 0;    ///< likewise, and not among the undecided
  double widest_gap = 0;     ///< of the density guard; 0: not guarded
  DistanceResult closest;    ///< a: the input, b: the obstacle (a point, or a triangle of its surface); along a path
                             ///< within the clearance only
  Density density;
  std::optional<PathReport> path;
  std::optional<nlohmann::ordered_json> distances; ///< where every point's was asked for
  Work work;                                       ///< of all queries
  std::size_t voxels_total = 0;
  Seconds seconds;
  std::vector<std::string> warnings;

  /// Whose tolerance comes on top of the surface's.
  std::string besideSurface() const { return cli::besideSurface(accuracy, path && path->swept); }

  bool mayLeaveUndecided() const
  {
    return accuracy.stopsEarly() || !input_uncertainty.isZero() || !obstacle_uncertainty.isZero();
  }
};

/// Where `surface` is not null, the obstacle's numbers are those of triangles.
/// `distance` and `closest_pair` are null when a cloud has no finite point, or nothing collides along a path;
/// `distance_interval` along a path, and each of its ends where it is not known.
nlohmann::ordered_json toJson(const CollisionReport& report);

/// As JSON. @throws files::FileError
void writeReport(const std::filesystem::path& path, const CollisionReport& report);

} // namespace pcl_bsh::cli

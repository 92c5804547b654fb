// SPDX-License-Identifier: BSD-3-Clause
// How far two clouds are from each other: numbers for programs (.json), and a page for people (.html).
#pragma once

#include <pcl_bsh/clashes/far_places.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/distances/statistics.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/json/json_document.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// The question, and the names that the report gives the two clouds.
struct DistanceQuestion {
  std::string input, obstacle; ///< file names
  std::string unit;            ///< of the clouds' lengths; empty: not known
  PointDistancesRequest request;
  std::optional<double> beyond;       ///< points farther than this form places; none: the 95th percentile, 0 at least
  const Obstacle* surface = nullptr;  ///< the obstacle, if it is a surface: its records are triangles
  bool solid = false;                 ///< it counts with what it encloses
  std::string coordinate_system = {}; ///< of the input, where its file names one; else empty

  /// Tells that distances are those to a surface; null unless the obstacle is one.
  Json surfaceToTell() const;
};

/// Distances from each record of one cloud to the nearest of the other. Cloud and distances are borrowed.
struct DistanceSide {
  std::string name;       ///< file name of the cloud
  PointsView cloud;       ///< its points; of triangles, their middles
  const char* part;       ///< the name of a record: "point" or "triangle"
  Eigen::Isometry3d pose; ///< of the cloud in the input's frame
  const PointDistances& found;
  std::size_t points = 0; ///< finite ones
  DistanceStatistics statistics;
  double beyond = 0.0;          ///< places beyond this distance are far; NaN when there is no distance at all
  std::vector<FarPlace> places; ///< in the cloud's own frame

  std::size_t farther() const { return points - statistics.count; } ///< than the greatest distance asked for

  /// Meaning of each of the numbers that statistics summarize.
  const char* meaning() const;

  /// Returns the place of a record in the input's frame.
  Eigen::Vector3d placeOf(std::uint32_t record) const
  {
    const Point3 p = cloud.point(record);
    return pose * Eigen::Vector3d(p[0], p[1], p[2]);
  }
};

struct DistanceReport {
  DistanceQuestion question;
  DistanceSide input, obstacle;
  double hausdorff; ///< as SymmetricDistances has it, and the following
  std::optional<PointPair> hausdorff_pair;
  Interval hausdorff_interval;

  /// Whether the interval is wider than the distance's rounding.
  bool isHausdorffAnInterval() const;
};

/// The report of what symmetricDistances() found between the two, which are borrowed.
/// @throws std::invalid_argument when `beyond` is negative or NaN
DistanceReport reportOf(const DistanceQuestion& question, const Placed& input, const Placed& obstacle,
                        const SymmetricDistances& found);

/// Returns lengths as numbers, and null for a missing one. Lists as many places of each cloud as the page, at most.
Json distanceJson(const DistanceReport& report);

/// A page that opens alone in a browser: statistics, histograms, and the farthest places in pictures and tables.
std::string distancePage(const DistanceReport& report);

/// Places of one cloud that are told one by one.
inline constexpr std::size_t most_far_places = 20;

/// Writes the format that the extension names: .json or .html. The file appears complete or not at all.
/// @throws files::FileError
void writeDistances(const std::filesystem::path& path, const DistanceReport& report);

/// @throws files::FileError when writeDistances() knows no such extension; as reportDate() does
void requireDistanceFormat(const std::filesystem::path& path);

} // namespace pcl_bsh::io

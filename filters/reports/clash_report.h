// SPDX-License-Identifier: BSD-3-Clause
// Clashes as lists for programs (.json, .csv), read back to compare with, and as a page for people (.html).
#pragma once

#include <pcl_bsh/filters/cloud_files/obstacle.h>
#include <pcl_bsh/filters/json/json_document.h>
#include <pcl_bsh/neighbors/spacing.h>
#include <pcl_bsh/report/clashes.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pcl_bsh::io {

/// Where a point of an input stood that is made of several files.
struct SourcePoint {
  std::string file;
  std::uint32_t record = 0;
};

/// All that a list of clashes tells, in the frame of the input. Clouds and result are borrowed.
struct ClashReport {
  std::string input, obstacle; ///< file names
  double clearance = 0;
  double cluster_distance = 0;
  std::optional<std::string> previous; ///< file name
  std::vector<Clash> clashes;
  const PointsView& scan;
  const PointsView& model;
  const std::vector<Eigen::Isometry3d>& poses;
  const TrajectoryResult& found;
  std::optional<double> swept;
  const Obstacle* surface = nullptr; ///< the obstacle, where it is one; `model` are its balls
  /// Of a point of `scan`, where the input is several files.
  std::function<SourcePoint(std::uint32_t)> source_of = nullptr;
  /// The same of a point of `model`.
  std::function<SourcePoint(std::uint32_t)> model_source_of = nullptr;

  /// Of the obstacle: a point, or a triangle.
  std::uint32_t modelPart(const Clash& clash) const
  {
    return surface != nullptr ? surface->partOf(clash.model_point) : clash.model_point;
  }
  const char* partName() const { return surface != nullptr ? surface->partName() : "point"; }

  std::size_t count(ClashStatus status) const
  {
    return static_cast<std::size_t>(
        std::count_if(clashes.begin(), clashes.end(), [&](const Clash& clash) { return clash.status == status; }));
  }

  Eigen::Vector3d scanPoint(const Clash& clash) const { return vectorOf(scan.point(clash.scan_point)); }

  /// Where the obstacle's point of the closest pair is at the closest pose (swept: when the motion from there begins).
  /// Of a surface, the middle of the ball that is closest.
  Eigen::Vector3d modelPoint(const Clash& clash) const
  {
    return poses[static_cast<std::size_t>(clash.closest_pose)] * vectorOf(model.point(clash.model_point));
  }

  static Eigen::Vector3d vectorOf(const Point3& p) { return {p[0], p[1], p[2]}; }
};

inline constexpr std::array<std::pair<ClashStatus, const char*>, 3> status_names = {
    {{ClashStatus::fresh, "new"}, {ClashStatus::persisting, "persisting"}, {ClashStatus::resolved, "resolved"}}};

inline const char* nameOf(ClashStatus status)
{
  return status_names[static_cast<std::size_t>(status)].second;
}

/// What an obstacle is compared as: null where that is its points.
/// @param beside as promiseOf() takes it
Json surfaceJson(const Obstacle* surface, const std::string& beside = "");

/// One object per clash, with its closest pair unless it is resolved.
std::string clashJson(const ClashReport& report);

/// One clash a line, lengths in the clouds' unit, each with the digits that read back to the same bits. A resolved one
/// has no pair.
std::string clashCsv(const ClashReport& report);

/// A page that opens alone in a browser: a chart of the path, a table, and two pictures of each clash.
std::string clashPage(const ClashReport& report);

/// Writes what the extension says: .json, .csv or .html. The file appears complete or not at all.
/// @throws files::FileError
void writeClashes(const std::filesystem::path& path, const ClashReport& report);

/// @throws files::FileError when writeClashes() knows no such extension
void requireClashFormat(const std::filesystem::path& path);

/// What a run asked, and the clashes that it listed, without points and pairs.
struct ClashList {
  std::string input, obstacle; ///< file names
  double clearance = 0;
  std::optional<double> swept;
  std::vector<Clash> clashes;
};

/// What an earlier run listed, for compareWithEarlier().
/// @throws files::FileError when the file cannot be read, JsonError naming the place in it that no run would have
/// written
ClashList readClashes(const std::filesystem::path& path);

/// The same, of a text. @throws JsonError whose message begins with `name`
ClashList parseClashes(std::string_view text, const std::string& name);

/// Whether the earlier list, read from `path`, can tell what is new now.
/// @param now what this run asks; its clashes do not matter
/// @return warnings, a line each: names of other clouds, motion between poses tested in one run only
/// @throws files::FileError when the clearances differ, so that clashes between the two would seem new or resolved
std::vector<std::string> requireComparable(const std::filesystem::path& path, const ClashList& earlier,
                                           const ClashList& now);

/// The distance within which colliding points are one clash where the user says none: a power of two of at least the
/// clearance and four times the scan's spacing, so that it stays the same from run to run.
double clusterDistanceFor(double clearance, const Spacing& scan);

} // namespace pcl_bsh::io

// SPDX-License-Identifier: BSD-3-Clause
// Clashes as lists for programs (.json, .csv), compared with those of an earlier run, as a page for people
// (.html), and as topics for programs that coordinate models (.bcf, .bcfzip).
#pragma once

#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/clashes/former_places.h>
#include <pcl_bsh/clashes/unseen_places.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/json/json_document.h>
#include <pcl_bsh/io/reports/clash_list.h>
#include <pcl_bsh/neighbors/spacing.h>
#include <pcl_bsh/question/ask.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// Where a point of an input stood that is made of several files.
struct SourcePoint {
  std::string file;
  std::uint32_t record = 0;
};

/// All that a list of clashes tells, in the frame of the input. Clouds and result are borrowed.
struct ClashReport {
  ClashQuestion question;
  double cluster_distance = 0;
  std::vector<Clash> clashes;
  const PointsView& scan;
  const PointsView& model;
  const std::vector<Eigen::Isometry3d>& poses;
  const TrajectoryResult& found;
  Survey survey;
  std::string unit = {};                    ///< of the clouds' lengths; empty: not known
  std::string coordinate_system = {};       ///< of the input, where its file names one; else empty
  std::optional<std::string> previous = {}; ///< file name
  BcfTopics topics = {};                    ///< what people said of its clashes
  const Obstacle* surface = nullptr;        ///< the obstacle, where it is one; `model` are its triangles
  const Answer::Unseen* unseen = nullptr;   ///< of a question with `seen` and `unseen_places`
  /// Of a point of `scan`, where the input is several files.
  std::function<SourcePoint(std::uint32_t)> source_of = nullptr;
  /// The same of a point of `model`.
  std::function<SourcePoint(std::uint32_t)> model_source_of = nullptr;

  /// Of the obstacle: a point, or a triangle.
  const char* partName() const { return surface != nullptr ? surface->partName() : "point"; }

  std::size_t count(ClashStatus status) const
  {
    return countIf([&](const Clash& clash) { return clash.status == status; });
  }

  /// Clashes that are there now.
  std::size_t present() const
  {
    return countIf([](const Clash& clash) { return isPresent(clash.status); });
  }

  /// Of these, those that collide only perhaps.
  std::size_t perhaps() const
  {
    return countIf([](const Clash& clash) { return isPresent(clash.status) && !clash.isCertain(); });
  }

  Eigen::Vector3d scanPoint(const Clash& clash) const { return vectorOf(scan.point(clash.scan_point)); }

  /// Where the obstacle's point of the closest pair is at the closest pose (swept: when the motion from there begins).
  /// Of a surface, the point of the triangle that is nearest to the scan's, rounded.
  Eigen::Vector3d modelPoint(const Clash& clash) const;

  static Eigen::Vector3d vectorOf(const Point3& p) { return {p[0], p[1], p[2]}; }

private:
  template <typename Condition>
  std::size_t countIf(const Condition& condition) const
  {
    return static_cast<std::size_t>(std::count_if(clashes.begin(), clashes.end(), condition));
  }
};

/// givenOptions() as an object.
Json optionsJson(const Question& question);

/// What an obstacle is compared as: null where that is its points.
Json surfaceJson(const Obstacle* surface, bool solid);

/// What of an obstacle is unseen, without `where`.
Json unseenJson(const Answer::Unseen& unseen);

/// One object per clash, with its closest pair if it is there now.
std::string clashJson(const ClashReport& report);

/// One clash a line, lengths in the clouds' unit, each with the digits that read back to the same bits. One that is not
/// there now has no pair. What was asked is repeated in each line.
std::string clashCsv(const ClashReport& report);

/// A page that opens alone in a browser: a chart of the path, a table, and two pictures of each clash.
std::string clashPage(const ClashReport& report);

/// A topic for each clash, with a viewpoint, as an archive of BCF 3.0 or 2.1. The GUID of a topic follows from the id
/// of its clash. Status, comments and who is to act are those of `topics`; what is resolved is closed, what is new
/// open. With the list of clashJson() as a document. Coordinates of viewpoints are in metres where the unit is known.
std::string clashBcf(const ClashReport& report, bool is_version_3);

/// Writes what the extension says: .json, .csv, .html, .bcf (3.0) or .bcfzip (2.1). The file appears complete or not at
/// all.
/// @throws files::FileError
void writeClashes(const std::filesystem::path& path, const ClashReport& report);

/// @throws files::FileError when writeClashes() knows no such extension. As reportDate()
void requireClashFormat(const std::filesystem::path& path);

/// How many there are, as programs tell it in a line: "3 clashes, 140 perhaps, 2 resolved".
std::string clashCounts(const ClashReport& report);

/// The clashes of two clouds in memory, and what of the obstacle is unseen. All but the question is borrowed.
ClashReport clashesOf(ClashQuestion question, const SphereHierarchy& scan, const SphereHierarchy& model,
                      const std::vector<Eigen::Isometry3d>& poses, const Answer& answer, double cluster_distance,
                      const Obstacle* surface);

/// Appends what of the obstacle is unseen along the path (findUnseenPlaces()), where that was asked. Before lists are
/// compared.
void listUnseen(ClashReport& report);

/// Tells which of the report's clashes were in the earlier list, and appends those that are not found again: resolved,
/// or not visited, unseen or not scanned.
/// @param file that the earlier list was read from
/// @param look tells FormerPlaces the model and the scan of this run; not called where nothing is resolved
/// @return warnings of surveyWarnings()
std::vector<std::string> compareWithList(ClashReport& report, const std::filesystem::path& file,
                                         const ClashList& earlier, const std::function<void(FormerPlaces&)>& look);

/// As above, of what clashesOf() made of these hierarchies.
std::vector<std::string> compareWithList(ClashReport& report, const std::filesystem::path& file,
                                         const ClashList& earlier, const SphereHierarchy& scan,
                                         const SphereHierarchy& model);

/// The distance within which colliding points are one clash where the user says none: a power of two of at least the
/// clearance and four times the scan's spacing, so that it stays the same from run to run.
double clusterDistanceFor(double clearance, const Spacing& scan);

} // namespace pcl_bsh::io

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
#include <pcl_bsh/io/reports/kept_obstacles.h>
#include <pcl_bsh/neighbors/spacing.h>
#include <pcl_bsh/question/obstacles.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::io {

/// Clashes of the input with an obstacle, in the frame of the input. Clouds and result are borrowed.
struct ClashReport {
  ClashQuestion question;
  double cluster_distance = 0;
  std::vector<Clash> clashes;
  const PointsView& scan;
  const PointsView& model;
  const std::vector<Eigen::Isometry3d>& poses;
  const TrajectoryResult& found; ///< its counts and poses; `clashes` have what is known of records
  Survey survey;
  std::string unit = {};                    ///< of the clouds' lengths; empty: not known
  std::string coordinate_system = {};       ///< of the input, where its file names one; else empty
  std::optional<std::string> previous = {}; ///< file name
  BcfTopics topics = {};                    ///< comments and states that people gave its clashes
  const Obstacle* surface = nullptr;        ///< the obstacle, if it is a surface; `model` are its triangles
  const Answer::Unseen* unseen = nullptr;   ///< of a question with `seen` and `unseen_places`
  /// The source of a point of `scan`, where the input is several files.
  std::function<SourcePoint(std::uint32_t)> source_of = nullptr;
  /// The source of a point of `model`, where the obstacle is several files.
  std::function<SourcePoint(std::uint32_t)> model_source_of = nullptr;
  std::string name = {};                  ///< of the obstacle, where it is one of several
  const ObstacleAnswer* answer = nullptr; ///< set where the obstacle is one of several
  const KeptObstacle* kept = nullptr;     ///< set where it is not asked about: there are no points to draw

  /// Returns the id in lists and pages: of several obstacles, it begins with the obstacle's name.
  std::string idOf(const Clash& clash) const { return name.empty() ? clash.id : name + '/' + clash.id; }

  /// Returns the name of a record of the obstacle: "point" or "triangle".
  const char* partName() const
  {
    if (kept != nullptr) return kept->partName();
    return surface != nullptr ? surface->partName() : "point";
  }

  std::size_t count(ClashStatus status) const
  {
    return countIf([&](const Clash& clash) { return clash.status == status; });
  }

  /// Whether a clash can be drawn: it is there now, and the report has its points.
  bool draws(const Clash& clash) const { return isPresent(clash.status) && kept == nullptr; }

  /// Clashes that are there now.
  std::size_t present() const
  {
    return countIf([](const Clash& clash) { return isPresent(clash.status); });
  }

  /// Present clashes that collide only perhaps.
  std::size_t perhaps() const
  {
    return countIf([](const Clash& clash) { return isPresent(clash.status) && !clash.isCertain(); });
  }

  Eigen::Vector3d scanPoint(const Clash& clash) const
  {
    return vectorOf(kept != nullptr ? clash.place : scan.point(clash.scan_point));
  }

  /// Returns the obstacle's point of the closest pair at the closest pose (swept: when the motion from there begins).
  /// Where the obstacle is a surface, it is the triangle's point that is nearest to the scan's, rounded.
  Eigen::Vector3d modelPoint(const Clash& clash) const;

  static Eigen::Vector3d vectorOf(const Point3& p) { return {p[0], p[1], p[2]}; }

private:
  template <typename Condition>
  std::size_t countIf(const Condition& condition) const
  {
    return static_cast<std::size_t>(std::count_if(clashes.begin(), clashes.end(), condition));
  }
};

/// How two obstacles stand to each other.
struct BetweenObstacles {
  std::string first, second; ///< names
  ObstaclePair pair;
};

/// The contents of a list of clashes, of one obstacle or of several with names. Borrows as its reports do.
struct ClashLists {
  std::vector<ClashReport> obstacles; ///< one at least
  std::vector<BetweenObstacles> between = {};

  ClashLists() = default;
  /** The list of one obstacle. */ ClashLists(ClashReport report) { obstacles.push_back(std::move(report)); }

  /// Whether obstacles have names, and clashes tell these.
  bool haveNames() const { return !obstacles.front().name.empty(); }

  /// Each clash with its obstacle; of several obstacles the most severe first, then those that are gone.
  std::vector<std::pair<const ClashReport*, const Clash*>> bySeverity() const;

  std::size_t present() const { return sum(&ClashReport::present); } ///< clashes that are there now
  std::size_t perhaps() const { return sum(&ClashReport::perhaps); } ///< those that collide only perhaps
  std::size_t count(ClashStatus status) const;

private:
  std::size_t sum(std::size_t (ClashReport::*of)() const) const;
};

/// Both records of a pair, or null.
Json pairJson(const std::optional<PointPair>& pair);

/// certain, perhaps or unseen.
const char* certaintyOf(const Clash& clash);

/// Returns the state of an obstacle: clash, perhaps, sparse, unseen or clear.
const char* nameOfState(Verdict verdict);
const char* nameOfState(const ObstacleAnswer& found); ///< or ignored

/// givenOptions() as an object.
Json optionsJson(const Question& question);

/// Tells that an obstacle is compared as a surface; null where its points are compared.
Json surfaceJson(const Obstacle* surface, bool solid);

/// The unseen records of an obstacle, without `where`.
Json unseenJson(const Answer::Unseen& unseen);

/// The question about an obstacle and its answer; the answer about two obstacles.
/// @param nearest the input's point of the closest pair, where the input is several files
/// @param surface surfaceJson()
Json obstacleJson(const std::string& name, const ClashQuestion& question, Json surface, const ObstacleAnswer& found,
                  const std::optional<SourcePoint>& nearest = std::nullopt);
Json betweenJson(const BetweenObstacles& two);

/// Both ends of an area in four digits; one number where they agree. Empty without an area.
std::string areaText(const std::optional<Interval>& area);

/// One object per clash, with its closest pair if it is there now. Several obstacles have one object each, too.
std::string clashJson(const ClashLists& lists);

/// One clash a line, lengths in the clouds' unit, each with the digits that read back to the same bits. One that is not
/// there now has no pair. Each line repeats the question.
std::string clashCsv(const ClashLists& lists);

/// A page that opens alone in a browser: a chart of the path, tables, and two pictures of each clash.
std::string clashPage(const ClashLists& lists);

/// A topic for each clash, with a viewpoint, as an archive of BCF 3.0 or 2.1. The GUID of a topic follows from the id
/// of its clash. Status, comments and assignees are those of `topics`. Resolved clashes are closed, new ones are open.
/// With the list of clashJson() as a document, and with a picture of each clash (the 200 most severe of those that are
/// there) where this was built with librsvg. Coordinates of viewpoints are in metres where the unit is known.
std::string clashBcf(const ClashLists& lists, bool is_version_3);

/// Writes the format that the extension names: .json, .csv, .html, .bcf (3.0) or .bcfzip (2.1). The file appears
/// complete or not at all.
/// @return what users should know of it; usually empty
/// @throws files::FileError
std::vector<std::string> writeClashes(const std::filesystem::path& path, const ClashLists& lists);

/// @throws files::FileError when writeClashes() knows no such extension; as reportDate() does
void requireClashFormat(const std::filesystem::path& path);

/// Counts the clashes in a line, as programs print it: "3 clashes, 140 perhaps, 2 resolved".
std::string clashCounts(const ClashLists& lists);

/// Appends the unseen places of the obstacle along the path (findUnseenPlaces()), where they were asked for. To be
/// called before lists are compared.
void listUnseen(ClashReport& report);

/// Tells which of the report's clashes were in the earlier list, and appends those that are not found again: resolved,
/// or not visited, unseen or not scanned.
/// @param file that the earlier list was read from
/// @param look tells FormerPlaces the model and the scan of this run; not called where nothing is resolved
/// @return warnings of surveyWarnings()
std::vector<std::string> compareWithList(ClashReport& report, const std::filesystem::path& file,
                                         const ClashList& earlier, const std::function<void(FormerPlaces&)>& look);

/// Names of obstacles in the earlier lists that are not asked about now, a warning each.
std::vector<std::string> warningsOfGone(const ClashLists& lists, const std::filesystem::path& file,
                                        const std::vector<ClashList>& earlier);

/// Calls the function above with a `look` that tells FormerPlaces these hierarchies.
std::vector<std::string> compareWithList(ClashReport& report, const std::filesystem::path& file,
                                         const ClashList& earlier, const SphereHierarchy& scan,
                                         const SphereHierarchy& model);

/// Returns the default distance within which colliding points are one clash. It is a power of two, and at least the
/// clearance and four times the scan's spacing. So scans of similar spacing have equal distances.
double clusterDistanceFor(double clearance, const Spacing& scan);

} // namespace pcl_bsh::io

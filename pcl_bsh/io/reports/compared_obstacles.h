// SPDX-License-Identifier: BSD-3-Clause
// Obstacles from files in one question, and the list of their clashes: for programs and stages.
//
//   std::vector<ComparedObstacle> all = ...; // one without a name, or several with names
//   const ObstaclesAnswer found = askAbout(question, scan, shapes, all);
//   writeClashes("clashes.html", listOf(listing, scan, hierarchies, all, found.all, warnings));
#pragma once

#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/question/obstacle_names.h>
#include <pcl_bsh/question/obstacles.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// An obstacle, the question about it, and its answer.
struct ComparedObstacle {
  std::string name; ///< empty: it is alone
  std::string file;
  Obstacle loaded = {};
  CloudFacts facts = {};
  Question question = {};
  Answer answer = {};              ///< where it is one of several; `collisions` are empty
  CollidingRecords colliding = {}; ///< of that answer
  ObstacleAnswer found = {};
  std::vector<Eigen::Isometry3d> poses = {};
  bool asked = true;                  ///< about the input; else an earlier list tells of it
  const KeptObstacle* kept = nullptr; ///< what that list tells: after ClashListing::keep()

  const char* partName() const { return kept ? kept->partName() : loaded.partName(); } ///< "point" or "triangle"
};

/// Asks about the only obstacle, or about several with names. Where collisions are asked for, each of several keeps the
/// question about it and its answer. The answer about the only one is in `all` alone.
/// @param shapes those of `obstacles`
/// @throws as ask() does
ObstaclesAnswer askAbout(const Question& question, Shape& input, std::vector<PlacedShape>& shapes,
                         std::vector<ComparedObstacle>& obstacles);

/// The greatest clearance of the questions about obstacles.
double greatestClearance(const std::vector<ComparedObstacle>& obstacles);

/// askBetween() by names.
std::vector<BetweenObstacles> askBetween(const Question& question, std::vector<PlacedShape>& shapes,
                                         const std::vector<ComparedObstacle>& obstacles, const IgnoredPairs& ignored);

/// obstacleJson() of one of several.
/// @param input its name. @param nearest as obstacleJson() takes it
Json obstacleJson(const ComparedObstacle& one, const std::string& input,
                  const std::optional<SourcePoint>& nearest = std::nullopt);

/// One line for each of several obstacles, and for each two in `between`. @param part name of a record of the input
std::string summaryOf(const std::vector<ComparedObstacle>& obstacles, const std::vector<BetweenObstacles>& between,
                      const char* part);

/// How the clashes of obstacles are listed.
struct ClashListing {
  std::string input; ///< its name
  std::string unit = {}, coordinate_system = {};
  std::optional<double> cluster_distance = {};        ///< none: from the greatest clearance and the input's spacing
  std::optional<std::filesystem::path> previous = {}; ///< file of an earlier list
  std::vector<ClashList> earlier = {};                ///< of that file
  std::optional<KeptObstacles> kept = {};             ///< of that file: those that are not asked about
  std::vector<BetweenObstacles> between = {};

  /// Reads the earlier list. Where it tells of obstacles that are not asked about, its cluster distance is used.
  /// @param obstacles with names, files and questions
  /// @param warnings gets what requireComparable() tells
  /// @throws as readClashLists() and requireComparable() do
  void readEarlier(const std::vector<ComparedObstacle>& obstacles, std::vector<std::string>& warnings);

  /// Gives obstacles that are not asked about the answers of the earlier list. To be called after readEarlier(), with
  /// `unit` and `coordinate_system`. @pre some are kept
  /// @param scan box of the input. @param warnings gets a line
  /// @throws as KeptObstacles::requireSame() does
  void keep(std::vector<ComparedObstacle>& obstacles, const IgnoredPairs& ignored, const std::optional<Extent>& scan,
            std::vector<std::string>& warnings) const;

  /// The list of an obstacle whose answer is of the earlier list. Borrows it.
  ClashReport keptReport(ComparedObstacle& one, double distance, const std::optional<Extent>& scan) const;

  /// Compares the list of an obstacle with its earlier one, where there is one. @param compared calls compareWithList()
  void compare(ClashReport& list, const std::function<std::vector<std::string>(const ClashList&)>& compared,
               std::vector<std::string>& warnings) const;

  /// Adds `between`, and warnings about obstacles that only the earlier list has. To be called when the lists of all
  /// obstacles are there.
  void complete(ClashLists& lists, std::vector<std::string>& warnings) const;
};

/// The list of all clashes. Borrows `obstacles`, hierarchies and `alone`.
/// @param hierarchies of `obstacles`. @param alone the answer about the only obstacle; of several, their common one
/// @param warnings gets those of the comparison with the earlier list
ClashLists listOf(const ClashListing& listing, const SphereHierarchy& scan,
                  const std::vector<const SphereHierarchy*>& hierarchies, std::vector<ComparedObstacle>& obstacles,
                  const Answer& alone, std::vector<std::string>& warnings);

} // namespace pcl_bsh::io

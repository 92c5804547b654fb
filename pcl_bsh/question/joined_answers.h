// SPDX-License-Identifier: BSD-3-Clause
// The answers about several obstacles as one: of a cloud, and of each tile of a site.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/question/obstacles.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN // for sites
namespace pcl_bsh {

/// Joins the answers about obstacles, one after another.
class JoinedAnswers {
public:
  /// @param records of the input. @param wanted which the caller keeps
  JoinedAnswers(std::size_t records, const Wanted& wanted) : records_(records), wanted_(wanted) {}

  /// Adds the answer about an obstacle, whose number is at least that of the last one. Vectors may be empty.
  void add(std::uint32_t obstacle, const Answer& answer);

  /// Adds the answer about collisions with an obstacle that is told of some records alone.
  /// @param records of the input, ascending, to which the entries of `found` belong; all others are free
  void add(std::uint32_t obstacle, const std::vector<std::int32_t>& records, const TrajectoryResult& found);

  /// Tells of the obstacle that was added last where it is nearest, if nothing collides with it.
  void setClosest(const DistanceResult& closest, std::int32_t pose);

  /// Adds an obstacle that is not asked about.
  void skip() { joined_.each.emplace_back().asked = false; }

  /// The answer has an entry for each record also where nothing was asked about the obstacles one by one.
  void fill(std::size_t poses);

  /// @param moves whether there is a path
  ObstaclesAnswer finish(bool moves);

private:
  static ObstacleAnswer summaryOf(const Answer& answer);
  void addCollisions(std::uint32_t obstacle, const TrajectoryResult& more, const std::vector<std::int32_t>* records);
  void addDistances(std::uint32_t obstacle, const PointDistances& more, const std::vector<std::uint8_t>& within);
  void addLists(const CollidingIndices& more);

  const std::size_t records_;
  const Wanted& wanted_;
  ObstaclesAnswer joined_;
};

/// The smallest distance of what collides along a path, as it is told, with its pair: of several, the first record's.
DistanceResult closestOf(const TrajectoryResult& found);

/// Refuses paths of obstacles that do not belong together. @throws InvalidInput
void requirePaths(const Question& question, const std::vector<PlacedShape>& obstacles);

/// The interval of a smallest distance holds those of all that may have it. @param all as it begins, nothing is known
void widen(Interval& all, const Interval& one);

/// The smallest distance at any of the poses, and the first pose that has it. Motion between poses does not count.
/// @param most no greater one is found, inclusive
std::pair<DistanceResult, std::int32_t> closestAlong(const Placed& input, const SphereHierarchy& obstacle,
                                                     const std::vector<Eigen::Isometry3d>& poses,
                                                     double most = std::numeric_limits<double>::infinity());

/// Whether a query about any collision at the one pose may spare the rest: nothing but what collides is told of the
/// records.
bool mayAskAny(const Question& question);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

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
  /// @param records of the input. @param wanted must outlive this
  JoinedAnswers(std::size_t records, const Wanted& wanted) : records_(records), wanted_(wanted) {}

  /// Adds the answer about an obstacle, whose number is at least that of the last one. Vectors may be empty.
  void add(std::uint32_t obstacle, const Answer& answer);

  /// Adds collisions with an obstacle that are told for some records alone.
  /// @param records of the input, ascending, to which the entries of `found` belong; all others are free
  void add(std::uint32_t obstacle, const std::vector<std::int32_t>& records, const TrajectoryResult& found);

  /// Sets the smallest distance of the obstacle that was added last, for an obstacle that nothing collides with.
  void setClosest(const DistanceResult& closest, std::int32_t pose);

  /// Adds an obstacle that is not asked about.
  void skip() { joined_.each.emplace_back().asked = false; }

  /// Gives the wanted vectors their entries, also where no obstacle's answer has any.
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

/// Returns the smallest told distance of records that collide along a path, with its pair. Among equal distances it is
/// the first record's.
DistanceResult closestOf(const TrajectoryResult& found);

/// Refuses paths of obstacles that do not belong together. @throws InvalidInput
void requirePaths(const Question& question, const std::vector<PlacedShape>& obstacles);

/// Turns the interval of the least of several distances into that with one more: the least lower and the least upper
/// end.
/// @param all an infinite lower end: nothing is known yet
void widen(Interval& all, const Interval& one);

/// The smallest distance at any of the poses, and the first pose that has it. Motion between poses does not count.
/// @param most no greater one is found, inclusive
std::pair<DistanceResult, std::int32_t> closestAlong(const Placed& input, const SphereHierarchy& obstacle,
                                                     const std::vector<Eigen::Isometry3d>& poses,
                                                     double most = std::numeric_limits<double>::infinity());

/// Whether anyCollision() is worth asking first: collisions at one pose are wanted, without `seen`, `density` or an
/// early stop. Where its verdict is free, no other query about collisions is needed.
bool mayAskAny(const Question& question);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

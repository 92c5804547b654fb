// SPDX-License-Identifier: BSD-3-Clause
// A question's answer, in the user's own records, with what users should know beside it.
#pragma once

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/question/question.h>
#include <pcl_bsh/question/shape.h>
#include <pcl_bsh/question/warnings.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// What was wanted; the rest is as a new Answer has it. Vectors have an entry for each record of the input's points or,
/// where it is a surface, for each of its triangles. Of an obstacle that is a surface, free is farther than the
/// clearance from it for certain, colliding is within clearance + tolerance, and a distance d says that the true one is
/// in [d, d + tolerance]; the tolerance of an input comes on top.
struct Answer {
  /// Flags, contacts (distance, first_pose, closest_pose, closest_point: a record of the obstacle's hierarchy, which
  /// Shape::part() knows), poses, and how many points collide or are undecided; at one pose alike. Along a path,
  /// distances are in `distance` and `closest_pose`, too.
  TrajectoryResult collisions;
  std::size_t sparse = 0;                 ///< points that are undecided for want of density, not among `undecided`
  DistanceResult closest;                 ///< its pair: part() of the input's record and of the obstacle's
  std::array<Point3, 2> closest_places{}; ///< of that pair, each in its own frame; of a surface, a ball's middle
  SymmetricDistances distances;           ///< `nearest` is a record of the other hierarchy; NaN beyond max_distance
  std::vector<Verdict> obstacle_flags;    ///< where wanted, of the records of the obstacle's hierarchy
  std::vector<std::uint8_t> within;       ///< 1: within the limits
  double widest_gap = 0.0;                ///< of the density guard; 0: it guarded nothing
  Density density;                        ///< where spacings are wanted
  Work work;                              ///< of all queries
  std::vector<Warning> warnings;
};

/// Builds what is not built yet.
/// @throws InvalidInput as checkOptions() and Shape::hierarchy() do, and the queries; InvalidOption for a density
///   guard, or limits, of an input that is a surface. Cancelled
Answer ask(const Question& question, Shape& input, Shape& obstacle);

/// Refuses what ask() would refuse whatever the two things are, before they are there. Throws likewise.
void check(const Question& question);

/// What verdicts and distances mean where the obstacle is a surface, in one sentence.
/// @param beside whose tolerance comes on top: besideSurface(); empty: none
std::string promiseOfObstacle(const SurfaceCover& surface, const std::string& beside = {});

/// The same of an input.
std::string promiseOfInput(const SurfaceCover& surface);

/// Whose tolerance comes on top of a surface's; empty: none.
std::string besideSurface(const Accuracy& accuracy, bool swept);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

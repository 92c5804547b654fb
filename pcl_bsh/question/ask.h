// SPDX-License-Identifier: BSD-3-Clause
// A question's answer, in the user's own records, with what users should know beside it.
#pragma once

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/question/question.h>
#include <pcl_bsh/question/shape.h>
#include <pcl_bsh/question/warnings/warnings.h>
#include <pcl_bsh/seen/unseen_points.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <cstdint>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The answer to a question. Members that are not wanted keep their defaults. Vectors have one entry for each record of
/// the input: a point or, where the input is a surface, a triangle. The inside of a closed surface counts only where
/// the surface is asked as a solid. Then records inside collide, at a negative distance, and so do the triangles of the
/// body that holds them.
struct Answer {
  /// Flags, contacts (distance, first_pose, closest_pose, closest_point: a record of the obstacle), poses, and how many
  /// points collide or are undecided; also at one pose. Along a path, distances are in `distance` and `closest_pose`,
  /// too. Swept, an entry of `poses` is about the motion from its pose to the next, and the last entry about the last
  /// pose.
  TrajectoryResult collisions;
  /// With Wanted::poses, for each pose at which anything collides, or may: the pair with the smallest distance. Among
  /// equal distances it is the smallest (input, obstacle).
  std::vector<std::optional<PointPair>> pose_pairs;
  AnyResult any; ///< its pair: with a solid, the record that is held, and a triangle of the body that holds it
  CollidingIndices indices;
  std::size_t sparse = 0;              ///< points that are undecided for want of density, not among `undecided`
  DistanceResult closest;              ///< its pair: records of the input and of the obstacle
  SymmetricDistances distances;        ///< `closest_point` is a record of the other hierarchy; NaN beyond max_distance
  std::vector<Verdict> obstacle_flags; ///< where wanted or with `seen`, of the obstacle's records; along a path the
                                       ///< gravest verdict of its poses

  /// With `seen`: points of the obstacle, or triangles where it is a surface, that are unseen.
  struct Unseen {
    std::size_t count = 0;                 ///< unseen at some pose, and of no graver verdict at any
    std::vector<std::size_t> at_poses;     ///< how many at each pose
    std::optional<std::size_t> first_pose; ///< the first pose with any
    std::vector<double> angles;            ///< of each scan: the angle within which its beams count, in radians
    std::vector<std::vector<bool>> where;  ///< with Wanted::unseen_places: at each pose, per record; empty: none
    std::vector<UnseenKinds> kinds;        ///< kinds of these

    // In shadow no beam passed the place itself. All other unseen records are in the skin: beams passed, but not by the
    // margin.
    std::size_t in_shadow = 0;                ///< of `count`: in shadow at some pose
    std::vector<std::size_t> shadow_at_poses; ///< of `at_poses`
    std::vector<bool> shadow;                 ///< per record: whether it is in shadow at some pose

    std::size_t inSkin() const { return count - in_shadow; } ///< of `count`, at no pose in shadow

    /// At each pose, the volume of cubes that collide with nothing and whose middles are in shadow. The cubes cover the
    /// inside of the obstacle, a solid. Their edges are at least 1/48 of its longest side.
    std::vector<double> inside;

    /// Adds the answer of the next pose. @param gravest the gravest verdict of each record at all poses before: updated
    /// @param of the kinds from markUnseen(); without `in_shadow` nothing is in shadow
    void addPose(const std::vector<Verdict>& found, bool with_places, std::vector<Verdict>& gravest,
                 UnseenKinds of = {});
  };
  Unseen unseen;
  std::vector<std::uint8_t> within; ///< 1: within the limits
  double widest_gap = 0.0;          ///< of the density guard; 0: it guarded nothing
  Density density;                  ///< where spacings are wanted
  Work work;                        ///< of all queries
  std::vector<Warning> warnings;
};

/// Answers a question. Hierarchies that are not built yet are built.
/// @throws InvalidInput as checkOptions() and Shape::hierarchy() do, and the queries; InvalidOption for a density
///   guard of an input that is a surface. Cancelled
Answer ask(const Question& question, Shape& input, Shape& obstacle);

/// Refuses the question where ask() would refuse it for any input and any obstacle. @throws InvalidInput
void check(const Question& question);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

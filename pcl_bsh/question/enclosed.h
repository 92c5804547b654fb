// SPDX-License-Identifier: BSD-3-Clause
// Adds the records that solids hold to results of queries about surfaces, for callers that run queries besides ask().
#pragma once

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/question/question.h>
#include <pcl_bsh/question/shape.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <Eigen/Geometry>

#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Adds enclosed records to the members of `found` that are there, along the question's path, as ask() does. Does
/// nothing where neither thing is asked as a solid. Distances of enclosed records are negative: the depth at the pose
/// where the record is deepest.
/// @param pivot of swept motion, as the query had it. @throws as ask() does of solids
void addEnclosed(const Question& question, Shape& input, Shape& obstacle, TrajectoryResult& found,
                 const Point3& pivot = {0, 0, 0});

/// Turns verdicts at poses of the obstacle, or of motions that begin there, into colliding where a solid holds a
/// record.
/// @param verdicts of the surfaces, one for each pose
void addEnclosed(const Question& question, Shape& input, Shape& obstacle, const std::vector<Eigen::Isometry3d>& poses,
                 std::vector<Verdict>& verdicts);

/// Turns distances at poses where a solid holds a record into negative depths, and pairs into those of the deepest
/// record.
/// @param distances of the surfaces, one for each pose @param pairs that have these distances; empty: nothing is done
void addEnclosed(const Question& question, Shape& input, Shape& obstacle, const std::vector<Eigen::Isometry3d>& poses,
                 std::vector<double>& distances, std::vector<PointPair>& pairs);

/// Adds enclosed records at the question's poses of the two.
void addEnclosed(const Question& question, Shape& input, Shape& obstacle, DistanceResult& closest);
void addEnclosed(const Question& question, Shape& input, Shape& obstacle, PointDistances& distances); ///< of the input
void addEnclosed(const Question& question, Shape& input, Shape& obstacle, AnyResult& found);

/// @param found has the flags of both sides where places are uncertain
void addEnclosed(const Question& question, Shape& input, Shape& obstacle, FlagsResult& found);

/// Options of closestPair() for two things of which one or both are solids.
struct SolidDistanceRequest : DistanceRequest {
  using DistanceRequest::DistanceRequest;
  bool solid = false;       ///< b counts with what its faces enclose: they must close
  bool input_solid = false; ///< a does
};

/// Returns the smallest distance. Where a solid holds anything, it is the depth of the deepest record, less than 0;
/// triangles have an interval, too. The pair is the deepest record and the triangle of the solid nearest to its deepest
/// place.
/// @throws as closestPair() does of surfaces; InvalidOption for a solid without faces, InvalidInput where these do not
///   close
DistanceResult closestPair(const Placed& a, const Placed& b, const SolidDistanceRequest& request);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

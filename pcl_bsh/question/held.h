// SPDX-License-Identifier: BSD-3-Clause
// What solids hold, for who runs queries that no question has: added to what these found of the surfaces.
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

/// As ask() adds it along the question's path, to all that is there; nothing where neither thing is asked as a solid.
/// Distances of what is held are depths, less than 0: at the pose where it is deepest.
/// @param pivot of swept motion, as the query had it. @throws as ask() does of solids
void addHeld(const Question& question, Shape& input, Shape& obstacle, TrajectoryResult& found,
             const Point3& pivot = {0, 0, 0});

/// Of the obstacle at each of these poses, or on motions that begin there.
/// @param verdicts of the surfaces, one for each pose: what is held collides
void addHeld(const Question& question, Shape& input, Shape& obstacle, const std::vector<Eigen::Isometry3d>& poses,
             std::vector<Verdict>& verdicts);

/// @param distances of the surfaces, one for each pose, and where there are any, @param pairs that realise them: those
///   of what is held become negative
void addHeld(const Question& question, Shape& input, Shape& obstacle, const std::vector<Eigen::Isometry3d>& poses,
             std::vector<double>& distances, std::vector<PointPair>& pairs);

/// Of the two as they stand.
void addHeld(const Question& question, Shape& input, Shape& obstacle, DistanceResult& closest);
void addHeld(const Question& question, Shape& input, Shape& obstacle, PointDistances& distances); ///< of the input
void addHeld(const Question& question, Shape& input, Shape& obstacle, AnyResult& found);

/// @param found has the flags of both sides where places are uncertain
void addHeld(const Question& question, Shape& input, Shape& obstacle, FlagsResult& found);

/// Options of closestPair() for two things of which one or both are solids.
struct SolidDistanceRequest : DistanceRequest {
  using DistanceRequest::DistanceRequest;
  bool solid = false;       ///< b counts with what its faces enclose: they must close
  bool input_solid = false; ///< a does
};

/// The smallest distance, which is less than 0 where a solid holds anything: the depth of the deepest, of triangles
/// with an interval. The pair is the deepest record and the triangle of the solid nearest to its deepest place.
/// @throws as closestPair() does of surfaces; InvalidOption for a solid without faces, InvalidInput where these do not
///   close
DistanceResult closestPair(const Placed& a, const Placed& b, const SolidDistanceRequest& request);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

// SPDX-License-Identifier: BSD-3-Clause
// A surface that is asked about: from answers about the balls of its cover to answers about its triangles.
//
//   SurfaceRequest request;
//   request.tolerance = 0.002;
//   request.triangles_apart = true;
//   SurfaceCover part = coverSurface(viewOf(vertices_xyz, n), triangles, request);
//   FlagsResult hit = collisionFlags({SphereHierarchy(part.view())}, {robot}, {0.02});
//   std::vector<Verdict> verdicts = triangleVerdicts(part, hit.a);
//
// Of a triangle and a cloud of points (or the balls of another surface's cover),
//   free       means farther apart than the clearance, for certain;
//   colliding  means within clearance + tolerance, or within clearance + both tolerances where both are surfaces.
// A distance between them is at least that of the nearest ball, and at most that much more.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/surface/surface_cover.h>

#include <cstddef>
#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// One per triangle. It collides if one of its balls does; else it is undecided if one is, sparse
/// if one is, and free.
/// @param ball_verdicts one per ball of the cover, as FlagsResult and TrajectoryResult have them
/// @throws std::invalid_argument (Input::surface) when the cover's balls hold parts of several triangles each
///   (SurfaceRequest::triangles_apart); (Input::result) when there is not one value per ball, or one is no Verdict.
///   The functions below throw likewise.
std::vector<Verdict> triangleVerdicts(const SurfaceCover& cover, const std::vector<Verdict>& ball_verdicts);

/// Per triangle the ball of its smallest distance, of several that of the smallest pose, then of the smallest number.
/// kNothing where no ball has a distance. Whatever was found out about that ball (its distance, the pose, the nearest
/// point) holds of the triangle.
/// @param distances one per ball; NaN: none
/// @param closest_poses one per ball, or empty
std::vector<std::uint32_t> nearestBalls(const SurfaceCover& cover, const std::vector<double>& distances,
                                        const std::vector<std::int32_t>& closest_poses = {});
std::vector<std::uint32_t> nearestBalls(const SurfaceCover& cover, const std::vector<float>& distances,
                                        const std::vector<std::int32_t>& closest_poses = {});

/// Per triangle the first pose at which one of its balls collides; kNothing (-1) where none does. At no earlier pose is
/// the triangle within the clearance.
/// @param first_poses one per ball; kNothing: none
std::vector<std::int32_t> triangleFirstPoses(const SurfaceCover& cover, const std::vector<std::int32_t>& first_poses);

/// Per triangle the value of its ball. @param none where it has none
template <typename Value>
std::vector<Value> ofBalls(const std::vector<std::uint32_t>& balls, const std::vector<Value>& values, Value none)
{
  std::vector<Value> chosen;
  chosen.reserve(balls.size());
  for (const std::uint32_t ball : balls) chosen.push_back(ball == kNothing ? none : values.at(ball));
  return chosen;
}

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

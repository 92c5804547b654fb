// SPDX-License-Identifier: BSD-3-Clause
// The normal of the surface where a contact is.
#pragma once

#include <pcl_bsh/manifold/candidate_search.h>
#include <pcl_bsh/neighbors/neighbors.h>

#include <Eigen/Geometry>

namespace pcl_bsh {

struct SurfaceNormal {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(); ///< of length 1, or 0 where there is no direction
  double residual = 0.0;                            ///< of a fitted plane
};

/// Returns the normal for a channel of places against triangles. It points out of the surface where that encloses the
/// probe, else towards the probe.
/// @param nearest place of the triangle, in the world
SurfaceNormal normalOfTriangle(const Channel& channel, const Candidate& of, const Eigen::Vector3d& nearest);

/// The normal of points or balls of b, towards a's. @param fit radius of planes that are fitted @param scratch memory
SurfaceNormal normalOfPoints(const Collider::Parts& a, const Collider::Parts& b, const Channel& channel,
                             const Candidate& of, double fit, Neighbors& scratch);

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// How deep is what a solid holds along a path, at which pose, and at which place?
#pragma once

#include <pcl_bsh/depths/depths.h>
#include <pcl_bsh/depths/queried_part.h>
#include <pcl_bsh/geometry/point3.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh {

/// The solid goes from pose to pose, or the queried thing does.
struct DepthPath {
  const std::vector<Eigen::Isometry3d>& poses; ///< of what moves, in the world
  Eigen::Isometry3d at_rest;                   ///< the pose of the other
  bool solid_moves = true;
  std::optional<double> swept = {}; ///< > 0: the motion between poses counts, too, to this tolerance
  Point3 pivot = {0, 0, 0};         ///< swept: the point of what moves that moves in straight lines
  unsigned threads = 1;             ///< 0: all of the machine's
};

/// The greatest depth of a record along a path.
struct DepthAlong : Depth {
  std::uint32_t pose = 0; ///< the first pose that has it; swept: at it, or on the motion from it to the next
};

/// The depth of each record of the part that is inside or meets the surface somewhere on the path; `record` is the
/// thing's own. Swept: upper - told <= swept / 2, except for triangles whose depth is not known so well at an instant
/// (kDepthShare). A record that cannot be deeper at a pose than it was at another, for it has not moved that far, is
/// not measured there.
/// @param solid its pose is not read
/// @param at_poses when given, set to the greatest depth at each pose, 0 where nothing is inside: then everything that
///   is inside is measured at each pose
/// @throws std::invalid_argument when a pose is not rigid; swept: as poseBetween() does
std::vector<DepthAlong> depthsAlong(const DeepSolid& solid, const QueriedPart& part, const DepthPath& path, Work& work,
                                    std::vector<double>* at_poses = nullptr);

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// Poses in an order in which neighbours are near each other, and bounds on how far points move between two.
#pragma once

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/query/pose_list.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// Above what lengths of the smallest doubles, and squares that underflow, are rounded by: a few of them added.
inline constexpr double kVanishingLength = 0x1p-1060;

/// A ball that holds all points of a body, with their radii, in the body's frame.
struct BodyBall {
  /// @param body not empty
  explicit BodyBall(const SphereHierarchy& body);

  Eigen::Vector3d center;
  double radius;
};

/// At least how far any point of the body is at one pose from where it is at the other; infinity where that is not
/// known. The poses are rigid within 1e-6.
double motionBound(const BodyBall& body, const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

/// Indices of poses along a Morton curve through the six dimensions of the body's motion. @param threads to use
std::vector<std::uint32_t> orderOf(const PoseList& poses, const BodyBall& body, unsigned threads);

} // namespace pcl_bsh

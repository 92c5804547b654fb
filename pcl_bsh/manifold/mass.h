// SPDX-License-Identifier: BSD-3-Clause
// Mass, centre and inertia of what a closed mesh encloses, and of clouds of balls.
//
//   MassProperties stone = massOf(Solid(mesh), 2700.0); // of stone, in kg where the mesh is in metres
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/solid/solid.h>

#include <Eigen/Core>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// In the frame of the mesh or the cloud.
struct MassProperties {
  double mass = 0.0;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero(); ///< about the centre, along the axes of the frame

  /// A body of the same shape and another mass.
  MassProperties withMass(double other) const { return {other, center, inertia * (other / mass)}; }
};

/// Measures the signed volume: a shell within another that is turned inward is a hollow, and what two shells enclose
/// counts twice. Integrals are exact, and each number is rounded once, to the nearest double. A mesh that does not
/// close is refused by Solid, with its open edges.
/// @throws InvalidInput where the density is not finite and > 0 (Input::density), where the volume is 0
/// (Input::surface)
MassProperties massOf(const Solid& solid, double density = 1.0);

/// Sums all balls; where these overlap, each counts. Integrals are exact, with the double nearest to 4 pi / 3 for the
/// volume of the unit ball, and each number is rounded once. Points that are not finite count for nothing.
/// @throws InvalidInput as above; Input::radius where no ball has a radius > 0
MassProperties massOf(const PointsView& balls, double density = 1.0);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

// SPDX-License-Identifier: BSD-3-Clause
// The few contacts that hold a body: deepest first, then those that span most area, with normals of the surfaces.
//
//   const Collider stone(stone_hierarchy), ground(ground_hierarchy);
//   ManifoldRequest request;
//   request.margin = 0.02;
//   Manifold now = contactManifold({stone, T_world_stone}, {ground}, request);
//   request.previous = &now; // of the next step: contacts that live on keep their ids
//
// SPECIFICATION.md ("Manifolds") defines which contacts these are. Most candidates are never looked at.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/manifold/collider.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/query/effort.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The result of contactManifold().
struct Manifold {
  std::vector<Contact> contacts; ///< by patch; of each the deepest first, then as they were chosen
  double thickness = 0.0;        ///< that was in use
  Eigen::Isometry3d pose_a = Eigen::Isometry3d::Identity(), pose_b = Eigen::Isometry3d::Identity();
  std::uint32_t next_id = 1; ///< of the next contact that is new
  Work work;
};

/// The options of contactManifold(). It is exact, and takes one thread. Lengths are in the clouds' unit.
struct ManifoldRequest : Effort {
  double margin = 0.0;             ///< contacts with a gap up to this; finite, >= 0
  std::optional<double> thickness; ///< taken from each distance: finite, >= 0. Nothing: half the larger spacing where
                                   ///< both sides are points without radii, else 0
  std::size_t most = 4;            ///< contacts of a patch
  std::size_t most_patches = 4;
  std::optional<double> height; ///< of a patch over the plane of its first contact, both ways; finite, >= 0. Nothing:
                                ///< twice the margin, the thickness and the size of the first gap together
  std::optional<double> fit;    ///< radius of planes fitted to points; finite, > 0. Nothing: four of the larger spacing
  std::optional<double> same_within;  ///< a contact keeps its id where its place moved no farther, in one body's frame
                                      ///< at least; finite, >= 0. Nothing: twice the margin and the thickness
  const Manifold* previous = nullptr; ///< of the same two, for ids; null: all contacts are new
};

/// Contacts of a with b. Normals point from b to a. Where the nearest place is within a triangle, its face has the
/// normal. From an edge or a corner it is the direction of the place, so that normals are continuous around both. Balls
/// have it from middle to middle. Points have b's normal field, or a's reversed. Without a field, a plane is fitted to
/// b's points nearby, with the normal towards a's. The contact's residual is the root mean square distance of these
/// points from the plane. A place that a solid holds has a normal out of it.
/// @throws InvalidInput when a number of the request or a pose is not what its declaration asks for. Cancelled.
Manifold contactManifold(const PlacedCollider& a, const PlacedCollider& b, const ManifoldRequest& request);

/// Writes into a result whose memory is used again. It may be request.previous. After an exception it is as it was.
void contactManifold(const PlacedCollider& a, const PlacedCollider& b, const ManifoldRequest& request,
                     Manifold& result);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

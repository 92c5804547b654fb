// SPDX-License-Identifier: BSD-3-Clause
// A thing that touches: a cloud, or a surface with its corners and edges, made ready for one manifold after another.
//
//   Collider stone(stone_hierarchy);                    // points, balls or triangles
//   Collider crate(crate_hierarchy, &crate_solid);      // what is inside is enclosed: gaps are signed
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/solid/solid.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <memory>
#include <optional>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// A normal for each record of a cloud of points, in the cloud's frame: outward, of any length but 0.
struct NormalField {
  const float* normals = nullptr; ///< x y z of record 0; null: no field
  std::size_t stride = 3 * sizeof(float);
};

/// The hierarchy, the solid and the normals are borrowed, and must stay as they are. Corners and edges of
/// triangles are sorted into voxels here; the spacing of points without radii is measured.
class Collider {
public:
  /// @param solid of the same triangles as the hierarchy; null: the surface is open, or counts as such
  /// @throws InvalidInput where a solid is given of what is no surface
  explicit Collider(const SphereHierarchy& thing, const Solid* solid = nullptr, NormalField normals = {});
  ~Collider();
  Collider(Collider&&) noexcept;
  Collider& operator=(Collider&&) noexcept;

  const SphereHierarchy& thing() const noexcept; ///< its records
  double spacing() const noexcept;               ///< median distance of neighbours; 0 of balls and triangles

  struct Parts;
  const Parts& parts() const noexcept { return *parts_; } ///< for the queries (pcl_bsh/manifold/collider_parts.h)

private:
  std::unique_ptr<const Parts> parts_;
};

/// A collider and where it stands. It is borrowed.
struct PlacedCollider {
  const Collider* collider;                               ///< not null
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_world_collider; rigid within 1e-6

  /// The collider must outlive this. Not explicit: a query takes it where it stands.
  PlacedCollider(const Collider& what, const Eigen::Isometry3d& T_world_collider = Eigen::Isometry3d::Identity())
  : collider(&what),
    pose(T_world_collider)
  {
  }
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

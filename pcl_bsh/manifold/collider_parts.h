// SPDX-License-Identifier: BSD-3-Clause
// The parts of a collider.
#pragma once

#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/manifold/collider.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh {

inline Eigen::Vector3d vectorOf(const Point3& p)
{
  return {p[0], p[1], p[2]};
}

/// An edge of two triangles that are not in one plane. Directions that point outward from it lie on the arc between
/// both normals.
struct SharpEdge {
  std::array<std::uint32_t, 2> ends;      ///< vertices
  std::array<std::uint32_t, 2> triangles; ///< ascending
  std::array<Eigen::Vector3d, 2> normals; ///< of these, outward; of an open surface to the side where it is convex
};

struct Collider::Parts {
  Parts(const SphereHierarchy& of, const Solid* enclosing, NormalField field)
  : thing(of),
    solid(enclosing),
    normals(field)
  {
  }

  const SphereHierarchy& thing;
  const Solid* solid;
  NormalField normals;
  double spacing = 0.0;

  /// The corners of a surface. This and the next members are of surfaces alone; of clouds, the thing's own points are
  /// the places.
  std::optional<const SphereHierarchy> corners;
  std::vector<std::uint32_t> triangle_of; ///< of each vertex the first triangle
  std::vector<SharpEdge> sharp;           ///< by their ends
  std::vector<std::int32_t> used;         ///< vertices that stand for all at their place, ascending
  std::vector<Triangle> segments;         ///< of the sharp edges
  std::optional<const SphereHierarchy> edges;

  bool isSurface() const noexcept { return thing.view().triangles != nullptr; }
  const SphereHierarchy& places() const noexcept { return corners ? *corners : thing; }

  /// The record that a contact names.
  std::uint32_t recordOfPlace(std::uint32_t place) const { return isSurface() ? triangle_of[place] : place; }
};

} // namespace pcl_bsh

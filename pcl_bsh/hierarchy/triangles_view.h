// SPDX-License-Identifier: BSD-3-Clause
// The caller's triangles, seen in place: a view of vertices, and three of its records for each triangle.
//
//   TrianglesView machine{viewOf(vertices_xyz, n), corners, m};   // corners: 3 m numbers of vertices
//   SphereHierarchy obstacle(viewOf(machine));                    // of triangles: queries answer for all of each
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The records of a triangle's corners.
using Triangle = std::array<std::uint32_t, 3>;

/// A read-only view of `count` triangles. The memory must stay valid and unchanged, as that of PointsView must.
struct TrianglesView {
  PointsView vertices;                            ///< all of its records; neither a subset nor radii nor uncertainties
  const std::uint32_t* corners = nullptr;         ///< of triangle 0: three records of `vertices`
  std::size_t count = 0;                          ///< triangles; at most 2^31 - 1
  std::size_t stride = 3 * sizeof(std::uint32_t); ///< bytes from one triangle's corners to the next one's

  /// The records of its corners. @pre triangle < count
  Triangle cornersOf(std::uint32_t triangle) const noexcept
  {
    Triangle records;
    std::memcpy(records.data(), reinterpret_cast<const unsigned char*>(corners) + stride * triangle, sizeof records);
    return records;
  }

  /// The places of its corners, as given. Closed: a segment where they lie on one line, a point where they coincide.
  std::array<Point3, 3> triangle(std::uint32_t triangle) const noexcept
  {
    const auto [a, b, c] = cornersOf(triangle);
    return {vertices.point(a), vertices.point(b), vertices.point(c)};
  }
};

/// A view that keeps alive the listed triangles, and whatever the vertices' owner keeps. @pre the list is not null
TrianglesView trianglesOf(const PointsView& vertices, std::shared_ptr<const std::vector<Triangle>> triangles);

/// The number of finite vertices that no triangle names: no part of the surface. @pre as viewOf() asks
std::size_t looseVertices(const TrianglesView& triangles);

/// The triangles as records of a cloud. Record i is triangle i. Its point and its radius are a ball that holds it:
/// trees are built of the balls, and queries decide by the triangles. A triangle with a corner that is not finite is
/// left out, as a point that is not finite. The balls, 16 bytes a triangle (28 of float64 vertices), are owned by the
/// view that is returned, and so is a copy of `triangles`.
/// @throws InvalidInput (Input::surface) naming the triangle and the value: corners that are null or not in the view,
///   too many triangles, a stride below three numbers, a triangle too large for a float32 radius. Also vertices with
///   radii, uncertainties of their own or a subset, and the vertices that checkView() refuses
PointsView viewOf(const TrianglesView& triangles);

/// The middles of a view's records as points: of triangles, those of their balls, which lie on the triangles up to
/// rounding. Records that are no triangles keep their points, and lose their radii.
PointsView middlesOf(const PointsView& view);

/// Refuses the triangles that viewOf() refuses, except for their size. @throws InvalidInput
void checkTriangles(const TrianglesView& triangles);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

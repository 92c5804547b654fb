// SPDX-License-Identifier: BSD-3-Clause
// Closed triangles and what they enclose.
//
//   Solid tank(TrianglesView{viewOf(vertices_xyz, n), corners, m});       // refused where it does not close
//   LabelsResult labels = labelPoints({scan}, {tank, T_world_tank});      // solid/labels.h
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <memory>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

class Columns;

/// Where a point is. On the surface counts as touching: with clearance 0 it collides, as what is inside does.
enum class Label : std::uint8_t { outside, inside, surface };

/// A mesh whose directed edges cancel along their lines: as many pass each place one way as the other way, for all
/// places but corners, in exact arithmetic. So an edge is met by one between the same places, or by several end to end:
/// a corner may lie within the edge of a neighbour (a T-junction), exactly on it. A point is inside where the surface
/// winds round it, in either sense, another number of times than 0. So nested and overlapping shells, shells that cross
/// themselves, faces doubled in opposite directions and several bodies in one mesh enclose what one expects. Corners
/// are one where their coordinates are equal. Triangles that are not finite count for nothing.
///
/// Holds the view; the memory that it refers to must stay as it is. Needs about 60 bytes a triangle, and up to 400 kB;
/// where triangles are long and thin, up to 10 MB.
class Solid {
public:
  /// @throws InvalidInput (Input::surface) for a view that viewOf() refuses, and for a mesh that does not close. It
  ///   tells how many of its edges are open, wholly or in part, and where the first open part lies, whose triangle is
  ///   the error's index
  explicit Solid(const TrianglesView& triangles);
  ~Solid();
  Solid(Solid&&) noexcept;
  Solid& operator=(Solid&&) noexcept;

  const TrianglesView& triangles() const noexcept { return triangles_; } ///< as given
  std::size_t bytes() const noexcept;                                    ///< memory held, the caller's not counted

  const Columns& columns() const noexcept { return *columns_; } ///< for the queries (pcl_bsh/solid/columns.h)

private:
  TrianglesView triangles_;
  std::unique_ptr<const Columns> columns_;
};

/// A solid and where it stands. The solid is borrowed.
struct PlacedSolid {
  const Solid* solid;                                     ///< not null
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_world_solid; rigid within 1e-6

  /// The solid must outlive this. Not explicit: queries take a solid where it stands as it was given.
  PlacedSolid(const Solid& where, const Eigen::Isometry3d& T_world_solid = Eigen::Isometry3d::Identity())
  : solid(&where),
    pose(T_world_solid)
  {
  }
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

// SPDX-License-Identifier: BSD-3-Clause
// A filter that removes the polygons of a mesh that collide with an obstacle, keeps only those, or flags them.
//
//   pcl_bsh::MeshCollisionFilter filter;
//   filter.setInputMesh(machine);   // a pcl::PolygonMesh
//   filter.setObstacleCloud(scan);  // or setObstacleSurface()
//   filter.setClearance(0.05);
//   filter.filter(free);            // the machine without the polygons that come near the scan
//
// A polygon collides where any point of it does.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/question_filter.h>

#include <pcl/PolygonMesh.h>

#include <cstdint>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The obstacle, its pose and all other settings are those of CollisionFilter (CollisionSettings). Undecided polygons
/// are counted in place of undecided points. A density guard is refused, and so is an uncertainty of the input that is
/// a field: both are about points. The inside of a closed mesh belongs to it only with setInputSolid().
class MeshCollisionFilter : public CollisionSettings {
public:
  /// The mesh that is asked about. Its vertices and polygons must not change: every use throws when they have, after a
  /// filter() that wrote over it, too.
  /// @throws std::invalid_argument when the pointer is null, or as viewOf() does; then the former input stays
  void setInputMesh(const pcl::PolygonMesh::ConstPtr& mesh);

  /// Sets triangles in place of a mesh, each a polygon. They must not change. filter() throws then, as it needs a mesh.
  /// @throws std::invalid_argument as viewOf() does
  void setInputSurface(const TrianglesView& triangles);

  /// true: the input includes what its faces enclose, and they must close, as for setObstacleSolid(). All polygons of a
  /// body that holds something of the obstacle collide. Default: false, a surface alone.
  void setInputSolid(bool solid) { question_.input_solid = solid; }

  /// false (default): filter() keeps the polygons that do not collide; true: those that do, or are undecided.
  void setNegative(bool negative) { negative_ = negative; }
  bool getNegative() const { return negative_; }

  /// One verdict per polygon of the input. A polygon of fewer than three corners has no surface: it is free.
  /// @throws std::invalid_argument when input or obstacle is missing, or a setting is not what its declaration asks for
  void computeFlags(std::vector<Verdict>& flags);

  /// More along the trajectory, or at the one pose: for each colliding polygon its smallest distance, the first pose
  /// and the closest. Summaries of poses stay empty. Throws as computeFlags() does.
  void computeTrajectory(TrajectoryResult& result);

  /// The polygons that are kept, in their order, and the vertices that they use, with all their fields. `output` may be
  /// the input mesh; on an error it stays as it was. Throws as computeFlags() does.
  void filter(pcl::PolygonMesh& output);

private:
  Shape inputShape() const;
  TrajectoryResult ofPolygons(TrajectoryResult found);

  std::optional<PointsView> triangles_;
  std::vector<std::uint32_t> polygons_; ///< of each triangle, the polygon of the mesh
  pcl::PolygonMesh::ConstPtr mesh_;
  std::uint64_t checksum_ = 0; ///< of the mesh when it was set
  bool negative_ = false;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

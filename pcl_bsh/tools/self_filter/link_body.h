// SPDX-License-Identifier: BSD-3-Clause
// The bodies of a link: solids, and the surfaces of meshes.
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/io/robots/surface.h>
#include <pcl_bsh/robot/kinematics.h>
#include <pcl_bsh/robot/robot.h>
#include <pcl_bsh/robot/shapes/shape.h>

#include <cstddef>
#include <filesystem>
#include <variant>
#include <vector>

namespace pcl_bsh::self_filter {

using io::Surface;
using io::surfaceOf;
using robots::Box;
using robots::Capsule;
using robots::Cylinder;
using robots::JointValues;
using robots::Link;
using robots::Robot;
using robots::Shape;
using robots::Solid;
using robots::Sphere;

/// Centres and radii, m.
struct Balls {
  std::vector<Point3> centers;
  std::vector<float> radii;

  /// This object must outlive what is built on it.
  PointsView view() const;
};

struct PlacedSolid {
  Solid solid;
  Eigen::Isometry3d T_solid_link;
};

/// The body of a link, in the link's frame.
struct LinkBody {
  /// A file of a mesh, some of the surface's triangles.
  struct Mesh {
    std::filesystem::path file;
    std::size_t first = 0, count = 0;
  };

  std::vector<PlacedSolid> solids;
  Balls enclosing; ///< a point within a length of a solid is within that length of one of these
  Surface surface; ///< of the meshes
  std::vector<Mesh> meshes;

  /// This object must outlive what is built on it.
  TrianglesView trianglesOf(const Mesh& mesh) const;

  /// Whether a point in the link's frame is within the padding of a solid. It is also true for points that are farther
  /// by a few roundings of double.
  bool hasWithin(double padding, const Eigen::Vector3d& point) const;
};

/// Returns the body of a link. A shape's pose and scale are applied to the vertices of its mesh, rounded in double.
/// @throws files::FileError for a mesh that cannot be read or has no faces; std::runtime_error naming the link for a
///   shape without a size
LinkBody bodyOf(const Link& link);

} // namespace pcl_bsh::self_filter

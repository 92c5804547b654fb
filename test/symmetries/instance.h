// SPDX-License-Identifier: BSD-3-Clause
// All that the public queries are asked about at once, as plain data that symmetries transform.
#pragma once

#include "fuzz/bytes.h"
#include "support/random.h"
#include "support/random_clouds.h"

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <Eigen/Geometry>

#include <string>
#include <vector>

namespace pcl_bsh::symmetries {

/// A cloud and where it stands. Radii and uncertainties are empty, or one per point.
struct Body {
  std::vector<Point3> points; ///< values that `scalar` holds
  std::vector<float> radii, uncertainties;
  Scalar scalar = Scalar::float32;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_world_body

  test::Cloud cloud() const;
};

/// Lengths are in the clouds' unit.
struct Instance {
  std::string name;
  Body a, b;
  double clearance = 0.0;
  std::vector<Triangle> faces;             ///< of b's points: a surface
  std::vector<Triangle> shell;             ///< of a closed mesh
  std::vector<Eigen::Isometry3d> path;     ///< T_world_b; not empty
  double tolerance = 0.0;                  ///< of the motion along the path; 0: it is not asked for
  std::vector<Eigen::Isometry3d> relative; ///< T_a_b, of questions; not empty
  std::vector<Point3> queries;             ///< in a's frame
  Point3 low = {}, high = {};              ///< of a box in a's frame
  unsigned threads = 1;
};

/// One that the bytes choose: up to a hundred points in a world of any unit, near each other.
Instance anyInstance(fuzz::Bytes& bytes, const std::string& name);

/// Some triangles of b's points; and tetrahedra, one or several, whose faces close whatever their points are.
void addFaces(Instance& made, double unit, test::Random& random);

/// Rounds coordinates to what the scalar type holds.
void roundTo(Scalar scalar, std::vector<Point3>& points);

} // namespace pcl_bsh::symmetries

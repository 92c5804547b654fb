// SPDX-License-Identifier: BSD-3-Clause
// The bodies of a link as balls that cover their surfaces.
#pragma once

#include "self_filter/robot.h"

#include <pcl_bsh/hierarchy/points_view.h>

#include <vector>

namespace pcl_bsh::self_filter {

/// In the link's frame. A sphere is one ball, and so solid; of boxes, cylinders and meshes what they enclose is not
/// part of it.
struct LinkBody {
  std::vector<Point3> centers;
  std::vector<float> radii;

  /// This object must outlive what is built on it.
  PointsView view() const;
};

/// Every point of the link's surface lies in a ball, and none reaches farther than the tolerance beyond the surface:
/// but for the rounding of a float, and that of a shape's pose and scale in double.
/// @param tolerance m, finite and > 0
/// @throws files::FileError for a mesh that cannot be read or has no faces; std::runtime_error naming the link for what
///   has no size, or cannot be covered
LinkBody bodyOf(const Link& link, double tolerance);

} // namespace pcl_bsh::self_filter

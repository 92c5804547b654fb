// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/geometry/triangle/separation.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

namespace pcl_bsh {

/// The corners of a triangle; a point is a triangle of three equal corners.
inline Corners cornersOf(const PointsView& view, std::uint32_t record)
{
  return view.triangles ? Corners::of(view.triangles->triangle(record)) : Corners::of(view.point(record));
}

} // namespace pcl_bsh

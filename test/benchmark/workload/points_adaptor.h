// SPDX-License-Identifier: BSD-3-Clause
// Our points as nanoflann wants to see them.
#pragma once

#include "points.h"

#include <nanoflann.hpp>

namespace pcl_bsh::bench {

struct PointsAdaptor {
  const Points& points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const
  {
    const Point& p = points[i];
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const
  {
    return false;
  }
};

/// A k-d tree over float points; distances in `Distance`.
template <typename Distance>
using NanoflannIndex = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointsAdaptor, Distance>,
                                                           PointsAdaptor, 3, std::uint32_t>;

} // namespace pcl_bsh::bench

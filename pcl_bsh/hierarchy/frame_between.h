// SPDX-License-Identifier: BSD-3-Clause
// Frames of records that have radii: storage.h has those of points.
#pragma once

#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>

namespace pcl_bsh {

/// As frameBetween() of points, with a unit in which radii are floats.
/// @param largest_radius of the records, or of more of them
LocalFrame frameBetween(const std::array<double, 3>& low, const std::array<double, 3>& high, bool float_origin,
                        float largest_radius);

/// The largest radius in a view; 0 where it has none.
inline float largestRadiusOf(const PointsView& view)
{
  return view.radii && view.count > 0 ? *std::max_element(view.radii, view.radii + view.count) : 0.0f;
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {

/// The least and the greatest uncertainty of a view's records, common and own ones added up; rounded outward.
struct UncertaintyRange {
  UncertaintyRange() = default;

  explicit UncertaintyRange(const PointsView& view) noexcept : least(view.uncertainty), most(view.uncertainty)
  {
    if (!view.uncertainties || view.count == 0) return;
    const auto [smallest, largest] = std::minmax_element(view.uncertainties, view.uncertainties + view.count);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    least = std::nextafter(least + *smallest, -infinity);
    most = std::nextafter(most + *largest, infinity);
  }

  double least = 0.0; ///< may be a little less than 0
  double most = 0.0;
};

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl_bsh::brute_force {

struct Candidate {
  std::uint32_t record;
  Point3 point;
  double radius;
};

/// The finite points of a view by ascending record: the first pair found is the smallest.
inline std::vector<Candidate> candidatesOf(const PointsView& view)
{
  std::vector<Candidate> candidates;
  candidates.reserve(view.size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::uint32_t record = view.record(i);
    const Point3 point = view.point(record);
    const bool finite = std::all_of(point.begin(), point.end(), [](double x) { return std::isfinite(x); });
    if (finite) candidates.push_back({record, point, view.radius(record)});
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& x, const Candidate& y) { return x.record < y.record; });
  return candidates;
}

} // namespace pcl_bsh::brute_force

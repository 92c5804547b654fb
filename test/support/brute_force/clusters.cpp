// SPDX-License-Identifier: BSD-3-Clause
#include "clusters.h"

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/clusters/disjoint_sets.h>
#include <pcl_bsh/query/brute_force_points.h>
#include <pcl_bsh/query/record_distance.h>

#include <algorithm>

namespace pcl_bsh::brute_force {

Clusters euclideanClusters(const SphereHierarchy& cloud, double distance)
{
  const DefaultFloatEnvironment environment;
  const PointsView& view = cloud.view();
  std::vector<FinitePoint> points = finitePoints(view); // a view may name a record twice
  const auto is_same = [](const FinitePoint& p, const FinitePoint& q) { return p.record == q.record; };
  points.erase(std::unique(points.begin(), points.end(), is_same), points.end());
  const RecordDistance exact(view, Eigen::Isometry3d::Identity(), view, Eigen::Isometry3d::Identity());
  DisjointSets sets(view.count);
  Clusters result;
  for (const FinitePoint& p : points) {
    for (const FinitePoint& q : points) {
      if (q.record >= p.record) break;
      ++result.work.exact_decisions;
      if (exact.compare({p.record, q.record}, RecordDistance::Sum{distance}) <= 0) sets.unite(p.record, q.record);
    }
  }
  result.of.assign(view.count, kNothing);
  for (const FinitePoint& p : points) {
    std::int32_t& number = result.of[sets.find(p.record)]; // of the smallest of the set, which comes first
    if (number == kNothing) {
      number = static_cast<std::int32_t>(result.sizes.size());
      result.sizes.push_back(0);
    }
    result.of[p.record] = number;
    ++result.sizes[static_cast<std::size_t>(number)];
  }
  return result;
}

} // namespace pcl_bsh::brute_force

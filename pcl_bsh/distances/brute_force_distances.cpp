// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/distances/brute_force_distances.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/distances/check_distances.h>
#include <pcl_bsh/distances/greatest_distance.h>
#include <pcl_bsh/query/brute_force_points.h>
#include <pcl_bsh/query/record_distance.h>

namespace pcl_bsh::brute_force {

PointDistances pointDistances(const Placed& a, const Placed& b, const PointDistancesRequest& request)
{
  check(a, b, request);
  const DefaultFloatEnvironment environment;
  const RecordDistance distance(a.hierarchy().view(), a.pose, b.hierarchy().view(), b.pose);
  PointDistances result;
  result.distance.assign(a.hierarchy().view().count, std::numeric_limits<double>::quiet_NaN());
  result.closest_point.assign(a.hierarchy().view().count, kNothing);
  const std::vector<FinitePoint> others = finitePoints(b.hierarchy().view());
  for (const FinitePoint& p : finitePoints(a.hierarchy().view())) {
    const FinitePoint* nearest = nullptr;
    const auto pairWith = [&](const FinitePoint& q) { return distance.pair({p.record, q.record}); };
    for (const FinitePoint& q : others) {
      ++result.work.exact_decisions;
      if (!nearest || distance.compareGaps(pairWith(q), pairWith(*nearest)) < 0) nearest = &q;
    }
    if (!nearest) continue;
    if (distance.compare(pairWith(*nearest), request.max_distance) > 0) continue;
    result.distance[p.record] = distance.gap(pairWith(*nearest));
    result.closest_point[p.record] = nearest->record;
  }
  findGreatest(a, b, result);
  return result;
}

} // namespace pcl_bsh::brute_force

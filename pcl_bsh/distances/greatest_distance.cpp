// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/distances/greatest_distance.h>

#include <pcl_bsh/traversal/point_pairs.h>

namespace pcl_bsh {

void findGreatest(const Placed& a, const Placed& b, PointDistances& result)
{
  result.measured = 0;
  std::size_t greatest = 0; // a record, once any is measured
  const PointPairs pairs(a, b, 0.0);
  const auto posed = [&](std::size_t record) {
    return pairs.posed({static_cast<std::uint32_t>(record), result.nearest[record]});
  };
  for (std::size_t i = 0; i < result.nearest.size(); ++i) {
    if (result.nearest[i] == PointDistances::kNoPoint) continue;
    // Rounding keeps the order: only of equal doubles one may be the greater.
    const double here = result.distance[i];
    const bool greater =
        result.measured == 0 || here > result.distance[greatest] ||
        (here == result.distance[greatest] && pairs.distance.compareGaps(posed(i), posed(greatest)) > 0);
    if (greater) greatest = i;
    ++result.measured;
  }
  result.greatest = std::numeric_limits<double>::quiet_NaN();
  result.greatest_pair.reset();
  if (result.measured == 0) return;
  result.greatest = result.distance[greatest];
  result.greatest_pair = PointPair{static_cast<std::uint32_t>(greatest), result.nearest[greatest]};
}

void findHausdorff(const Placed& a, const Placed& b, SymmetricDistances& result)
{
  result.hausdorff = std::numeric_limits<double>::quiet_NaN();
  result.hausdorff_pair.reset();
  const bool all = result.a.measured == a.hierarchy().size() && result.b.measured == b.hierarchy().size();
  if (!all || !result.a.greatest_pair || !result.b.greatest_pair) return;
  const PointPair from_a = *result.a.greatest_pair;
  const PointPair from_b = {result.b.greatest_pair->b, result.b.greatest_pair->a};
  const PointPairs pairs(a, b, 0.0);
  const int sign = pairs.distance.compareGaps(pairs.posed(from_a), pairs.posed(from_b));
  const bool takes_a = sign > 0 || (sign == 0 && from_a < from_b);
  result.hausdorff_pair = takes_a ? from_a : from_b;
  result.hausdorff = takes_a ? result.a.greatest : result.b.greatest;
}

} // namespace pcl_bsh

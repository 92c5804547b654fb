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

void findGreatestOfBoth(const Placed& a, const Placed& b, SymmetricDistances& result)
{
  const std::optional<PointPair>& of_a = result.a.greatest_pair;
  std::optional<PointPair> of_b;
  if (result.b.greatest_pair) of_b = {result.b.greatest_pair->b, result.b.greatest_pair->a};
  const PointPairs pairs(a, b, 0.0);
  const auto isFromA = [&] {
    if (!of_a || !of_b) return of_a.has_value();
    const int sign = pairs.distance.compareGaps(pairs.posed(*of_a), pairs.posed(*of_b));
    return sign > 0 || (sign == 0 && *of_a < *of_b);
  };
  const bool takes_a = isFromA();
  result.hausdorff_pair = takes_a ? of_a : of_b;
  result.hausdorff = takes_a ? result.a.greatest : result.b.greatest;
}

void findHausdorff(const Placed& a, const Placed& b, SymmetricDistances& result)
{
  result.hausdorff = std::numeric_limits<double>::quiet_NaN();
  result.hausdorff_pair.reset();
  const bool all = result.a.measured == a.hierarchy().size() && result.b.measured == b.hierarchy().size();
  if (all && result.a.greatest_pair && result.b.greatest_pair) findGreatestOfBoth(a, b, result);
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/distances/greatest_distance.h>

#include <pcl_bsh/base/pulse.h>
#include <pcl_bsh/traversal/point_pairs.h>

namespace pcl_bsh {
namespace {

/// The greatest of the distances from a, as a pair (a, b). @param precedes which of two pairs is named where their
/// distances are equal
template <class Precedes>
std::optional<PointPair> greatestOf(const Placed& a, const Placed& b, const PointDistances& result,
                                    const Precedes& precedes)
{
  std::optional<PointPair> greatest;
  const PointPairs pairs(a, b, 0.0);
  Pulse pulse;
  for (std::uint32_t i = 0; i < result.closest_point.size(); ++i) {
    if (result.closest_point[i] == kNothing) continue;
    const PointPair pair{i, result.closest_point[i]};
    if (greatest) {
      // Rounding keeps the order: only of equal doubles one may be the greater.
      if (result.distance[i] < result.distance[greatest->a]) continue;
      if (result.distance[i] == result.distance[greatest->a]) {
        pulse.count(128);
        const int sign = pairs.distance.compareGaps(pairs.posed(pair), pairs.posed(*greatest));
        if (sign < 0 || (sign == 0 && !precedes(pair, *greatest))) continue;
      }
    }
    greatest = pair;
  }
  return greatest;
}

/// Whether each point has a distance. A subset may name one twice.
bool allMeasured(const Placed& cloud, const PointDistances& result)
{
  const PointsView& view = cloud.hierarchy().view();
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::uint32_t record = view.record(i);
    if (result.closest_point[record] == kNothing && isFinite(view.point(record))) return false;
  }
  return true;
}

PointPair swapped(const PointPair& pair)
{
  return {pair.b, pair.a};
}

} // namespace

void findGreatest(const Placed& a, const Placed& b, PointDistances& result)
{
  result.measured = 0;
  for (const std::uint32_t nearest : result.closest_point) result.measured += nearest != kNothing;
  result.greatest_pair =
      greatestOf(a, b, result, [](const PointPair&, const PointPair&) { return false; }); // the first is the smallest
  result.greatest =
      result.greatest_pair ? result.distance[result.greatest_pair->a] : std::numeric_limits<double>::quiet_NaN();
}

void findGreatestOfBoth(const Placed& a, const Placed& b, SymmetricDistances& result)
{
  const std::optional<PointPair>& of_a = result.a.greatest_pair;
  std::optional<PointPair> of_b; // of several the smallest (a, b): in the order of b it may be another one
  if (result.b.greatest_pair)
    of_b = swapped(*greatestOf(
        b, a, result.b, [](const PointPair& pair, const PointPair& other) { return swapped(pair) < swapped(other); }));
  const PointPairs pairs(a, b, 0.0);
  const auto isFromA = [&] {
    if (!of_a || !of_b) return of_a.has_value();
    const int sign = pairs.distance.compareGaps(pairs.posed(*of_a), pairs.posed(*of_b));
    return sign > 0 || (sign == 0 && *of_a < *of_b);
  };
  const bool takes_a = isFromA();
  result.hausdorff_pair = takes_a ? of_a : of_b;
  result.hausdorff = takes_a ? result.a.greatest : result.b.greatest;
  result.hausdorff_interval = {result.hausdorff, result.hausdorff};
}

void findHausdorff(const Placed& a, const Placed& b, SymmetricDistances& result)
{
  result.hausdorff = std::numeric_limits<double>::quiet_NaN();
  result.hausdorff_interval = {result.hausdorff, result.hausdorff};
  result.hausdorff_pair.reset();
  if (!result.a.greatest_pair || !result.b.greatest_pair) return;
  if (allMeasured(a, result.a) && allMeasured(b, result.b)) findGreatestOfBoth(a, b, result);
}

} // namespace pcl_bsh

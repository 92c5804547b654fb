// SPDX-License-Identifier: BSD-3-Clause
// The greatest distance of all places of a surface from another cloud, by branch and bound: of some places it is
// measured exactly, and of a piece of a triangle it is bounded. The distance from one record of the other cloud is a
// convex function, and the greatest on a piece is that at one of its corners. No place of a piece is farther from its
// nearest corner than the longest side over the root of three. Pieces that may be the farthest are cut in two.
#include <pcl_bsh/distances/surface_hausdorff.h>

#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/distances/farthest_place.h>

#include <algorithm>

namespace pcl_bsh {
namespace {

constexpr std::size_t kMostDivisions = std::size_t{1} << 20;

double toleranceOf(const Placed& a, const Placed& b, const Accuracy& accuracy)
{
  if (!accuracy.isExact()) return accuracy.value;
  return kHausdorffShare * std::max(diagonalOf(a.hierarchy().view()), diagonalOf(b.hierarchy().view()));
}

} // namespace

HausdorffDistance surfaceHausdorff(const Placed& a, const Placed& b, const Effort& effort)
{
  const double tolerance = toleranceOf(a, b, effort.accuracy);
  HausdorffDistance result;
  FarthestPlace of_a(a, b, tolerance, effort.threads, result.work), of_b(b, a, tolerance, effort.threads, result.work);
  const auto lower = [&] { return std::max(of_a.interval().lower, of_b.interval().lower); };
  for (std::size_t divisions = 0, before = 1; divisions != before && divisions < kMostDivisions;) {
    before = divisions;
    divisions += of_a.divide(lower());
    divisions += of_b.divide(lower());
  }
  result.interval = {lower(), std::max(of_a.interval().upper, of_b.interval().upper)};
  const bool is_of_a = of_a.distance() >= of_b.distance();
  result.distance =
      std::clamp(std::max(of_a.distance(), of_b.distance()), result.interval.lower, result.interval.upper);
  const PointPair pair = (is_of_a ? of_a : of_b).pair();
  result.pair = is_of_a ? pair : PointPair{pair.b, pair.a};
  return result;
}

} // namespace pcl_bsh

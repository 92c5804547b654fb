// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/neighbors/neighbor_scratch.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/exact_distance.h>

#include <algorithm>

namespace pcl_bsh {
namespace {

const ExactDistance& unposed()
{
  static const ExactDistance distance(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity());
  return distance;
}

/// Squared distances that are one float need not be one number: puts the first `most` in their exact order, and equal
/// distances in the order of their records.
void settleTies(const PointsView& view, const Point3& query, NeighborScratch& scratch, std::size_t most, Work& work)
{
  const auto nearer = [&](std::uint32_t x, std::uint32_t y) {
    const Point3 p = view.point(x), q = view.point(y);
    if (p == q) return x < y;
    ++work.exact_decisions;
    const int sign = unposed().compareGaps({p, query}, {q, query});
    return sign != 0 ? sign < 0 : x < y;
  };
  const float* const squared = scratch.squared.data();
  std::uint32_t* const records = scratch.records.data();
  const std::size_t count = scratch.records.size();
  for (std::size_t begin = 0; begin + 1 < count && begin < most;) {
    std::size_t end = begin + 1;
    while (end < count && squared[end] == squared[begin]) ++end;
    if (end - begin > 1 && !std::is_sorted(records + begin, records + end, nearer)) {
      const std::size_t needed = std::min(end, most);
      if (needed < end) std::nth_element(records + begin, records + needed - 1, records + end, nearer);
      std::sort(records + begin, records + needed, nearer);
    }
    begin = end;
  }
}

} // namespace

void checkOfPoints(const PointsView& cloud)
{
  if (cloud.triangles)
    throw InvalidInput(Input::surface, "neighbours", "the cloud is of triangles",
                       "search among points, or ask for the distances from points to it");
}

void checkRadius(double radius)
{
  if (!(radius >= 0.0))
    throw InvalidInput(Input::radius, "radius", plainText(radius), "give a length >= 0").withValue(radius);
}

bool isWithin(const Point3& p, const Point3& q, double radius, Work& work)
{
  ++work.exact_decisions;
  return unposed().compare(p, q, radius) <= 0;
}

void writeNearestFirst(const PointsView& view, const Point3& query, const RadiusOptions& options,
                       NeighborScratch& scratch, const NeighborOutput& found, Work& work)
{
  const std::size_t count = scratch.records.size();
  const std::size_t kept = options.most == 0 ? count : std::min(count, options.most);
  if (options.sorted || kept < count) {
    sortBySquared(scratch);
    settleTies(view, query, scratch, kept, work);
  }
  found.indices.clear(); // should there be memory for one list alone, both are empty
  found.squared_distances.clear();
  found.indices.reserve(kept);
  found.squared_distances.reserve(kept);
  found.indices.assign(scratch.records.data(), scratch.records.data() + kept);
  found.squared_distances.assign(scratch.squared.data(), scratch.squared.data() + kept);
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/neighbors/query_order.h>

#include <pcl_bsh/hierarchy/build/morton.h>

#include <hwy/contrib/sort/vqsort.h>

#include <cmath>

namespace pcl_bsh {

std::vector<std::uint32_t> queryOrder(const SphereHierarchy::Storage& cloud, const PointsView& queries,
                                      unsigned threads)
{
  constexpr double kCells = 1 << 10; // along the longest axis: three times ten bits, and the query's number below them
  constexpr std::uint64_t kLast = 0xffffffffu;
  constexpr std::size_t kStretch = 1 << 15; // queries that are worth a thread
  const LocalFrame& frame = cloud.frame;
  const double reach = std::max({frame.reach[0], frame.reach[1], frame.reach[2]}) * frame.unit;
  const double cells_per_length = reach > 0.0 ? kCells / 2 / reach : 0.0;

  const std::size_t count = queries.size(), stretches = std::clamp<std::size_t>(count / kStretch, 1, threads);
  std::vector<std::uint32_t> order(count);
  parallelFor(stretches, threads, [&](std::size_t stretch) {
    const std::size_t begin = stretch * count / stretches, end = (stretch + 1) * count / stretches;
    std::vector<std::uint64_t> keys(end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      const Point3 p = queries.point(queries.record(i));
      std::uint64_t cell[3];
      bool finite = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const double place = (p[k] - frame.origin[k]) * cells_per_length + kCells / 2;
        finite = finite && std::isfinite(p[k]);
        cell[k] = place > 0.0 ? static_cast<std::uint64_t>(std::min(place, kCells - 1)) : 0;
      }
      keys[i - begin] = (finite ? mortonCode(cell[0], cell[1], cell[2]) : kLast) << 32 | i;
    }
    hwy::Sorter()(keys.data(), keys.size(), hwy::SortAscending());
    for (std::size_t i = begin; i < end; ++i) order[i] = static_cast<std::uint32_t>(keys[i - begin]);
  });
  return order;
}

} // namespace pcl_bsh

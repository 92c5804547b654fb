// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/neighbors/neighbors.h>

#include "clouds.h"
#include "support/every_allocation.h"

#include <limits>
#include <tuple>

namespace pcl_bsh::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Point3 kPlace = {0.25, 0.4, -0.7};

const Cloud& cloud()
{
  static const Cloud made = richCloud(4, 900);
  return made;
}
const Cloud& queries()
{
  static const Cloud made = richCloud(5, 600, true);
  return made;
}

std::unique_ptr<SphereHierarchy> fresh()
{
  return std::make_unique<SphereHierarchy>(cloud().view(), fineOptions());
}

TEST(NeighborAllocationFailure, OfOneQuery)
{
  for (const double radius : {0.2, 1.0, kInfinity})
    for (const RadiusOptions& options : {RadiusOptions{0, true}, RadiusOptions{0, false}, RadiusOptions{30, true}})
      failEachAllocation(fresh, [&](const auto& hierarchy) {
        Neighbors found;
        radiusSearch(*hierarchy, kPlace, radius, found, options);
        return std::tuple(found.indices, found.squared_distances);
      });
  for (const std::size_t k : {std::size_t{1}, std::size_t{20}, std::size_t{2000}})
    failEachAllocation(fresh, [&](const auto& hierarchy) {
      Neighbors found;
      nearestKSearch(*hierarchy, kPlace, k, found);
      return std::tuple(found.indices, found.squared_distances);
    });
  failEachAllocation(fresh, [&](const auto& hierarchy) {
    std::vector<std::int32_t> found;
    boxSearch(*hierarchy, {-1, -1, -1}, {1, 0.5, 1}, found);
    return found;
  });
  failEachAllocation(fresh, [&](const auto& hierarchy) { return anyInRadius(*hierarchy, kPlace, 0.3); });
}

TEST(NeighborAllocationFailure, LeavesListsOfOneLength)
{
  for (std::size_t k = 1;; ++k) {
    const auto hierarchy = fresh();
    Neighbors found;
    nearestKSearch(*hierarchy, kPlace, 3, found);
    const FailingAllocation failing(k);
    try {
      radiusSearch(*hierarchy, kPlace, 1.0, found);
    }
    catch (const std::bad_alloc&) {
      ASSERT_EQ(found.indices.size(), found.squared_distances.size()) << k;
    }
    if (!failing.hasHappened()) break;
  }
}

TEST(NeighborAllocationFailure, OfBatchesInThreads)
{
  for (const unsigned threads : {1u, 2u}) {
    failEachAllocation(fresh, [&](const auto& hierarchy) {
      NeighborLists found;
      radiusSearch(*hierarchy, queries().view(), 0.2, found, {}, threads);
      return std::tuple(found.indices, found.squared_distances);
    });
    failEachAllocation(fresh, [&](const auto& hierarchy) {
      NeighborLists found;
      nearestKSearch(*hierarchy, queries().view(), 10, found, threads);
      return std::tuple(found.indices, found.squared_distances);
    });
    failEachAllocation(fresh, [&](const auto& hierarchy) {
      return std::tuple(flagAnyInRadius(*hierarchy, queries().view(), 0.05, threads),
                        anyInBalls(*hierarchy, queries().view(), threads));
    });
  }
}

} // namespace
} // namespace pcl_bsh::test

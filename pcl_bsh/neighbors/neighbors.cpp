// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/neighbors/neighbors.h>

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/hierarchy/view_check.h>
#include <pcl_bsh/neighbors/neighbor_scratch.h>
#include <pcl_bsh/neighbors/query_order.h>
#include <pcl_bsh/query/progress.h>

#include <limits>

namespace pcl_bsh {
namespace {

constexpr double kAnyDistance = std::numeric_limits<double>::infinity();

/// One query of a kind, wherever it comes from: alone or in a batch.
void answer(const SphereHierarchy& cloud, const Point3& query, double radius, const RadiusOptions& options,
            const NeighborOutput& found, Work& work)
{
  const ScratchLease<NeighborScratch> lease;
  NeighborScratch& scratch = *lease;
  scratch.records.clear();
  if (isFinite(query)) {
    if (options.most > 0)
      findNearest(cloud.storage(), query, options.most, radius, scratch, work);
    else
      findWithin(cloud.storage(), query, radius, scratch, work);
  }
  writeNearestFirst(cloud.view(), query, options, scratch, found, work);
}

void answer(const SphereHierarchy& cloud, const Point3& query, std::size_t k, const NeighborOutput& found, Work& work)
{
  const ScratchLease<NeighborScratch> lease;
  NeighborScratch& scratch = *lease;
  scratch.records.clear();
  if (isFinite(query) && k > 0) findNearest(cloud.storage(), query, k, kAnyDistance, scratch, work);
  writeNearestFirst(cloud.view(), query, {k, true}, scratch, found, work);
}

void makeRoom(NeighborLists& found, std::size_t queries)
{
  found.indices.resize(queries);
  found.squared_distances.resize(queries);
}

/// Prefetches the vectors that an answer will go to, or, soon before it does, their elements.
void fetch(const NeighborLists& found, std::size_t i, bool soon)
{
  hwy::Prefetch(soon ? static_cast<const void*>(found.indices[i].data()) : &found.indices[i]);
  hwy::Prefetch(soon ? static_cast<const void*>(found.squared_distances[i].data()) : &found.squared_distances[i]);
}

constexpr auto kUnasked = [](std::size_t, bool) {};

} // namespace

std::size_t radiusSearch(const SphereHierarchy& cloud, const Point3& query, double radius, Neighbors& found,
                         const RadiusOptions& options, Work* work)
{
  checkOfPoints(cloud.view());
  checkRadius(radius);
  const DefaultFloatEnvironment environment;
  Work unasked;
  answer(cloud, query, radius, options, {found.indices, found.squared_distances}, work ? *work : unasked);
  return found.indices.size();
}

std::size_t nearestKSearch(const SphereHierarchy& cloud, const Point3& query, std::size_t k, Neighbors& found,
                           Work* work)
{
  checkOfPoints(cloud.view());
  const DefaultFloatEnvironment environment;
  Work unasked;
  answer(cloud, query, k, {found.indices, found.squared_distances}, work ? *work : unasked);
  return found.indices.size();
}

bool anyInRadius(const SphereHierarchy& cloud, const Point3& query, double radius, Work* work)
{
  checkOfPoints(cloud.view());
  checkRadius(radius);
  const DefaultFloatEnvironment environment;
  Work unasked;
  return isFinite(query) && findAny(cloud.storage(), query, radius, work ? *work : unasked);
}

void radiusSearch(const SphereHierarchy& cloud, const PointsView& queries, double radius, NeighborLists& found,
                  const RadiusOptions& options, const Effort& effort)
{
  checkOfPoints(cloud.view());
  checkRadius(radius);
  checkView("queries", queries);
  makeRoom(found, queries.size());
  const auto expect = [&](std::size_t i, bool soon) { fetch(found, i, soon); };
  forEachQuery(cloud.storage(), queries, effort, expect, [&](std::size_t i, const Point3& query) {
    Work work;
    answer(cloud, query, radius, options, {found.indices[i], found.squared_distances[i]}, work);
    return costInPairs(work) + found.indices[i].size();
  });
}

void nearestKSearch(const SphereHierarchy& cloud, const PointsView& queries, std::size_t k, NeighborLists& found,
                    const Effort& effort)
{
  checkOfPoints(cloud.view());
  checkView("queries", queries);
  makeRoom(found, queries.size());
  const auto expect = [&](std::size_t i, bool soon) { fetch(found, i, soon); };
  forEachQuery(cloud.storage(), queries, effort, expect, [&](std::size_t i, const Point3& query) {
    Work work;
    answer(cloud, query, k, {found.indices[i], found.squared_distances[i]}, work);
    return costInPairs(work) + found.indices[i].size();
  });
}

void flagAnyInRadius(const SphereHierarchy& cloud, const PointsView& queries, double radius,
                     std::vector<std::uint8_t>& flags, const Effort& effort)
{
  checkOfPoints(cloud.view());
  checkRadius(radius);
  checkView("queries", queries);
  flags.assign(queries.size(), 0);
  forEachQuery(cloud.storage(), queries, effort, kUnasked, [&](std::size_t i, const Point3& query) {
    Work work;
    flags[i] = isFinite(query) && findAny(cloud.storage(), query, radius, work) ? 1 : 0;
    return costInPairs(work);
  });
}

void anyInBalls(const SphereHierarchy& cloud, const PointsView& balls, std::vector<std::uint8_t>& flags,
                const Effort& effort)
{
  checkOfPoints(cloud.view());
  checkView("balls", balls);
  if (!balls.radii) throw InvalidInput(Input::radius, "balls", "the view has no radii", "give one per record");
  for (std::size_t i = 0; i < balls.size(); ++i) checkRadius(balls.radius(balls.record(i)));
  flags.assign(balls.size(), 0);
  forEachQuery(cloud.storage(), balls, effort, kUnasked, [&](std::size_t i, const Point3& center) {
    Work work;
    flags[i] = isFinite(center) && findAny(cloud.storage(), center, balls.radius(balls.record(i)), work) ? 1 : 0;
    return costInPairs(work);
  });
}

Neighbors radiusSearch(const SphereHierarchy& cloud, const Point3& query, double radius, const RadiusOptions& options)
{
  Neighbors found;
  radiusSearch(cloud, query, radius, found, options);
  return found;
}

Neighbors nearestKSearch(const SphereHierarchy& cloud, const Point3& query, std::size_t k)
{
  Neighbors found;
  nearestKSearch(cloud, query, k, found);
  return found;
}

std::vector<std::int32_t> boxSearch(const SphereHierarchy& cloud, const Point3& low, const Point3& high)
{
  std::vector<std::int32_t> indices;
  boxSearch(cloud, low, high, indices);
  return indices;
}

NeighborLists radiusSearch(const SphereHierarchy& cloud, const PointsView& queries, double radius,
                           const RadiusOptions& options, const Effort& effort)
{
  NeighborLists found;
  radiusSearch(cloud, queries, radius, found, options, effort);
  return found;
}

NeighborLists nearestKSearch(const SphereHierarchy& cloud, const PointsView& queries, std::size_t k,
                             const Effort& effort)
{
  NeighborLists found;
  nearestKSearch(cloud, queries, k, found, effort);
  return found;
}

std::vector<std::uint8_t> flagAnyInRadius(const SphereHierarchy& cloud, const PointsView& queries, double radius,
                                          const Effort& effort)
{
  std::vector<std::uint8_t> flags;
  flagAnyInRadius(cloud, queries, radius, flags, effort);
  return flags;
}

std::vector<std::uint8_t> anyInBalls(const SphereHierarchy& cloud, const PointsView& balls, const Effort& effort)
{
  std::vector<std::uint8_t> flags;
  anyInBalls(cloud, balls, flags, effort);
  return flags;
}

} // namespace pcl_bsh

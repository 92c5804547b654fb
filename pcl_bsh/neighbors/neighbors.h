// SPDX-License-Identifier: BSD-3-Clause
// The neighbours of a point, as pcl::search asks for them: within a radius, the k nearest, in a box.
//
//   SphereHierarchy scan(viewOf(xyz, n));
//   Neighbors found = nearestKSearch(scan, {x, y, z}, 8); // found.indices, found.squared_distances: nearest first
//   radiusSearch(scan, {x, y, z}, 0.1, found);            // |p - q| <= 0.1, in the memory of `found`
//   bool near = anyInRadius(scan, {x, y, z}, 0.1);
//
// Functions that fill a result use its memory again.
//
// Neighbours and their order are those of exact arithmetic on the given numbers: by ascending distance,
// equal distances by ascending record number. Radii that the cloud's points may have play no part. A query that is not
// finite has no neighbour; nor has anything in an empty cloud. A cloud of triangles is refused by
// std::invalid_argument. Voxels are built as queries visit them. Several threads may query one hierarchy at once.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/query/result.h>

#include <cstddef>
#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The answer to one query. Vectors that come with memory are filled without allocating.
struct Neighbors {
  std::vector<std::int32_t> indices;    ///< record numbers of the cloud's view
  std::vector<float> squared_distances; ///< one per index: |p - q|^2, rounded once, to the nearest float
};

/// The answers to many queries: the i-th one's in [i]. Memory that comes with them is used again.
struct NeighborLists {
  std::vector<std::vector<std::int32_t>> indices;
  std::vector<std::vector<float>> squared_distances;
};

/// How many neighbours radiusSearch() tells, and in which order.
struct RadiusOptions {
  std::size_t most = 0; ///< only so many, the nearest ones; 0: all
  bool sorted = true;   ///< false: in any order, but always the same one
};

/// All points with |p - query| <= radius.
/// @throws std::invalid_argument when the radius is negative or NaN. Infinity is a radius.
Neighbors radiusSearch(const SphereHierarchy& cloud, const Point3& query, double radius,
                       const RadiusOptions& options = {});

/// Fills a result. @return how many neighbours it has.
/// @param work when given, what the query cost is added: a node or leaf pair is one node or leaf against the query.
std::size_t radiusSearch(const SphereHierarchy& cloud, const Point3& query, double radius, Neighbors& found,
                         const RadiusOptions& options = {}, Work* work = nullptr);

/// The k nearest points, or all when there are fewer.
Neighbors nearestKSearch(const SphereHierarchy& cloud, const Point3& query, std::size_t k);

/// Fills a result. @return how many neighbours it has. `work` as above.
std::size_t nearestKSearch(const SphereHierarchy& cloud, const Point3& query, std::size_t k, Neighbors& found,
                           Work* work = nullptr);

/// Does any point lie within the radius? Throws as radiusSearch() does. `work` as above.
bool anyInRadius(const SphereHierarchy& cloud, const Point3& query, double radius, Work* work = nullptr);

/// The points with low <= p <= high on each axis, by ascending record number.
/// @throws std::invalid_argument when a bound is NaN. Infinite bounds are bounds; low above high is an empty box.
std::vector<std::int32_t> boxSearch(const SphereHierarchy& cloud, const Point3& low, const Point3& high);

/// Fills a result. @return how many indices it has. `work` as above.
std::size_t boxSearch(const SphereHierarchy& cloud, const Point3& low, const Point3& high,
                      std::vector<std::int32_t>& indices, Work* work = nullptr);

/// Answers many queries at once, shared among threads. It takes them in an order that visits neighbouring places one
/// after another. The i-th answer belongs to the i-th point that the view of queries names: bit for bit what the single
/// query gives. @throws as the single query does; std::invalid_argument for an accuracy other than exact. Cancelled.
NeighborLists radiusSearch(const SphereHierarchy& cloud, const PointsView& queries, double radius,
                           const RadiusOptions& options = {}, const Effort& effort = {});
NeighborLists nearestKSearch(const SphereHierarchy& cloud, const PointsView& queries, std::size_t k,
                             const Effort& effort = {});

/// Fill a result.
void radiusSearch(const SphereHierarchy& cloud, const PointsView& queries, double radius, NeighborLists& found,
                  const RadiusOptions& options = {}, const Effort& effort = {});
void nearestKSearch(const SphereHierarchy& cloud, const PointsView& queries, std::size_t k, NeighborLists& found,
                    const Effort& effort = {});

/// One flag per query, 1 = some point lies within the radius. Throws as radiusSearch() of many does.
std::vector<std::uint8_t> flagAnyInRadius(const SphereHierarchy& cloud, const PointsView& queries, double radius,
                                          const Effort& effort = {});
void flagAnyInRadius(const SphereHierarchy& cloud, const PointsView& queries, double radius,
                     std::vector<std::uint8_t>& flags, const Effort& effort = {});

/// One flag per ball, 1 = some point lies in it, its surface included. The view's radii are the balls'.
/// @throws std::invalid_argument when the view has no radii, or one of them is negative or NaN; as
///   radiusSearch() of many does.
std::vector<std::uint8_t> anyInBalls(const SphereHierarchy& cloud, const PointsView& balls, const Effort& effort = {});
void anyInBalls(const SphereHierarchy& cloud, const PointsView& balls, std::vector<std::uint8_t>& flags,
                const Effort& effort = {});

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

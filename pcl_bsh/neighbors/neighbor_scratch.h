// SPDX-License-Identifier: BSD-3-Clause
// Parts that all queries for neighbours share: memory kept from query to query, and the last steps.
#pragma once

#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/base/large_array.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/neighbors/neighbors.h>

#include <hwy/contrib/sort/vqsort.h>

namespace pcl_bsh {

/// Memory of one query, lent by a ScratchLease.
struct NeighborScratch {
  LargeArray<std::uint32_t> records; ///< the records found
  LargeArray<float> squared; ///< their squared distances: while searching perhaps upper bounds, then as in the answer
  LargeArray<const Voxel*> voxels; ///< of the candidates for the nearest, in the candidates' order

  // of sorting
  LargeArray<std::uint32_t> sorted_records;
  LargeArray<float> sorted_squared;
  LargeArray<std::uint64_t> keys, sorted_keys;
  LargeArray<std::uint32_t> steps;

  hwy::Sorter sorter;

  std::size_t bytes() const noexcept
  {
    return records.bytes() + squared.bytes() + voxels.bytes() + sorted_records.bytes() + sorted_squared.bytes() +
           keys.bytes() + sorted_keys.bytes() + steps.bytes();
  }
};

void checkRadius(double radius);

/// Throws InvalidInput for a cloud of triangles: neighbours are points.
void checkOfPoints(const PointsView& cloud);

/// Exact: |p - q| <= radius.
bool isWithin(const Point3& p, const Point3& q, double radius, Work& work);

/// Sorts scratch.records by scratch.squared. Records at equal squared distances come in any order.
void sortBySquared(NeighborScratch& scratch);

/// The vectors that an answer is written to.
struct NeighborOutput {
  std::vector<std::int32_t>& indices;
  std::vector<float>& squared_distances;
};

/// Sorts what was found and keeps the first `most` (0: all). Expects the DefaultFloatEnvironment.
void writeNearestFirst(const PointsView& view, const Point3& query, const RadiusOptions& options,
                       NeighborScratch& scratch, const NeighborOutput& found, Work& work);

/// Each answers one query: finds and measures records, in any order, into the scratch. @pre arguments are checked, and
/// the DefaultFloatEnvironment is set. The radius search ignores options.most.
void findWithin(const SphereHierarchy::Storage& cloud, const Point3& query, double radius, NeighborScratch& scratch,
                Work& work);
bool findAny(const SphereHierarchy::Storage& cloud, const Point3& query, double radius, Work& work);
void findNearest(const SphereHierarchy::Storage& cloud, const Point3& query, std::size_t k, double radius,
                 NeighborScratch& scratch, Work& work);

} // namespace pcl_bsh

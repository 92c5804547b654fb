// SPDX-License-Identifier: BSD-3-Clause
// What queries for neighbours share below their public face: memory kept from query to query, and the last steps.
#pragma once

#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/neighbors/neighbors.h>

#include <hwy/contrib/sort/vqsort.h>

#include <type_traits>

namespace pcl_bsh {

/// A list that grows but never shrinks, and is not written before it is used. Large ones are kept for other uses when
/// they end (LargeBuffer).
template <class T>
class ScratchArray {
  static_assert(std::is_trivially_copyable_v<T>);

public:
  std::size_t size() const noexcept { return size_; }
  void resize(std::size_t size) noexcept { size_ = size; } ///< @pre reserveMore() was called
  void clear() noexcept { size_ = 0; }
  T* data() noexcept { return items_.get(); }
  T* end() noexcept { return items_.get() + size_; }
  T& operator[](std::size_t i) noexcept { return items_[i]; }
  std::size_t bytes() const noexcept { return capacity_ * sizeof(T); }

  /// Makes sure that `more` items fit behind the last one.
  void reserveMore(std::size_t more)
  {
    if (size_ + more > capacity_) grow(size_ + more);
  }

  /// @pre reserveMore() was called
  void push(const T& item) noexcept { items_[size_++] = item; }

private:
  void grow(std::size_t least)
  {
    const std::size_t capacity = std::max(2 * capacity_, least + 64);
    LargeBuffer<T> larger = makeBuffer<T>(capacity);
    std::copy_n(items_.get(), size_, larger.get());
    items_ = std::move(larger);
    capacity_ = capacity;
  }

  LargeBuffer<T> items_;
  std::size_t size_ = 0, capacity_ = 0;
};

/// To be had by a ScratchLease.
struct NeighborScratch {
  ScratchArray<std::uint32_t> records; ///< what was found
  ScratchArray<float> squared; ///< how far it is: perhaps an upper bound while searching, then the value of the answer
  ScratchArray<const Voxel*> voxels; ///< where the candidates for the nearest are, in the order of those

  // of sorting
  ScratchArray<std::uint32_t> sorted_records;
  ScratchArray<float> sorted_squared;
  ScratchArray<std::uint64_t> keys, sorted_keys;
  ScratchArray<std::uint32_t> steps;

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

/// Sorts scratch.records by scratch.squared, its equals in any order.
void sortBySquared(NeighborScratch& scratch);

/// The vectors that an answer is written to.
struct NeighborOutput {
  std::vector<std::int32_t>& indices;
  std::vector<float>& squared_distances;
};

/// Sorts what was found and keeps the first `most` (0: all). Expects the DefaultFloatEnvironment.
void writeNearestFirst(const PointsView& view, const Point3& query, const RadiusOptions& options,
                       NeighborScratch& scratch, const NeighborOutput& found, Work& work);

/// One query each, arguments checked, environment set: found and measured, in any order. The radius search ignores
/// options.most.
void findWithin(const SphereHierarchy::Storage& cloud, const Point3& query, double radius, NeighborScratch& scratch,
                Work& work);
bool findAny(const SphereHierarchy::Storage& cloud, const Point3& query, double radius, Work& work);
void findNearest(const SphereHierarchy::Storage& cloud, const Point3& query, std::size_t k, double radius,
                 NeighborScratch& scratch, Work& work);

} // namespace pcl_bsh

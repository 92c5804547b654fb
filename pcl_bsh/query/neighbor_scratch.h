// SPDX-License-Identifier: BSD-3-Clause
// What queries for neighbours share below their public face: memory kept from query to query, and the last steps.
#pragma once

#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/query/neighbors.h>

namespace pcl_bsh {

/// A list that grows but never shrinks, and is not written before it is used.
template <class T>
class Pile {
public:
  std::size_t size() const noexcept { return size_; }
  void resize(std::size_t size) noexcept { size_ = size; } ///< @pre room() was made
  void clear() noexcept { size_ = 0; }
  T* data() noexcept { return items_.data(); }
  T* end() noexcept { return items_.data() + size_; }
  T& operator[](std::size_t i) noexcept { return items_[i]; }

  /// Makes sure that `more` items fit behind the last one.
  void room(std::size_t more)
  {
    if (size_ + more > items_.size()) items_.resize(std::max(2 * items_.size(), size_ + more + 64));
  }

  /// @pre room() was made
  void push(const T& item) noexcept { items_[size_++] = item; }

private:
  std::vector<T> items_;
  std::size_t size_ = 0;
};

/// One per thread.
struct NeighborScratch {
  Pile<std::uint32_t> records; ///< what was found
  Pile<float> squared;         ///< how far it is: perhaps an upper bound while searching, then the value to deliver
  Pile<const Voxel*> voxels;   ///< where the candidates for the nearest are, in the order of those

  // of sorting
  Pile<std::uint32_t> sorted_records;
  Pile<float> sorted_squared;
  Pile<std::uint64_t> keys, sorted_keys;
  Pile<std::uint32_t> steps;

  static NeighborScratch& ofThisThread();
};

void checkRadius(double radius);

/// Exact: |p - q| <= radius.
bool isWithin(const Point3& p, const Point3& q, double radius, Work& work);

/// Sorts scratch.records by scratch.squared, its equals in any order.
void sortBySquared(NeighborScratch& scratch);

/// Where an answer goes.
struct Delivery {
  std::vector<std::int32_t>& indices;
  std::vector<float>& squared_distances;
};

/// Sorts what was found and keeps the first `most` (0: all). Expects the DefaultFloatEnvironment.
void deliver(const PointsView& view, const Point3& query, const RadiusOptions& options, NeighborScratch& scratch,
             const Delivery& found, Work& work);

/// One query each, arguments checked, environment set: found and measured, in any order. The radius search ignores
/// options.most.
void findWithin(const SphereHierarchy::Storage& cloud, const Point3& query, double radius, NeighborScratch& scratch,
                Work& work);
bool findAny(const SphereHierarchy::Storage& cloud, const Point3& query, double radius, Work& work);
void findNearest(const SphereHierarchy::Storage& cloud, const Point3& query, std::size_t k, double radius,
                 NeighborScratch& scratch, Work& work);

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/neighbor_scratch.h>

#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/geometry/squared_distance.h>

#include <hwy/contrib/sort/vqsort.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

namespace pcl_bsh {
namespace {

const ExactDistance& unposed()
{
  static const ExactDistance distance(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity());
  return distance;
}

/// A squared distance and a record as one number that sorts by the one, then by the other.
std::uint64_t keyOf(float squared, std::uint32_t record)
{
  return std::uint64_t{std::bit_cast<std::uint32_t>(squared)} << 32 | record;
}
float squaredOf(std::uint64_t key)
{
  return std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32));
}
std::uint32_t recordOf(std::uint64_t key)
{
  return static_cast<std::uint32_t>(key);
}

/// PointsView::point() for one scalar type.
template <class T>
Point3 pointAt(const PointsView& view, std::uint32_t record)
{
  const auto* base = static_cast<const unsigned char*>(view.data) + view.stride * record;
  Point3 p;
  for (std::size_t k = 0; k < 3; ++k) {
    T value;
    std::memcpy(&value, base + view.offset[k], sizeof value);
    p[k] = value;
  }
  return p;
}

template <class T>
void measure(const PointsView& view, const Point3& query, const std::uint32_t* records, std::size_t count,
             std::uint64_t* keys)
{
  for (std::size_t i = 0; i < count; ++i)
    keys[i] = keyOf(squaredDistanceAsFloat(pointAt<T>(view, records[i]), query), records[i]);
}

void sortKeys(std::uint64_t* keys, std::size_t count)
{
  constexpr std::size_t kFew = 48; // below, calling the vectorised sort costs more than it saves
  if (count <= kFew) {
    std::sort(keys, keys + count);
    return;
  }
  thread_local const hwy::Sorter sorter;
  sorter(keys, count, hwy::SortAscending());
}

/// Squared distances that are one float need not be one number: puts those runs that begin among the first `most` in
/// their exact order.
void settleTies(const PointsView& view, const Point3& query, std::uint64_t* keys, std::size_t count, std::size_t most,
                Work& work)
{
  const auto nearer = [&](std::uint64_t x, std::uint64_t y) {
    const Point3 p = view.point(recordOf(x)), q = view.point(recordOf(y));
    if (p == q) return x < y;
    ++work.exact_decisions;
    const int sign = unposed().compareGaps({p, query}, {q, query});
    return sign != 0 ? sign < 0 : x < y;
  };
  for (std::size_t begin = 0; begin + 1 < count && begin < most;) {
    std::size_t end = begin + 1;
    while (end < count && keys[end] >> 32 == keys[begin] >> 32) ++end;
    if (end - begin > 1 && !std::is_sorted(keys + begin, keys + end, nearer))
      std::sort(keys + begin, keys + end, nearer);
    begin = end;
  }
}

} // namespace

NeighborScratch& NeighborScratch::ofThisThread()
{
  thread_local NeighborScratch scratch;
  return scratch;
}

bool isFinite(const Point3& point) noexcept
{
  return std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
}

void checkRadius(double radius)
{
  if (!(radius >= 0.0)) throw std::invalid_argument("radius: " + std::to_string(radius) + ": give a length >= 0");
}

bool isWithin(const Point3& p, const Point3& q, double radius, Work& work)
{
  ++work.exact_decisions;
  return unposed().compare(p, q, radius) <= 0;
}

void deliver(const PointsView& view, const Point3& query, const RadiusOptions& options, NeighborScratch& scratch,
             Neighbors& found, Work& work)
{
  const std::size_t count = scratch.records.size();
  scratch.keys.clear();
  scratch.keys.room(count);
  std::uint64_t* const keys = scratch.keys.data();
  if (view.scalar == Scalar::float32)
    measure<float>(view, query, scratch.records.data(), count, keys);
  else
    measure<double>(view, query, scratch.records.data(), count, keys);
  const std::size_t kept = options.most == 0 ? count : std::min(count, options.most);
  if (options.sorted || kept < count) {
    sortKeys(keys, count);
    settleTies(view, query, keys, count, kept, work);
  }
  found.indices.resize(kept);
  found.squared_distances.resize(kept);
  for (std::size_t i = 0; i < kept; ++i) {
    found.indices[i] = static_cast<std::int32_t>(recordOf(keys[i]));
    found.squared_distances[i] = squaredOf(keys[i]);
  }
}

} // namespace pcl_bsh

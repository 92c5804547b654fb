// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/build/voxel_edge.h>

#include <pcl_bsh/hierarchy/build/morton.h>

#include <hwy/contrib/sort/vqsort.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl_bsh {
namespace {

// Enough points that the work of a voxel outweighs its frame, few enough that building one stays in the cache.
constexpr double kPointsPerVoxel = 6000.0;

// A voxel counts as one of strays where it holds less than 1 / kStrayShare of the wanted points.
constexpr double kStrayShare = 64.0;

// Keep an edge and its inverse normal numbers; 2^20 of the largest hold any cloud of doubles.
constexpr double kSmallestEdge = 0x1p-1000, kLargestEdge = 0x1p1006;

/// The smallest edge for which cells of 20 bits per axis reach over the cloud (one bit of the 21 is to spare). No
/// coordinate may count more cells than a float can hold.
double finestEdge(const Bounds& bounds)
{
  double half = 0.0, largest = 0.0; // half of the extent: the extent itself might overflow
  for (std::size_t k = 0; k < 3; ++k) {
    half = std::max(half, bounds.high[k] / 2 - bounds.low[k] / 2);
    largest = std::max({largest, std::abs(bounds.low[k]), std::abs(bounds.high[k])});
  }
  if (!(half > 0.0)) half = std::max(largest, 1.0); // one place: any edge will do
  const double over_cloud = std::exp2(std::ilogb(half) + 2 - 20),
               countable = std::exp2(std::ilogb(largest * 0x1p-100) + 1);
  return std::clamp(largest > 0.0 ? std::max(over_cloud, countable) : over_cloud, kSmallestEdge, kLargestEdge);
}

} // namespace

double voxelEdgeFromRequest(double edge, const Bounds& bounds)
{
  const double power = std::exp2(std::round(std::log2(std::clamp(edge, kSmallestEdge, kLargestEdge))));
  return std::max(power, finestEdge(bounds));
}

double voxelEdgeFromDensity(const PointsView& view, const Bounds& bounds)
{
  const double cell = finestEdge(bounds);
  const double wanted = std::max(1.0, static_cast<double>(bounds.finite) / kPointsPerVoxel);

  // Morton codes of a sample: neighbours in sorted order that first differ in bits of level L are in different voxels
  // from level L down.
  const std::size_t sample = sampleSize(view);
  std::vector<std::uint64_t> codes;
  codes.reserve(sample);
  for (std::size_t i = 0; i < sample; ++i) {
    const Point3 p = view.point(sampleRecord(view, i));
    std::array<std::uint64_t, 3> number;
    bool finite = true;
    for (std::size_t k = 0; k < 3; ++k) {
      finite = finite && std::isfinite(p[k]);
      // The bounds may be a sample's: points lie outside.
      const double cells = p[k] / cell - bounds.low[k] / cell;
      if (finite) number[k] = static_cast<std::uint64_t>(std::clamp(cells, 0.0, 0x1.fffffp20));
    }
    if (finite) codes.push_back(mortonCode(number[0], number[1], number[2]));
  }
  hwy::Sorter()(codes.data(), codes.size(), hwy::SortAscending());

  std::array<std::size_t, kMortonBits + 1> split_at{}; // [b]: neighbours whose codes differ first in bit b of some axis
  for (std::size_t i = 1; i < codes.size(); ++i) {
    const std::uint64_t difference = codes[i] ^ codes[i - 1];
    if (difference != 0) ++split_at[static_cast<std::size_t>(63 - __builtin_clzll(difference)) / 3];
  }
  // The number of occupied voxels of edge cell * 2^b. Voxels of strays count in part, by the points that they hold.
  const double enough = std::max(1.0, static_cast<double>(codes.size()) / (kStrayShare * wanted));
  const auto occupiedByMany = [&](unsigned b) {
    double occupied = 0.0;
    for (std::size_t i = 0, end = 0; i < codes.size(); i = end) {
      while (end < codes.size() && codes[end] >> 3 * b == codes[i] >> 3 * b) ++end;
      occupied += std::min(1.0, static_cast<double>(end - i) / enough);
    }
    return occupied;
  };

  double edge = kLargestEdge;
  std::size_t occupied = 1;
  const double most = std::max(2.0, wanted * wanted);
  for (unsigned b = kMortonBits; b-- > 0;) {
    // Going down to voxels of edge cell * 2^b: stop where their number would be farther from the wanted one, as a
    // ratio, than the present number. Two are never too many: an outlier has one of its own. But a few strays must not
    // keep all other points in one voxel: go on where voxels of many points are too few even two levels farther down.
    const std::size_t finer = occupied + split_at[b];
    if (static_cast<double>(finer) * static_cast<double>(occupied) > most &&
        occupiedByMany(b - std::min(b, 1u)) * occupiedByMany(b - std::min(b, 2u)) > most)
      break;
    occupied = finer;
    edge = cell * std::exp2(static_cast<double>(b));
  }
  return std::clamp(edge, cell, kLargestEdge);
}

} // namespace pcl_bsh

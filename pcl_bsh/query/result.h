// SPDX-License-Identifier: BSD-3-Clause
// What queries return: the answer, and the work it took.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace pcl_bsh {

enum class Verdict : std::uint8_t { free, colliding, undecided };

/// As it stands among flags.
constexpr std::uint8_t flagOf(Verdict verdict) noexcept
{
  return static_cast<std::uint8_t>(verdict);
}

/// Noise-free cost of a query. The same for any number of threads.
struct Work {
  std::uint64_t node_pairs = 0;      ///< sphere-sphere tests of two nodes
  std::uint64_t leaf_pairs = 0;      ///< pairs of leaves whose points were compared
  std::uint64_t exact_decisions = 0; ///< pairs of points, or of tiny nodes, that float arithmetic could not decide
  std::uint64_t voxels_built = 0;    ///< voxels whose octree and spheres this query built, of both clouds

  Work& operator+=(const Work& other) noexcept
  {
    node_pairs += other.node_pairs;
    leaf_pairs += other.leaf_pairs;
    exact_decisions += other.exact_decisions;
    voxels_built += other.voxels_built;
    return *this;
  }
};

/// One point of each cloud, as record numbers of the clouds' views.
struct PointPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  bool operator==(const PointPair& other) const noexcept { return a == other.a && b == other.b; }
  bool operator<(const PointPair& other) const noexcept { return a != other.a ? a < other.a : b < other.b; }
};

/// Holds a length for certain: lower <= length <= upper.
struct Interval {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

struct AnyResult {
  Verdict verdict = Verdict::free;  ///< undecided only when the request's accuracy lets the walk stop early
  std::optional<PointPair> witness; ///< a colliding pair, when colliding
  Interval distance;                ///< of the clouds, as far as the walk had to learn it
  Work work;
};

struct FlagsResult {
  /// One per record of a's view, a Verdict as a number: 0 free, 1 collides, 2 undecided, the latter only when the
  /// request's accuracy lets the walk stop early. Empty when not asked for.
  std::vector<std::uint8_t> a;
  std::vector<std::uint8_t> b; ///< likewise for b
  std::size_t colliding_a = 0;
  std::size_t colliding_b = 0;
  std::size_t undecided_a = 0;
  std::size_t undecided_b = 0;
  Work work;
};

struct DistanceResult {
  /// Smallest |T_a p - T_b q|, less the two points' radii where given (then negative = depth of overlap); rounded to
  /// the nearest double. Infinity when a cloud has no finite point.
  double distance = std::numeric_limits<double>::infinity();
  std::optional<PointPair> pair; ///< the pair that realises it; of several, the smallest (a, b)
  /// Holds the smallest distance for certain. The neighbouring doubles of `distance` when the request's accuracy is
  /// exact; otherwise `distance` and `pair` are those of the nearest pair that was found, and the upper end.
  Interval interval;
  Work work;
};

} // namespace pcl_bsh

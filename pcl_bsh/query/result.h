// SPDX-License-Identifier: BSD-3-Clause
// The words that the results of all queries share.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/work.h>

#include <cstdint>
#include <limits>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Sparse: undecided, because the other cloud is not scanned densely enough there; only where a request asks for that.
enum class Verdict : std::uint8_t { free, colliding, undecided, sparse };

/// As it stands among flags.
constexpr std::uint8_t flagOf(Verdict verdict) noexcept
{
  return static_cast<std::uint8_t>(verdict);
}

/// One point of each cloud, as record numbers of the clouds' views.
struct PointPair {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  /// By a, then by b: of several pairs queries tell the smallest.
  bool operator==(const PointPair& other) const noexcept { return a == other.a && b == other.b; }
  bool operator<(const PointPair& other) const noexcept { return a != other.a ? a < other.a : b < other.b; }
};

/// Holds a length for certain: lower <= length <= upper.
struct Interval {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

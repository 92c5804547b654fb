// SPDX-License-Identifier: BSD-3-Clause
// The words that the results of all queries share.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/work.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Sparse: undecided, because the other cloud is not scanned densely enough there. Unseen: it would be free, but no
/// scanner saw that there is nothing. Both only where a request asks for that.
enum class Verdict : std::uint8_t { free, colliding, undecided, sparse, unseen };

/// The graver of two verdicts: colliding, then undecided, sparse, unseen, and at last free.
constexpr Verdict graver(Verdict one, Verdict other) noexcept
{
  if (one == Verdict::free || other == Verdict::free) return one == Verdict::free ? other : one;
  return one < other ? one : other;
}
/// How many are this one.
inline std::size_t countOf(const std::vector<Verdict>& verdicts, Verdict verdict)
{
  return static_cast<std::size_t>(std::count(verdicts.begin(), verdicts.end(), verdict));
}

/// 1 for each verdict that is free, or, with `free` false, for each that is not; 0 for the others.
inline std::vector<std::uint8_t> maskOf(const std::vector<Verdict>& verdicts, bool free)
{
  std::vector<std::uint8_t> mask(verdicts.size());
  std::transform(verdicts.begin(), verdicts.end(), mask.begin(),
                 [free](Verdict verdict) { return (verdict == Verdict::free) == free ? 1 : 0; });
  return mask;
}

/// Verdicts as fields of files and arrays of other libraries have them: a byte each, 0 free, 1 colliding, 2 undecided,
/// 3 sparse, 4 unseen. In the memory of the verdicts.
inline const std::uint8_t* bytesOf(const std::vector<Verdict>& verdicts) noexcept
{
  return reinterpret_cast<const std::uint8_t*>(verdicts.data());
}

/// A copy of the verdicts as numbers.
inline std::vector<std::uint8_t> numbersOf(const std::vector<Verdict>& verdicts)
{
  return {bytesOf(verdicts), bytesOf(verdicts) + verdicts.size()};
}

/// An entry of an array of numbers that stands for nothing: -1 for signed numbers, else the greatest number.
struct Nothing { /// @cond
  template <class Number, class = std::enable_if_t<std::is_integral_v<Number> && !std::is_same_v<Number, bool>>>
  constexpr operator Number() const noexcept
  {
    return static_cast<Number>(-1);
  }
  template <class Number>
  friend constexpr bool operator==(Number number, Nothing) noexcept
  {
    return number == static_cast<Number>(-1);
  }
  template <class Number>
  friend constexpr bool operator!=(Number number, Nothing) noexcept
  {
    return number != static_cast<Number>(-1);
  } /// @endcond
};
/// How results say "none" for records, poses, clusters and balls. A single value uses std::optional.
inline constexpr Nothing kNothing;

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

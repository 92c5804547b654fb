// SPDX-License-Identifier: BSD-3-Clause
// An exact order of lines in space, each given by a span between two of its places. Spans of one line compare equal.
#pragma once

#include <pcl_bsh/geometry/exact/dyadic.h>
#include <pcl_bsh/geometry/exact/long_number.h>
#include <pcl_bsh/geometry/exact/rough_number.h>
#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/geometry/rounding.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace pcl_bsh {

/// The part of a line between two finite places. @pre low < high in lexicographic order
struct LineSpan {
  Point3 low, high;
};

namespace line_order {

/// The sign of u_j v_k - v_j u_k for u = a1 - a0 and v = b1 - b0.
template <class Number>
int turn(const Point3& a0, const Point3& a1, const Point3& b0, const Point3& b1, std::size_t j, std::size_t k,
         bool& sure)
{
  const auto along = [](const Point3& from, const Point3& to, std::size_t axis) {
    return Number(to[axis]) - Number(from[axis]);
  };
  const Number left = along(a0, a1, j) * along(b0, b1, k), right = along(b0, b1, j) * along(a0, a1, k);
  if constexpr (std::is_same_v<Number, Dyadic>)
    return (left - right).sign();
  else
    return (left - right).sign(sure);
}

inline int turn(const Point3& a0, const Point3& a1, const Point3& b0, const Point3& b1, std::size_t j, std::size_t k)
{
  const bool no_left = a0[j] == a1[j] || b0[k] == b1[k], no_right = b0[j] == b1[j] || a0[k] == a1[k];
  if (no_left && no_right) return 0;
  bool sure = true;
  if (const int sign = turn<RoughNumber>(a0, a1, b0, b1, j, k, sure); sure) return sign;
  sure = true;
  if (const int sign = turn<LongNumber>(a0, a1, b0, b1, j, k, sure); sure) return sign;
  return turn<Dyadic>(a0, a1, b0, b1, j, k, sure);
}

/// The first coordinate along which a span has a length.
inline std::size_t axisOf(const LineSpan& span)
{
  std::size_t k = 0;
  while (k < 2 && span.low[k] == span.high[k]) ++k;
  return k;
}

} // namespace line_order

/// Compares lines by their slopes: negative, 0 where they are parallel, or positive. A strict weak order.
/// @pre the default floating-point environment
inline int compareDirections(const LineSpan& a, const LineSpan& b)
{
  const std::size_t k = line_order::axisOf(a), other = line_order::axisOf(b);
  if (k != other) return k < other ? -1 : 1;
  for (std::size_t j = k + 1; j < 3; ++j)
    if (const int sign = line_order::turn(a.low, a.high, b.low, b.high, j, k)) return sign;
  return 0;
}

/// The growth of the second coordinate per unit of the first one along a line, in double arithmetic.
struct RoughSlope {
  double value; ///< NaN unless its absolute value is between 2^-900 and 2^900

  explicit RoughSlope(const LineSpan& span) : value((span.high[1] - span.low[1]) / (span.high[0] - span.low[0]))
  {
    if (!(std::abs(value) > 0x1p-900 && std::abs(value) < 0x1p900)) value = std::numeric_limits<double>::quiet_NaN();
  }

  /// As compareDirections(), or 0 where this does not tell: each slope errs by three roundings.
  int compare(const RoughSlope& other) const
  {
    const double doubt = 8 * kDoubleUnit * (std::abs(value) + std::abs(other.value));
    return value < other.value - doubt ? -1 : value > other.value + doubt ? 1 : 0;
  }
};

/// Compares lines by their directions, and parallel lines by their offset: 0 where the spans are of one line.
/// @pre as compareDirections()
inline int compareLines(const LineSpan& a, const LineSpan& b)
{
  if (const int sign = compareDirections(a, b)) return sign;
  for (std::size_t k = 0; k < 3; ++k) // the moments of parallel lines about any place differ as these do
    if (const int sign = line_order::turn(b.low, a.low, a.low, a.high, (k + 1) % 3, (k + 2) % 3)) return sign;
  return 0;
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// Limits and the values of fields, compared as the numbers they are: a nanosecond stamp of today is no double.
#pragma once

#include <pcl_bsh/filters/pipeline/option_type.h>

#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <variant>

namespace pcl_bsh::pipeline {

/// The number that a limit is; none where there is no limit.
inline std::optional<long double> exactly(const Limit& limit)
{
  static_assert(std::numeric_limits<long double>::digits >= 64, "holds each integer of 64 bits, and each double");
  return std::visit(
      [](auto number) -> std::optional<long double> {
        if constexpr (std::is_same_v<decltype(number), std::monostate>)
          return std::nullopt;
        else
          return static_cast<long double>(number);
      },
      limit);
}

/// The values of type T within limits: from `least` to `most`, both inclusive.
template <typename T>
struct RangeOf {
  T least;
  T most;
};

namespace detail {

/// The T nearest to the limit on its inner side; of floats, the nearest on either side. Nothing when all T lie on the
/// outer side. @param up whether the inner side is up
template <typename T>
std::optional<T> inward(const std::optional<long double>& limit, bool up)
{
  constexpr T lowest = std::numeric_limits<T>::lowest(), highest = std::numeric_limits<T>::max();
  if (!limit) return up ? lowest : highest;
  if (*limit > static_cast<long double>(highest)) return up ? std::nullopt : std::optional<T>(highest);
  if (*limit < static_cast<long double>(lowest)) return up ? std::optional<T>(lowest) : std::nullopt;
  if constexpr (std::is_integral_v<T>) return static_cast<T>(up ? std::ceil(*limit) : std::floor(*limit));
  auto nearest = static_cast<T>(*limit);
  if constexpr (std::is_same_v<T, double>) { // whole numbers beyond 2^53 lie between doubles
    if (up && nearest < *limit) nearest = std::nextafter(nearest, highest);
    if (!up && nearest > *limit) nearest = std::nextafter(nearest, lowest);
  }
  return nearest;
}

} // namespace detail

/// Nothing when no finite T lies within the limits. As in PCL, a limit of float values is the nearest float, so that
/// 0.3 is one number on both sides. Values of all other types lie within the limits as written.
template <typename T>
std::optional<RangeOf<T>> rangeOf(const Limits& limits)
{
  const std::optional<T> least = detail::inward<T>(exactly(limits.least), true),
                         most = detail::inward<T>(exactly(limits.most), false);
  if (!least || !most) return std::nullopt;
  return RangeOf<T>{*least, *most};
}

/// Whether both are given and the least is the greater one.
inline bool areCrossed(const Limits& limits)
{
  const std::optional<long double> least = exactly(limits.least), most = exactly(limits.most);
  return least && most && *most < *least;
}

} // namespace pcl_bsh::pipeline

// SPDX-License-Identifier: BSD-3-Clause
// Limits and the values of fields, compared as the numbers they are: a nanosecond stamp of today is no double.
#pragma once

#include <pcl_bsh/filters/pipeline/option_type.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

namespace pcl_bsh::pipeline {

/// a < b as real numbers, for finite ones of any two types.
template <typename A, typename B>
bool isLess(A a, B b)
{
  if constexpr (std::is_integral_v<A> && std::is_integral_v<B>) {
    return std::cmp_less(a, b);
  }
  else if constexpr (std::is_floating_point_v<A> && std::is_floating_point_v<B>) {
    return a < b;
  }
  else if constexpr (std::is_integral_v<A>) { // a < b: not b <= a
    const double whole = std::floor(static_cast<double>(b));
    const double beyond = std::ldexp(1.0, std::numeric_limits<A>::digits); // one more than the greatest A
    if (whole >= beyond) return true;
    if (whole < static_cast<double>(std::numeric_limits<A>::lowest())) return false;
    const auto below = static_cast<A>(whole);
    return a < below || (a == below && whole < static_cast<double>(b));
  }
  else {
    const double whole = std::ceil(static_cast<double>(a));
    const double beyond = std::ldexp(1.0, std::numeric_limits<B>::digits);
    if (whole >= beyond) return false;
    if (whole < static_cast<double>(std::numeric_limits<B>::lowest())) return true;
    const auto above = static_cast<B>(whole);
    return above < b || (above == b && static_cast<double>(a) < whole);
  }
}

/// The values of type T within limits: from `least` to `most`, both inclusive.
template <typename T>
struct RangeOf {
  T least;
  T most;
};

namespace detail {

/// The T nearest to the limit on its inner side; nothing when all T lie on the outer one. @param up the inner side is
/// up
template <typename T, typename Number>
std::optional<T> inward(Number limit, bool up)
{
  constexpr T lowest = std::numeric_limits<T>::lowest(), highest = std::numeric_limits<T>::max();
  if (isLess(highest, limit)) return up ? std::nullopt : std::optional<T>(highest);
  if (isLess(limit, lowest)) return up ? std::optional<T>(lowest) : std::nullopt;
  if constexpr (std::is_integral_v<T> && std::is_floating_point_v<Number>) {
    return static_cast<T>(up ? std::ceil(limit) : std::floor(limit));
  }
  else {
    auto nearest = static_cast<T>(limit);
    if constexpr (std::is_same_v<T, double>) { // whole numbers beyond 2^53 lie between doubles
      constexpr double infinity = std::numeric_limits<double>::infinity();
      if (up && isLess(nearest, limit)) nearest = std::nextafter(nearest, infinity);
      if (!up && isLess(limit, nearest)) nearest = std::nextafter(nearest, -infinity);
    }
    return nearest;
  }
}

template <typename T>
std::optional<T> inward(const Limit& limit, bool up)
{
  return std::visit(
      [up](auto number) -> std::optional<T> {
        if constexpr (std::is_same_v<decltype(number), std::monostate>) {
          return up ? std::numeric_limits<T>::lowest() : std::numeric_limits<T>::max();
        }
        else {
          return inward<T>(number, up);
        }
      },
      limit);
}

} // namespace detail

/// Nothing when no finite T lies within the limits. As PCL has it, a limit of float values is the nearest float, so
/// that 0.3 is the same number on both sides; of all other types, the values are those within the limits as written.
template <typename T>
std::optional<RangeOf<T>> rangeOf(const Limits& limits)
{
  const std::optional<T> least = detail::inward<T>(limits.least, true), most = detail::inward<T>(limits.most, false);
  if (!least || !most) return std::nullopt;
  return RangeOf<T>{*least, *most};
}

/// Whether both are given and the least is the greater one.
inline bool areCrossed(const Limits& limits)
{
  return std::visit(
      [](auto least, auto most) {
        if constexpr (std::is_same_v<decltype(least), std::monostate> ||
                      std::is_same_v<decltype(most), std::monostate>) {
          return false;
        }
        else {
          return isLess(most, least);
        }
      },
      limits.least, limits.most);
}

} // namespace pcl_bsh::pipeline

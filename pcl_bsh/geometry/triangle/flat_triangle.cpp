// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/triangle/flat_triangle.h>

#include <pcl_bsh/geometry/triangle/vector3.h>

#include <algorithm>
#include <limits>
#include <type_traits>

namespace pcl_bsh {
namespace {

template <class Number>
Number rounded(double x)
{
  if constexpr (std::is_same_v<Number, float>)
    return roundToFloat(x);
  else
    return x;
}

/// The inverse of a square; 0 where it and its products may leave the range of Number. A side left out like this is at
/// most kShortSide long.
template <class Number>
Number inverse(double square)
{
  constexpr double least = std::is_same_v<Number, float> ? 0x1p-120 : 0x1p-900;
  return square > least ? rounded<Number>(1.0 / square) : Number{0};
}
template <class Number>
inline constexpr double kShortSide = std::is_same_v<Number, float> ? 0x1p-60 : 0x1p-450;
template <class Number>
inline constexpr double kFlatRange = std::is_same_v<Number, float> ? 0x1p60 : 0x1p400;

/// The part of y across x, scaled to length 1. @pre |x| = 1, and |y| is not small beside the error of its part along x
Point3 squareTo(const Point3& x, const Point3& y)
{
  const Point3 rest = y - dot(y, x) * x;
  return (1.0 / std::sqrt(dot(rest, rest))) * rest;
}

} // namespace

template <class Number>
FlatTriangle<Number> flatten(const Triangle3& corners, double slack)
{
  FlatTriangle<Number> flat;
  double largest = 0.0;
  for (const Point3& corner : corners)
    for (const double x : corner) largest = std::max(largest, std::abs(x));
  const Point3 sides[3] = {corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
  const double squares[3] = {dot(sides[0], sides[0]), dot(sides[1], sides[1]), dot(sides[2], sides[2])};
  const std::size_t first = squares[0] >= squares[1] && squares[0] >= squares[2] ? 0 : squares[1] >= squares[2] ? 1 : 2;
  const Point3 &start = corners[first], &longest = sides[first], far = -1.0 * sides[(first + 2) % 3];
  const double length = std::sqrt(squares[first]);
  for (std::size_t k = 0; k < 3; ++k) flat.origin[k] = rounded<Number>(start[k]);
  const bool in_range = largest <= kFlatRange<Number> && (length == 0.0 || length > 1.0 / kFlatRange<double>);
  if (!in_range) {
    flat.error = std::numeric_limits<Number>::infinity();
    return flat;
  }

  if (length > 0.0) {
    const Point3 x = (1.0 / length) * longest;
    const Point3 rest = far - dot(far, x) * x;
    const double height = std::sqrt(dot(rest, rest));
    Point3 y = {0.0, 0.0, 0.0};
    if (height > 0x1p-48 * length) { // else any direction will do: the apex is where it is measured
      y = squareTo(x, (1.0 / height) * rest);
    }
    else {
      const auto smaller = [&](std::size_t i, std::size_t j) { return std::abs(x[i]) < std::abs(x[j]) ? i : j; };
      y[smaller(smaller(0, 1), 2)] = 1.0;
      y = squareTo(x, y);
    }
    const Point3 rows[3] = {x, y, cross(x, y)};
    for (std::size_t k = 0; k < 9; ++k) flat.rows[k] = rounded<Number>(rows[k / 3][k % 3]);
    flat.length = rounded<Number>(length);
    flat.apex_x = std::clamp(rounded<Number>(dot(far, x)), Number{0}, flat.length);
    flat.apex_y = std::max(rounded<Number>(dot(far, y)), Number{0});
  }

  // How far from their stored places the rounded rows carry the corners.
  const Point3 stored[3] = {{0, 0, 0}, {double{flat.length}, 0, 0}, {double{flat.apex_x}, double{flat.apex_y}, 0}};
  const Point3 origin = {double{flat.origin[0]}, double{flat.origin[1]}, double{flat.origin[2]}};
  double apart = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point3 at = corners[(first + i) % 3] - origin;
    double squared = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Number* row = flat.rows + 3 * k;
      const double off = double{row[0]} * at[0] + double{row[1]} * at[1] + double{row[2]} * at[2] - stored[i][k];
      squared += off * off;
    }
    apart = std::max(apart, std::sqrt(squared));
  }
  const double error =
      apart + slack + (kFlatTriangleUnits * kFlatUnit<Number> + 16 * kDoubleUnit) * length + kShortSide<Number>;
  const double outward = error * (1.0 + 0x1p-16);
  if constexpr (std::is_same_v<Number, float>)
    flat.error = roundUp(outward);
  else
    flat.error = outward;

  const double x = double{flat.apex_x}, rest = double{flat.length} - x, height = double{flat.apex_y};
  constexpr double steepest = double{std::numeric_limits<Number>::max()};
  flat.to_start = inverse<Number>(x * x + height * height);
  flat.to_end = inverse<Number>(rest * rest + height * height);
  flat.rise = height > 0.0 ? rounded<Number>(std::min(height / x, steepest)) : Number{0};
  flat.fall = height > 0.0 ? rounded<Number>(std::min(height / rest, steepest)) : Number{0};
  return flat;
}

template FlatTriangle<float> flatten(const Triangle3& corners, double slack);
template FlatTriangle<double> flatten(const Triangle3& corners, double slack);

FlatTriangle<float> flatten(const LocalFrame& frame, const Triangle3& corners)
{
  Triangle3 local;
  double reach = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      local[i][k] = (corners[i][k] - frame.origin[k]) / frame.unit;
      reach = std::max(reach, std::abs(local[i][k]));
    }
  return flatten<float>(local, 4 * kDoubleUnit * reach); // a difference, on each of three axes
}

} // namespace pcl_bsh

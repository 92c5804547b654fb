// SPDX-License-Identifier: BSD-3-Clause
// Where triangles are nearest to points and to each other, in double: to be shown, not to decide by.
#pragma once

#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace pcl_bsh {

/// Up to rounding, also of triangles without area.
inline Point3 nearestPoint(const Point3& p, const Triangle3& triangle)
{
  using Vector = std::array<double, 3>;
  const auto less = [](const Vector& a, const Vector& b) { return Vector{a[0] - b[0], a[1] - b[1], a[2] - b[2]}; };
  const auto dot = [](const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const auto at = [](const Vector& from, const Vector& u, double s, const Vector& v, double t) {
    return Vector{from[0] + s * u[0] + t * v[0], from[1] + s * u[1] + t * v[1], from[2] + s * u[2] + t * v[2]};
  };
  const Vector u = less(triangle[1], triangle[0]), v = less(triangle[2], triangle[0]), w = less(p, triangle[0]);
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const double area = uu * vv - uv * uv;
  const double s = vv * uw - uv * vw, t = uu * vw - uv * uw; // times the area
  if (area > 0.0 && s >= 0.0 && t >= 0.0 && s + t <= area) return at(triangle[0], u, s / area, v, t / area);
  Point3 nearest = triangle[0];
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Point3& from = triangle[k];
    const Vector side = less(triangle[(k + 1) % 3], from);
    const double length = dot(side, side);
    const double share = length > 0.0 ? std::clamp(dot(less(p, from), side) / length, 0.0, 1.0) : 0.0;
    const Point3 candidate = at(from, side, share, {}, 0.0);
    const Vector to = less(p, candidate);
    if (!(dot(to, to) < least)) continue;
    least = dot(to, to);
    nearest = candidate;
  }
  return nearest;
}

/// The nearest places of two triangles, one of each. Projecting to and fro (von Neumann) comes to them.
inline std::array<Point3, 2> nearestPoints(const Triangle3& a, const Triangle3& b)
{
  constexpr int most = 1000;
  std::array<Point3, 2> nearest = {a[0], nearestPoint(a[0], b)};
  for (int i = 0; i < most; ++i) {
    const Point3 from = nearest[0];
    nearest[0] = nearestPoint(nearest[1], a);
    if (nearest[0] == from) break;
    nearest[1] = nearestPoint(nearest[0], b);
  }
  return nearest;
}

} // namespace pcl_bsh

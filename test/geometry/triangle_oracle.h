// SPDX-License-Identifier: BSD-3-Clause
// Distances of triangles by the definition, in rational numbers: the least over all places that may be nearest, each
// found by solving for its parameters.
#pragma once

#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/geometry/triangle/vector3.h>

#include "support/random.h"

#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <array>
#include <optional>

namespace pcl_bsh::test {

using Rational =
    boost::multiprecision::number<boost::multiprecision::cpp_rational::backend_type, boost::multiprecision::et_off>;
using RationalPoint = Vector3<Rational>;
using RationalTriangle = std::array<RationalPoint, 3>;

inline RationalPoint posed(const Eigen::Isometry3d& pose, const Point3& p)
{
  RationalPoint at;
  for (Eigen::Index k = 0; k < 3; ++k) {
    at[static_cast<std::size_t>(k)] = Rational(pose(k, 3));
    for (Eigen::Index j = 0; j < 3; ++j)
      at[static_cast<std::size_t>(k)] += Rational(pose(k, j)) * Rational(p[static_cast<std::size_t>(j)]);
  }
  return at;
}

inline RationalTriangle posed(const Eigen::Isometry3d& pose, const Triangle3& t)
{
  return {posed(pose, t[0]), posed(pose, t[1]), posed(pose, t[2])};
}

inline Rational squaredLength(const RationalPoint& v)
{
  return dot(v, v);
}

inline Rational squaredDistance(const RationalPoint& p, const RationalTriangle& t)
{
  Rational least = squaredLength(p - t[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min(least, squaredLength(p - t[i]));
    const RationalPoint edge = t[(i + 1) % 3] - t[i];
    if (squaredLength(edge) == 0) continue;
    const Rational share = dot(p - t[i], edge) / squaredLength(edge);
    if (share > 0 && share < 1) least = std::min(least, squaredLength(p - t[i] - share * edge));
  }
  const RationalPoint u = t[1] - t[0], v = t[2] - t[0], w = p - t[0];
  const Rational a = dot(u, u), b = dot(u, v), c = dot(v, v), d = dot(u, w), e = dot(v, w);
  const Rational whole = a * c - b * b;
  if (whole == 0) return least;
  const Rational s = (c * d - b * e) / whole, r = (a * e - b * d) / whole;
  if (s >= 0 && r >= 0 && s + r <= 1) least = std::min(least, squaredLength(w - s * u - r * v));
  return least;
}

/// Whether a segment meets a triangle at one place, which is not in the segment's line altogether.
inline bool crosses(const RationalPoint& from, const RationalPoint& to, const RationalTriangle& t)
{
  // from + q way = t0 + s u + r v, by Cramer's rule
  const RationalPoint way = from - to, u = t[1] - t[0], v = t[2] - t[0], w = from - t[0];
  const auto determinant = [](const RationalPoint& x, const RationalPoint& y, const RationalPoint& z) {
    return x[0] * (y[1] * z[2] - y[2] * z[1]) - y[0] * (x[1] * z[2] - x[2] * z[1]) + z[0] * (x[1] * y[2] - x[2] * y[1]);
  };
  const Rational whole = determinant(way, u, v);
  if (whole == 0) return false;
  const Rational q = determinant(w, u, v) / whole, s = determinant(way, w, v) / whole,
                 r = determinant(way, u, w) / whole;
  return q >= 0 && q <= 1 && s >= 0 && r >= 0 && s + r <= 1;
}

inline Rational squaredDistance(const RationalTriangle& x, const RationalTriangle& y)
{
  Rational least = squaredLength(x[0] - y[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    least = std::min({least, squaredDistance(x[i], y), squaredDistance(y[i], x)});
    if (crosses(x[i], x[(i + 1) % 3], y) || crosses(y[i], y[(i + 1) % 3], x)) return 0;
    for (std::size_t j = 0; j < 3; ++j) {
      const RationalPoint u = x[(i + 1) % 3] - x[i], v = y[(j + 1) % 3] - y[j], w = x[i] - y[j];
      const Rational a = dot(u, u), b = dot(u, v), c = dot(v, v), d = dot(u, w), e = dot(v, w);
      const Rational whole = a * c - b * b;
      if (whole == 0) continue;
      const Rational s = (b * e - c * d) / whole, r = (a * e - b * d) / whole;
      if (s > 0 && s < 1 && r > 0 && r < 1) least = std::min(least, squaredLength(w + s * u - r * v));
    }
  }
  return least;
}

/// How triangles of the tests look; the last has corners that coincide or lie on one line.
enum class TriangleShape { any, lattice, needle, tiny, flat };
inline constexpr TriangleShape kTriangleShapes[] = {TriangleShape::any, TriangleShape::lattice, TriangleShape::needle,
                                                    TriangleShape::tiny, TriangleShape::flat};

inline Point3 cornerOf(TriangleShape shape, double size, Random& random)
{
  return random.point([&] {
    return shape == TriangleShape::lattice || shape == TriangleShape::flat ? std::ldexp(random.integer(-8, 8), -10)
                                                                           : size * random.uniform(-1, 1);
  });
}

inline Triangle3 triangleOf(TriangleShape shape, double size, Random& random)
{
  Triangle3 t = {cornerOf(shape, size, random), cornerOf(shape, size, random), cornerOf(shape, size, random)};
  for (std::size_t k = 0; k < 3; ++k) {
    if (shape == TriangleShape::tiny)
      t[1][k] = t[0][k] + 1e-7 * (t[1][k] - t[0][k]), t[2][k] = t[0][k] + 1e-7 * t[2][k];
    if (shape == TriangleShape::needle) t[2][k] = t[random.integer(0, 1) == 0 ? 0u : 1u][k] + 1e-5 * t[2][k];
  }
  if (shape != TriangleShape::flat) return t;
  const int kind = random.integer(0, 3); // a point, two segments, three corners on one line
  if (kind == 0) t[1] = t[2] = t[0];
  if (kind == 1) t[2] = t[0];
  if (kind == 2) t[1] = t[2];
  if (kind == 3)
    for (std::size_t k = 0; k < 3; ++k) t[2][k] = t[0][k] + 3 * (t[1][k] - t[0][k]);
  return t;
}

} // namespace pcl_bsh::test

// SPDX-License-Identifier: BSD-3-Clause
// The vector between the nearest places that TriangleDistance finds, and the exact planes across it.
#include <pcl_bsh/geometry/triangle/triangle_distance.h>

#include <pcl_bsh/geometry/exact/exact_plane.h>
#include <pcl_bsh/geometry/triangle/nearest_features.h>
#include <pcl_bsh/geometry/triangle/ordinary_length.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace pcl_bsh {
namespace {

const Point3& cornerOf(const Point3& point, std::size_t)
{
  return point;
}
const Point3& cornerOf(const Triangle3& triangle, std::size_t i)
{
  return triangle[i % 3];
}

/// A vector along the way between the nearest features of two that do not meet, of any length.
/// @param edge_a, edge_b called with a corner's number: the edge from it to the next corner.
/// @param between from a place on one feature to one on the other
template <class EdgeA, class EdgeB>
Vector3<Dyadic> normalAcross(const Features& features, const EdgeA& edge_a, const EdgeB& edge_b,
                             const Vector3<Dyadic>& between)
{
  const auto across = [&](const Vector3<Dyadic>& edge) {
    return dot(edge, edge) * between - dot(between, edge) * edge;
  };
  switch (features.kind) {
  case Features::meeting:
  case Features::corners:
    return between;
  case Features::corner_edge:
    return across(edge_b(features.j));
  case Features::edge_corner:
    return across(edge_a(features.i));
  case Features::edges:
    return cross(edge_a(features.i), edge_b(features.j));
  case Features::corner_face:
    return cross(edge_b(0), edge_b(1));
  case Features::face_corner:
    break;
  }
  return cross(edge_a(0), edge_a(1));
}

/// A vector of the same direction in doubles: its largest component is in [1, 2).
Point3 ofLengthOne(const Vector3<Dyadic>& v)
{
  const Dyadic::Scaled parts[3] = {v[0].scaled(), v[1].scaled(), v[2].scaled()};
  const int largest = std::max({parts[0].exponent, parts[1].exponent, parts[2].exponent});
  const auto part = [&](std::size_t k) { return std::ldexp(parts[k].mantissa, parts[k].exponent - largest); };
  return {part(0), part(1), part(2)};
}

} // namespace

template <class Pair>
Point3 TriangleDistance::betweenNearest(const Pair& pair) const
{
  bool by_integers = false;
  const Features features = nearestFeatures(pair, by_integers);
  const Seen at = seen(pair.a, pair.b);
  const std::size_t i = features.i, j = features.j, next_i = (i + 1) % 3, next_j = (j + 1) % 3;
  const auto across = [](const Point3& from, const Point3& way) { // from a line through 0
    const Point3 edge = ofOrdinaryLength(way);
    return from - (dot(from, edge) / dot(edge, edge)) * edge;
  };
  const auto along = [&](const Point3& from, const Point3& u, const Point3& v) { // from a plane through 0
    const Point3 way_u = ofOrdinaryLength(u), way_v = ofOrdinaryLength(v);
    Point3 normal = cross(way_u, way_v);
    constexpr double needle = 0x1p-40; // of the sine, squared: rounding may turn the normal by its root
    if (!(dot(normal, normal) > needle * dot(way_u, way_u) * dot(way_v, way_v)))
      normal = ofLengthOne(normalAcross(
          features,
          [&](std::size_t k) {
            return placed<Dyadic>(a_, cornerOf(pair.a, k + 1)) - placed<Dyadic>(a_, cornerOf(pair.a, k));
          },
          [&](std::size_t k) { return placed<Dyadic>(b_, pair.b[(k + 1) % 3]) - placed<Dyadic>(b_, pair.b[k]); },
          Vector3<Dyadic>()));
    return (dot(from, normal) / dot(normal, normal)) * normal;
  };
  switch (features.kind) {
  case Features::meeting:
    return {0.0, 0.0, 0.0};
  case Features::corners:
    return at.a[i] - at.b[j];
  case Features::corner_edge:
    return across(at.a[i] - at.b[j], at.b[next_j] - at.b[j]);
  case Features::edge_corner:
    return -1.0 * across(at.b[j] - at.a[i], at.a[next_i] - at.a[i]);
  case Features::edges:
    return along(at.a[i] - at.b[j], at.a[next_i] - at.a[i], at.b[next_j] - at.b[j]);
  case Features::corner_face:
    return along(at.a[i] - at.b[0], at.b[1] - at.b[0], at.b[2] - at.b[0]);
  case Features::face_corner:
    break;
  }
  return -1.0 * along(at.b[j] - at.a[0], at.a[1] - at.a[0], at.a[2] - at.a[0]);
}

template <class Pair>
std::optional<std::array<ExactPlane, 2>> TriangleDistance::planesOfNearest(const Pair& pair) const
{
  using Vector = Vector3<Dyadic>;
  bool by_integers = false;
  const Features features = nearestFeatures(pair, by_integers);
  if (features.kind == Features::meeting) return std::nullopt;
  const auto given_a = [&pair](std::size_t i) { return cornerOf(pair.a, i); };
  const auto edge_a = [&](std::size_t i) {
    return placed<Dyadic>(a_, given_a(i + 1)) - placed<Dyadic>(a_, given_a(i));
  };
  const auto edge_b = [&](std::size_t j) {
    return placed<Dyadic>(b_, pair.b[(j + 1) % 3]) - placed<Dyadic>(b_, pair.b[j]);
  };
  const std::size_t i = features.i, j = features.j;
  const Vector between = placed<Dyadic>(b_, pair.b[j]) - placed<Dyadic>(a_, given_a(i)); // from one plane to the other
  const Vector normal = normalAcross(features, edge_a, edge_b, between);
  const int side = dot(normal, between).sign();
  if (side == 0) return std::nullopt;
  const auto plane = [&normal](const Pose& pose, const Point3& through, double towards) {
    Vector turned; // back
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t k = 0; k < 3; ++k) turned[k] += Dyadic(towards * pose[row][k]) * normal[row];
    return ExactPlane(through, turned);
  };
  return std::array<ExactPlane, 2>{plane(a_, given_a(i), side), plane(b_, pair.b[j], -side)};
}

Point3 TriangleDistance::between(const PointPair& pair) const
{
  return betweenNearest(pair);
}

Point3 TriangleDistance::between(const TrianglePair& pair) const
{
  return betweenNearest(pair);
}

std::optional<std::array<ExactPlane, 2>> TriangleDistance::planesBetween(const PointPair& pair) const
{
  return planesOfNearest(pair);
}

std::optional<std::array<ExactPlane, 2>> TriangleDistance::planesBetween(const TrianglePair& pair) const
{
  return planesOfNearest(pair);
}

} // namespace pcl_bsh

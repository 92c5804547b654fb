// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/triangle/double_distance.h>

#include <pcl_bsh/simd/triangle_lanes-inl.h> // the kernel, of one double in place of lanes of floats

#include <algorithm>
#include <limits>

namespace pcl_bsh {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();

/// Error of places and gaps below, relative to the largest coordinate. A place on an edge errs by 3 v of it on each
/// axis, two places and their distance by less than 13 v. A dot product with a direction errs by 3 v sqrt(3) of it, two
/// such by less than 11 v. Their difference and the quotient err by 4 v of a gap of up to 2 sqrt(3) of it.
constexpr double kPlaceError = 32 * kDoubleUnit;

/// The range of corners along a direction.
struct Span {
  double low, high;
};
template <std::size_t Count>
Span spanOf(const Point3 (&corners)[Count], const Point3& direction)
{
  Span span{kEndless, -kEndless};
  for (const Point3& corner : corners) {
    const double at = dot(corner, direction);
    span.low = std::min(span.low, at);
    span.high = std::max(span.high, at);
  }
  return span;
}

/// A lower bound, within kPlaceError, of the distance of the corners' convex hulls; -infinity where nothing is known.
template <std::size_t Count>
double gapAlong(const Point3 (&a)[Count], const Point3 (&b)[Count], const Point3& direction)
{
  const double square = dot(direction, direction);
  if (!(square > 0x1p-800 && square < 0x1p800)) return -kEndless;
  const Span along_a = spanOf(a, direction), along_b = spanOf(b, direction);
  return std::max(along_b.low - along_a.high, along_a.low - along_b.high) / std::sqrt(square);
}

/// A lower bound, within three times kPlaceError, of the distance of both. It combines the gap along the normal of a
/// with the gap, across this normal, of the circles about both. It separates triangles of surfaces that face each other
/// from far away, unless the triangles are opposite.
double gapAboutNormal(const Point3 (&a)[3], const Point3 (&b)[3])
{
  const Point3 normal = cross(a[1] - a[0], a[2] - a[0]);
  const double along = std::max(gapAlong(a, b, normal), 0.0); // 0, too, where the normal tells nothing
  if (along == 0.0) return -kEndless;
  const Point3 middle_a = (1.0 / 3.0) * (a[0] + a[1] + a[2]), middle_b = (1.0 / 3.0) * (b[0] + b[1] + b[2]);
  double squared_a = 0.0, squared_b = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Point3 from_a = a[k] - middle_a, from_b = b[k] - middle_b;
    squared_a = std::max(squared_a, dot(from_a, from_a)), squared_b = std::max(squared_b, dot(from_b, from_b));
  }
  const Point3 between = middle_b - middle_a;
  const Point3 rest = between - (dot(between, normal) / dot(normal, normal)) * normal;
  const double across = std::max(std::sqrt(dot(rest, rest)) - std::sqrt(squared_a) - std::sqrt(squared_b), 0.0);
  return std::sqrt(along * along + across * across);
}

/// From a place on the first of two edges to one on the second, near the nearest.
/// (After Ericson: Real-Time Collision Detection, 2005, 5.1.9; written anew.)
Point3 betweenEdges(const Point3& from_a, const Point3& way_a, const Point3& from_b, const Point3& way_b)
{
  const Point3 between = from_a - from_b;
  const double aa = dot(way_a, way_a), bb = dot(way_b, way_b), ab = dot(way_a, way_b);
  const double on_a = dot(way_a, between), on_b = dot(way_b, between);
  const auto share = [](double part, double whole) {
    return whole > 0.0 ? std::min(std::max(part / whole, 0.0), 1.0) : 0.0; // not std::clamp: of NaN, it makes NaN
  };
  double s = share(ab * on_b - on_a * bb, aa * bb - ab * ab);
  const double t = share(ab * s + on_b, bb);
  s = share(ab * t - on_a, aa);
  return between + s * way_a - t * way_b;
}

/// The distance of a place from a triangle that was laid flat, and by how much it may be off.
struct Measured {
  double length, off;
};
Measured measure(const FlatTriangle<double>& triangle, const Point3& at)
{
  const double squared = HWY_NAMESPACE::squaredToTriangle(
      triangle, [](double x) { return x; }, at[0], at[1], at[2]);
  const double length = std::sqrt(squared);
  return {length, (length * (kFlatRelative<double> + kFewDoubleRoundings) + triangle.error) * (1.0 + 0x1p-16)};
}

Point3 normalOf(const FlatTriangle<double>& triangle)
{
  return {triangle.rows[6], triangle.rows[7], triangle.rows[8]};
}

/// The least distance from the other triangle to places where edges of one pass through the other's plane, plus its
/// error. Infinite where no edge passes through the plane.
double leastWherePierced(const Triangle3& edges, const FlatTriangle<double>& flat)
{
  const Point3 origin = {flat.origin[0], flat.origin[1], flat.origin[2]};
  double heights[3], least = kEndless;
  for (std::size_t i = 0; i < 3; ++i) heights[i] = dot(normalOf(flat), edges[i] - origin);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    if (!(heights[i] > 0.0 && heights[next] < 0.0) && !(heights[i] < 0.0 && heights[next] > 0.0)) continue;
    const double share = heights[i] / (heights[i] - heights[next]);
    const Measured found = measure(flat, edges[i] + share * (edges[next] - edges[i]));
    least = std::min(least, found.length + found.off);
  }
  return least;
}

} // namespace

ExactDistance::Enclosure distanceOfOrigin(const FlatTriangle<double>& triangle)
{
  const Measured found = measure(triangle, {0.0, 0.0, 0.0});
  if (!std::isfinite(found.length + found.off)) return {-kEndless, kEndless};
  return {found.length - found.off, found.length + found.off};
}

DoubleDistance distanceOfTriangles(const Triangle3& a, const Triangle3& b, double error, double reach)
{
  const Point3 corners_a[3] = {a[0], a[1], a[2]}, corners_b[3] = {b[0], b[1], b[2]};
  double largest = 0.0;
  for (const Triangle3& triangle : {a, b})
    for (const Point3& corner : triangle)
      for (const double x : corner) largest = std::max(largest, std::abs(x));
  DoubleDistance found{{-kEndless, kEndless}, {}};
  if (!(largest < 0x1p200 && (largest > 0x1p-200 || largest == 0.0))) return found;
  const double doubt = error + kPlaceError * largest;

  found.distance.low = gapAlong(corners_a, corners_b, (b[0] + b[1] + b[2]) - (a[0] + a[1] + a[2])) - doubt;
  if (found.distance.low > reach) return found;
  if (reach < kEndless) {
    const double doubt_about = error + 3 * kPlaceError * largest;
    found.distance.low = std::max(found.distance.low, gapAboutNormal(corners_a, corners_b) - doubt_about);
    if (found.distance.low > reach) return found;
  }

  // Corners and faces.
  const FlatTriangle<double> flat_a = flatten<double>(a), flat_b = flatten<double>(b);
  double lows[15];
  double high = kEndless, nearest_edges = kEndless;
  for (std::size_t k = 0; k < 6; ++k) {
    const Measured corner = measure(k < 3 ? flat_b : flat_a, k < 3 ? a[k] : b[k - 3]);
    lows[9 + k] = corner.length - corner.off - doubt;
    high = std::min(high, corner.length + corner.off + doubt);
  }
  if (high >= reach || reach == kEndless)
    high = std::min({high, leastWherePierced(a, flat_b) + doubt, leastWherePierced(b, flat_a) + doubt});

  found.distance.high = high;
  for (const FlatTriangle<double>* flat : {&flat_a, &flat_b})
    found.distance.low = std::max(found.distance.low, gapAlong(corners_a, corners_b, normalOf(*flat)) - doubt);
  if (reach < kEndless && (found.distance.low > reach || high < reach)) return found;

  // Edges, and the directions between the nearest of them.
  Point3 direction = {0, 0, 0}, normal = {0, 0, 0};
  for (std::size_t k = 0; k < 9; ++k) {
    const std::size_t i = k / 3, j = k % 3;
    const Point3 ends_a[2] = {a[i], a[(i + 1) % 3]}, ends_b[2] = {b[j], b[(j + 1) % 3]};
    const Point3 way_a = ends_a[1] - ends_a[0], way_b = ends_b[1] - ends_b[0];
    const Point3 between = betweenEdges(ends_a[0], way_a, ends_b[0], way_b);
    const double length = std::sqrt(dot(between, between));
    high = std::min(high, length + doubt);
    lows[k] = gapAlong(ends_a, ends_b, between) - doubt;
    if (length < nearest_edges) {
      nearest_edges = length;
      direction = between;
      normal = cross(way_a, way_b);
    }
  }
  found.distance.high = high;
  for (const Point3& along : {direction, normal})
    found.distance.low = std::max(found.distance.low, gapAlong(corners_a, corners_b, along) - doubt);
  if (!std::isfinite(high)) return found;
  for (std::size_t k = 0; k < 15; ++k) {
    if (!(lows[k] > high)) continue;
    if (k < 9)
      found.pairs.edges = static_cast<std::uint16_t>(found.pairs.edges & ~(1u << k));
    else
      found.pairs.faces = static_cast<std::uint8_t>(found.pairs.faces & ~(1u << (k - 9)));
  }
  return found;
}

} // namespace pcl_bsh

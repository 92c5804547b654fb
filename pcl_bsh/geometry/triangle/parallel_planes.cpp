// SPDX-License-Identifier: BSD-3-Clause
// TriangleDistance of triangles in parallel planes: whether they lie over each other, and which planes are nearer.
#include <pcl_bsh/geometry/triangle/plane_overlap.h>
#include <pcl_bsh/geometry/triangle/triangle_distance.h>

#include <pcl_bsh/geometry/triangle/nearest_features.h>

#include <array>
#include <optional>

namespace pcl_bsh {
namespace {

Vector3<LongNumber> asGiven(const Point3& p)
{
  return {LongNumber(p[0]), LongNumber(p[1]), LongNumber(p[2])};
}
LongCorners asGiven(const Triangle3& t)
{
  return {asGiven(t[0]), asGiven(t[1]), asGiven(t[2])};
}

} // namespace

PlaneOverlap TriangleDistance::findOverlap(const TrianglePair& pair) const
{
  if (shareCorner(pair)) return PlaneOverlap::unknown;
  std::optional<bool> parallel = areParallelAsGiven(pair);
  const LongCorners a = longCorners(a_, pair.a), b = longCorners(b_, pair.b);
  if (!parallel) parallel = areParallel(a, b);
  if (parallel == false) return PlaneOverlap::unknown;
  const PlaneOverlap overlap = overlapOf(a, b);
  if (parallel || overlap == PlaneOverlap::unknown) return overlap;
  const auto corners = [this](const Pose& pose, const Triangle3& t) -> std::array<Vector3<Dyadic>, 3> {
    return {placed<Dyadic>(pose, t[0]), placed<Dyadic>(pose, t[1]), placed<Dyadic>(pose, t[2])};
  };
  return *areParallel(corners(a_, pair.a), corners(b_, pair.b)) ? overlap : PlaneOverlap::unknown;
}

/// Whether the planes of triangles under one pose are parallel, by the given coordinates, which are short numbers.
/// Nothing where that is not known, or where the poses differ.
std::optional<bool> TriangleDistance::areParallelAsGiven(const TrianglePair& pair) const
{
  if (a_ != b_) return std::nullopt;
  return areParallel(asGiven(pair.a), asGiven(pair.b));
}

/// Sign of the distance of the planes of the first pair less that of the second, which are all parallel. Compares
/// pairs of one pose in the given coordinates: the pose stretches all gaps alike. Nothing where that is not known.
std::optional<int> TriangleDistance::comparePlanesAsGiven(const TrianglePair& first, const TrianglePair& second) const
{
  if (a_ != b_) return std::nullopt;
  const LongCorners a = asGiven(first.a), other = asGiven(second.a);
  if (areParallel(a, other) != true) return std::nullopt;
  const Vector3<LongNumber> normal = cross(a[1] - a[0], a[2] - a[0]);
  const Vector3<LongNumber> way = asGiven(first.b[0]) - a[0], other_way = asGiven(second.b[0]) - other[0];
  bool sure = true;
  const int up = dot(normal, way).sign(sure), other_up = dot(normal, other_way).sign(sure);
  if (up == 0) return sure ? std::optional(other_up == 0 ? 0 : -1) : std::nullopt;
  const Vector3<LongNumber> more = up == other_up ? way - other_way : way + other_way;
  const int side = up * dot(normal, more).sign(sure);
  return sure ? std::optional(side) : std::nullopt;
}

} // namespace pcl_bsh

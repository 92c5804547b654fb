// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/polygon_triangles.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/geometry/triangle/ordinary_length.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

namespace pcl_bsh {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The most corners of a polygon to clip: the time for clipping ears grows with their square.
constexpr std::size_t most_clipped = 4096;

double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c)
{
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// A polygon's corners in the plane of its vector area, counterclockwise on the whole; NaN where it has no area.
std::vector<Vector2d> flattened(const std::vector<Vector3d>& corners)
{
  double largest = 0.0;
  for (const Vector3d& p : corners) largest = std::max(largest, (p - corners[0]).cwiseAbs().maxCoeff());
  const double factor = toOrdinary(largest); // the shape alone counts
  const auto fromFirst = [&](const Vector3d& p) -> Vector3d { return factor * (p - corners[0]); };
  Vector3d area = Vector3d::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i) area += fromFirst(corners[i - 1]).cross(fromFirst(corners[i]));
  const Vector3d normal = area.stableNormalized();
  const Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
  std::vector<Vector2d> flat;
  flat.reserve(corners.size());
  for (const Vector3d& p : corners) flat.emplace_back(x.dot(fromFirst(p)), y.dot(fromFirst(p)));
  return flat;
}

/// Each corner turns left, and all turns together are one round; or there is no area, and so no plane.
bool isConvex(const std::vector<Vector2d>& flat)
{
  const std::size_t count = flat.size();
  int crossings = 0; // of the direction of travel from downwards to upwards: once in a round
  for (std::size_t i = 0; i < count; ++i) {
    const Vector2d &a = flat[i], &b = flat[(i + 1) % count], &c = flat[(i + 2) % count];
    if (turn(a, b, c) < 0) return false;
    if ((b - a).y() < 0 && (c - b).y() >= 0) ++crossings;
  }
  return crossings <= 1;
}

/// The corners of the triangles, or nothing where no ear is left to clip: the polygon crosses itself.
std::optional<std::vector<Triangle>> clipEars(const std::vector<Vector2d>& flat)
{
  std::vector<std::uint32_t> left(flat.size());
  std::iota(left.begin(), left.end(), 0u);
  // Only corners that turn right can lie in an ear; what turns left goes on doing so as others are clipped.
  std::vector<std::uint32_t> reflex;
  for (std::uint32_t i = 0; i < flat.size(); ++i) {
    const std::size_t count = flat.size();
    if (turn(flat[(i + count - 1) % count], flat[i], flat[(i + 1) % count]) <= 0) reflex.push_back(i);
  }
  std::vector<Triangle> triangles;
  std::size_t at = 0, failed = 0;
  while (left.size() > 3) {
    if (failed == left.size()) return std::nullopt;
    const std::size_t count = left.size();
    const std::uint32_t a = left[(at + count - 1) % count], b = left[at % count], c = left[(at + 1) % count];
    const double bend = turn(flat[a], flat[b], flat[c]);
    const auto isInEar = [&](std::uint32_t p) {
      return p != a && p != b && p != c && flat[p] != flat[a] && flat[p] != flat[c] &&
             turn(flat[a], flat[b], flat[p]) >= 0 && turn(flat[b], flat[c], flat[p]) >= 0 &&
             turn(flat[c], flat[a], flat[p]) >= 0;
    };
    if (bend < 0 || (bend > 0 && std::any_of(reflex.begin(), reflex.end(), isInEar))) {
      ++failed;
      at = (at + 1) % count;
      continue;
    }
    triangles.push_back({a, b, c});
    if (bend <= 0) std::erase(reflex, b);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at % count));
    at = at % count % left.size();
    failed = 0;
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

/// The triangles of a polygon, with corners named by their positions in it.
std::vector<Triangle> triangulated(const std::vector<Vector3d>& corners)
{
  const std::vector<Vector2d> flat = flattened(corners);
  if (!isConvex(flat)) {
    if (corners.size() > most_clipped) {
      throw InvalidInput(Input::surface, "surface",
                         plainText("has a face of ", corners.size(), " corners that is not convex"),
                         "export it with triangles");
    }
    if (auto ears = clipEars(flat)) return std::move(*ears);
  }
  std::vector<Triangle> fan;
  for (std::uint32_t i = 2; i < corners.size(); ++i) fan.push_back({0, i - 1, i});
  return fan;
}

} // namespace

void addTriangles(const PointsView& vertices, const std::uint32_t* polygon, std::size_t count,
                  std::vector<Triangle>& triangles)
{
  for (std::size_t i = 0; i < count; ++i) {
    if (polygon[i] < vertices.count) continue;
    throw InvalidInput(Input::surface, "surface",
                       plainText("a face names vertex ", polygon[i], " (from 0), of ", vertices.count),
                       "leave the face out, or mend the mesh");
  }
  if (count < 3) return;
  if (count == 3) {
    triangles.push_back({polygon[0], polygon[1], polygon[2]});
    return;
  }
  std::vector<Vector3d> corners;
  corners.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Point3 p = vertices.point(polygon[i]);
    corners.emplace_back(p[0], p[1], p[2]);
  }
  for (const Triangle& t : triangulated(corners)) triangles.push_back({polygon[t[0]], polygon[t[1]], polygon[t[2]]});
}

} // namespace pcl_bsh

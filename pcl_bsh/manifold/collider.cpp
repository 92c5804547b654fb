// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/manifold/collider.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>
#include <pcl_bsh/manifold/collider_parts.h>
#include <pcl_bsh/neighbors/spacing.h>
#include <pcl_bsh/query/result.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace pcl_bsh {
namespace {

/// Edges whose sides turn by a smaller angle than about this are flat.
constexpr double kFlatTurn = 1e-6;

/// Finite triangles that the view names, ascending.
std::vector<std::uint32_t> trianglesIn(const PointsView& view)
{
  std::vector<std::uint32_t> all;
  for (std::size_t i = 0; i < view.size(); ++i)
    if (isFinite(view.triangles->triangle(view.record(i)))) all.push_back(view.record(i));
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Returns for each vertex the first one at its place.
std::vector<std::uint32_t> firstOfPlaces(const TrianglesView& mesh)
{
  std::vector<std::uint32_t> order(mesh.vertices.count), first(mesh.vertices.count);
  std::iota(order.begin(), order.end(), 0u);
  const auto placeOf = [&](std::uint32_t i) {
    Point3 p = mesh.vertices.point(i);
    for (double& x : p) x = std::isnan(x) ? std::numeric_limits<double>::infinity() : x + 0.0; // 0 for -0
    return p;
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t l, std::uint32_t r) {
    const Point3 p = placeOf(l), q = placeOf(r);
    return p != q ? p < q : l < r;
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && placeOf(order[i]) == placeOf(order[i - 1]) ? first[order[i - 1]] : order[i];
  return first;
}

struct HalfEdge {
  std::uint32_t low, high, triangle, across; ///< ends by number; the corner that is no end
  bool rises;                                ///< whether the triangle passes it from low to high

  bool isOf(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<HalfEdge> halfEdgesOf(const TrianglesView& mesh, const std::vector<std::uint32_t>& triangles,
                                  const std::vector<std::uint32_t>& first)
{
  std::vector<HalfEdge> all;
  all.reserve(3 * triangles.size());
  for (const std::uint32_t t : triangles) {
    const Triangle corners = mesh.cornersOf(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = first[corners[k]], to = first[corners[(k + 1) % 3]];
      if (from != to)
        all.push_back({std::min(from, to), std::max(from, to), t, first[corners[(k + 2) % 3]], from < to});
    }
  }
  std::sort(all.begin(), all.end(), [](const HalfEdge& l, const HalfEdge& r) {
    return std::tie(l.low, l.high, l.triangle) < std::tie(r.low, r.high, r.triangle);
  });
  return all;
}

/// Returns the sign of the volume that the triangles enclose, as doubles sum it: -1 where they are turned inward, else
/// 1.
double windingSign(const TrianglesView& mesh, const std::vector<std::uint32_t>& triangles)
{
  double sum = 0.0;
  if (triangles.empty()) return 1.0;
  const Eigen::Vector3d origin = vectorOf(mesh.triangle(triangles.front())[0]);
  for (const std::uint32_t t : triangles) {
    const auto corners = mesh.triangle(t);
    const Eigen::Vector3d a = vectorOf(corners[0]) - origin, b = vectorOf(corners[1]) - origin;
    sum += a.dot(b.cross(vectorOf(corners[2]) - origin));
  }
  return sum < 0.0 ? -1.0 : 1.0;
}

/// The edge that two triangles pass in opposite directions, if it is no flat one and, of a solid, convex.
std::optional<SharpEdge> sharpEdge(const TrianglesView& mesh, const HalfEdge& one, const HalfEdge& other, bool is_solid,
                                   double outward)
{
  if (one.rises == other.rises) return std::nullopt;
  const auto normalOf = [&](std::uint32_t triangle) {
    const auto corners = mesh.triangle(triangle);
    const Eigen::Vector3d from = vectorOf(corners[0]);
    return (outward * (vectorOf(corners[1]) - from).cross(vectorOf(corners[2]) - from)).stableNormalized().eval();
  };
  Eigen::Vector3d n = normalOf(one.triangle), m = normalOf(other.triangle);
  if (n.isZero(0.0) || m.isZero(0.0) || !(n.cross(m).norm() > kFlatTurn)) return std::nullopt;
  const Eigen::Vector3d end = vectorOf(mesh.vertices.point(one.low));
  const bool is_convex = n.dot(vectorOf(mesh.vertices.point(other.across)) - end) < 0.0;
  if (!is_convex && is_solid) return std::nullopt;
  if (!is_convex) n = -n, m = -m;
  return SharpEdge{{one.low, one.high}, {one.triangle, other.triangle}, {n, m}};
}

void addSurface(Collider::Parts& parts)
{
  const TrianglesView& mesh = *parts.thing.view().triangles;
  const std::vector<std::uint32_t> triangles = trianglesIn(parts.thing.view()), first = firstOfPlaces(mesh);
  constexpr std::uint32_t none = kNothing;
  parts.triangle_of.assign(mesh.vertices.count, none);
  for (const std::uint32_t t : triangles) {
    for (const std::uint32_t corner : mesh.cornersOf(t)) {
      std::uint32_t& of = parts.triangle_of[first[corner]];
      of = std::min(of, t);
    }
  }
  for (std::uint32_t i = 0; i < parts.triangle_of.size(); ++i)
    if (parts.triangle_of[i] != none) parts.used.push_back(static_cast<std::int32_t>(i));
  PointsView corners = mesh.vertices;
  corners.restrictTo(parts.used.data(), parts.used.size());
  parts.corners.emplace(corners);

  const std::vector<HalfEdge> halves = halfEdgesOf(mesh, triangles, first);
  const double outward = parts.solid ? windingSign(mesh, triangles) : 1.0;
  for (std::size_t i = 0; i < halves.size();) {
    std::size_t end = i + 1;
    while (end < halves.size() && halves[end].isOf(halves[i])) ++end;
    if (end == i + 2)
      if (const auto edge = sharpEdge(mesh, halves[i], halves[i + 1], parts.solid != nullptr, outward))
        parts.sharp.push_back(*edge);
    i = end;
  }
  for (const SharpEdge& edge : parts.sharp) parts.segments.push_back({edge.ends[0], edge.ends[1], edge.ends[1]});
  const std::uint32_t* of_first = parts.segments.empty() ? nullptr : parts.segments.front().data();
  parts.edges.emplace(viewOf(TrianglesView{mesh.vertices, of_first, parts.segments.size()}));
}

} // namespace

Collider::Collider(const SphereHierarchy& thing, const Solid* solid, NormalField normals)
{
  auto parts = std::make_unique<Parts>(thing, solid, normals);
  if (solid && !parts->isSurface())
    throw InvalidInput(Input::surface, "collider", "a solid of points", "give a solid of the hierarchy's triangles");
  if (parts->isSurface())
    addSurface(*parts);
  else if (!thing.view().areBalls())
    parts->spacing = spacingOf(thing).median;
  parts_ = std::move(parts);
}

Collider::~Collider() = default;
Collider::Collider(Collider&&) noexcept = default;
Collider& Collider::operator=(Collider&&) noexcept = default;

const SphereHierarchy& Collider::thing() const noexcept
{
  return parts_->thing;
}

double Collider::spacing() const noexcept
{
  return parts_->spacing;
}

} // namespace pcl_bsh

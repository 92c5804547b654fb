// SPDX-License-Identifier: BSD-3-Clause
// Manifolds by comparing all, as SPECIFICATION.md defines them, and things that touch.
#pragma once

#include <pcl_bsh/manifold/contact_manifold.h>
#include <pcl_bsh/query/record_distance.h>
#include <pcl_bsh/solid/labels.h>

#include "support/made_meshes.h"
#include "support/random.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace pcl_bsh::test {

inline Eigen::Vector3d eigen(const Point3& p)
{
  return {p[0], p[1], p[2]};
}

/// Points, balls or triangles that own what a collider borrows.
struct Thing {
  explicit Thing(std::vector<Point3> of, std::vector<float> with_radii = {})
  : places(std::move(of)),
    radii(std::move(with_radii))
  {
    PointsView view = viewOf(places.empty() ? nullptr : places[0].data(), places.size());
    if (!radii.empty()) view.radii = radii.data();
    hierarchy.emplace(view);
    collider.emplace(*hierarchy);
  }
  explicit Thing(TestMesh of, bool is_solid = false) : mesh(std::move(of)), is_mesh(true)
  {
    hierarchy.emplace(viewOf(mesh.trianglesView()));
    if (is_solid) solid.emplace(mesh.trianglesView());
    collider.emplace(*hierarchy, solid ? &*solid : nullptr);
  }
  Thing(const Thing&) = delete;
  Thing& operator=(const Thing&) = delete;

  std::vector<Point3> places;
  std::vector<float> radii;
  TestMesh mesh;
  bool is_mesh = false;
  std::optional<SphereHierarchy> hierarchy;
  std::optional<Solid> solid;
  std::optional<Collider> collider;
};

/// The places of a thing that touch, and by which record a contact names each.
struct Probes {
  std::vector<Point3> places;
  std::vector<float> radii;
  std::vector<std::uint32_t> numbers, records; ///< in the order of ties, and as named

  explicit Probes(const Thing& thing)
  {
    if (!thing.is_mesh) {
      places = thing.places;
      radii = thing.radii;
      for (std::uint32_t i = 0; i < places.size(); ++i) numbers.push_back(i), records.push_back(i);
      return;
    }
    std::set<Point3> seen;
    for (std::uint32_t i = 0; i < thing.mesh.vertices.size(); ++i) {
      const Point3& p = thing.mesh.vertices[i];
      const auto has = [&](const Triangle& t) {
        return std::any_of(t.begin(), t.end(), [&](std::uint32_t k) { return thing.mesh.vertices[k] == p; });
      };
      const auto of = std::find_if(thing.mesh.triangles.begin(), thing.mesh.triangles.end(), has);
      if (of == thing.mesh.triangles.end() || !seen.insert(p).second) continue;
      places.push_back(p);
      numbers.push_back(i);
      records.push_back(static_cast<std::uint32_t>(of - thing.mesh.triangles.begin()));
    }
  }
};

/// A contact that may be chosen.
struct TwinCandidate {
  double gap;
  int channel;
  std::pair<std::uint32_t, std::uint32_t> order; ///< among those of a channel with equal gaps
  PointPair pair;
  Eigen::Vector3d place;

  bool operator<(const TwinCandidate& other) const
  {
    return std::tie(gap, channel, order) < std::tie(other.gap, other.channel, other.order);
  }
};

/// Two triangles about an edge that is not flat; of a solid convex.
struct TwinEdge {
  Point3 from, to;
  std::uint32_t record;
  Eigen::Vector3d n, m;
};

inline std::vector<TwinEdge> edgesOf(const Thing& thing)
{
  struct Side {
    std::uint32_t triangle;
    Point3 from, to, across;
  };
  const TestMesh& mesh = thing.mesh;
  std::map<std::set<Point3>, std::vector<Side>> sides;
  double volume = 0.0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto c = mesh.trianglesView().triangle(t);
    volume += eigen(c[0]).dot(eigen(c[1]).cross(eigen(c[2])));
    for (std::size_t k = 0; k < 3; ++k)
      if (c[k] != c[(k + 1) % 3]) sides[{c[k], c[(k + 1) % 3]}].push_back({t, c[k], c[(k + 1) % 3], c[(k + 2) % 3]});
  }
  std::map<std::pair<std::size_t, std::size_t>, TwinEdge> edges; // by the first vertices at their ends
  const auto first = [&](const Point3& p) {
    return static_cast<std::size_t>(std::find(mesh.vertices.begin(), mesh.vertices.end(), p) - mesh.vertices.begin());
  };
  for (const auto& [ends, both] : sides) {
    if (both.size() != 2 || both[0].from == both[1].from) continue;
    const auto normalOf = [](const Side& side) -> Eigen::Vector3d {
      return (eigen(side.to) - eigen(side.from)).cross(eigen(side.across) - eigen(side.from)).normalized();
    };
    Eigen::Vector3d n = normalOf(both[0]), m = normalOf(both[1]);
    if (thing.solid && volume < 0.0) n = -n, m = -m;
    if (!(n.cross(m).norm() > 1e-6)) continue;
    const bool convex = n.dot(eigen(both[1].across) - eigen(both[1].from)) < 0.0;
    if (!convex && thing.solid) continue;
    if (!convex) n = -n, m = -m;
    std::size_t low = first(both[0].from), high = first(both[0].to);
    Point3 from = both[0].from, to = both[0].to;
    if (low > high) std::swap(low, high), std::swap(from, to);
    edges.emplace(std::make_pair(low, high), TwinEdge{from, to, std::min(both[0].triangle, both[1].triangle), n, m});
  }
  std::vector<TwinEdge> all;
  for (const auto& [ends, edge] : edges) all.push_back(edge);
  return all;
}

/// Whether a direction is a sum of both normals with factors that are not negative.
inline bool isBetween(const Eigen::Vector3d& n, const Eigen::Vector3d& m, const Eigen::Vector3d& direction)
{
  const double nm = n.dot(m), nd = n.dot(direction), md = m.dot(direction), whole = 1.0 - nm * nm;
  return nd - nm * md >= -1e-9 * whole - 1e-12 && md - nm * nd >= -1e-9 * whole - 1e-12 && nd + md > 0.0;
}

/// All that may become contacts.
inline std::vector<TwinCandidate> candidatesOf(const Thing& a, const Eigen::Isometry3d& pose_a, const Thing& b,
                                               const Eigen::Isometry3d& pose_b, double margin, double thickness)
{
  std::vector<TwinCandidate> all;
  const auto add_probes = [&](int channel, const Thing& of, const Eigen::Isometry3d& pose, const Thing& surface,
                              const Eigen::Isometry3d& pose_surface) {
    const Probes probes(of);
    PointsView view = viewOf(probes.places.empty() ? nullptr : probes.places[0].data(), probes.places.size());
    if (!probes.radii.empty()) view.radii = probes.radii.data();
    const RecordDistance distance(view, pose, surface.hierarchy->view(), pose_surface);
    for (std::uint32_t i = 0; i < probes.places.size(); ++i) {
      double least = std::numeric_limits<double>::infinity();
      std::uint32_t nearest = 0;
      for (std::uint32_t j = 0; j < surface.hierarchy->view().count; ++j) {
        const double gap = distance.gap({i, j});
        if (gap < least) least = gap, nearest = j; // of equal ones the first
      }
      const Eigen::Vector3d place = pose * eigen(probes.places[i]);
      if (surface.solid) {
        const LabelsResult labels = labelPoints({SphereHierarchy(view), pose}, {*surface.solid, pose_surface});
        std::vector<float> below(probes.radii);
        for (float& radius : below) radius = -radius;
        PointsView deep = view;
        if (!below.empty()) deep.radii = below.data();
        if (labels.labels[i] != labelOf(Label::outside))
          least = -RecordDistance(deep, pose, surface.hierarchy->view(), pose_surface).gap(PointPair{i, nearest});
      }
      const double gap = least - thickness;
      if (!(gap <= margin)) continue;
      const std::uint32_t record = probes.records[i];
      all.push_back({gap,
                     channel,
                     {probes.numbers[i], nearest},
                     channel == 0 ? PointPair{record, nearest} : PointPair{nearest, record},
                     place});
    }
  };
  if (!a.is_mesh || b.is_mesh) add_probes(0, a, pose_a, b, pose_b);
  if (a.is_mesh) add_probes(1, b, pose_b, a, pose_a);
  if (!a.is_mesh || !b.is_mesh) return all;
  const std::vector<TwinEdge> of_a = edgesOf(a), of_b = edgesOf(b);
  for (std::uint32_t i = 0; i < of_a.size(); ++i)
    for (std::uint32_t j = 0; j < of_b.size(); ++j) {
      const TwinEdge &e = of_a[i], &f = of_b[j];
      const Eigen::Vector3d p = pose_a * eigen(e.from), u = pose_a * eigen(e.to) - p;
      const Eigen::Vector3d q = pose_b * eigen(f.from), v = pose_b * eigen(f.to) - q;
      if (!(u.cross(v).squaredNorm() > 1e-12 * u.squaredNorm() * v.squaredNorm())) continue;
      Eigen::Matrix<double, 3, 2> sides;
      sides << u, -v;
      const Eigen::Vector2d at = sides.colPivHouseholderQr().solve(q - p);
      if (!(at.minCoeff() > 1e-9 && at.maxCoeff() < 1 - 1e-9)) continue;
      Eigen::Vector3d out = u.cross(v).normalized();
      const auto fits = [&] {
        const Eigen::Matrix3d ra = pose_a.linear(), rb = pose_b.linear();
        return isBetween(rb * f.n, rb * f.m, out) && isBetween(ra * e.n, ra * e.m, -out);
      };
      if (!fits()) {
        out = -out;
        if (!fits()) continue;
      }
      const std::vector<double> ends = {e.from[0], e.from[1], e.from[2], e.to[0], e.to[1], e.to[2],
                                        f.from[0], f.from[1], f.from[2], f.to[0], f.to[1], f.to[2]};
      const Triangle whole = {0, 1, 1};
      const PointsView view_a = viewOf(TrianglesView{viewOf(ends.data(), 2), whole.data(), 1}),
                       view_b = viewOf(TrianglesView{viewOf(ends.data() + 6, 2), whole.data(), 1});
      const double apart = RecordDistance(view_a, pose_a, view_b, pose_b).gap(PointPair{0, 0});
      if (!(apart <= margin + thickness)) continue;
      const Eigen::Vector3d on_a = p + at.x() * u, on_b = q + at.y() * v;
      const double gap = (out.dot(on_a - on_b) < 0.0 ? -apart : apart) - thickness;
      if (gap <= margin) all.push_back({gap, 2, {i, j}, {e.record, f.record}, on_a});
    }
  return all;
}

/// The area of the convex hull of points of a plane, by sweeping over its upper and its lower side.
inline double hullArea(std::vector<Eigen::Vector2d> points)
{
  std::sort(points.begin(), points.end(),
            [](const auto& l, const auto& r) { return std::make_pair(l.x(), l.y()) < std::make_pair(r.x(), r.y()); });
  const auto areaBelow = [&](double sign) { // of the upper side of the points, or of these upside down
    std::vector<Eigen::Vector2d> side;
    for (const Eigen::Vector2d& p : points) {
      const Eigen::Vector2d at(p.x(), sign * p.y());
      while (side.size() >= 2) {
        const Eigen::Vector2d &from = side[side.size() - 2], &last = side.back();
        if ((last.x() - from.x()) * (at.y() - from.y()) < (last.y() - from.y()) * (at.x() - from.x())) break;
        side.pop_back();
      }
      side.push_back(at);
    }
    double area = 0.0;
    for (std::size_t i = 1; i < side.size(); ++i)
      area += 0.5 * (side[i].x() - side[i - 1].x()) * (side[i].y() + side[i - 1].y());
    return area;
  };
  return areaBelow(1.0) + areaBelow(-1.0);
}

} // namespace pcl_bsh::test

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/bodies.h>

#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace pcl_bsh {
namespace {

using Id = std::uint32_t;

/// For each vertex, the first vertex at its place.
std::vector<Id> firstAtPlaces(const PointsView& vertices)
{
  std::vector<Id> order(vertices.count), first(vertices.count);
  std::iota(order.begin(), order.end(), Id{0});
  std::iota(first.begin(), first.end(), Id{0});
  order.erase(std::remove_if(order.begin(), order.end(), [&](Id v) { return !isFinite(vertices.point(v)); }),
              order.end());
  std::sort(order.begin(), order.end(),
            [&](Id l, Id r) { return std::pair(vertices.point(l), l) < std::pair(vertices.point(r), r); });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (vertices.point(order[i]) == vertices.point(order[i - 1])) first[order[i]] = first[order[i - 1]];
  return first;
}

std::vector<SolidBodies::Body> bodiesOf(const TrianglesView& view)
{
  std::vector<Id> parent = firstAtPlaces(view.vertices);
  const auto root = [&](Id vertex) {
    while (parent[vertex] != vertex) vertex = parent[vertex] = parent[parent[vertex]];
    return vertex;
  };
  const auto for_each_triangle = [&](const auto& take) {
    for (Id i = 0; i < view.count; ++i)
      if (isFinite(view.triangle(i))) take(i, view.cornersOf(i));
  };
  for_each_triangle([&](Id, const Triangle& t) {
    const Id least = std::min({root(t[0]), root(t[1]), root(t[2])});
    for (const Id corner : t) parent[root(corner)] = least;
  });
  constexpr Id unknown = ~Id{0};
  std::vector<Id> body_of(parent.size(), unknown);
  std::vector<SolidBodies::Body> bodies;
  for_each_triangle([&](Id i, const Triangle& t) {
    Id& body = body_of[root(t[0])];
    if (body == unknown) {
      body = static_cast<Id>(bodies.size());
      bodies.emplace_back();
    }
    bodies[body].triangles.push_back(i);
  });
  if (bodies.size() == 1) return bodies;
  for (SolidBodies::Body& body : bodies) {
    for (const Id i : body.triangles) body.corners.push_back(view.cornersOf(i));
    TrianglesView own = view;
    own.corners = body.corners.front().data();
    own.count = body.corners.size();
    own.stride = sizeof(Triangle);
    body.own = std::make_unique<const Solid>(own);
  }
  return bodies;
}

} // namespace

const std::vector<SolidBodies::Body>& SolidBodies::all() const
{
  if (const auto* const known = bodies_.get()) return *known;
  bool kept = false;
  return *bodies_.keep(std::make_unique<const std::vector<Body>>(bodiesOf(solid_.triangles())), kept);
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/surface/charts.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace pcl_bsh::surface {

namespace {

/// 21 degrees. Greater charts have shorter borders, but a hexagon of the plane loses up to 14 % of its area where the
/// surface slants.
constexpr double kLeastCosine = 0.93;
/// Beside its longest edge a triangle this thin has no direction of its own.
constexpr double kNoHeight = 1e-9;

/// The longest edge, and the vector area (twice the area long).
struct Shape {
  Vector3d edge, area;

  explicit Shape(const Corners& c)
  {
    const std::array<Vector3d, 3> edges = {c[1] - c[0], c[2] - c[1], c[0] - c[2]};
    edge = *std::max_element(edges.begin(), edges.end(),
                             [](const auto& e, const auto& f) { return e.squaredNorm() < f.squaredNorm(); });
    area = edges[0].cross(edges[1]);
  }

  bool isThin() const { return !(area.norm() > kNoHeight * edge.squaredNorm()); }
};

/// An edge between two places, and a triangle that has it.
struct Side {
  std::uint32_t from, to, triangle;

  friend bool operator<(const Side& s, const Side& t)
  {
    return std::tie(s.from, s.to, s.triangle) < std::tie(t.from, t.to, t.triangle);
  }
  bool joins(const Side& other) const { return from == other.from && to == other.to; }
};

/// The first vertex at the place of each: files without shared vertices name a corner once for each triangle.
std::vector<std::uint32_t> placesOf(const std::vector<Vector3d>& vertices)
{
  std::vector<std::uint32_t> order(vertices.size()), place(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto before = [&](std::uint32_t i, std::uint32_t j) {
    const Vector3d &p = vertices[i], &q = vertices[j];
    return std::tie(p.x(), p.y(), p.z(), i) < std::tie(q.x(), q.y(), q.z(), j);
  };
  std::sort(order.begin(), order.end(), before);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && vertices[order[k]] == vertices[order[k - 1]];
    place[order[k]] = same ? place[order[k - 1]] : order[k];
  }
  return place;
}

/// Which triangles share an edge: sides of the same edge follow each other.
class Neighbours {
public:
  explicit Neighbours(const Mesh& mesh) : first_of_triangle_(mesh.triangles.size())
  {
    const std::vector<std::uint32_t> place = placesOf(mesh.vertices);
    sides_.reserve(3 * mesh.triangles.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax(place[mesh.triangles[t][k]], place[mesh.triangles[t][(k + 1) % 3]]);
        sides_.push_back({low, high, t});
      }
    }
    std::sort(sides_.begin(), sides_.end());
    edge_of_side_.resize(sides_.size());
    for (std::size_t s = 0, found = 0; s < sides_.size(); ++s) {
      if (s > 0 && !sides_[s].joins(sides_[s - 1])) ++found;
      if (s == 0 || !sides_[s].joins(sides_[s - 1])) edges_.push_back(s);
      edge_of_side_[s] = static_cast<std::uint32_t>(found);
    }
    edges_.push_back(sides_.size());
    std::vector<std::uint8_t> known(mesh.triangles.size(), 0);
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      const std::uint32_t t = sides_[s].triangle;
      first_of_triangle_[t][known[t]++] = edge_of_side_[s];
    }
  }

  std::size_t edges() const { return edges_.size() - 1; }
  const std::array<std::uint32_t, 3>& edgesOf(std::uint32_t triangle) const { return first_of_triangle_[triangle]; }

  template <class Visit>
  void forEachAt(std::uint32_t edge, const Visit& visit) const
  {
    for (std::size_t s = edges_[edge]; s < edges_[edge + 1]; ++s) visit(sides_[s].triangle);
  }

private:
  std::vector<Side> sides_;
  std::vector<std::size_t> edges_; ///< of each edge the first of its sides
  std::vector<std::uint32_t> edge_of_side_;
  std::vector<std::array<std::uint32_t, 3>> first_of_triangle_;
};

} // namespace

double areaOf(const Corners& corners)
{
  return 0.5 * Shape(corners).area.norm();
}

Plane planeOf(const Corners& corners)
{
  const Shape shape(corners);
  Plane plane;
  if (shape.edge.squaredNorm() > 0) plane.x = shape.edge.normalized();
  const Vector3d along = plane.x;
  plane.normal = shape.isThin() ? along.unitOrthogonal() : Vector3d(shape.area - along.dot(shape.area) * along);
  plane.normal.normalize();
  plane.y = plane.normal.cross(plane.x);
  return plane;
}

double cosineTo(const Plane& plane, const Corners& corners)
{
  const Shape shape(corners);
  if (!shape.isThin()) return std::abs(plane.normal.dot(shape.area)) / shape.area.norm();
  const double length = shape.edge.norm();
  return length > 0 ? plane.at(shape.edge).norm() / length : 1.0;
}

Chart chartOf(const Mesh& mesh, std::uint32_t triangle)
{
  const Corners corners = mesh.corners(triangle);
  return {planeOf(corners), {triangle}, 1.0};
}

std::vector<Chart> growCharts(const Mesh& mesh, const std::vector<double>& areas)
{
  const std::size_t count = mesh.triangles.size();
  const Neighbours neighbours(mesh);
  std::vector<std::uint32_t> seeds(count);
  std::iota(seeds.begin(), seeds.end(), 0u);
  std::sort(seeds.begin(), seeds.end(),
            [&](std::uint32_t s, std::uint32_t t) { return areas[s] != areas[t] ? areas[s] > areas[t] : s < t; });

  std::vector<Chart> charts;
  std::vector<bool> taken(count, false);
  // All triangles at an edge are asked once by a chart, however many there are.
  constexpr std::uint32_t nobody = 0xffffffffu;
  std::vector<std::uint32_t> asked_by(neighbours.edges(), nobody);
  for (const std::uint32_t seed : seeds) {
    if (taken[seed]) continue;
    const auto number = static_cast<std::uint32_t>(charts.size());
    Chart chart = chartOf(mesh, seed);
    taken[seed] = true;
    for (std::size_t next = 0; next < chart.triangles.size(); ++next) {
      for (const std::uint32_t edge : neighbours.edgesOf(chart.triangles[next])) {
        if (std::exchange(asked_by[edge], number) == number) continue;
        neighbours.forEachAt(edge, [&](std::uint32_t t) {
          if (taken[t]) return;
          const double cosine = cosineTo(chart.plane, mesh.corners(t));
          if (cosine < kLeastCosine) return;
          taken[t] = true;
          chart.triangles.push_back(t);
          chart.least_cosine = std::min(chart.least_cosine, cosine);
        });
      }
    }
    charts.push_back(std::move(chart));
  }
  return charts;
}

} // namespace pcl_bsh::surface

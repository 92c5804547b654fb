// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/build/crowded_cell.h>
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <algorithm>
#include <array>
#include <tuple>

namespace pcl_bsh {
namespace {

/// The most points of a leaf whose points have different places. Float lanes decide nothing here and every pair is
/// compared exactly, so that fewer points than a leaf could hold cost less.
constexpr std::uint32_t kFewPoints = 4;

/// Points with the same coordinates, radius and uncertainty, or the same triangle: [first, first + count) of the points
/// sorted by place.
struct Place {
  Point3 point;
  double radius, uncertainty;
  std::uint32_t first, count;
};

class CrowdedCell {
public:
  CrowdedCell(const PointsView& view, PointRecord* points, std::uint32_t count, std::vector<Node>& nodes)
  : nodes_(nodes)
  {
    struct Given {
      Point3 point;
      double radius, uncertainty;
      PointRecord stored;
    };
    std::vector<Given> given;
    given.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t record = points[i].record;
      given.push_back({view.point(record), view.radius(record), view.ownUncertainty(record), points[i]});
    }
    const TrianglesView* const triangles = view.triangles; // different triangles may have equal balls
    const auto before = [triangles](const Given& l, const Given& r) {
      const auto of_l = std::tie(l.point, l.radius, l.uncertainty), of_r = std::tie(r.point, r.radius, r.uncertainty);
      if (triangles && of_l == of_r) {
        const auto corners_l = triangles->triangle(l.stored.record), corners_r = triangles->triangle(r.stored.record);
        if (corners_l != corners_r) return corners_l < corners_r;
      }
      return std::tie(l.point, l.radius, l.uncertainty, l.stored.record) <
             std::tie(r.point, r.radius, r.uncertainty, r.stored.record);
    };
    // Often they are of one place, the returns of a scanner that met nothing, and in order.
    if (!std::is_sorted(given.begin(), given.end(), before)) std::sort(given.begin(), given.end(), before);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (i > 0 && given[i].point == places_.back().point && given[i].radius == places_.back().radius &&
          given[i].uncertainty == places_.back().uncertainty &&
          (!triangles ||
           triangles->triangle(given[i].stored.record) == triangles->triangle(given[i - 1].stored.record)))
        ++places_.back().count;
      else
        places_.push_back({given[i].point, given[i].radius, given[i].uncertainty, i, 1});
    }
    for (std::uint32_t i = 0; i < count; ++i) points[i] = given[i].stored; // once nothing can throw: none may get lost
  }

  /// @param begin the number of the first point in its voxel
  std::uint32_t grow(std::uint32_t begin) { return grow({0, places_.size(), 0}, begin); }

  const std::vector<Place>& places() const { return places_; } ///< once grown, in the order of the leaves

private:
  struct Range {
    std::size_t first, last; // places
    std::uint32_t points;

    bool isLeaf() const { return points <= kFewPoints || last - first == 1; }
  };

  Range rangeOf(std::size_t first, std::size_t last) const
  {
    Range range{first, last, 0};
    for (std::size_t i = first; i < last; ++i) range.points += places_[i].count;
    return range;
  }

  /// A node over a range: halved, the fullest part first, until all parts are leaves or eight are reached.
  std::uint32_t grow(const Range& all, std::uint32_t begin)
  {
    std::array<Range, kNodeChildren> parts = {rangeOf(all.first, all.last)};
    std::size_t used = 1;
    while (used < kNodeChildren) {
      const auto fullest = std::max_element(parts.begin(), parts.begin() + used, [](const Range& l, const Range& r) {
        return (l.isLeaf() ? 0 : l.points) < (r.isLeaf() ? 0 : r.points);
      });
      if (fullest->isLeaf()) break;
      const std::size_t middle = halve(*fullest), last = fullest->last;
      std::copy_backward(fullest + 1, parts.begin() + used, parts.begin() + used + 1);
      *fullest = rangeOf(fullest->first, middle);
      *(fullest + 1) = rangeOf(middle, last);
      ++used;
    }
    const auto node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    nodes_[node].count = 0;
    for (std::size_t i = 0; i < used; ++i) {
      const std::uint32_t below = parts[i].isLeaf() ? Node::kLeaf : grow(parts[i], begin);
      nodes_[node].addChild(begin, begin + parts[i].points, below);
      begin += parts[i].points;
    }
    return node;
  }

  /// Parts the places of a range at the median along their longest extent. @return the first of the upper half.
  std::size_t halve(const Range& range)
  {
    const auto at = [&](std::size_t i) { return places_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::size_t axis = 0;
    double longest = -1.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax_element(
          at(range.first), at(range.last), [k](const Place& l, const Place& r) { return l.point[k] < r.point[k]; });
      const double half = high->point[k] / 2 - low->point[k] / 2; // the extent itself might overflow
      if (half > longest) longest = half, axis = k;
    }
    const std::size_t middle = range.first + (range.last - range.first) / 2;
    std::nth_element(at(range.first), at(middle), at(range.last), [axis](const Place& l, const Place& r) {
      return std::tie(l.point[axis], l.first) < std::tie(r.point[axis], r.first);
    });
    return middle;
  }

  std::vector<Node>& nodes_;
  std::vector<Place> places_;
};

GivenSphere sphereOfPoints(const Voxel& voxel, const PointsView& view, const Node& node, std::uint32_t child)
{
  const std::uint32_t* records = voxel.records() + node.begin[child];
  return sphereAround(
      node.isLeaf(child) ? node.comparedPoints(child) : node.points(child),
      [&](std::size_t i) { return view.point(records[i]); }, [&](std::size_t i) { return view.radius(records[i]); });
}

} // namespace

std::uint32_t growCrowdedCell(const PointsView& view, PointRecord* points, std::uint32_t begin, std::uint32_t end,
                              std::vector<Node>& nodes)
{
  CrowdedCell cell(view, points + begin, end - begin, nodes);
  const std::uint32_t root = cell.grow(begin);
  const std::vector<PointRecord> by_place(points + begin, points + end);
  PointRecord* next = points + begin;
  for (const Place& place : cell.places()) next = std::copy_n(by_place.data() + place.first, place.count, next);
  return root;
}

std::vector<GivenSphere> givenSpheres(const Voxel& voxel, const PointsView& view)
{
  const double reach = *std::max_element(voxel.frame.reach.begin(), voxel.frame.reach.end());
  std::vector<GivenSphere> spheres(voxel.nodes.size() * kNodeChildren);
  for (std::size_t n = 0; n < voxel.nodes.size(); ++n) {
    const Node& node = voxel.nodes[n];
    for (std::uint32_t i = 0; i < node.count; ++i)
      if (static_cast<double>(node.r[i]) <= 2 * kCrowdedExtent * reach)
        spheres[n * kNodeChildren + i] = sphereOfPoints(voxel, view, node, i);
  }
  return spheres;
}

GivenSphere givenSphereOf(const PointsView& view, const Voxel& voxel, const Node& node, std::uint32_t child)
{
  if (!voxel.given.empty()) {
    const auto index = static_cast<std::size_t>(&node - voxel.nodes.data()) * kNodeChildren + child;
    if (voxel.given[index].isKnown()) return voxel.given[index];
  }
  return node.isLeaf(child) ? sphereOfPoints(voxel, view, node, child) : storedSphere(voxel.frame, node, child);
}

GivenSphere storedSphere(const LocalFrame& frame, const Node& node, std::uint32_t child)
{
  // Each coordinate of the centre is rounded twice, by v of what it is made of; twice as much pays for the sums here.
  constexpr double kCenterError = 4 * kDoubleUnit;
  constexpr double kVanishing = 0x1p-1070; // above what underflows
  const float local[3] = {node.x[child], node.y[child], node.z[child]};
  GivenSphere sphere;
  sphere.radius = static_cast<double>(node.r[child]) * frame.unit;
  for (std::size_t k = 0; k < 3; ++k) {
    const double offset = static_cast<double>(local[k]) * frame.unit;
    sphere.center[k] = frame.origin[k] + offset;
    sphere.radius += kCenterError * (std::abs(frame.origin[k]) + std::abs(offset));
  }
  sphere.radius = sphere.radius * (1.0 + kFewDoubleRoundings) + kVanishing;
  return sphere;
}

} // namespace pcl_bsh

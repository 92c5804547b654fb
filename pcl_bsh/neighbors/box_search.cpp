// SPDX-License-Identifier: BSD-3-Clause
// Points in an axis-aligned box. Comparing coordinates is exact as it stands; spheres only say which points to compare.
#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/neighbors/neighbor_scratch.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

struct QueryBox {
  Point3 low, high;

  bool contains(const Point3& p) const
  {
    for (std::size_t k = 0; k < 3; ++k)
      if (!(low[k] <= p[k] && p[k] <= high[k])) return false;
    return true;
  }
};

/// The box in a frame's units, grown and shrunk by all that rounding may amount to.
struct LocalBox {
  LocalBox(const LocalFrame& frame, const QueryBox& box)
  {
    const double inverse = 1.0 / frame.unit;
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = box.low[k] * inverse - frame.origin[k] * inverse;
      high[k] = box.high[k] * inverse - frame.origin[k] * inverse;
      constexpr double kVanishing = 0x1p-1000; // above what underflows
      // The differences err by v of themselves; those that matter are not far beyond the frame's reach.
      const double error = kFewDoubleRoundings * (frame.reach[k] + std::abs(frame.origin[k] * inverse)) + kVanishing;
      outer_low[k] = low[k] - error, outer_high[k] = high[k] + error;
      inner_low[k] = low[k] + error, inner_high[k] = high[k] - error;
    }
  }

  /// Whether the sphere lies apart from the box.
  bool misses(const std::array<double, 3>& center, double radius) const
  {
    double squared = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double outside = std::max({outer_low[k] - center[k], center[k] - outer_high[k], 0.0});
      squared += outside * outside;
    }
    return squared > radius * radius * (1.0 + kDoubleMargin);
  }

  /// Whether the sphere lies in the box altogether.
  bool holds(const std::array<double, 3>& center, double radius) const
  {
    for (std::size_t k = 0; k < 3; ++k) {
      const double margin = radius * (1.0 + kDoubleMargin);
      if (!(center[k] - margin >= inner_low[k] && center[k] + margin <= inner_high[k])) return false;
    }
    return true;
  }

  Point3 low, high, outer_low, outer_high, inner_low, inner_high;
};

class BoxWalk {
public:
  BoxWalk(const SphereHierarchy::Storage& cloud, const QueryBox& box, std::vector<std::int32_t>& indices, Work& work)
  : cloud_(cloud),
    box_(box),
    indices_(indices),
    work_(work)
  {
  }

  void run()
  {
    if (cloud_.size == 0) return;
    ++work_.volumes_carried;
    visit(LocalBox(cloud_.frame, box_), nullptr, cloud_.top[0]);
  }

private:
  /// @param voxel that the node is in; null above the voxels
  void visit(const LocalBox& box, const Voxel* voxel, const Node& node)
  {
    work_.node_pairs += node.count;
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const std::array<double, 3> center = {node.x[i], node.y[i], node.z[i]};
      const double radius = node.r[i];
      if (box.misses(center, radius)) continue;
      if (box.holds(center, radius))
        takeBelow(voxel, node, i);
      else if (!node.isLeaf(i))
        visit(box, voxel, voxel ? voxel->nodes[node.child[i]] : cloud_.top[node.child[i]]);
      else if (voxel)
        compare(*voxel, node, i);
      else
        enter(node.begin[i]);
    }
  }

  void enter(std::uint32_t index)
  {
    ++work_.volumes_carried;
    const Voxel& voxel = cloud_.built(index, work_);
    visit(LocalBox(voxel.frame, box_), &voxel, voxel.nodes[0]);
  }

  void compare(const Voxel& voxel, const Node& node, std::uint32_t child)
  {
    ++work_.leaf_pairs;
    const std::uint32_t begin = node.begin[child];
    const auto inside = [&](std::uint32_t i) { return box_.contains(cloud_.view.point(voxel.records()[i])); };
    if (node.isCoincident(child)) {
      if (inside(begin)) takeAll(voxel, begin, node.begin[child + 1]);
      return;
    }
    for (std::uint32_t i = begin; i < node.begin[child + 1]; ++i)
      if (inside(i)) takeAll(voxel, i, i + 1);
  }

  void takeBelow(const Voxel* voxel, const Node& node, std::uint32_t child)
  {
    const std::uint32_t begin = node.begin[child], end = node.begin[child + 1];
    if (voxel) return takeAll(*voxel, begin, end);
    for (std::uint32_t v = begin; v < end; ++v) takeAll(cloud_.built(v, work_), 0, cloud_.voxels[v].count);
  }

  void takeAll(const Voxel& voxel, std::uint32_t begin, std::uint32_t end)
  {
    indices_.insert(indices_.end(), voxel.records() + begin, voxel.records() + end);
  }

  const SphereHierarchy::Storage& cloud_;
  const QueryBox& box_;
  std::vector<std::int32_t>& indices_;
  Work& work_;
};

} // namespace

std::size_t boxSearch(const SphereHierarchy& cloud, const Point3& low, const Point3& high,
                      std::vector<std::int32_t>& indices, Work* work)
{
  checkOfPoints(cloud.view());
  for (std::size_t k = 0; k < 3; ++k)
    if (std::isnan(low[k]) || std::isnan(high[k]))
      throw InvalidInput(Input::box, "box", "a bound is NaN", "give numbers, infinite ones for a side that is open");
  const DefaultFloatEnvironment environment;
  indices.clear();
  Work unasked;
  BoxWalk(cloud.storage(), {low, high}, indices, work ? *work : unasked).run();
  std::sort(indices.begin(), indices.end());
  return indices.size();
}

} // namespace pcl_bsh

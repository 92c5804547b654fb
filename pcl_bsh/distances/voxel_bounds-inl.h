// SPDX-License-Identifier: BSD-3-Clause
// Between a voxel of a and the voxels of b, from the tree above these alone.

#if defined(PCL_BSH_DISTANCES_VOXEL_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_VOXEL_BOUNDS_INL_H_
#undef PCL_BSH_DISTANCES_VOXEL_BOUNDS_INL_H_
#else
#define PCL_BSH_DISTANCES_VOXEL_BOUNDS_INL_H_
#endif

#include <pcl_bsh/distances/distance_visit-inl.h>

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// In the walk's unit.
class VoxelBounds {
public:
  struct Range {
    float lower = std::numeric_limits<float>::infinity();
    float upper;
  };

  /// @param above the space of the tree above b's voxels, as seen from the voxel of a @param work counts the tests
  VoxelBounds(const DistanceObstacle& above, const Spaces& b, Work& work) : above_(above), b_(b), work_(work) {}

  /// How near and how far the voxels of b are from a sphere around the origin of a's voxel.
  /// @param cut what is farther is of no interest
  Range range(float radius, float cut)
  {
    Range range{std::numeric_limits<float>::infinity(), cut};
    boundBelow(b_.storage.top[0], radius * above_.frame.stretch_a, range);
    return range;
  }

  /// A lower bound of the distance from any point of the voxel of a to any of b. It bounds that of any node's centre,
  /// too, if the radius is of the voxel's sphere: this holds the box around its points, in which centres lie. The
  /// smallest sphere of the points would not do.
  float least(float radius)
  {
    const Node& root = b_.storage.top[0];
    float lower[kLanes], upper[kLanes] = {}, least = std::numeric_limits<float>::infinity();
    boundChildren(root, radius * above_.frame.stretch_a, lower, upper);
    for (std::uint32_t lane = 0; lane < root.count; ++lane) least = std::min(least, orNone(lower[lane]));
    return least;
  }

private:
  /// Bounds the distances from such a sphere to the children of a node above the voxels of b.
  void boundChildren(const Node& node, float radius, float* lower, float* upper)
  {
    CarriedNode spheres;
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      spheres.x[lane] = node.x[lane];
      spheres.y[lane] = node.y[lane];
      spheres.z[lane] = node.z[lane];
      spheres.r[lane] = node.r[lane] * above_.frame.stretch_b;
    }
    boundDistances(spheres, above_, {above_.frame.g[0], above_.frame.g[1], above_.frame.g[2]}, radius, lower, upper);
    work_.node_pairs += node.count;
  }

  void boundBelow(const Node& node, float radius, Range& range)
  {
    float lower[kLanes], upper[kLanes];
    std::fill(std::begin(upper), std::end(upper), range.upper);
    boundChildren(node, radius, lower, upper);
    for (std::uint32_t lane = 0; lane < node.count; ++lane) range.upper = std::min(range.upper, upper[lane]);
    for (std::uint32_t lane = 0; lane < node.count; ++lane) {
      if (lower[lane] > range.upper) continue;
      if (node.isLeaf(lane))
        range.lower = std::min(range.lower, orNone(lower[lane]));
      else
        boundBelow(b_.storage.top[node.child[lane]], radius, range);
    }
  }

  const DistanceObstacle& above_;
  const Spaces& b_;
  Work& work_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

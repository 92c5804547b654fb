// SPDX-License-Identifier: BSD-3-Clause
// Items of lists of spheres of b, for walks that take each node of a through such a list.

#if defined(PCL_BSH_TRAVERSAL_OBSTACLE_SPHERE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_OBSTACLE_SPHERE_INL_H_
#undef PCL_BSH_TRAVERSAL_OBSTACLE_SPHERE_INL_H_
#else
#define PCL_BSH_TRAVERSAL_OBSTACLE_SPHERE_INL_H_
#endif

#include <pcl_bsh/traversal/leaf_pair-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A sphere of b that matters to the points of some node of a: a child of `node`, in one of the spaces of b that the
/// walk has numbered.
struct ObstacleSphere {
  const Node* node;
  std::uint16_t lane;
  std::uint16_t level; ///< of `node` below its voxel, from 1; 0 above the voxels
  std::uint32_t obstacle;

  bool isLeaf() const { return node->isLeaf(lane); }
  ObstacleSphere below(const Node& child, std::uint32_t i) const
  {
    return {&child, static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(level + 1), obstacle};
  }
  LeafRange leaf(const Voxel& voxel) const { return {&voxel, node->begin[lane], node->comparedPoints(lane)}; }

  /// Returns the sphere with its slab and its cross slab.
  /// @param slabs, cross those of the voxel; `cross` is null where there is one slab only
  /// @param stretch factor of radii
  CrossedSlabs between(const Voxel& voxel, const Slabs* slabs, const Slabs* cross, float stretch) const
  {
    const auto index = node - voxel.nodes.data();
    const Slabs& own = slabs[index];
    CrossedSlabs held{{own.x[lane], own.y[lane], own.z[lane]},       {0.0f, 0.0f, 0.0f},     own.h[lane], 0.0f,
                      {node->x[lane], node->y[lane], node->z[lane]}, node->r[lane] * stretch};
    if (!cross) return held;
    held.cross = {cross[index].x[lane], cross[index].y[lane], cross[index].z[lane]};
    held.cross_h = cross[index].h[lane];
    return held;
  }
};

/// A sphere in the frame of a's voxel.
struct BoundingSphere {
  Point center;
  float radius;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

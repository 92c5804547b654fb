// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>

namespace pcl_bsh {
namespace {

std::size_t depthBelow(const std::vector<Node>& nodes, std::uint32_t node)
{
  std::size_t deepest = 0;
  for (std::uint32_t i = 0; i < nodes[node].count; ++i)
    if (!nodes[node].isLeaf(i)) deepest = std::max(deepest, depthBelow(nodes, nodes[node].child[i]));
  return deepest + 1;
}

} // namespace

HierarchyStatistics SphereHierarchy::statistics() const
{
  const Storage& s = *storage_;
  HierarchyStatistics result;
  result.points = s.size;
  result.voxels = s.voxel_count;
  result.voxel_edge = s.voxel_edge;
  result.requested_voxel_edge = s.options.voxel_edge;
  result.nodes = s.top.size();
  result.bytes = sizeof(Storage) + s.voxel_count * (sizeof(Voxel) + kBlockPadding * sizeof(float)) +
                 s.size * (sizeof(PointRecord) + (s.view.radii ? sizeof(float) : 0)) + s.top.capacity() * sizeof(Node) +
                 s.floats_unused * sizeof(float) + s.list_words * sizeof(std::uint32_t);
  double leaf_points = 0.0, leaf_radii = 0.0;
  for (std::size_t v = 0; v < s.voxel_count; ++v) {
    const Voxel& voxel = s.voxels[v];
    if (voxel.state.load(std::memory_order_acquire) != Voxel::built) continue;
    ++result.voxels_built;
    result.nodes += voxel.nodes.size();
    result.bytes += voxel.nodes.capacity() * sizeof(Node);
    result.bytes += voxel.given.capacity() * sizeof(GivenSphere);
    for (const LazySlabs* slabs : {&voxel.slabs, &voxel.cross_slabs})
      if (slabs->isFitted()) result.bytes += voxel.nodes.size() * sizeof(Slabs);
    if (voxel.own_uncertainties.made())
      result.bytes += sizeof(OwnUncertainties) + voxel.nodes.size() * sizeof(UncertaintyLanes) +
                      (voxel.count + kMaxLeafPoints) * sizeof(float);
    result.depth = std::max(result.depth, depthBelow(voxel.nodes, 0));
    for (const Node& node : voxel.nodes)
      for (std::uint32_t i = 0; i < node.count; ++i) {
        if (!node.isLeaf(i)) continue;
        ++result.leaves;
        leaf_points += node.points(i);
        leaf_radii += static_cast<double>(node.r[i]) * voxel.frame.unit;
      }
  }
  if (result.leaves > 0) {
    result.mean_leaf_points = leaf_points / static_cast<double>(result.leaves);
    result.mean_leaf_radius = leaf_radii / static_cast<double>(result.leaves);
  }
  return result;
}

} // namespace pcl_bsh

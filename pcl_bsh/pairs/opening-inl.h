// SPDX-License-Identifier: BSD-3-Clause
// The cost of opening a pair, for searches that may have to do without: the level it needs, and the points to prepare.

#if defined(PCL_BSH_PAIRS_OPENING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_PAIRS_OPENING_INL_H_
#undef PCL_BSH_PAIRS_OPENING_INL_H_
#else
#define PCL_BSH_PAIRS_OPENING_INL_H_
#endif

#include <pcl_bsh/traversal/pair_walk-inl.h>

#include <cstddef>
#include <cstdint>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// The level of the node that opening a pair reads: 0 above the voxels and of two leaves, 1 the root of a voxel.
inline std::uint64_t levelToOpen(const PairWalk& walk, const LanePair& pair)
{
  const Opened opened = walk.choose(pair);
  if (opened == Opened::neither) return 0;
  const Spaces& side = opened == Opened::a ? walk.a : walk.b;
  const Lane& lane = opened == Opened::a ? pair.a : pair.b;
  if (lane.space == kAboveVoxels) return walk.nodeOf(side, lane).isLeaf(lane.lane) ? 1 : 0;
  const std::vector<Node>& nodes = side.storage.voxels[lane.space].nodes;
  const std::uint32_t first = nodes[lane.node].begin[lane.lane];
  std::uint64_t level = 2;
  for (std::uint32_t node = 0; node != lane.node; ++level) {
    std::uint32_t above = 0;
    while (nodes[node].begin[above + 1] <= first) ++above;
    node = nodes[node].child[above];
  }
  return level;
}

/// How many points a step would build trees of, or fit slabs to.
inline std::size_t pointsToPrepare(const PairWalk& walk, const LanePair& pair, Opened opened)
{
  const auto voxelOf = [](const Spaces& side, const Lane& lane, bool enters) {
    const Node& node = side.node(lane.space, lane.node);
    return enters && lane.space == kAboveVoxels && node.isLeaf(lane.lane) ? node.begin[lane.lane] : lane.space;
  };
  const std::uint32_t in_a = voxelOf(walk.a, pair.a, opened == Opened::a),
                      in_b = voxelOf(walk.b, pair.b, opened == Opened::b);
  const bool compares_slabs = in_a != kAboveVoxels && in_b != kAboveVoxels;
  const auto pointsOf = [compares_slabs](const Spaces& side, std::uint32_t space) -> std::size_t {
    if (space == kAboveVoxels) return 0;
    const std::size_t points = side.storage.pointsToBuild(space);
    const Voxel& voxel = side.storage.voxels[space];
    return points == 0 && compares_slabs && !voxel.slabs.isFitted() ? voxel.count : points;
  };
  return pointsOf(walk.a, in_a) + pointsOf(walk.b, in_b);
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

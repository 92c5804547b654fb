// SPDX-License-Identifier: BSD-3-Clause
// Which voxels are walked, and the walk, for each instruction set.
#include <pcl_bsh/flags/query.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/flags/walk.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/flags/walk-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace {

/// Appends the voxels below a node above a's voxels that may come near to anything of b, in their order.
void findNearVoxels(const Spaces& a, const Node& others, const RelativeFrame& frame, float reach, const Node& node,
                    std::vector<std::uint32_t>& near, Work& work)
{
  const SphereLanes spheres{others.x, others.y, others.z, others.r, frame.stretch_b};
  work.node_pairs += std::uint64_t{node.count} * others.count;
  work.volumes_carried += node.count;
  for (std::uint32_t lane = 0; lane < node.count; ++lane) {
    const Point center = carriedCenter(frame, node, lane);
    const QueryBall ball{center.x, center.y, center.z, node.r[lane] * frame.stretch_a + reach, 0.0f};
    if ((spheresNear(spheres, ball, nullptr) & firstBits(others.count)) == 0) continue;
    if (node.isLeaf(lane))
      near.push_back(node.begin[lane]);
    else
      findNearVoxels(a, others, frame, reach, a.storage.top[node.child[lane]], near, work);
  }
}

} // namespace

void findNearVoxelsOnTarget(const FlagQuery& query, std::vector<std::uint32_t>& near, Work& work)
{
  const Spaces a(query.a), b(query.b);
  const RelativeFrame frame(a.frame(kAboveVoxels), a.pose, b.frame(kAboveVoxels), b.pose, query.rotation);
  const double reach = query.pairs.reach.length();
  if (frame.separates(reach + a.storage.largest_radius + b.storage.largest_radius)) return;
  findNearVoxels(a, b.storage.top[0], frame, frame.pruneReach(reach), a.storage.top[0], near, work);
}

FlaggedVoxel flagVoxelOnTarget(const FlagQuery& query, const StopRule& rule, std::uint32_t voxel, FlagWriter& writer)
{
  const ScratchLease<FlagScratch> scratch;
  FlagWalk walk(query, rule, writer, *scratch);
  walk.run(voxel);
  return walk.found;
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(findNearVoxelsOnTarget);
HWY_EXPORT(flagVoxelOnTarget);

void findNearVoxels(const FlagQuery& query, std::vector<std::uint32_t>& near, Work& work)
{
  HWY_DYNAMIC_DISPATCH(findNearVoxelsOnTarget)(query, near, work);
}

FlaggedVoxel flagVoxel(const FlagQuery& query, const StopRule& rule, std::uint32_t voxel, FlagWriter& writer)
{
  return HWY_DYNAMIC_DISPATCH(flagVoxelOnTarget)(query, rule, voxel, writer);
}

} // namespace pcl_bsh
#endif

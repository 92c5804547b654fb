// SPDX-License-Identifier: BSD-3-Clause
// Children of a node of a that are apart from a sphere of b, though their spheres are not: leaves that are large beside
// the other sphere, nodes that are far away for their size, and nodes too small for floats.

#if defined(PCL_BSH_FLAGS_APART_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_FLAGS_APART_INL_H_
#undef PCL_BSH_FLAGS_APART_INL_H_
#else
#define PCL_BSH_FLAGS_APART_INL_H_
#endif

#include <pcl_bsh/flags/visit-inl.h>
#include <pcl_bsh/hierarchy/build/crowded_cell.h>
#include <pcl_bsh/traversal/far_points-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// The children in `near` that are apart from the candidate because one of the two is a leaf much larger than the
/// other, which is none, and none of its points is near that. Such a leaf's sphere tells nothing: see
/// PairWalk::leafIsApart().
HWY_NOINLINE inline std::uint32_t leavesApart(const ObstacleVoxel& obstacle, const Voxel& voxel, const FlagVisit& visit,
                                              const ObstacleSphere& candidate, const QueryBall& ball,
                                              const PointPairs& pairs, std::uint32_t near, Work& work)
{
  const float radius = candidate.node->r[candidate.lane] * obstacle.frame.stretch_b;
  std::uint32_t apart = 0;
  for (std::uint32_t bits = near; bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
    const bool is_leaf = (visit.leaves >> lane & 1) != 0;
    if (is_leaf == candidate.isLeaf()) continue;
    if (is_leaf && visit.r[lane] > kLargeLeaf * radius) {
      const LeafRange leaf{&voxel, visit.node->begin[lane], visit.node->comparedPoints(lane)};
      LeafPoints points;
      carryLeaf(obstacle.frame, leaf, points);
      const float reach = radius + obstacle.frame.pruneReach(pairs.clearance + leaf.largestRadius());
      work.node_pairs += leaf.count;
      if (pointsNear(points.x, points.y, points.z, leaf.count, ball.x, ball.y, ball.z, reach, kSphereMargin) == 0)
        apart |= 1u << lane;
    }
    else if (!is_leaf && radius > kLargeLeaf * visit.r[lane]) {
      const LeafRange leaf = candidate.leaf(*obstacle.voxel);
      const float reach = visit.r[lane] + obstacle.frame.pruneReach(pairs.clearance + leaf.largestRadius());
      work.node_pairs += leaf.count;
      if (pointsNear(leaf.x(), leaf.y(), leaf.z(), leaf.count, visit.x[lane], visit.y[lane], visit.z[lane], reach,
                     kSphereMargin) == 0)
        apart |= 1u << lane;
    }
  }
  return apart;
}

/// The voxels that two nodes are in, and where their clouds are.
struct ComparedSides {
  Voxel& voxel_a;
  GivenCloud a;
  Voxel& voxel_b;
  GivenCloud b;
};

/// The children in `near` that are far from the candidate for their size, and apart from it. @pre no radii
HWY_NOINLINE inline std::uint32_t farApart(const ObstacleVoxel& obstacle, const ComparedSides& sides,
                                           const FlagVisit& visit, const ObstacleSphere& candidate,
                                           const QueryBall& ball, const PointPairs& pairs, std::uint32_t near,
                                           Work& work)
{
  float gap[kLanes];
  spheresNear({visit.x, visit.y, visit.z, visit.r, 1.0f}, ball, gap);
  const float radius = candidate.node->r[candidate.lane] * obstacle.frame.stretch_b;
  std::uint32_t far = near & spheresFar(gap, visit.r, 1.0f, radius, kFarNodes);
  if (far == 0) return 0;
  const NodeSupport other = nodeSupport(sides.voxel_b, *candidate.node, candidate.lane, work);
  std::uint32_t apart = 0;
  for (; far != 0; far &= far - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(far));
    const NodeSupport own = nodeSupport(sides.voxel_a, *visit.node, lane, work);
    const bool is_leaf = (visit.leaves >> lane & 1) != 0;
    bool is_apart =
        areFarNodesApart(pairs.distance, sides.a.pose, own, sides.b.pose, other, pairs.clearance, work.exact_decisions);
    if (!is_apart && is_leaf && !candidate.isLeaf() && visit.r[lane] > kLargeFarLeaf * radius)
      is_apart = pointsFarApart(pairs.distance, sides.a, sides.b,
                                {&sides.voxel_a, visit.node->begin[lane], visit.node->comparedPoints(lane)}, true,
                                other, pairs.clearance, work);
    else if (!is_apart && !is_leaf && candidate.isLeaf() && radius > kLargeFarLeaf * visit.r[lane])
      is_apart = pointsFarApart(pairs.distance, sides.a, sides.b, candidate.leaf(*obstacle.voxel), false, own,
                                pairs.clearance, work);
    if (is_apart) apart |= 1u << lane;
  }
  return apart;
}

/// The children in `near` which float arithmetic cannot tell from the candidate's sphere, but whose points as given are
/// apart from the candidate's.
inline std::uint32_t apartAsGiven(const ObstacleVoxel& obstacle, const ComparedSides& sides, const FlagVisit& visit,
                                  const ObstacleSphere& candidate, const QueryBall& ball, const PointPairs& pairs,
                                  std::uint32_t near, Work& work)
{
  std::uint32_t apart = 0;
  GivenSphere other;
  for (std::uint32_t bits = near; bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
    const float dx = visit.x[lane] - ball.x, dy = visit.y[lane] - ball.y, dz = visit.z[lane] - ball.z;
    if (visit.r[lane] > obstacle.blunt_radius ||
        !obstacle.frame.isUndecided(dx * dx + dy * dy + dz * dz, visit.r[lane] + ball.near_reach))
      continue;
    ++work.exact_decisions;
    if (!other.isKnown()) other = givenSphereOf(sides.b.view, sides.voxel_b, *candidate.node, candidate.lane);
    const GivenSphere own = givenSphereOf(sides.a.view, sides.voxel_a, *visit.node, lane);
    if (areApart(pairs.distance, own, other, pairs.clearance)) apart |= 1u << lane;
  }
  return apart;
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle

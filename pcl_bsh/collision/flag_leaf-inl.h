// SPDX-License-Identifier: BSD-3-Clause
// The points of a leaf of a against the leaves of b that it is near to.

#if defined(PCL_BSH_COLLISION_FLAG_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_COLLISION_FLAG_LEAF_INL_H_
#undef PCL_BSH_COLLISION_FLAG_LEAF_INL_H_
#else
#define PCL_BSH_COLLISION_FLAG_LEAF_INL_H_
#endif

#include <pcl_bsh/collision/flag_visit-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// By float band, and exactly within the band.
inline std::uint32_t hitPoints(const ObstacleVoxel& obstacle, const FlagVisit& visit, std::uint32_t lane,
                               const LeafRange& leaf, const LeafPoints& points, const PointPairs& pairs, Work& work)
{
  const std::uint32_t open = visit.open_points[lane];
  alignas(64) float nearest[kLeafPoints];
  std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
  std::uint32_t hit = 0;
  for (const ObstacleSphere& candidate : visit.near[lane]) {
    ++work.leaf_pairs;
    const LeafRange other = candidate.leaf(*obstacle.voxel);
    // Of neighbouring leaves, only the points that face each other.
    const std::uint32_t facing = pointsNear(other.x(), other.y(), other.z(), other.count, visit.x[lane], visit.y[lane],
                                            visit.z[lane], visit.r[lane] + obstacle.prune_reach, kSphereMargin);
    if (facing == 0) continue;
    nearestSquared(points, other.x(), other.y(), other.z(), facing, nearest);
    hit = open & atMost(nearest, obstacle.band.hit);
    if (hit == open) return hit;
  }
  const std::uint32_t undecided = open & ~hit & ~above(nearest, obstacle.band.miss);
  for (const ObstacleSphere& candidate : visit.near[lane]) {
    if ((undecided & ~hit) == 0) break;
    const LeafRange other = candidate.leaf(*obstacle.voxel);
    eachPairNotBeyond(points, undecided, other, obstacle.band.miss, [&](std::uint32_t i, std::uint32_t j, float) {
      if ((hit >> i & 1) == 0 && pairs.collide({leaf.record(i), other.record(j)}, work)) hit |= 1u << i;
      return (undecided & ~hit) == 0;
    });
  }
  return hit;
}

/// The same where points have radii.
inline std::uint32_t hitBalls(const ObstacleVoxel& obstacle, const FlagVisit& visit, std::uint32_t lane,
                              const LeafRange& leaf, const LeafPoints& points, const PointPairs& pairs, Work& work)
{
  const std::uint32_t open = visit.open_points[lane];
  std::uint32_t hit = 0;
  for (const ObstacleSphere& candidate : visit.near[lane]) {
    if (hit == open) break;
    ++work.leaf_pairs;
    const LeafRange other = candidate.leaf(*obstacle.voxel);
    eachBallPairNear(obstacle.frame, points, open, leaf, other, pairs.clearance, pairs.reach.least,
                     [&](std::uint32_t i, std::uint32_t j, float, bool surely) {
                       if ((hit >> i & 1) == 0 && (surely || pairs.collide({leaf.record(i), other.record(j)}, work)))
                         hit |= 1u << i;
                       return hit == open;
                     });
  }
  return hit;
}

/// Which open points of a leaf, carried to the obstacle voxel, collide with the leaves of it that the child is near to.
inline std::uint32_t collidingPoints(const ObstacleVoxel& obstacle, const FlagVisit& visit, std::uint32_t lane,
                                     const LeafRange& leaf, const LeafPoints& points, const PointPairs& pairs,
                                     Work& work)
{
  return pairs.haveRadii() ? hitBalls(obstacle, visit, lane, leaf, points, pairs, work)
                           : hitPoints(obstacle, visit, lane, leaf, points, pairs, work);
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle

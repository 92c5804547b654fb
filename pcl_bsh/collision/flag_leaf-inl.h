// SPDX-License-Identifier: BSD-3-Clause
// The points of a leaf of a against the leaves of b that it is near to.

#if defined(PCL_BSH_COLLISION_FLAG_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_COLLISION_FLAG_LEAF_INL_H_
#undef PCL_BSH_COLLISION_FLAG_LEAF_INL_H_
#else
#define PCL_BSH_COLLISION_FLAG_LEAF_INL_H_
#endif

#include <pcl_bsh/collision/flag_query.h>
#include <pcl_bsh/collision/flag_visit-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// Points of a leaf: those that collide for certain, or may turn out to; and those that may collide, likewise.
struct OpenPoints {
  std::uint32_t surely = 0, perhaps = 0;
};

/// Which of the open points collide with a leaf of b. @param recordOf(i) of one of them
template <class RecordOf>
inline OpenPoints hitUncertain(const ObstacleVoxel& obstacle, const LeafPoints& points, const RecordOf& recordOf,
                               const LeafRange& other, const OpenPoints& open, const FlagQuery& query, Work& work)
{
  alignas(64) float squared[kLeafPoints][kLeafPoints];
  std::uint32_t near_surely[kLeafPoints], near[kLeafPoints], any = 0;
  for (std::uint32_t lanes = open.surely | open.perhaps; lanes != 0; lanes &= lanes - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(lanes));
    leafSquaredDistances(other.x(), other.y(), other.z(), points.x[i], points.y[i], points.z[i], squared[i]);
    near_surely[i] = (open.surely >> i & 1) != 0 ? firstBits(other.count) & ~above(squared[i], obstacle.band.miss) : 0;
    near[i] = (open.perhaps >> i & 1) != 0 ? firstBits(other.count) & ~above(squared[i], obstacle.possible.miss)
                                           : near_surely[i];
    if (near[i] != 0) query.pairs.ofPairs().prefetchOfA(recordOf(i));
    any |= near[i];
  }
  for (; any != 0; any &= any - 1)
    query.pairs.ofPairs().prefetchOfB(other.record(static_cast<std::uint32_t>(std::countr_zero(any))));
  OpenPoints hit;
  for (std::uint32_t lanes = open.surely | open.perhaps; lanes != 0; lanes &= lanes - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(lanes));
    const std::uint32_t bit = 1u << i;
    for (std::uint32_t others = near[i]; others != 0; others &= others - 1) {
      const auto j = static_cast<std::uint32_t>(std::countr_zero(others));
      const PointPair pair{recordOf(i), other.record(j)};
      if ((near_surely[i] >> j & 1) != 0 && query.certain->collide(obstacle.frame, squared[i][j], pair, work)) {
        hit.surely |= bit;
        break;
      }
      if ((open.perhaps & ~hit.perhaps & bit) != 0 && query.pairs.collide(obstacle.frame, squared[i][j], pair, work))
        hit.perhaps |= bit;
      if (((open.surely | (open.perhaps & ~hit.perhaps)) & bit) == 0) break;
    }
  }
  return hit;
}

/// The points of a leaf of b that face the child: those of neighbouring leaves that may matter.
inline std::uint32_t facingPoints(const ObstacleVoxel& obstacle, const FlagVisit& visit, std::uint32_t lane,
                                  const LeafRange& other)
{
  return pointsNear(other.x(), other.y(), other.z(), other.count, visit.x[lane], visit.y[lane], visit.z[lane],
                    visit.r[lane] + obstacle.prune_reach, kSphereMargin);
}

/// Where points are uncertain: by float bands, of the nearest pair and of each pair, and exactly within these.
inline std::uint32_t hitUncertainPoints(const ObstacleVoxel& obstacle, FlagVisit& visit, std::uint32_t lane,
                                        const LeafRange& leaf, const LeafPoints& points, const FlagQuery& query,
                                        Work& work)
{
  const std::vector<ObstacleSphere>& candidates = visit.near[lane];
  const std::uint32_t open = visit.open_points[lane];
  constexpr std::size_t kNoted = 64;
  std::uint32_t near[kNoted];
  alignas(64) float nearest[kLeafPoints], here[kLeafPoints];
  std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
  std::uint32_t hit = 0;
  for (std::size_t n = 0; n < candidates.size(); ++n) {
    ++work.leaf_pairs;
    const LeafRange other = candidates[n].leaf(*obstacle.voxel);
    std::fill(std::begin(here), std::end(here), std::numeric_limits<float>::infinity());
    nearestSquared(points, other.x(), other.y(), other.z(), facingPoints(obstacle, visit, lane, other), here);
    if (n < kNoted) near[n] = open & ~above(here, obstacle.possible.miss);
    for (std::size_t i = 0; i < kLeafPoints; ++i) nearest[i] = std::min(nearest[i], here[i]);
    hit = open & atMost(nearest, obstacle.band.hit);
    if (hit == open) return hit;
  }
  visit.perhaps[lane] |= open & atMost(nearest, obstacle.possible.hit);
  OpenPoints left{open & ~hit & ~above(nearest, obstacle.band.miss), 0};
  left.perhaps = open & ~hit & ~visit.perhaps[lane] & ~above(nearest, obstacle.possible.miss);
  for (std::size_t n = 0; n < candidates.size() && (left.surely | left.perhaps) != 0; ++n) {
    const std::uint32_t lanes = n < kNoted ? near[n] : open;
    const OpenPoints found = hitUncertain(
        obstacle, points, [&leaf](std::uint32_t i) { return leaf.record(i); }, candidates[n].leaf(*obstacle.voxel),
        {left.surely & lanes, left.perhaps & lanes}, query, work);
    hit |= found.surely;
    visit.perhaps[lane] |= found.perhaps;
    left = {left.surely & ~found.surely, left.perhaps & ~found.surely & ~found.perhaps};
  }
  return hit;
}

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
    const std::uint32_t facing = facingPoints(obstacle, visit, lane, other);
    if (facing == 0) continue;
    nearestSquared(points, other.x(), other.y(), other.z(), facing, nearest);
    hit = open & atMost(nearest, obstacle.band.hit);
    if (hit == open) return hit;
  }
  const std::uint32_t undecided = open & ~hit & ~above(nearest, obstacle.band.miss);
  for (const ObstacleSphere& candidate : visit.near[lane]) {
    if ((undecided & ~hit) == 0) break;
    const LeafRange other = candidate.leaf(*obstacle.voxel);
    eachPairNotBeyond(points, undecided, other, obstacle.band.miss, [&](std::uint32_t i, std::uint32_t j, float s) {
      if ((hit >> i & 1) == 0 && pairs.collide(obstacle.frame, s, {leaf.record(i), other.record(j)}, work))
        hit |= 1u << i;
      return (undecided & ~hit) == 0;
    });
  }
  return hit;
}

/// The same where points have radii.
inline std::uint32_t hitBalls(const ObstacleVoxel& obstacle, FlagVisit& visit, std::uint32_t lane,
                              const LeafRange& leaf, const LeafPoints& points, const FlagQuery& query, Work& work)
{
  const std::uint32_t open = visit.open_points[lane];
  std::uint32_t hit = 0;
  for (const ObstacleSphere& candidate : visit.near[lane]) {
    if (hit == open) break;
    ++work.leaf_pairs;
    const LeafRange other = candidate.leaf(*obstacle.voxel);
    eachBallPairNear(obstacle.frame, points, open, leaf, other, query.pairs.clearance, query.surePairs().reach.least,
                     [&](std::uint32_t i, std::uint32_t j, float squared, bool surely) {
                       if ((hit >> i & 1) != 0) return false;
                       const PointPair pair{leaf.record(i), other.record(j)};
                       if (surely || query.surePairs().collide(obstacle.frame, squared, pair, work)) {
                         hit |= 1u << i;
                       }
                       else if (query.certain && (visit.perhaps[lane] >> i & 1) == 0 &&
                                query.pairs.collide(obstacle.frame, squared, pair, work)) {
                         visit.perhaps[lane] |= 1u << i;
                       }
                       return hit == open;
                     });
  }
  return hit;
}

/// Which open points of a leaf, carried to the obstacle voxel, collide with the leaves of it that the child is near to.
inline std::uint32_t collidingPoints(const ObstacleVoxel& obstacle, FlagVisit& visit, std::uint32_t lane,
                                     const LeafRange& leaf, const LeafPoints& points, const FlagQuery& query,
                                     Work& work)
{
  if (query.pairs.haveRadii()) return hitBalls(obstacle, visit, lane, leaf, points, query, work);
  return query.certain ? hitUncertainPoints(obstacle, visit, lane, leaf, points, query, work)
                       : hitPoints(obstacle, visit, lane, leaf, points, query.pairs, work);
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle

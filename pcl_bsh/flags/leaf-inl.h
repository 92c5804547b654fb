// SPDX-License-Identifier: BSD-3-Clause
// The points of a leaf of a against the leaves of b that it is near to.

#if defined(PCL_BSH_FLAGS_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_FLAGS_LEAF_INL_H_
#undef PCL_BSH_FLAGS_LEAF_INL_H_
#else
#define PCL_BSH_FLAGS_LEAF_INL_H_
#endif

#include <pcl_bsh/flags/query.h>
#include <pcl_bsh/flags/uncertain-inl.h>
#include <pcl_bsh/flags/visit-inl.h>
#include <pcl_bsh/traversal/beyond_reach.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// Masks of a leaf's points, a bit each: points that certainly collide, and points that may collide; or points for
/// which one or the other is still open.
struct OpenPoints {
  std::uint32_t surely = 0, perhaps = 0;
};

/// Which of the open points collide with a leaf of b, and which may. @param recordOf(i) returns the record of point i
template <class RecordOf>
inline OpenPoints hitUncertain(const ObstacleVoxel& obstacle, const LeafPoints& points, const RecordOf& recordOf,
                               const LeafRange& other, const OpenPoints& open, const FlagQuery& query, Work& work)
{
  alignas(64) float squared[kLeafPoints][kLeafPoints];
  std::uint32_t near_surely[kLeafPoints], near[kLeafPoints], any = 0;
  for (const std::uint32_t i : Bits(open.surely | open.perhaps)) {
    leafSquaredDistances(other.x(), other.y(), other.z(), points.x[i], points.y[i], points.z[i], squared[i]);
    near_surely[i] = (open.surely >> i & 1) != 0 ? firstBits(other.count) & ~above(squared[i], obstacle.band.miss) : 0;
    near[i] = (open.perhaps >> i & 1) != 0 ? firstBits(other.count) & ~above(squared[i], obstacle.possible.miss)
                                           : near_surely[i];
    if (near[i] != 0) query.pairs.ofPairs().prefetchOfA(recordOf(i));
    any |= near[i];
  }
  for (const std::uint32_t j : Bits(any)) query.pairs.ofPairs().prefetchOfB(other.record(j));
  OpenPoints hit;
  for (const std::uint32_t i : Bits(open.surely | open.perhaps)) {
    const std::uint32_t bit = 1u << i;
    for (const std::uint32_t j : Bits(near[i])) {
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

/// Returns the points of a leaf of b, a bit each, that may be within reach of the child's sphere.
inline std::uint32_t facingPoints(const ObstacleVoxel& obstacle, const FlagVisit& visit, std::uint32_t lane,
                                  const LeafRange& other)
{
  return pointsNear(other.x(), other.y(), other.z(), other.count, visit.x[lane], visit.y[lane], visit.z[lane],
                    visit.r[lane] + obstacle.reach, kSphereMargin);
}

/// Which open points collide for certain, where points are uncertain. Adds those that may collide to visit.perhaps. The
/// least distances to points of b, plus and less their own uncertainties, decide most; single pairs decide the rest.
/// @param reach of the obstacle. @param own uncertainties of the leaf's points
HWY_NOINLINE inline std::uint32_t hitUncertainPoints(const ObstacleVoxel& obstacle, const UncertainReach& reach,
                                                     FlagVisit& visit, std::uint32_t lane, const LeafRange& leaf,
                                                     const float* own, const LeafPoints& points, const FlagQuery& query,
                                                     Work& work)
{
  const UncertainPoints limits(reach, own);
  const std::vector<ObstacleSphere>& candidates = visit.near[lane];
  const std::uint32_t open = visit.open_points[lane];
  alignas(64) float longer[kLeafPoints], shorter[kLeafPoints];
  std::fill(std::begin(longer), std::end(longer), std::numeric_limits<float>::infinity());
  std::fill(std::begin(shorter), std::end(shorter), std::numeric_limits<float>::infinity());
  std::uint32_t hit = 0;
  for (const ObstacleSphere& candidate : candidates) {
    ++work.leaf_pairs;
    const LeafRange other = candidate.leaf(*obstacle.voxel);
    const std::uint32_t facing = facingPoints(obstacle, visit, lane, other);
    if (facing == 0) continue;
    nearestWithLengths(points, other.x(), other.y(), other.z(), ownOf(reach.of_b, other), reach.scale_up, facing,
                       longer, shorter);
    hit = open & atMostEach(longer, limits.sure);
    if (hit == open) return hit;
  }
  visit.perhaps[lane] |= open & atMostEach(shorter, limits.maybe);
  OpenPoints left{open & ~hit & ~aboveEach(longer, limits.sure_miss), 0};
  left.perhaps = open & ~hit & ~visit.perhaps[lane] & ~aboveEach(shorter, limits.miss);
  for (const ObstacleSphere& candidate : candidates) {
    if ((left.surely | left.perhaps) == 0) break;
    const OpenPoints found = hitUncertain(
        obstacle, points, [&leaf](std::uint32_t i) { return leaf.record(i); }, candidate.leaf(*obstacle.voxel), left,
        query, work);
    hit |= found.surely;
    visit.perhaps[lane] |= found.perhaps;
    left = {left.surely & ~found.surely, left.perhaps & ~found.surely & ~found.perhaps};
  }
  return hit;
}

/// Which open points collide, where none has a radius: by the float band, and exactly within it.
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

/// Bits of the squared distances that are beyond a length: the sum of two radii and a pruneReach(), each rounded once.
HWY_INLINE std::uint32_t lanesBeyond(LaneVector squared, LaneVector length)
{
  const LaneTag d;
  const LaneVector limit = hn::Mul(hn::Mul(length, length), hn::Set(d, 1.0f + 8 * kSphereMargin));
  return bitsOf(d, hn::Gt(squared, hn::Add(limit, hn::Set(d, kVanishingSquare))));
}

/// Factor that takes the stored radius of a ball of b to the obstacle's frame and unit.
inline double ballScale(const ObstacleVoxel& obstacle)
{
  return static_cast<double>(obstacle.frame.stretch_b) / obstacle.voxel->frame.unit;
}

/// Returns the open points that are surely within reach of the middle of a ball of b's triangles, which is on its
/// triangle. Sets visit.asked, for each candidate, to the points that a ball of it may be near to. It has all open
/// points where the clearance is less than rounding, and none is looked at. It has all, too, where the candidate's
/// balls are larger than the reach, as such balls are near to most. @param radii of a's balls in the obstacle's frame,
/// or zeros
inline std::uint32_t hitMiddles(const ObstacleVoxel& obstacle, FlagVisit& visit, std::uint32_t lane,
                                const LeafPoints& points, const float* radii)
{
  const LaneTag d;
  const std::vector<ObstacleSphere>& candidates = visit.near[lane];
  const std::uint32_t open = visit.open_points[lane];
  visit.asked.assign(candidates.size(), open);
  if (!(obstacle.sure_reach > 0.0f)) return 0;
  const float surely = obstacle.sure_reach * obstacle.sure_reach * (1.0f - kSphereMargin) - kVanishingSquare;
  alignas(64) float squared[kLeafPoints];
  std::uint32_t hit = 0;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    const LeafRange other = candidates[c].leaf(*obstacle.voxel);
    const auto largest = static_cast<float>(other.largestRadius() * ballScale(obstacle));
    const bool are_small = largest <= obstacle.reach;
    const LaneVector within = hn::Set(d, obstacle.reach + (are_small ? largest : 0.0f));
    leafSquaredDistances(other.x(), other.y(), other.z(), visit.x[lane], visit.y[lane], visit.z[lane], squared);
    std::uint32_t far = 0;
    for (std::size_t j = 0; j < kLeafPoints; j += hn::Lanes(d))
      far |= lanesBeyond(hn::Load(d, squared + j), hn::Add(within, hn::Set(d, visit.r[lane]))) << j;
    std::fill(std::begin(squared), std::end(squared), std::numeric_limits<float>::infinity());
    nearestSquared(points, other.x(), other.y(), other.z(), firstBits(other.count) & ~far, squared);
    hit |= open & atMost(squared, surely);
    if (hit == open) break;
    for (std::size_t i = 0; i < kLeafPoints && are_small; i += hn::Lanes(d))
      visit.asked[c] &= ~(lanesBeyond(hn::Load(d, squared + i), hn::Add(within, hn::Load(d, radii + i))) << i);
  }
  return hit;
}

/// Which balls of a leaf of b are not proven to be farther than the reach from all of a child. @param within gets, for
/// each ball, how far from its middle points may matter
inline std::uint32_t facingBalls(const ObstacleVoxel& obstacle, const FlagVisit& visit, std::uint32_t lane,
                                 const LeafRange& other, float* within)
{
  const LaneTag d;
  const double stretched = ballScale(obstacle);
  alignas(64) float squared[kLeafPoints];
  leafSquaredDistances(other.x(), other.y(), other.z(), visit.x[lane], visit.y[lane], visit.z[lane], squared);
  std::fill_n(within, kLeafPoints, 0.0f);
  for (std::uint32_t j = 0; j < other.count; ++j)
    within[j] = obstacle.reach + static_cast<float>(other.radius(j) * stretched);
  std::uint32_t far = 0;
  for (std::size_t j = 0; j < kLeafPoints; j += hn::Lanes(d))
    far |= lanesBeyond(hn::Load(d, squared + j), hn::Add(hn::Load(d, within + j), hn::Set(d, visit.r[lane]))) << j;
  return firstBits(other.count) & ~far;
}

/// Calls compare(record, triangle, squared, near) for triangles of b until it returns true. The triangle's ball may be
/// near enough to points that hitMiddles() left in visit.asked, or to their balls: `near` has the bits of these points.
/// `squared` has the squared distances from the triangle. @param hit bits of points that need not be compared.
/// @param radii of a's balls in the obstacle's frame, at least; or zeros
template <class FacingOf, class Compare>
void eachTriangleNear(const ObstacleVoxel& obstacle, const FlagVisit& visit, std::uint32_t lane,
                      const std::uint32_t& hit, const LeafPoints& points, const float* radii, const PointsView& view,
                      FlatRecords& flat, Work& work, const FacingOf& facingOf, const Compare& compare)
{
  const LaneTag d;
  alignas(64) float squared[kLeafPoints], within[kLeafPoints];
  for (std::size_t c = 0; c < visit.near[lane].size(); ++c) {
    const ObstacleSphere& candidate = visit.near[lane][c];
    std::uint32_t open = visit.asked[c] & ~hit;
    if (open != 0) open &= facingOf(candidate);
    if (open == 0) continue;
    ++work.leaf_pairs;
    const LeafRange other = candidate.leaf(*obstacle.voxel);
    for (const std::uint32_t j : Bits(facingBalls(obstacle, visit, lane, other, within))) {
      squaredDistances(points, other.x()[j], other.y()[j], other.z()[j], squared);
      std::uint32_t near = open & ~hit;
      for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d))
        near &= ~(lanesBeyond(hn::Load(d, squared + i), hn::Add(hn::Set(d, within[j]), hn::Load(d, radii + i))) << i);
      if (near == 0) continue;
      const std::uint32_t record = other.record(j);
      const FlatRecord& triangle = flat.of(view, other, j);
      squaredToTriangle(triangle.flat, points.x, points.y, points.z, kLeafPoints, squared);
      if (compare(record, triangle, squared, near)) return;
    }
  }
}

/// Which open points collide, where b is of triangles and a's points have no radii. Middles of balls decide first, then
/// the float band of triangles whose balls come near enough, and exact arithmetic within the band.
template <class FacingOf>
std::uint32_t hitTriangles(const ObstacleVoxel& obstacle, FlagVisit& visit, std::uint32_t lane, const LeafRange& leaf,
                           const LeafPoints& points, const FlagQuery& query, FlatRecords& flat, Work& work,
                           BeyondReach& beyond, const FacingOf& facingOf)
{
  alignas(64) static constexpr float kNone[kLeafPoints] = {};
  const std::uint32_t open = visit.open_points[lane];
  std::uint32_t hit = hitMiddles(obstacle, visit, lane, points, kNone);
  if (hit == open) return hit;
  eachTriangleNear(obstacle, visit, lane, hit, points, kNone, query.b.hierarchy().view(), flat, work, facingOf,
                   [&](std::uint32_t record, const FlatRecord& triangle, const float* squared, std::uint32_t near) {
                     const auto bandOf = [&](double length) { return triangle.band(obstacle.frame, length); };
                     const auto decide = [&](const DistanceBand& band, const PointPairs& pairs, std::uint32_t among) {
                       std::uint32_t decided = among & atMost(squared, band.hit);
                       for (const std::uint32_t i : Bits(among & ~decided & ~above(squared, band.miss))) {
                         const PointPair at{leaf.record(i), record};
                         if (pairs.collide(at, work))
                           decided |= 1u << i;
                         else if (&pairs == &query.pairs)
                           beyond.found(at);
                       }
                       return decided;
                     };
                     const bool is_usual = triangle.isUsual(obstacle.frame);
                     hit |= decide(is_usual ? obstacle.flat : query.surely.band(bandOf), query.surePairs(), near);
                     if (query.certain)
                       visit.perhaps[lane] |= decide(is_usual ? obstacle.possibly_flat : query.length_band.band(bandOf),
                                                     query.pairs, near & ~hit & ~visit.perhaps[lane]);
                     return hit == open;
                   });
  return hit;
}

/// Which open balls or triangles of a collide, where b is of triangles: by their middles, as far as these are near
/// enough, and exactly where only their balls come near.
template <class FacingOf>
std::uint32_t hitByTriangles(const ObstacleVoxel& obstacle, FlagVisit& visit, std::uint32_t lane, const LeafRange& leaf,
                             const LeafPoints& points, const FlagQuery& query, FlatRecords& flat, Work& work,
                             BeyondReach& beyond, const FacingOf& facingOf)
{
  const LaneTag d;
  const std::uint32_t open = visit.open_points[lane];
  const double surely = query.surePairs().reach.least - query.a.hierarchy().view().off_middle;
  alignas(64) float radii[kLeafPoints] = {}, limits[kLeafPoints];
  for (std::uint32_t i = 0; i < leaf.count; ++i) radii[i] = roundUp(leaf.radius(i) * ballScale(obstacle));
  std::uint32_t hit = hitMiddles(obstacle, visit, lane, points, radii);
  if (hit == open) return hit;
  struct Doubtful {
    std::uint32_t record, near;
  };
  static constexpr std::size_t kMost = 256;
  Doubtful doubtful[kMost];
  const bool of_triangles = query.a.hierarchy().view().triangles != nullptr;
  CarriedTriangles own;
  bool is_carried = false;
  std::size_t count = 0;
  const auto decide = [&] { // once floats have found what they can
    for (const Doubtful* pair = doubtful; pair != doubtful + count && hit != open; ++pair)
      for (const std::uint32_t i : Bits(pair->near & ~hit)) {
        const PointPair at{leaf.record(i), pair->record};
        if (query.surePairs().collide(at, work))
          hit |= 1u << i;
        else if (query.certain && ((visit.perhaps[lane] >> i & 1) != 0 || query.pairs.collide(at, work)))
          visit.perhaps[lane] |= 1u << i;
        else
          beyond.found(at);
      }
    count = 0;
  };
  eachTriangleNear(obstacle, visit, lane, hit, points, radii, query.b.hierarchy().view(), flat, work, facingOf,
                   [&](std::uint32_t record, const FlatRecord& triangle, const float* squared, std::uint32_t near) {
                     if (surely > 0.0) hit |= near & atMost(squared, triangle.band(obstacle.frame, surely).hit);
                     if (hit == open) return true;
                     const LaneVector more = hn::Set(d, obstacle.reach + roundUp(triangle.error(obstacle.frame)));
                     for (std::size_t i = 0; i < kLeafPoints; i += hn::Lanes(d)) {
                       const LaneVector limit =
                           hn::Mul(hn::Add(hn::Load(d, radii + i), more), hn::Set(d, 1.0f + kFlatMargin));
                       hn::Store(hn::Add(hn::Mul(limit, limit), hn::Set(d, kVanishingSquare)), d, limits + i);
                     }
                     near &= ~hit & ~aboveEach(squared, limits);
                     if (near == 0) return false;
                     if (of_triangles) {
                       if (!is_carried) own.carry(query.a.hierarchy().view(), leaf, obstacle.frame);
                       is_carried = true;
                       const double error = own.error + triangle.error(obstacle.frame);
                       const double least = query.surePairs().reach.least;
                       const LanesVerdict found =
                           compareWithTriangle(triangle.flat, own.leaf, near, obstacle.reach + roundUp(error),
                                               least > 0.0 ? obstacle.frame.band(least, error, kFlatShare).hit : -1.0f);
                       hit |= found.within;
                       near &= ~found.within & ~found.apart;
                       if (near == 0) return hit == open;
                     }
                     doubtful[count++] = {record, near};
                     if (count == kMost) decide();
                     return hit == open;
                   });
  decide();
  return hit;
}

/// Which open points collide, where points have radii. @param facingOf(candidate) bits of its points that may matter
template <class FacingOf>
inline std::uint32_t hitBalls(const ObstacleVoxel& obstacle, FlagVisit& visit, std::uint32_t lane,
                              const LeafRange& leaf, const LeafPoints& points, const FlagQuery& query, Work& work,
                              BeyondReach& beyond, const FacingOf& facingOf)
{
  const std::uint32_t open = visit.open_points[lane];
  std::uint32_t hit = 0;
  const auto compare = [&](const LeafRange& other) {
    eachBallPairNear(obstacle.frame, points, open & ~hit, leaf, other, query.pairs.reach.length(),
                     query.surePairs().surelyOfBalls(),
                     [&](std::uint32_t i, std::uint32_t j, float squared, bool surely) {
                       if ((hit >> i & 1) != 0) return false;
                       const PointPair pair{leaf.record(i), other.record(j)};
                       if (surely || query.surePairs().collide(obstacle.frame, squared, pair, work)) {
                         hit |= 1u << i;
                       }
                       else if (query.certain && ((visit.perhaps[lane] >> i & 1) != 0 ||
                                                  query.pairs.collide(obstacle.frame, squared, pair, work))) {
                         visit.perhaps[lane] |= 1u << i;
                       }
                       else {
                         beyond.found(pair);
                       }
                       return hit == open;
                     });
  };
  for (const ObstacleSphere& candidate : visit.near[lane]) {
    if (hit == open) break;
    ++work.leaf_pairs;
    const LeafRange other = candidate.leaf(*obstacle.voxel);
    const std::uint32_t facing = facingOf(candidate);
    if (facing == firstBits(other.count)) {
      compare(other);
      continue;
    }
    for (const std::uint32_t j : Bits(facing)) {
      if (hit == open) break;
      compare({other.voxel, other.begin + j, 1});
    }
  }
  return hit;
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

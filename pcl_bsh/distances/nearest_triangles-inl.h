// SPDX-License-Identifier: BSD-3-Clause
// The nearest triangles of b to the points of one leaf of a that have no radii.

#if defined(PCL_BSH_DISTANCES_NEAREST_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_NEAREST_TRIANGLES_INL_H_
#undef PCL_BSH_DISTANCES_NEAREST_TRIANGLES_INL_H_
#else
#define PCL_BSH_DISTANCES_NEAREST_TRIANGLES_INL_H_
#endif

#include <pcl_bsh/distances/measured_leaf-inl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

class NearestTriangles {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

public:
  NearestTriangles(MeasuredLeaf& leaf, DistanceScratch& scratch)
  : leaf_(leaf),
    flat_(scratch.flat),
    maybe_(scratch.maybe_nearest),
    long_(scratch.long_triangles),
    moved_only_(leaf.query.a.pose.linear() == Eigen::Matrix3d::Identity()),
    unmoved_(moved_only_ && leaf.query.a.pose.translation() == Eigen::Vector3d::Zero())
  {
    long_.forget();
  }

  /// The nearest triangle of b to each point of the leaf: floats leave a few candidates, longer numbers decide.
  /// @param near leaves that can hold it, in the order of their lower bounds
  /// @return false where all points are known to be nearer than what was measured
  bool find(float cut, const std::vector<NearSphere>& near)
  {
    const LaneTag d;
    alignas(64) float squared[kLeafPoints], reach[kLeafPoints];
    alignas(64) float nearest[kLeafPoints]; ///< of the squared distances in one obstacle
    for (std::uint32_t i = 0; i < kLeafPoints; ++i)
      most_[i] = i < leaf_.range.count ? cut : -std::numeric_limits<float>::infinity();
    maybe_.clear();
    for (const NearSphere& candidate : near) {
      if (candidate.lower > largestOf(most_, kLeafPoints)) break;
      leaf_.pulse.step();
      const DistanceObstacle& obstacle = leaf_.obstacles[candidate.sphere.obstacle];
      const CarriedLeaf& own = leaf_.carried(candidate.sphere.obstacle);
      const LeafRange other = candidate.sphere.leaf(*obstacle.voxel);
      const float stretched = stretchOf(obstacle);
      setReach(obstacle, reach);
      if (nearerPoints(own.points, obstacle.slabsOf(candidate.sphere), reach) == 0) continue;
      ++leaf_.work.leaf_pairs;
      std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
      float largest_error = 0.0f;
      for (std::uint32_t j = 0; j < other.count; ++j) {
        const LaneVector radius = hn::Set(d, enough(other.radius(j) * double{stretched}));
        squaredDistances(own.points, other.x()[j], other.y()[j], other.z()[j], squared);
        bool any = false;
        for (std::size_t i = 0; i < leaf_.lanes; i += hn::Lanes(d))
          any = any || !hn::AllTrue(d, isBeyond(hn::Load(d, squared + i), hn::Load(d, reach + i), radius));
        if (!any) continue;
        const FlatRecord& triangle = flat_.of(leaf_.view_b, other, j);
        MaybeNearest& entry = maybe_.emplace_back();
        entry.obstacle = candidate.sphere.obstacle;
        entry.point = other.begin + j;
        entry.error = enough(triangle.error(obstacle.frame));
        squaredToTriangle(triangle.flat, own.points.x, own.points.y, own.points.z, leaf_.lanes, entry.squared);
        any = false;
        for (std::size_t i = 0; i < leaf_.lanes; i += hn::Lanes(d)) {
          const LaneVector at = hn::LoadU(d, entry.squared + i);
          any = any || !hn::AllTrue(d, isBeyond(at, hn::Load(d, reach + i), hn::Set(d, entry.error)));
          hn::Store(hn::Min(at, hn::Load(d, nearest + i)), d, nearest + i);
        }
        largest_error = std::max(largest_error, entry.error);
        if (!any) maybe_.pop_back();
      }
      const float error = enough(obstacle.frame.error + double{largest_error});
      for (std::size_t i = 0; i < leaf_.lanes; i += hn::Lanes(d)) {
        LaneVector low, high;
        boundsOfFlat(d, hn::Load(d, nearest + i), hn::Zero(d), error, obstacle, low, high);
        const LaneVector before = hn::Load(d, most_ + i);
        hn::Store(hn::IfThenElse(hn::Lt(high, before), high, before), d, most_ + i);
      }
    }
    if (leaf_.query.exceeds(largestOf(most_, kLeafPoints))) return false;
    decideAmong();
    return true;
  }

private:
  /// Sets lengths in the obstacle's unit: what is farther from a point of the leaf is not the nearest.
  void setReach(const DistanceObstacle& obstacle, float* reach)
  {
    const LaneTag d;
    for (std::size_t i = 0; i < leaf_.lanes; i += hn::Lanes(d)) {
      const LaneVector scaled = hn::Mul(hn::Load(d, most_ + i), hn::Set(d, obstacle.at_most_inside));
      const LaneVector sum = hn::Add(scaled, hn::Set(d, obstacle.slack));
      hn::Store(hn::Mul(sum, hn::Set(d, 1.0f + kFlatMargin)), d, reach + i);
    }
  }

  /// Whether squared distances are surely above the square of the sum of `reach` and `more`. A reach of minus infinity
  /// stands for no point; NaN is beyond nothing.
  static HWY_INLINE hn::Mask<LaneTag> isBeyond(LaneVector squared, LaneVector reach, LaneVector more)
  {
    const LaneTag d;
    const LaneVector limit = hn::Mul(hn::Add(reach, more), hn::Set(d, 1.0f + kFlatMargin));
    return hn::Or(hn::Gt(squared, hn::Add(hn::Mul(limit, limit), hn::Set(d, kVanishingSquare))),
                  hn::Lt(limit, hn::Zero(d)));
  }

  /// Which points of the leaf may be nearer than their `reach` to what lies in a sphere of b and in its slabs.
  std::uint32_t nearerPoints(const LeafPoints& points, const CrossedSlabs& held, const float* reach) const
  {
    const LaneTag d;
    std::uint32_t far = 0;
    for (std::size_t i = 0; i < leaf_.lanes; i += hn::Lanes(d)) {
      const LaneVector length =
          lengthToSlabs(held, hn::Load(d, points.x + i), hn::Load(d, points.y + i), hn::Load(d, points.z + i));
      far |= bitsOf(d, hn::Gt(length, hn::Load(d, reach + i))) << i; // not so for NaN
    }
    return ~far & firstBits(leaf_.range.count);
  }

  /// The triangle that is the nearest to a point, of those that were looked at.
  struct Nearest {
    bool compared = false; ///< whether with another one: then the following are set
    SharedPart part;
    double gap;   ///< of the triangle, at most
    bool bounded; ///< whether doubles have bounded the gap
  };

  /// Decides for each point which triangle is the nearest, among those that may be.
  void decideAmong()
  {
    const LaneTag d;
    std::uint32_t several = 0;
    alignas(64) float reach[kLeafPoints] = {};
    for (std::uint32_t i = 0; i < leaf_.range.count; ++i) leaf_.found[i] = NearestFound();
    placed_ = 0;
    std::uint32_t obstacle = kNoVoxel; // that `reach` is in
    for (const MaybeNearest& entry : maybe_) {
      if (entry.obstacle != obstacle) setReach(leaf_.obstacles[obstacle = entry.obstacle], reach);
      std::uint32_t beyond = 0;
      for (std::size_t i = 0; i < leaf_.lanes; i += hn::Lanes(d))
        beyond |= bitsOf(d, isBeyond(hn::LoadU(d, entry.squared + i), hn::Load(d, reach + i), hn::Set(d, entry.error)))
                  << i;
      for (const std::uint32_t i : Bits(~beyond & firstBits(leaf_.range.count))) {
        const NearestFound found{leaf_.obstacles[obstacle].voxel, entry.point};
        if (leaf_.found[i].voxel) {
          Nearest& nearest = nearest_[i];
          if ((several >> i & 1) == 0) nearest.compared = false;
          several |= 1u << i;
          compareTriangles(i, found, nearest);
          continue;
        }
        leaf_.found[i] = found;
        if (leaf_.max < kInfinity) setBounds(leaf_.found[i], leaf_.obstacles[obstacle], entry.squared[i], entry.error);
      }
    }
    for (std::uint32_t i = 0; i < leaf_.range.count; ++i) {
      leaf_.length[i] = kNotKnown;
      if (!leaf_.found[i].voxel) continue;
      LongTriangle& triangle = longOf(leaf_.found[i]);
      const LongVector& place = placeOf(i);
      leaf_.length[i] = (several >> i & 1) != 0 ? longDistance(triangle, nearest_[i].part, place)
                                                : longDistance(triangle, nearPartOf(triangle, place), place);
    }
  }

  /// Sets the bounds of a distance that floats tell.
  void setBounds(NearestFound& found, const DistanceObstacle& obstacle, float squared, float error) const
  {
    const LaneTag d;
    LaneVector low, high;
    boundsOfFlat(d, hn::Set(d, squared), hn::Zero(d), enough(obstacle.frame.error + double{error}), obstacle, low,
                 high);
    const float most = hn::GetLane(high);
    found.least = double{orNone(hn::GetLane(low))} * leaf_.unit;
    found.most = std::isnan(most) ? kInfinity : double{most} * leaf_.unit;
  }

  /// Takes the nearer of two triangles to point i, of equals the smaller record.
  void compareTriangles(std::uint32_t i, const NearestFound& found, Nearest& nearest)
  {
    NearestFound& best = leaf_.found[i];
    ++leaf_.work.exact_decisions;
    leaf_.pulse.look();
    const auto partOf = [&](const NearestFound& of) {
      const LongTriangle& triangle = longOf(of);
      return SharedPart(nearPartOf(triangle, placeOf(i)), triangle);
    };
    if (!nearest.compared) {
      nearest.compared = true;
      nearest.gap = double{most_[i]} * leaf_.unit;
      nearest.bounded = false;
      nearest.part = partOf(best);
      best.least = -kInfinity; // of several: what floats say is not the least of them
      best.most = kInfinity;
    }
    const SharedPart part = partOf(found);
    const auto take = [&] {
      best.voxel = found.voxel;
      best.point = found.point;
      nearest.part = part;
      nearest.bounded = false;
    };
    if (part.low > nearest.part.high) return;
    if (part.high < nearest.part.low) return take();
    if (part.isSameAs(nearest.part)) {
      if (recordOf(found) < recordOf(best)) take();
      return;
    }
    const RecordDistance::Pair pair = leaf_.posed(i, found), best_pair = leaf_.posed(i, best);
    if (!std::exchange(nearest.bounded, true))
      nearest.gap = std::min(nearest.gap, leaf_.query.pairs.distance.enclose(best_pair).high);
    if (leaf_.query.pairs.distance.isSurelyBeyond(pair, nearest.gap)) return;
    const int sign = leaf_.query.pairs.distance.compareGaps(pair, best_pair);
    if (sign < 0 || (sign == 0 && recordOf(found) < recordOf(best))) take();
  }

  LongTriangle& longOf(const NearestFound& found)
  {
    return long_.of(*leaf_.view_b.triangles, leaf_.query.b.pose, recordOf(found));
  }

  /// Where point i is in the world.
  const LongVector& placeOf(std::uint32_t i)
  {
    LongVector& place = places_[i];
    if ((placed_ >> i & 1) != 0) return place;
    placed_ |= 1u << i;
    const Point3 p = leaf_.given(i);
    if (unmoved_) return place = LongVector(p);
    if (!moved_only_) return place = LongVector(placedLong(leaf_.query.a.pose, p));
    place.error = 0.0;
    place.plain = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const WithError sum = twoSum(p[k], leaf_.query.a.pose.translation()[static_cast<Eigen::Index>(k)]);
      place.value[k] = sum.value, place.tail[k] = sum.error;
    }
    return place;
  }

  MeasuredLeaf& leaf_;
  FlatRecords& flat_;
  std::vector<MaybeNearest>& maybe_;
  LongTriangles& long_;
  const bool moved_only_; ///< whether a's pose turns nothing
  const bool unmoved_;    ///< whether it moves nothing, either

  LongVector places_[kLeafPoints]; ///< of the points that have their bit in placed_
  std::uint32_t placed_ = 0;
  alignas(64) float most_[kLeafPoints]; ///< upper bounds of the distances of points, in the walk's unit
  Nearest nearest_[kLeafPoints];        ///< of points that several triangles may be the nearest to
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

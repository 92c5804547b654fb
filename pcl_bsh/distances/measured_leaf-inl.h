// SPDX-License-Identifier: BSD-3-Clause
// One leaf of a while its points are measured: where it is as seen from b, and what was found for them.

#if defined(PCL_BSH_DISTANCES_MEASURED_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_MEASURED_LEAF_INL_H_
#undef PCL_BSH_DISTANCES_MEASURED_LEAF_INL_H_
#else
#define PCL_BSH_DISTANCES_MEASURED_LEAF_INL_H_
#endif

#include <pcl_bsh/distances/distance_query.h>
#include <pcl_bsh/distances/distance_visit-inl.h>
#include <pcl_bsh/query/progress.h>

#include <algorithm>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// The record of b that is the nearest to a point of a.
struct NearestFound {
  const Voxel* voxel = nullptr;                            ///< null: none
  std::uint32_t point = 0;                                 ///< in the voxel
  double least = -std::numeric_limits<double>::infinity(); ///< lower bound: distance less the radius of b's point alone
  double most = std::numeric_limits<double>::infinity();   ///< upper bound of that difference
};

inline std::uint32_t recordOf(const NearestFound& found)
{
  return found.voxel->records()[found.point];
}

/// A float that is not below a double >= 0, nor much above it.
inline float enough(double x)
{
  return roundToFloat(x) * (1.0f + 0x1p-22f) + 0x1p-140f;
}

/// Upper bound of a length of 1 in the clouds' unit, in the obstacle's.
inline float stretchOf(const DistanceObstacle& obstacle)
{
  return enough(static_cast<double>(obstacle.frame.stretch_b) / obstacle.voxel->frame.unit);
}

struct MeasuredLeaf {
  MeasuredLeaf(const DistancesQuery& asked, DistanceScratch& scratch, Work& counted)
  : query(asked),
    obstacles(scratch.obstacles),
    leaves(scratch.leaves),
    stamp(scratch.stamp),
    work(counted),
    view_a(asked.a.hierarchy().view()),
    view_b(asked.b.hierarchy().view()),
    of_triangles(asked.pairs.ofTriangles()),
    unit(asked.unit),
    largest_radius(asked.b.hierarchy().storage().largest_radius),
    max(asked.pairs.reach.most),
    pulse(counted)
  {
  }

  void begin(const Voxel& voxel, const DistanceVisit& visit, std::uint32_t lane)
  {
    range = {&voxel, visit.node->begin[lane], visit.node->comparedPoints(lane)};
    lanes = (range.count + hn::Lanes(LaneTag()) - 1) / hn::Lanes(LaneTag()) * hn::Lanes(LaneTag());
    ++stamp;
  }

  const CarriedLeaf& carried(std::uint32_t obstacle)
  {
    CarriedLeaf& own = leaves[obstacle];
    if (own.stamp == stamp) return own;
    own.stamp = stamp;
    carryLeaf(obstacles[obstacle].frame, range, own.points);
    float* const axes[] = {own.points.x, own.points.y, own.points.z};
    for (std::size_t k = 0; k < 3; ++k) {
      std::fill(axes[k] + range.count, axes[k] + kLeafPoints, axes[k][0]);
      own.low[k] = smallestOf(axes[k], kLeafPoints);
      own.high[k] = largestOf(axes[k], kLeafPoints);
    }
    return own;
  }

  Point3 given(std::uint32_t i) const { return range.voxel->point(view_a, range.begin + i); }

  RecordDistance::Pair posed(std::uint32_t i, const NearestFound& other) const
  {
    if (of_triangles) return query.pairs.posed({range.record(i), recordOf(other)});
    return {ExactDistance::Pair{given(i), other.voxel->point(view_b, other.point), range.radius(i),
                                other.voxel->radii ? double{other.voxel->radii[other.point]} : 0.0},
            {}};
  }

  const DistancesQuery& query;
  const std::vector<DistanceObstacle>& obstacles;
  std::vector<CarriedLeaf>& leaves; ///< by obstacle
  std::uint64_t& stamp;
  Work& work;
  const PointsView& view_a;
  const PointsView& view_b;
  const bool of_triangles;     ///< whether a cloud is
  const double unit;           ///< of bounds and floats, in the clouds' unit
  const double largest_radius; ///< of b's points, in the clouds' unit
  const double max;            ///< the greatest distance that is asked for
  WorkPulse pulse;             ///< of all that measures leaves

  LeafRange range;
  std::size_t lanes = kLeafPoints; ///< of the leaf's points, whole vectors
  NearestFound found[kLeafPoints];
  alignas(64) double length[kLeafPoints]; ///< to what was found; NaN where it is not known
};

/// The nearest of some records of b to one of the leaf's, in exact arithmetic; of several the smallest record.
class BestRecord {
public:
  /// @param i of the leaf's records @param cut it is no farther than this from b, in the walk's unit, unless it is
  ///   beyond max_distance
  BestRecord(MeasuredLeaf& leaf, std::uint32_t i, float cut) : leaf_(leaf), i_(i), most_(double{cut} * leaf.unit) {}

  /// Takes one that may be the nearest, before any other.
  void begin(const NearestFound& found)
  {
    const RecordDistance::Pair pair = leaf_.posed(i_, found);
    take(found, pair, gapOf(pair));
  }

  /// Takes it if it is nearer than the best.
  void consider(const NearestFound& found)
  {
    if (found.voxel == best_.voxel && found.point == best_.point) return;
    leaf_.pulse.look();
    const RecordDistance::Pair pair = leaf_.posed(i_, found);
    if (leaf_.of_triangles && leaf_.query.pairs.distance.isSurelyBeyond(pair, most_)) return;
    const Interval gap = gapOf(pair);
    if (best_.voxel && !(gap.upper < least_)) {
      ++leaf_.work.exact_decisions;
      const int sign = leaf_.query.pairs.distance.compareGaps(pair, pair_);
      if (sign > 0 || (sign == 0 && recordOf(best_) < recordOf(found))) return;
    }
    take(found, pair, gap);
  }

  /// The nearest of those considered; `voxel` is null where no record was near enough.
  const NearestFound& found() const { return best_; }

  /// The gap is at most this, in the clouds' unit.
  double most() const { return most_; }

private:
  /// The interval of a gap that doubles tell, in the clouds' unit.
  Interval gapOf(const RecordDistance::Pair& pair) const
  {
    const double radii = pair.radius_p + pair.radius_q;
    const RecordDistance::Enclosure apart = leaf_.query.pairs.distance.enclose(pair);
    const double doubt = kFewDoubleRoundings * (apart.high + radii);
    return {apart.low - radii - doubt, apart.high - radii + doubt};
  }

  void take(const NearestFound& found, const RecordDistance::Pair& pair, const Interval& gap)
  {
    best_.voxel = found.voxel; // its float bounds stay unset: they may be those of another record
    best_.point = found.point;
    pair_ = pair;
    least_ = gap.lower;
    most_ = std::min(most_, gap.upper);
  }

  MeasuredLeaf& leaf_;
  const std::uint32_t i_;
  double most_;
  double least_ = 0.0; ///< of the best one's gap
  NearestFound best_;
  RecordDistance::Pair pair_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

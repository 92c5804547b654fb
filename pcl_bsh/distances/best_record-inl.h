// SPDX-License-Identifier: BSD-3-Clause
// The nearest of some records of b to one of a leaf of a, in exact arithmetic; of several the smallest record.

#if defined(PCL_BSH_DISTANCES_BEST_RECORD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_BEST_RECORD_INL_H_
#undef PCL_BSH_DISTANCES_BEST_RECORD_INL_H_
#else
#define PCL_BSH_DISTANCES_BEST_RECORD_INL_H_
#endif

#include <pcl_bsh/distances/measured_leaf-inl.h>

#include <algorithm>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

class BestRecord {
public:
  /// @param i of the leaf's records @param cut it is no farther than this from b, in the walk's unit, unless that
  /// exceeds the greatest distance
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
  /// As far as doubles know it.
  Interval gapOf(const RecordDistance::Pair& pair) const
  {
    const double radii = pair.radius_p + pair.radius_q;
    const RecordDistance::Enclosure apart = leaf_.query.pairs.distance.enclose(pair);
    const double doubt = kFewDoubleRoundings * (apart.high + radii);
    return {apart.low - radii - doubt, apart.high - radii + doubt};
  }

  void take(const NearestFound& found, const RecordDistance::Pair& pair, const Interval& gap)
  {
    best_.voxel = found.voxel; // what floats say of a distance may be that of another one
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

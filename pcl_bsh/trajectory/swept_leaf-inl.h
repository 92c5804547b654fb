// SPDX-License-Identifier: BSD-3-Clause
// Swept: points of a leaf of the scan against points of a leaf of the model, at all instants of an interval.

#if defined(PCL_BSH_TRAJECTORY_SWEPT_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_SWEPT_LEAF_INL_H_
#undef PCL_BSH_TRAJECTORY_SWEPT_LEAF_INL_H_
#else
#define PCL_BSH_TRAJECTORY_SWEPT_LEAF_INL_H_
#endif

#include <pcl_bsh/trajectory/leaf_visit-inl.h>
#include <pcl_bsh/trajectory/point_segment.h>
#include <pcl_bsh/trajectory/voxel_results.h>

#include <tuple>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

class SweptLeaf {
public:
  SweptLeaf(const TrajectoryQuery& query, const VoxelInModelFrame& voxel_frame, VoxelResults& results)
  : query_(query),
    voxel_frame_(voxel_frame),
    results_(results)
  {
  }

  /// Points that move in straight lines against points at rest, in double. What that gets wrong is small against the
  /// tolerance (checkTolerance()).
  /// @param clipped during which part of the interval each may be near. @param near_points to which points of the
  /// model's leaf, as bits: the others are farther than the reach, at every instant
  void compare(LeafVisit& leaf, std::uint32_t lanes, const ClippedSegments<kLeafPoints>& clipped, const BoxLeaf& other,
               const std::uint32_t (&near_points)[kLeafPoints], const VoxelMotion& motion)
  {
    ++results_.work.leaf_pairs;
    const double begin = motion.interval->first, steps = motion.interval->last - motion.interval->first;
    for (std::uint32_t bits = lanes; bits != 0; bits &= bits - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
      const double earliest_here = begin + steps * clipped.from[i];
      if (isSettled(leaf, i, earliest_here)) continue;
      const std::uint32_t record = leaf.points.record(i);
      const PointSegment segment(query_, record, *motion.interval);
      for (std::uint32_t its = near_points[i]; its != 0; its &= its - 1) {
        ++results_.work.exact_decisions;
        const std::uint32_t q = other.record(static_cast<std::uint32_t>(std::countr_zero(its)));
        const double near_enough = query_.nearEnough({record, q});
        if (near_enough < 0.0) continue;
        const ClosestApproach approach = segment.approachTo(query_, q, near_enough);
        if (!approach.contact) continue;
        if (query_.witness) return keepWitness(leaf, {record, q});
        results_.hit[leaf.slot] = static_cast<std::uint16_t>(results_.hit[leaf.slot] | 1u << i);
        double& first = results_.first[leaf.points.begin + i];
        first = std::min(first, begin + steps * approach.enter);
        results_.earliest = std::min(results_.earliest, first);
        if (!query_.closest) {
          if (isSettled(leaf, i, earliest_here)) break;
          continue;
        }
        const double radii = query_.scan.hierarchy().view().radius(record) + query_.model.view().radius(q);
        consider(results_.best[leaf.points.begin + i], approach.distance - radii, begin + steps * approach.at, q);
      }
      if (isSettled(leaf, i, begin)) leaf.open &= ~(1u << i);
      if (query_.closest && query_.radii == 0.0) {
        NearestPoint& best = results_.best[leaf.points.begin + i];
        best.reach = std::min(best.reach, roundUp(best.gap));
        if (results_.bestBounds(leaf.points.begin + i, motion.interval->first))
          leaf.lowerReach(voxel_frame_, i, best.reach, motion);
      }
    }
  }

private:
  /// Whether nothing that a point meets from this time on changes an answer.
  bool isSettled(const LeafVisit& leaf, std::uint32_t i, double from) const
  {
    return !query_.closest && !query_.witness && (results_.hit[leaf.slot] >> i & 1) != 0 &&
           results_.firstOf(leaf.points.begin + i) <= from;
  }

  void keepWitness(LeafVisit& leaf, const PointPair& pair)
  {
    results_.witness = pair;
    leaf.open = 0;
  }

  /// Keeps the nearest; of several the first instant, and there the smallest record.
  static void consider(NearestPoint& best, double gap, double time, std::uint32_t record)
  {
    if (std::tie(gap, time, record) >= std::tie(best.gap, best.time, best.record)) return;
    best.gap = gap;
    best.time = time;
    best.record = record;
  }

  const TrajectoryQuery& query_;
  const VoxelInModelFrame& voxel_frame_;
  VoxelResults& results_;
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle

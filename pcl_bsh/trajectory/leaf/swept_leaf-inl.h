// SPDX-License-Identifier: BSD-3-Clause
// Swept: points of a leaf of the scan against points of a leaf of the model, at all instants of an interval.

#if defined(PCL_BSH_TRAJECTORY_LEAF_SWEPT_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_LEAF_SWEPT_LEAF_INL_H_
#undef PCL_BSH_TRAJECTORY_LEAF_SWEPT_LEAF_INL_H_
#else
#define PCL_BSH_TRAJECTORY_LEAF_SWEPT_LEAF_INL_H_
#endif

#include <pcl_bsh/trajectory/boxes/model_boxes-inl.h>
#include <pcl_bsh/trajectory/leaf/leaf_visit-inl.h>
#include <pcl_bsh/trajectory/leaf/point_segment.h>
#include <pcl_bsh/trajectory/leaf/record_course.h>
#include <pcl_bsh/trajectory/voxel_results.h>

#include <optional>
#include <tuple>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

class SweptLeaf {
public:
  SweptLeaf(const TrajectoryQuery& query, const VoxelInModelFrame& voxel_frame, VoxelResults& results,
            ComparedPairs& compared)
  : query_(query),
    voxel_frame_(voxel_frame),
    results_(results),
    compared_(compared)
  {
  }

  /// Compares points, or triangles, that move in straight lines with those at rest, in double. The rounding is small
  /// against the tolerance (checkTolerance()). Floats tell first which of the pairs can change an answer.
  /// @param clipped during which part of the interval each may be near
  void compare(LeafVisit& leaf, std::uint32_t lanes, const ClippedSegments<kLeafPoints>& clipped, const ModelBox& box,
               const VoxelMotion& motion)
  {
    ++results_.work.leaf_pairs;
    const BoxLeaf other = box.points(query_.boxes);
    const double begin = motion.interval->first, steps = motion.interval->last - motion.interval->first;
    for (const std::uint32_t i : Bits(lanes)) {
      if (isSettled(leaf, i, begin + steps * clipped.from[i])) continue;
      if (other.is_part && compared_.add(other.record(0), 1u << i) == 0) continue;
      pass(leaf, i, other, box, motion);
      std::optional<PointSegment> segment;
      std::optional<RecordCourse> course; // where records are not points
      for (std::uint32_t left = mattering(leaf, i, passages_.near, motion); left != 0;) {
        const auto j = static_cast<std::uint32_t>(std::countr_zero(left));
        left &= left - 1;
        const PointPair pair{leaf.points.record(i), other.record(j)};
        if (query_.of_points && !segment) segment.emplace(query_, pair.a, *motion.interval);
        if (!query_.of_points && !course) course.emplace(query_, pair.a, *motion.interval);
        ++results_.work.exact_decisions;
        const double near_enough = query_.nearEnough(pair);
        if (near_enough < 0.0) continue;
        const Approach approach = segment ? segment->approachTo(query_, pair.b, near_enough)
                                          : course->approachTo(query_, pair.b, *motion.interval, near_enough,
                                                               query_.closest, earlyEnough(begin, steps));
        results_.work.node_pairs += approach.looks;
        if (!approach.contact) continue;
        if (query_.witness) return keepWitness(leaf, pair);
        keep(leaf, i, pair, approach, begin, steps);
        left = mattering(leaf, i, left, motion);
      }
      if (isSettled(leaf, i, begin)) leaf.open &= ~(1u << i);
      if (query_.closest && results_.bestBounds(leaf.points.begin + i, motion.interval->first))
        leaf.lowerReach(voxel_frame_, i, results_.best[leaf.points.begin + i].reach, motion);
    }
  }

private:
  /// Whether nothing that a point meets from this time on changes an answer.
  bool isSettled(const LeafVisit& leaf, std::uint32_t i, double from) const
  {
    return !query_.closest && !query_.witness && isHit(leaf, i) && results_.firstOf(leaf.points.begin + i) <= from;
  }

  /// Returns the part of an interval from which on any contact of a point is as good as its first.
  double earlyEnough(double begin, double steps) const
  {
    if (query_.witness) return 0.0;
    if (query_.request.first_poses || query_.closest) return 1.0;
    return (results_.earliest - begin) / steps + kDoubleMargin * (1.0 + begin / steps); // above what rounding takes
  }

  bool isHit(const LeafVisit& leaf, std::uint32_t i) const { return (results_.hit[leaf.slot] >> i & 1) != 0; }

  /// Computes how point i passes the points of the model's leaf, in floats. Where floats do not hold the lengths, all
  /// are near.
  void pass(const LeafVisit& leaf, std::uint32_t i, const BoxLeaf& other, const ModelBox& box,
            const VoxelMotion& motion)
  {
    if (!query_.of_points || !motion.squares || query_.boxes.unit(box.voxel) != 1.0) {
      passages_ = {firstBits(other.count), {}, {}};
      return;
    }
    passPoints(leaf.segments, i, other.x(), other.y(), other.z(), other.count, query_.boxes.shift(box.voxel).data(),
               roundUp(query_.reach) + astrayIn(motion), motion.smallest, motion.rounding, passages_);
  }

  /// How much farther apart a pair may be in floats than it is.
  float astrayIn(const VoxelMotion& motion) const
  {
    return (motion.reach - static_cast<float>(motion.stray) - static_cast<float>(query_.reach)) + motion.rounding;
  }

  /// Returns the bits of `points` of the model that can change an answer. While no contact of point i is known, these
  /// are all. Then they are the points that it may come near before its first contact, or as near as its nearest.
  std::uint32_t mattering(const LeafVisit& leaf, std::uint32_t i, std::uint32_t points, const VoxelMotion& motion) const
  {
    if (points == 0 || query_.witness || !isHit(leaf, i)) return points;
    const std::uint32_t point = leaf.points.begin + i;
    const double begin = motion.interval->first, steps = motion.interval->last - motion.interval->first;
    const auto part = steps > 0.0 ? roundUp((results_.firstOf(point) - begin) / steps) : 2.0f;
    const float farthest = query_.closest ? results_.best[point].reach + astrayIn(motion) : -1.0f;
    const float limit = query_.closest ? farthest * farthest * (1.0f + kRadiusMargin) : -1.0f;
    return passages_.before(points, part, limit);
  }

  /// Keeps a pair that comes near enough.
  void keep(const LeafVisit& leaf, std::uint32_t i, const PointPair& pair, const Approach& approach, double begin,
            double steps)
  {
    const std::uint32_t point = leaf.points.begin + i;
    results_.hit[leaf.slot] = static_cast<std::uint16_t>(results_.hit[leaf.slot] | 1u << i);
    double& first = results_.first[point];
    first = std::min(first, begin + steps * approach.enter);
    results_.earliest = std::min(results_.earliest, first);
    if (!query_.closest) return;
    const double radii = query_.scan.hierarchy().view().ownRadius(pair.a) + query_.model.view().ownRadius(pair.b);
    NearestPoint& best = results_.best[point];
    consider(best, approach.distance - radii, begin + steps * approach.at, pair.b);
    best.reach = std::min(best.reach, roundUp(std::max(0.0, best.gap)));
    best.meets = best.meets || (approach.meets && radii == 0.0);
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
  ComparedPairs& compared_;
  Passages<kLeafPoints> passages_{}; // of one point
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

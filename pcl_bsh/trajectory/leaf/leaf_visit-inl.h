// SPDX-License-Identifier: BSD-3-Clause
// A leaf of the scan during an interval, as the model sees it: its points on their arcs, the poses at which they are in
// a box, and the records that they were compared with.

#if defined(PCL_BSH_TRAJECTORY_LEAF_LEAF_VISIT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_LEAF_LEAF_VISIT_INL_H_
#undef PCL_BSH_TRAJECTORY_LEAF_LEAF_VISIT_INL_H_
#else
#define PCL_BSH_TRAJECTORY_LEAF_LEAF_VISIT_INL_H_
#endif

#include <pcl_bsh/trajectory/boxes/model_boxes-inl.h>
#include <pcl_bsh/trajectory/voxel_in_model_frame-inl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A leaf of the scan, its points on their arcs.
struct LeafVisit {
  LeafRange points;
  std::size_t slot;   ///< of its flags
  std::uint32_t open; ///< bits of the points that are not settled
  Segments<kLeafPoints> segments;
  Segment around;
  alignas(64) float near_squared[kLeafPoints]; ///< at one pose, nothing in a box at a larger squared distance matters
  alignas(64) float own[kLeafPoints] = {};     ///< radii of balls, or of the balls about triangles

  /// Sets the arcs of its points, and the segment around them. @param bound as LeafWalk::compare() has it
  void begin(const VoxelInModelFrame& voxel_frame, const VoxelMotion& motion, float bound)
  {
    alignas(64) float from[3][kLeafPoints], to[3][kLeafPoints], bow[3][kLeafPoints];
    see(motion.from, from);
    see(motion.to, to);
    see(motion.bow, bow);
    segments.set(from, to, bow, motion.smallest);
    std::fill(segments.reach[0], segments.reach[0] + kLeafPoints, motion.reach);
    std::fill(near_squared, near_squared + kLeafPoints, voxel_frame.nearSquared(motion, bound));
    alignas(64) float extent[3][kLeafPoints] = {};
    for (std::uint32_t i = 0; points.voxel->radii && i < points.count; ++i) {
      own[i] = roundUp(points.radius(i) * (1.0 + voxel_frame.path.skew) * (1.0 + kDoubleMargin));
      for (float(&along)[kLeafPoints] : extent) along[i] = own[i];
      segments.reach[0][i] = voxel_frame.reachOf(motion, motion.reach, own[i]);
      near_squared[i] = voxel_frame.nearSquared(motion, bound, own[i]);
    }
    around = voxel_frame.aroundSegments(motion, from, to, bow, extent, points.count);
  }

  /// From now on, records farther from a point than the best do not matter during the motion.
  void lowerReach(const VoxelInModelFrame& voxel_frame, std::uint32_t i, float best, const VoxelMotion& motion)
  {
    segments.reach[0][i] = std::min(segments.reach[0][i], voxel_frame.reachOf(motion, best, own[i]));
    if (motion.at_rest) near_squared[i] = std::min(near_squared[i], voxel_frame.nearSquared(motion, best, own[i]));
  }

  /// Returns bits of the points, seen at these places at one pose, to which a record in a box may matter.
  std::uint32_t nearBox(const float* x, const float* y, const float* z, const ModelBox& box) const
  {
    const BoxEnds ends(box);
    return pointsNearBox(x, y, z, kLeafPoints, ends.low, ends.high, near_squared);
  }

private:
  void see(const AffineMap& map, float (&at)[3][kLeafPoints]) const
  {
    carry(map.m, map.g, points.x(), points.y(), points.z(), points.count, at[0], at[1], at[2]);
    for (float* along : at) std::fill(along + points.count, along + kLeafPoints, 0.0f);
  }
};

/// The poses at which each of a leaf's points has to be looked at: first[i] to last[i], inclusive. All of these are in
/// [begin, end).
struct PoseRanges {
  std::uint32_t lanes = 0; ///< points that have such a pose
  std::uint32_t first[kLeafPoints], last[kLeafPoints];
  std::uint32_t begin = 0xffffffffu, end = 0;

  std::uint32_t at(std::uint32_t k, std::uint32_t among) const
  {
    std::uint32_t here = 0;
    for (const std::uint32_t i : Bits(among & lanes))
      if (first[i] <= k && k <= last[i]) here |= 1u << i;
    return here;
  }
};

/// Returns the ranges of points in `lanes`.
inline PoseRanges rangesOf(std::uint32_t lanes, const ClippedSegments<kLeafPoints>& clipped, const VoxelMotion& motion)
{
  PoseRanges ranges;
  const double steps = motion.interval->last - motion.interval->first;
  for (const std::uint32_t i : Bits(lanes)) {
    ranges.first[i] = motion.interval->first + static_cast<std::uint32_t>(std::ceil(steps * clipped.from[i]));
    ranges.last[i] = motion.interval->first + static_cast<std::uint32_t>(std::floor(steps * clipped.to[i]));
    if (ranges.first[i] > ranges.last[i]) continue;
    ranges.lanes |= 1u << i;
    ranges.begin = std::min(ranges.begin, ranges.first[i]);
    ranges.end = std::max(ranges.end, ranges.last[i] + 1);
  }
  return ranges;
}

/// Returns the ranges of points in `lanes` at one pose.
inline PoseRanges rangesAt(std::uint32_t lanes, const VoxelMotion& motion)
{
  PoseRanges ranges;
  ranges.lanes = lanes;
  std::fill(ranges.first, ranges.first + kLeafPoints, motion.interval->first);
  std::fill(ranges.last, ranges.last + kLeafPoints, motion.interval->first);
  ranges.begin = motion.interval->first;
  ranges.end = ranges.begin + 1;
  return ranges;
}

/// Remembers which points of a leaf were compared with which records of the model during a motion: further parts of the
/// same triangle hold nothing new for them. It may forget.
class ComparedPairs {
public:
  void clear()
  {
    if (is_used_) *this = ComparedPairs();
  }

  /// Notes points as compared with a record. @param points bits of the leaf's points. @return bits of the points that
  /// were not yet, as far as is remembered
  std::uint32_t add(std::uint32_t record, std::uint32_t points)
  {
    is_used_ = true;
    Entry& entry = entries_[record % entries_.size()];
    if (entry.record != record || entry.points == 0) entry = {record, 0};
    const std::uint32_t left = points & ~entry.points;
    entry.points |= points;
    return left;
  }

private:
  struct Entry {
    std::uint32_t record = 0, points = 0;
  };

  std::array<Entry, 64> entries_ = {};
  bool is_used_ = false;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

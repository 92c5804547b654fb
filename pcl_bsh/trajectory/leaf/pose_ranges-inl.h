// SPDX-License-Identifier: BSD-3-Clause
// From the parts of an interval in which points are in a box to the poses in it.

#if defined(PCL_BSH_TRAJECTORY_LEAF_POSE_RANGES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_LEAF_POSE_RANGES_INL_H_
#undef PCL_BSH_TRAJECTORY_LEAF_POSE_RANGES_INL_H_
#else
#define PCL_BSH_TRAJECTORY_LEAF_POSE_RANGES_INL_H_
#endif

#include <pcl_bsh/trajectory/voxel_in_model_frame-inl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// The poses at which each of a leaf's points has to be looked at: first..last, of all of them [begin, end).
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

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

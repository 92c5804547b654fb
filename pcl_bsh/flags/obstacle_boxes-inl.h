// SPDX-License-Identifier: BSD-3-Clause
// The voxels of b that a voxel of a can reach, as boxes: which of them a few points of a are near, all at once.

#if defined(PCL_BSH_FLAGS_OBSTACLE_BOXES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_FLAGS_OBSTACLE_BOXES_INL_H_
#undef PCL_BSH_FLAGS_OBSTACLE_BOXES_INL_H_
#else
#define PCL_BSH_FLAGS_OBSTACLE_BOXES_INL_H_
#endif

#include <pcl_bsh/flags/visit-inl.h>

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Takes a box to an obstacle's frame: the turned box is in the one that is returned.
inline QueryBox carryBox(const RelativeFrame& frame, const QueryBox& box)
{
  QueryBox carried{carryPoint(frame.m.data(), frame.g.data(), box.center), {}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float* row = frame.m.data() + 3 * axis;
    carried.half[axis] =
        (std::abs(row[0]) * box.half[0] + std::abs(row[1]) * box.half[1]) + std::abs(row[2]) * box.half[2];
  }
  return carried;
}

/// The first obstacles, as far as their frames are turned alike; the others count as near.
class ObstacleBoxes {
public:
  explicit ObstacleBoxes(const std::vector<ObstacleVoxel>& obstacles) : turned_(obstacles.front().frame)
  {
    turned_.g = {0.0f, 0.0f, 0.0f};
    for (const ObstacleVoxel& obstacle : obstacles) {
      if (count_ == kMost || obstacle.frame.m != turned_.m) break;
      const std::array<double, 3>& reach = obstacle.voxel->frame.reach;
      const double stretched = (reach[0] + reach[1] + reach[2]) * (static_cast<double>(obstacle.frame.stretch_b) - 1.0);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        shift_[axis][count_] = obstacle.frame.g[axis];
        half_[axis][count_] = roundUp(reach[axis] + stretched);
      }
      squared_reach_[count_] = obstacle.reach * obstacle.reach * (1.0f + kSphereMargin) + kVanishingSquare;
      ++count_;
    }
  }

  std::size_t count() const { return count_; }

  /// The obstacles that the box may be near, for isAmong(). @param box in the frame of a's voxel
  std::uint64_t near(const QueryBox& box) const
  {
    const QueryBox turned = carryBox(turned_, box);
    const float center[3] = {turned.center.x, turned.center.y, turned.center.z};
    const LaneTag d;
    const LaneVector more = hn::Set(d, 1.0f + kSphereMargin), less = hn::Set(d, 1.0f - kSphereMargin);
    std::uint64_t apart = 0;
    for (std::size_t k = 0; k < count_; k += hn::Lanes(d)) {
      LaneVector squared = hn::Zero(d);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const LaneVector away = hn::Abs(hn::Add(hn::Set(d, center[axis]), hn::Load(d, shift_[axis] + k)));
        const LaneVector within = hn::Add(hn::Set(d, turned.half[axis]), hn::Load(d, half_[axis] + k));
        const LaneVector gap = hn::Max(hn::Sub(hn::Mul(away, less), hn::Mul(within, more)), hn::Zero(d));
        squared = hn::Add(squared, hn::Mul(gap, gap));
      }
      const auto is_apart = hn::And(hn::FirstN(d, count_ - k), hn::Gt(squared, hn::Load(d, squared_reach_ + k)));
      apart |= std::uint64_t{bitsOf(d, is_apart)} << k;
    }
    return ~apart;
  }

  /// Whether near() has obstacle k.
  static bool isAmong(std::uint64_t near, std::size_t k) { return k >= kMost || (near >> k & 1) != 0; }

private:
  static constexpr std::size_t kMost = 64;

  std::size_t count_ = 0;
  RelativeFrame turned_; // from a's voxel, without a shift
  alignas(64) float shift_[3][kMost] = {};
  alignas(64) float half_[3][kMost] = {};
  alignas(64) float squared_reach_[kMost] = {};
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle

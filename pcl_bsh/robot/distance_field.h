// SPDX-License-Identifier: BSD-3-Clause
// How far the obstacles are from the middles of cubes, measured when first asked for: a gap changes by no more than the
// way does, so one bounds those of all places about it.
#pragma once

#include <pcl_bsh/query/result.h>
#include <pcl_bsh/robot/obstacle_gap.h>

#include <Eigen/Geometry>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

namespace pcl_bsh::robots {

/// A grid of cubes. Several threads may ask at once: what a cube has does not depend on who measures it.
class DistanceField {
public:
  /// @param half of the edge of all of it
  /// @param farthest gaps are told up to that
  DistanceField(const std::vector<Obstacle>& obstacles, const Eigen::Vector3d& middle, double half, std::size_t count,
                double farthest);

  /// Bounds of the least gap of a point, of all obstacles. Nothing is known outside of the grid.
  Interval gap(const Eigen::Vector3d& point) const
  {
    const Eigen::Vector3d place = (point - low_) * inverse_edge_;
    const double most = static_cast<double>(count_);
    if (!(place.minCoeff() >= 0.0 && place.maxCoeff() < most)) return {};
    const auto x = static_cast<std::size_t>(place.x()), y = static_cast<std::size_t>(place.y()),
               z = static_cast<std::size_t>(place.z());
    const Eigen::Vector3d middle =
        low_ + edge_ * Eigen::Vector3d(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5,
                                       static_cast<double>(z) + 0.5);
    Value& value = values_[(z * count_ + y) * count_ + x];
    float gap = value.load(std::memory_order_relaxed);
    if (gap == kUnknown) gap = measure(middle, value);
    const double way = (point - middle).norm() + rounding_, known = static_cast<double>(gap);
    return {known - way - kRounding * std::abs(known),
            known < farthest_ ? known + way + kRounding * std::abs(known) + spread_ : Interval().upper};
  }

private:
  using Value = std::atomic<float>;
  static_assert(sizeof(Value) == sizeof(float) && Value::is_always_lock_free);

  struct Free {
    void operator()(Value* values) const noexcept { std::free(values); }
  };

  static constexpr float kUnknown = 0.0f; ///< as memory comes: pages that nobody asks about are never touched
  static constexpr double kRounding = 0x1p-22;

  float measure(const Eigen::Vector3d& middle, Value& value) const;

  const std::vector<Obstacle>* obstacles_;
  std::size_t count_;
  double edge_, inverse_edge_, farthest_, rounding_;
  double spread_ = 0.0; ///< upper bounds are no more above lower ones, where places of points are uncertain
  Eigen::Vector3d low_;
  std::unique_ptr<Value[], Free> values_;
};

} // namespace pcl_bsh::robots

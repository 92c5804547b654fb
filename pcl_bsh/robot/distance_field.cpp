// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/robot/distance_field.h>

#include <algorithm>
#include <new>

namespace pcl_bsh::robots {

DistanceField::DistanceField(const std::vector<Obstacle>& obstacles, const Eigen::Vector3d& middle, double half,
                             std::size_t count, double farthest)
: obstacles_(&obstacles),
  count_(count),
  edge_(2.0 * half / static_cast<double>(count)),
  inverse_edge_(1.0 / edge_),
  farthest_(static_cast<double>(static_cast<float>(farthest) * (1.0f - 0x1p-20f))),
  rounding_(0x1p-50 * (middle.lpNorm<1>() + 4.0 * half)),
  low_(middle.array() - half),
  values_(static_cast<Value*>(std::calloc(count * count * count, sizeof(Value))))
{
  if (!values_) throw std::bad_alloc();
  for (const Obstacle& obstacle : obstacles) {
    const double uncertain = obstacle.mostUncertain();
    spread_ = std::max(spread_, 2.0 * uncertain);
    rounding_ += 0x1p-50 * obstacle.pose.translation.lpNorm<1>();
    // squared distances are rounded to floats
    rounding_ = std::max(rounding_, kRounding * (farthest + obstacle.hierarchy().storage().largest_radius + uncertain));
  }
}

float DistanceField::measure(const Eigen::Vector3d& middle, Value& value) const
{
  double gap = farthest_;
  for (const Obstacle& obstacle : *obstacles_) {
    gap = std::min(gap, obstacle.gap(middle, gap).lower);
  }
  const float kept = gap == 0.0 ? -0x1p-100f : static_cast<float>(gap);
  value.store(kept, std::memory_order_relaxed);
  return kept;
}

} // namespace pcl_bsh::robots

// SPDX-License-Identifier: BSD-3-Clause
// Which voxels of the scan may be near the model, and during which intervals of the path.
#include <pcl_bsh/trajectory/query.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

constexpr double kSmallestMotion = 0x1p-45; ///< of the margin: what moves less is at rest

} // namespace

bool TrajectoryQuery::near(const WorldSphere& sphere, const PathInterval& interval, double& stray) const
{
  double squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    squared += (sphere.center[axis] - interval.pivot[axis]) * (sphere.center[axis] - interval.pivot[axis]);
  stray = interval.drift + interval.turn * (std::sqrt(squared) * (1.0 + kDoubleMargin) + sphere.radius);
  const double margin = (reach + sphere.radius) * (1.0 + path.skew) + stray + error(sphere.center);
  const Point3 from = path.poses[interval.first].see(sphere.center), to = path.poses[interval.last].see(sphere.center);
  double enter = 0.0, leave = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double slack = margin + kDoubleMargin * (std::abs(from[axis]) + std::abs(to[axis]) + boxes.radius);
    const double low = boxes.low[axis] - slack - from[axis], high = boxes.high[axis] + slack - from[axis];
    const double motion = to[axis] - from[axis];
    if (std::abs(motion) <= kSmallestMotion * slack) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    enter = std::max(enter, std::min(low / motion, high / motion));
    leave = std::min(leave, std::max(low / motion, high / motion));
  }
  return !(enter > leave);
}

void TrajectoryQuery::collectNear(std::uint32_t node, std::uint32_t lane, std::uint32_t index, const StopRule& rule,
                                  Progress& progress, std::vector<NearVoxel>& near_voxels) const
{
  progress.tick(4);
  const SphereHierarchy::Storage& storage = scan.hierarchy().storage();
  const Node& of = storage.top[node];
  const bool is_voxel = of.isLeaf(lane);
  const LocalFrame& frame = is_voxel ? storage.voxels[of.begin[lane]].frame : storage.frame;
  Point3 center = frame.origin;
  if (!is_voxel) {
    const float at[3] = {of.x[lane], of.y[lane], of.z[lane]};
    for (std::size_t axis = 0; axis < 3; ++axis) center[axis] += at[axis] * frame.unit;
  }
  const double radius = (is_voxel ? storage.voxels[of.begin[lane]].radius : of.r[lane]) * frame.unit;
  const WorldSphere sphere{carried(scan.pose, center), radius * (1.0 + path.skew + kDoubleMargin)};
  const PathInterval& interval = path.intervals[index];
  double stray = 0.0;
  if (!rule.isOver()) {
    ++result.work.node_pairs;
    ++result.work.volumes_carried;
    if (!near(sphere, interval, stray)) return;
  }
  if (interval.divided() && stray > (is_voxel ? 0.5 : 1.0) * sphere.radius) {
    collectNear(node, lane, interval.left, rule, progress, near_voxels);
    collectNear(node, lane, interval.right, rule, progress, near_voxels);
  }
  else if (is_voxel) {
    near_voxels.push_back({of.begin[lane], index});
  }
  else {
    const std::uint32_t below = of.child[lane];
    for (std::uint32_t i = 0; i < storage.top[below].count; ++i)
      collectNear(below, i, index, rule, progress, near_voxels);
  }
}

std::vector<NearVoxel> TrajectoryQuery::nearVoxels(const StopRule& rule, Progress& progress) const
{
  const SphereHierarchy::Storage& storage = scan.hierarchy().storage();
  std::vector<NearVoxel> near_voxels;
  if (storage.size == 0 || boxes.storage.size == 0 || path.poses.empty()) return near_voxels;
  for (std::uint32_t lane = 0; lane < storage.top[0].count; ++lane) {
    collectNear(0, lane, 0, rule, progress, near_voxels);
    progress.skipTo(lane + 1);
  }
  std::stable_sort(near_voxels.begin(), near_voxels.end(),
                   [](const NearVoxel& one, const NearVoxel& other) { return one.voxel < other.voxel; });
  return near_voxels;
}

std::span<const NearVoxel> takeVoxel(std::span<const NearVoxel>& near_voxels)
{
  std::size_t count = 0;
  while (count < near_voxels.size() && near_voxels[count].voxel == near_voxels[0].voxel) ++count;
  const std::span<const NearVoxel> taken = near_voxels.first(count);
  near_voxels = near_voxels.subspan(count);
  return taken;
}

} // namespace pcl_bsh

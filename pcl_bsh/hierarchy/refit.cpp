// SPDX-License-Identifier: BSD-3-Clause
// Spheres follow points that move: every voxel keeps its points and its tree, its frame and spheres are measured anew.
#include <pcl_bsh/geometry/float_environment.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pcl_bsh {
namespace {

void requireFit(const PointsView& before, const PointsView& now, double most_growth)
{
  const auto refuse = [](const std::string& what) { throw std::invalid_argument("SphereHierarchy::refit: " + what); };
  if (!(std::isfinite(most_growth) && most_growth >= 1.0))
    refuse("growth " + std::to_string(most_growth) + " is not finite and >= 1");
  if (now.count != before.count || now.size() != before.size())
    refuse("the view has " + std::to_string(now.count) + " records instead of " + std::to_string(before.count));
  if (now.scalar != before.scalar) refuse("the view has coordinates of another type");
  if (now.count > 0 && !now.data) refuse("the view's data is null");
  if (!now.indices != !before.indices) refuse("the view is of another subset");
  if (now.indices && now.indices != before.indices &&
      !std::equal(now.indices, now.indices + now.index_count, before.indices))
    refuse("the view is of another subset");
  if (!now.radii != !before.radii) refuse("the view has radii and the one before none, or the other way round");
  for (std::size_t i = 0; now.radii && i < now.count; ++i)
    if (!(now.radii[i] >= 0.0f && now.radii[i] <= std::numeric_limits<float>::max()))
      refuse("radius " + std::to_string(now.radii[i]) + " of point " + std::to_string(i) + " is not finite and >= 0");
}

double sumOfLeafRadii(const Voxel& voxel)
{
  double sum = 0.0;
  for (const Node& node : voxel.nodes)
    for (std::uint32_t i = 0; i < node.count; ++i)
      if (node.isLeaf(i)) sum += static_cast<double>(node.r[i]) * voxel.frame.unit;
  return sum;
}

bool hasCoincidentLeaf(const Voxel& voxel)
{
  for (const Node& node : voxel.nodes)
    for (std::uint32_t i = 0; i < node.count; ++i)
      if (node.isLeaf(i) && node.isCoincident(i)) return true;
  return false;
}

/// Bounds of points, as given.
struct Range {
  std::array<double, 3> low, high;

  Range()
  {
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
  }

  void widen(const std::array<double, 3>& lowest, const std::array<double, 3>& highest)
  {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], lowest[k]);
      high[k] = std::max(high[k], highest[k]);
    }
  }
};

/// Where the voxel's points are now, in their order. @return false when one is not finite any more
bool reread(Voxel& voxel, const PointsView& view, std::vector<PointRecord>& points, Range& range)
{
  const bool built = voxel.state.load(std::memory_order_acquire) == Voxel::built;
  const auto* sorted = reinterpret_cast<const PointRecord*>(voxel.block);
  points.resize(voxel.count);
  for (std::uint32_t i = 0; i < voxel.count; ++i) {
    points[i].record = built ? voxel.records()[i] : sorted[i].record;
    const Point3 p = view.point(points[i].record);
    if (!isFinite(p)) return false;
    range.widen(p, p);
  }
  voxel.frame = frameBetween(range.low, range.high, view.scalar == Scalar::float32);
  for (PointRecord& point : points) point = storedIn(voxel.frame, view.point(point.record), point.record);
  return true;
}

std::size_t countFinite(const PointsView& view)
{
  std::size_t count = 0;
  for (std::size_t i = 0; i < view.size(); ++i) count += isFinite(view.point(view.record(i)));
  return count;
}

} // namespace

RefitReport SphereHierarchy::refit(const PointsView& now, double most_growth)
{
  requireFit(storage_->view, now, most_growth);
  const DefaultFloatEnvironment environment;
  RefitReport report;
  const auto sortAnew = [&] {
    storage_ = std::make_unique<Storage>(now, storage_->options);
    report.sorted_anew = true;
    report.voxels_refitted = report.voxels_dropped = 0;
    return report;
  };
  if (countFinite(now) != storage_->size) return sortAnew();
  Storage& s = *storage_;
  s.view = now;
  s.strayed = 0.0;
  Range all;
  std::vector<PointRecord> points;
  for (std::size_t v = 0; v < s.voxel_count; ++v) {
    Voxel& voxel = s.voxels[v];
    const bool built = voxel.state.load(std::memory_order_acquire) == Voxel::built;
    if (built && voxel.leaf_radii == 0.0) voxel.leaf_radii = sumOfLeafRadii(voxel);
    // The frame's unit may change: radii are compared in the cloud's.
    Range range;
    if (!reread(voxel, now, points, range)) return sortAnew();
    all.widen(range.low, range.high);
    s.strayed = std::max(s.strayed, s.strayOf(voxel.key, range.low, range.high));
    ++report.voxels_refitted;
    bool keep = built && voxel.given.empty() && !hasCoincidentLeaf(voxel); // points of one place may have parted
    if (keep) {
      refitVoxel(voxel, points.data(), now, s.options.fit);
      keep = sumOfLeafRadii(voxel) <= most_growth * voxel.leaf_radii;
    }
    if (!keep) {
      if (built) ++report.voxels_dropped;
      std::copy(points.begin(), points.end(), reinterpret_cast<PointRecord*>(voxel.block));
      voxel.nodes.clear();
      voxel.given.clear();
      voxel.leaf_radii = 0.0;
      voxel.state.store(Voxel::sorted, std::memory_order_release);
    }
    s.measure(voxel);
  }
  const double sum = s.sumOfRadii();
  report.looseness = s.extent > 0.0 ? sum / s.extent : 1.0;
  if (report.looseness > most_growth) return sortAnew();
  if (s.size > 0) s.frame = frameBetween(all.low, all.high, now.scalar == Scalar::float32);
  s.raiseTop();
  return report;
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// Spheres follow points that move: every voxel keeps its points and its tree, its frame and spheres are measured anew.
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/hierarchy/bounds.h>
#include <pcl_bsh/hierarchy/frame_between.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/view_check.h>

#include <algorithm>
#include <cmath>
#include <new>

namespace pcl_bsh {
namespace {

void requireFit(const PointsView& before, const PointsView& now, double most_growth)
{
  const std::string name = "SphereHierarchy::refit";
  const auto refuse = [&](const std::string& what, Input input = Input::points) {
    throw InvalidInput(input, name, what);
  };
  if (!(std::isfinite(most_growth) && most_growth >= 1.0))
    refuse("growth " + std::to_string(most_growth) + " is not finite and >= 1", Input::growth);
  if (now.count != before.count || now.size() != before.size())
    refuse("the view has " + counted(now.count, "record") + " instead of " + std::to_string(before.count));
  if (now.scalar != before.scalar) refuse("the view has coordinates of another type");
  if (!now.indices != !before.indices) refuse("the view is of another subset");
  if (now.indices && now.indices != before.indices &&
      !std::equal(now.indices, now.indices + now.index_count, before.indices))
    refuse("the view is of another subset");
  checkView(name, now);
  if (!now.radii != !before.radii) refuse("the view has radii and the one before none, or the other way round");
  checkLengths(name, now);
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

/// Where the voxel's points are now, and their largest radius. @return false when one is not finite any more
bool readBounds(const Voxel& voxel, const PointsView& view, Bounds& bounds, float& largest_radius)
{
  bool finite = true;
  voxel.forEachRecord([&](std::uint32_t record) {
    const Point3 p = view.point(record);
    finite = finite && isFinite(p);
    bounds.add(p);
    if (view.radii) largest_radius = std::max(largest_radius, view.radii[record]);
  });
  return finite;
}

/// Gives the voxel its points' new coordinates and its frame. Its tree follows where it can. It is built anew where
/// points of one place may have parted, where spheres have grown by more than `most_growth` on average, and where
/// memory is exhausted.
void follow(Voxel& voxel, const LocalFrame& frame, const PointsView& now, double most_growth, SphereFit fit,
            PointRecord* points, RefitReport& report) noexcept
{
  const bool built = voxel.state.load(std::memory_order_acquire) == Voxel::built;
  if (built && voxel.leaf_radii == 0.0) voxel.leaf_radii = sumOfLeafRadii(voxel);
  voxel.frame = frame; // its unit may be another: radii are compared in the cloud's
  bool keep = built && voxel.given.empty() && !hasCoincidentLeaf(voxel);
  if (!voxel.isListed())
    voxel.forEachRecord(
        [&, out = points](std::uint32_t record) mutable { *out++ = storedIn(frame, now.point(record), record); });
  if (keep) {
    try {
      refitVoxel(voxel, points, now, fit);
      keep = sumOfLeafRadii(voxel) <= most_growth * voxel.leaf_radii;
    }
    catch (const std::bad_alloc&) {
      keep = false;
    }
  }
  if (!keep && !voxel.isListed()) {
    std::copy_n(points, voxel.count, reinterpret_cast<PointRecord*>(voxel.block));
    voxel.nodes.clear();
    voxel.given.clear();
    voxel.leaf_radii = 0.0;
    voxel.state.store(Voxel::sorted, std::memory_order_release);
  }
  measureVoxel(voxel, now);
  report.voxels_dropped += built && !keep;
  report.volumes_refitted += 1 + countChildren(voxel.nodes);
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
    report.volumes_refitted = storage_->voxel_count + countChildren(storage_->top);
    return report;
  };
  Storage& s = *storage_;
  if (s.size < now.size() && countFinite(now) != s.size) return sortAnew();

  // Steps that may throw come first, and change nothing.
  std::vector<LocalFrame> frames(s.voxel_count);
  std::uint32_t most_points = 0;
  const float largest_of_all = largestRadiusOf(now);
  double sum = 0.0, strayed = 0.0;
  Bounds all;
  for (std::size_t v = 0; v < s.voxel_count; ++v) {
    Bounds bounds;
    float largest_radius = 0.0f;
    if (!readBounds(s.voxels[v], now, bounds, largest_radius)) return sortAnew();
    frames[v] = frameBetween(bounds.low, bounds.high, now.scalar == Scalar::float32, largest_radius);
    sum += static_cast<double>(radiusOf(frames[v], largest_radius)) * frames[v].unit;
    all.add(bounds.low, bounds.high);
    strayed = std::max(strayed, s.shiftOf(s.voxels[v].key, bounds.low, bounds.high));
    most_points = std::max(most_points, s.voxels[v].count);
  }
  report.looseness = s.extent > 0.0 ? sum / s.extent : 1.0;
  if (report.looseness > most_growth) return sortAnew();
  const LocalFrame frame =
      s.size > 0 ? frameBetween(all.low, all.high, now.scalar == Scalar::float32, largest_of_all) : LocalFrame();
  std::vector<PointRecord> points(most_points);
  const std::vector<Voxel*> voxels = s.list();

  [&]() noexcept { // the same voxels with the same keys: the tree above them needs no more memory than it has
    s.view = now;
    s.uncertainty = UncertaintyRange(now);
    s.strayed = strayed;
    for (std::size_t v = 0; v < s.voxel_count; ++v)
      follow(s.voxels[v], frames[v], now, most_growth, s.options.fit, points.data(), report);
    s.frame = frame;
    s.setTopTree(Storage::makeTopTree(voxels, frame, s.takeTopTree()));
  }();
  report.voxels_refitted = s.voxel_count;
  report.volumes_refitted += countChildren(s.top);
  return report;
}

} // namespace pcl_bsh

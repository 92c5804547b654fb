// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/build/morton.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace pcl_bsh {

SphereHierarchy::Storage::Storage(const PointsView& points, const HierarchyOptions& build_options)
: view(points),
  options(build_options),
  uncertainty(points)
{
  VoxelSorting sorting = sortIntoVoxels(view, options);
  voxel_edge = sorting.edge;
  base = sorting.base;
  size = sorting.size;
  voxel_count = sorting.voxel_count;
  voxels = std::move(sorting.voxels);
  buffers.push_back(std::move(sorting.buffer));
  lists = std::move(sorting.lists);
  list_words = sorting.list_words;
  frame = sorting.frame;
  if (size > 0 && view.radii) {
    radii_buffers.push_back(std::make_unique<float[]>(size));
    for (std::size_t v = 0; v < voxel_count; ++v) voxels[v].radii = radii_buffers.front().get() + voxels[v].begin;
  }
  for (std::size_t v = 0; v < voxel_count; ++v) measureVoxel(voxels[v], view);
  extent = sumOfRadii();
  setTopTree(makeTopTree(list(), frame, TopTree()));
}

void measureVoxel(Voxel& voxel, const PointsView& view)
{
  voxel.slabs.reset();
  voxel.cross_slabs.reset();
  voxel.own_uncertainties.reset();
  voxel.largest_radius = 0.0f;
  if (view.radii)
    voxel.forEachRecord(
        [&](std::uint32_t record) { voxel.largest_radius = std::max(voxel.largest_radius, view.radii[record]); });
  voxel.radius = radiusOf(voxel.frame, voxel.largest_radius);
}

float radiusOf(const LocalFrame& f, float largest_radius)
{
  const double ball = static_cast<double>(largest_radius) / f.unit;
  const double corner = std::hypot(f.reach[0] + f.slack(0), f.reach[1] + f.slack(1), f.reach[2] + f.slack(2));
  return roundUp((corner + ball) * (1.0 + kDoubleMargin));
}

std::uint64_t SphereHierarchy::Storage::nextRevision() noexcept
{
  static std::atomic<std::uint64_t> count{0};
  return count.fetch_add(1, std::memory_order_relaxed) + 1;
}

std::vector<Voxel*> SphereHierarchy::Storage::list() const
{
  std::vector<Voxel*> all(voxel_count);
  for (std::size_t v = 0; v < voxel_count; ++v) all[v] = &voxels[v];
  return all;
}

SphereHierarchy::Storage::TopTree SphereHierarchy::Storage::makeTopTree(const std::vector<Voxel*>& all,
                                                                        const LocalFrame& frame, TopTree reuse)
{
  TopTree above = std::move(reuse);
  above.largest_radius = 0.0;
  for (const Voxel* voxel : all)
    above.largest_radius = std::max(above.largest_radius, static_cast<double>(voxel->largest_radius));
  if (!all.empty()) above.top = buildTop(all, frame, std::move(above.top));
  above.slots.assign(std::bit_ceil(2 * all.size() + 1), kNoVoxel);
  for (std::uint32_t v = 0; v < all.size(); ++v) {
    std::size_t slot = slotOf(all[v]->key, above.slots.size());
    while (above.slots[slot] != kNoVoxel) slot = (slot + 1) & (above.slots.size() - 1);
    above.slots[slot] = v;
  }
  return above;
}

SphereHierarchy::Storage::GridPlace SphereHierarchy::Storage::find(const Point3& place) const noexcept
{
  const double inverse = 1.0 / voxel_edge;
  std::array<std::uint64_t, 3> cell;
  double margin = 1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double cells = place[k] * inverse - base[k];
    if (!(cells >= 0.0 && cells < 0x1p21)) return {kNoVoxel, -1.0};
    cell[k] = static_cast<std::uint64_t>(cells);
    const double past = cells - static_cast<double>(cell[k]);
    margin = std::min(margin, std::min(past, 1.0 - past) - kCellRounding * (cells + 2.0));
  }
  const std::uint64_t key = mortonCode(cell[0], cell[1], cell[2]);
  std::size_t slot = slotOf(key, slots_.size());
  while (slots_[slot] != kNoVoxel && voxels[slots_[slot]].key != key) slot = (slot + 1) & (slots_.size() - 1);
  return {slots_[slot], (margin - strayed) * voxel_edge * (1.0 - kDoubleMargin)};
}

double SphereHierarchy::Storage::shiftOf(std::uint64_t key, const std::array<double, 3>& low,
                                         const std::array<double, 3>& high) const noexcept
{
  const double inverse = 1.0 / voxel_edge;
  double stray = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto cell = static_cast<double>(gatherBits(key >> k));
    // Cell 0 reaches down without end: no other voxel is below it, and find() knows nothing there.
    const double below = cell > 0.0 ? cell - (low[k] * inverse - base[k]) : 0.0;
    const double above = high[k] * inverse - base[k] - (cell + 1.0);
    stray = std::max({stray, below, above});
  }
  // Each difference errs by 2^-53 of less than 2^22 cells and of what it comes to.
  constexpr double kCellNumberError = 0x1p-30;
  return stray > 0.0 ? stray * (1.0 + kFewDoubleRoundings) + kCellNumberError : 0.0;
}

double SphereHierarchy::Storage::sumOfRadii() const
{
  double sum = 0.0;
  for (std::size_t v = 0; v < voxel_count; ++v) sum += static_cast<double>(voxels[v].radius) * voxels[v].frame.unit;
  return sum;
}

bool SphereHierarchy::Storage::claim(Voxel& voxel)
{
  std::uint8_t state = Voxel::sorted;
  while (!voxel.state.compare_exchange_weak(state, Voxel::building, std::memory_order_acq_rel)) {
    if (state == Voxel::built) return false;
    if (state == Voxel::building) voxel.state.wait(Voxel::building, std::memory_order_acquire);
    state = Voxel::sorted;
  }
  return true;
}

void SphereHierarchy::Storage::release(Voxel& voxel, Voxel::State state)
{
  voxel.state.store(state, std::memory_order_release);
  voxel.state.notify_all();
}

Cube SphereHierarchy::Storage::cubeOf(std::uint64_t key) const noexcept
{
  Cube cube{{}, voxel_edge};
  for (std::size_t k = 0; k < 3; ++k) cube.low[k] = (base[k] + static_cast<double>(gatherBits(key >> k))) * voxel_edge;
  return cube;
}

void SphereHierarchy::Storage::build(std::size_t index, BuildWork& work) const
{
  Voxel& voxel = voxels[index];
  if (!claim(voxel)) return;
  const DefaultFloatEnvironment environment; // the caller's may be another
  try {
    buildVoxel(voxel, view, options, cubeOf(voxel.key));
  }
  catch (...) {
    release(voxel, Voxel::sorted);
    throw;
  }
  ++work.voxels_built;
  work.volumes_built += countChildren(voxel.nodes);
  release(voxel, Voxel::built);
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>

namespace pcl_bsh {

SphereHierarchy::Storage::Storage(const PointsView& points, const HierarchyOptions& build_options)
: view(points),
  options(build_options)
{
  VoxelSorting sorting = sortIntoVoxels(view, options);
  voxel_edge = sorting.edge;
  size = sorting.size;
  voxel_count = sorting.voxel_count;
  voxels = std::move(sorting.voxels);
  buffer_ = std::move(sorting.buffer);
  frame = sorting.frame;
  if (size == 0) return;

  std::vector<float> largest_radii;
  if (view.radii) {
    radii_ = std::make_unique<float[]>(size);
    for (std::size_t v = 0; v < voxel_count; ++v) {
      voxels[v].radii = radii_.get() + voxels[v].begin;
      const auto* sorted = reinterpret_cast<const PointRecord*>(voxels[v].block);
      float largest = 0.0f;
      for (std::uint32_t i = 0; i < voxels[v].count; ++i) largest = std::max(largest, view.radii[sorted[i].record]);
      largest_radii.push_back(largest);
      largest_radius = std::max(largest_radius, static_cast<double>(largest));
    }
  }
  for (std::size_t v = 0; v < voxel_count; ++v) {
    const LocalFrame& f = voxels[v].frame;
    const double ball = view.radii ? largest_radii[v] / f.unit : 0.0;
    const double corner = std::hypot(f.reach[0] + f.slack(0), f.reach[1] + f.slack(1), f.reach[2] + f.slack(2));
    voxels[v].radius = roundUp((corner + ball) * (1.0 + 0x1p-40));
  }
  top = buildTop(voxels.get(), voxel_count, frame, view.radii ? largest_radii.data() : nullptr);
}

void SphereHierarchy::Storage::build(std::size_t index, std::uint64_t& built_now) const
{
  Voxel& voxel = voxels[index];
  std::uint8_t state = Voxel::sorted;
  while (!voxel.state.compare_exchange_weak(state, Voxel::building, std::memory_order_acq_rel)) {
    if (state == Voxel::built) return;
    if (state == Voxel::building) voxel.state.wait(Voxel::building, std::memory_order_acquire);
    state = Voxel::sorted;
  }
  try {
    buildVoxel(voxel, view, options.fit);
  }
  catch (...) {
    voxel.state.store(Voxel::sorted, std::memory_order_release);
    voxel.state.notify_all();
    throw;
  }
  ++built_now;
  voxel.state.store(Voxel::built, std::memory_order_release);
  voxel.state.notify_all();
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/sampling/cell_grid.h>
#include <pcl_bsh/filters/pipeline/stages/sampling/record_mean.h>
#include <pcl_bsh/search/cloud_view.h>

#include <array>

namespace pcl_bsh::pipeline {
namespace {

/// As pcl::ApproximateVoxelGrid: points are gathered in a small table of cells, and a cell is written out when another
/// needs its place.
struct ApproximateVoxelGrid : Stage {
  Size3 leaf_size;
  bool downsample_all_data = true;

  StageCloudPtr run(StageClouds&& inputs) override
  {
    struct Slot {
      Cell cell{};
      std::vector<std::uint32_t> records;
    };
    std::array<Slot, 512> table; // as many as PCL has, or results would differ
    const StageCloud& input = *inputs[0];
    const PointsView points = viewOf(input.cloud);
    const CellGrid grid(points, leaf_size.xyz, "leaf_size");
    RecordMeans output(input, downsample_all_data);
    const auto flush = [&output](Slot& slot) {
      if (!slot.records.empty()) output.add(slot.records);
      slot.records.clear();
    };
    for (std::uint32_t i = 0; i < points.count; ++i) {
      const Point3 p = points.point(i);
      if (!isFinite(p)) continue;
      const Cell cell = grid.cellOf(p);
      Slot& slot = table[hashOf(cell) % table.size()];
      if (slot.cell != cell) flush(slot);
      slot.cell = cell;
      slot.records.push_back(i);
    }
    for (Slot& slot : table) flush(slot);
    return output.finished();
  }

private:
  static std::uint32_t hashOf(const Cell& cell)
  {
    const auto low = [](std::int64_t number) { return static_cast<std::uint32_t>(number); };
    return low(cell[0]) * 7171U + low(cell[1]) * 3079U + low(cell[2]) * 4231U;
  }
};

} // namespace

StageType approximateVoxelGrid()
{
  return describe<ApproximateVoxelGrid>(
             "filters.approximate_voxel_grid",
             "As filters.voxel_grid in one pass, with a table of 512 cubes: a cube whose points are far apart in the "
             "file may give several.")
      .alias("pcl::ApproximateVoxelGrid")
      .option(&ApproximateVoxelGrid::leaf_size, "leaf_size", "edge of the cubes")
      .unit("m")
      .above(0)
      .required()
      .option(&ApproximateVoxelGrid::downsample_all_data, "downsample_all_data",
              "true: all fields are averaged (integers: the most frequent value); false: only x y z, the other fields "
              "are one point's");
}

} // namespace pcl_bsh::pipeline

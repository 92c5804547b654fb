// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/sampling/cell_grid.h>
#include <pcl_bsh/filters/pipeline/stages/sampling/record_mean.h>
#include <pcl_bsh/search/cloud_view.h>

namespace pcl_bsh::pipeline {
namespace {

struct VoxelGrid : Stage {
  Size3 leaf_size;
  bool downsample_all_data = true;
  unsigned minimum_points_number_per_voxel = 0;

  StageCloudPtr run(StageClouds&& inputs) override
  {
    const StageCloud& input = *inputs[0];
    const PointsView points = viewOf(input.cloud);
    const SortedCells cells(points, CellGrid(points, leaf_size.xyz, "leaf_size"));
    RecordMeans output(input, downsample_all_data);
    output.reserve(cells.count());
    cells.forEach([&](const std::vector<std::uint32_t>& records) {
      if (records.size() >= minimum_points_number_per_voxel) output.add(records);
    });
    return output.finished();
  }
};

} // namespace

StageType voxelGrid()
{
  return describe<VoxelGrid>(
             "filters.voxel_grid",
             "Replaces the points in each cube of a grid by their mean. Cells have 64-bit numbers, so that none are "
             "confused in large scenes; float64 coordinates keep their digits.")
      .alias("pcl::VoxelGrid")
      .option(&VoxelGrid::leaf_size, "leaf_size", "edge of the cubes")
      .unit("m")
      .above(0)
      .required()
      .option(&VoxelGrid::downsample_all_data, "downsample_all_data",
              "true: all fields are averaged (integers: the most frequent value); false: only x y z, the other fields "
              "are one point's")
      .option(&VoxelGrid::minimum_points_number_per_voxel, "minimum_points_number_per_voxel",
              "least number of points in a cube; cubes with fewer give no point");
}

} // namespace pcl_bsh::pipeline

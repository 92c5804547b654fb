// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/built_in.h>
#include <pcl_bsh/filters/pipeline/stages/sampling/cell_grid.h>
#include <pcl_bsh/filters/pipeline/stages/selection/selecting_stage.h>
#include <pcl_bsh/search/cloud_view.h>

#include <limits>

namespace pcl_bsh::pipeline {
namespace {

/// As pcl::UniformSampling, whose 32-bit numbers of cells overflow in large scenes, so that it drops points.
struct UniformSampling : SelectingStage {
  double radius_search = 0;

protected:
  std::vector<std::uint8_t> passing(const StageCloudPtr& cloud) override
  {
    const PointsView points = viewOf(cloud->cloud);
    std::vector<std::uint8_t> passes(points.count, 0);
    const CellGrid grid(points, {radius_search, radius_search, radius_search}, "radius_search");
    SortedCells(points, grid).forEach([&](const std::vector<std::uint32_t>& records) {
      passes[nearestToCentre(points, grid, records)] = 1;
    });
    return passes;
  }

private:
  static std::uint32_t nearestToCentre(const PointsView& points, const CellGrid& grid,
                                       const std::vector<std::uint32_t>& records)
  {
    const Point3 centre = grid.centreOf(grid.cellOf(points.point(records[0])));
    double least = std::numeric_limits<double>::infinity();
    std::uint32_t nearest = records[0];
    for (const std::uint32_t i : records) {
      const Point3 p = points.point(i);
      double squared = 0;
      for (std::size_t k = 0; k < 3; ++k) squared += (p[k] - centre[k]) * (p[k] - centre[k]);
      if (squared >= least) continue;
      least = squared;
      nearest = i;
    }
    return nearest;
  }
};

} // namespace

StageType uniformSampling()
{
  auto description = describe<UniformSampling>("filters.uniform_sampling",
                                               "Keeps, of the points in each cube of a grid, the one nearest to the "
                                               "cube's centre, as it is.")
                         .alias("pcl::UniformSampling")
                         .option(&UniformSampling::radius_search, "radius_search", "edge of the cubes")
                         .unit("m")
                         .above(0)
                         .required();
  return withSelectionOptions(description);
}

} // namespace pcl_bsh::pipeline

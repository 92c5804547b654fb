// SPDX-License-Identifier: BSD-3-Clause
#include "loading.h"
#include "surface_input.h"
#include <pcl_bsh/tools/cli/step.h>

#include <pcl_bsh/filters/uncertainty.h>
#include <pcl_bsh/geometry/counted.h>
#include <pcl_bsh/search/cloud_view.h>

#include <string>
#include <utility>

namespace pcl_bsh::cli {

Scan loadInput(const CollideOptions& options, double& seconds)
{
  Step step("Loading " + options.input.string());
  Scan scan;
  const io::ColumnNames columns = options.columns.of(options.input);
  io::Mesh mesh = io::readMesh(options.input, options.surface, &scan.facts, columns, options.threads);
  scan.cloud = std::move(mesh.vertices);
  scan.triangles = std::move(mesh.triangles);
  const std::string triangles = scan.triangles.empty() ? "" : ", " + counted(scan.triangles.size(), "triangle");
  seconds += step.done(counted(std::size_t{scan.cloud.width} * scan.cloud.height, "point") + triangles);
  return scan;
}

std::shared_ptr<const SurfaceCover> coverOf(const CollideOptions& options, const Scan& input, double& seconds,
                                            std::vector<std::string>& warnings)
{
  if (input.triangles.empty()) return nullptr;
  requireForSurface(options);
  Step step("Covering " + options.input.string());
  auto cover = std::make_shared<const SurfaceCover>(coverInput(
      options.input, viewOf(input.cloud), input.triangles, options.surface, options.clearance,
      [&](double fraction) {
        step.share(fraction);
        return true;
      },
      warnings));
  seconds += step.done(counted(cover->centers.size(), "ball"));
  return cover;
}

SphereHierarchy build(const PointsView& points, const std::vector<pcl::PCLPointField>& fields,
                      const std::filesystem::path& path, const Uncertainty& uncertainty, unsigned threads,
                      double& seconds)
{
  const PointsView view = withUncertainty(points, fields, path.string(), uncertainty);
  Step step("Sorting " + path.string() + " into voxels");
  HierarchyOptions options;
  options.threads = threads;
  SphereHierarchy hierarchy(view, options);
  seconds += step.done(counted(hierarchy.statistics().voxels, "voxel"));
  return hierarchy;
}

} // namespace pcl_bsh::cli

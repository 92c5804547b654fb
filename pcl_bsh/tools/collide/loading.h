// SPDX-License-Identifier: BSD-3-Clause
// The clouds and surfaces of a question, and their hierarchies. Each step adds its seconds.
#pragma once

#include "options.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>

#include <memory>
#include <vector>

namespace pcl_bsh::cli {

struct Scan {
  pcl::PCLPointCloud2 cloud;
  std::vector<Triangle> triangles; ///< where the input has faces: these are asked about
  io::CloudFacts facts;            ///< of the input's file
};

/// @throws files::FileError
Scan loadInput(const CollideOptions& options, double& seconds);

/// The balls of the input's surface; none where it is points.
/// @param warnings what users should know of the cover is appended, a line each
/// @throws std::invalid_argument, files::FileError as requireForSurface() and coverInput() do
std::shared_ptr<const SurfaceCover> coverOf(const CollideOptions& options, const Scan& input, double& seconds,
                                            std::vector<std::string>& warnings);

/// @throws InvalidInput as withUncertainty() does
SphereHierarchy build(const PointsView& points, const std::vector<pcl::PCLPointField>& fields,
                      const std::filesystem::path& path, const Uncertainty& uncertainty, unsigned threads,
                      double& seconds);

} // namespace pcl_bsh::cli

// SPDX-License-Identifier: BSD-3-Clause
// From files to the two things of a question, and back. Each step adds its seconds.
#pragma once

#include "options.h"

#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/trajectory/trajectory.h>

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

/// The input's points, or its triangles.
/// @param warnings what users should know of a surface is appended, a line each
/// @throws std::invalid_argument, files::FileError where the options ask what is told of points alone, where a surface
///   cannot be covered, or the output cannot hold it
Shape shapeOf(const CollideOptions& options, const Scan& input, double& seconds, std::vector<std::string>& warnings);

/// @throws InvalidInput as Shape::hierarchy() does
const SphereHierarchy& build(Shape& shape, const Uncertainty& uncertainty, unsigned threads, double& seconds);

/// The mesh with what was found as properties of its faces, or the triangles that are kept.
/// @return how many triangles were written
std::size_t writeSurface(const CollideOptions& options, const Scan& input, const TrajectoryResult& found);

} // namespace pcl_bsh::cli

// SPDX-License-Identifier: BSD-3-Clause
// Loads the input, builds hierarchies, and writes an input that is a surface. Each step adds its seconds.
#pragma once

#include "collide_options.h"

#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/question/ask.h>

#include <memory>
#include <vector>

namespace pcl_bsh::cli {

struct Scan {
  io::Obstacle shape;   ///< its points, or, where the input has faces, its triangles
  io::CloudFacts facts; ///< of the input's file

  const pcl::PCLPointCloud2& cloud() const { return shape.points(); }
};

/// @throws files::FileError; std::invalid_argument where the input is a surface and the options ask what is told of
///   points alone, or the output cannot hold it
Scan loadInput(const CollideOptions& options, double& seconds);

/// Builds a shape's hierarchy, as a step of the program. @throws InvalidInput as Shape::hierarchy() does
const SphereHierarchy& build(Shape& shape, const Uncertainty& uncertainty, unsigned threads, double& seconds);

/// The mesh with what was found as properties of its faces, or the triangles that are kept.
/// @return how many triangles were written
std::size_t writeSurface(const CollideOptions& options, const Scan& input, const Answer& answer);

} // namespace pcl_bsh::cli

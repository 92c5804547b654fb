// SPDX-License-Identifier: BSD-3-Clause
// Points on simple surfaces, for scenes that need no scan.
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace pcl_bsh::io {

/// x y z of points about `spacing` apart on the surface of a "sphere" (radius size.x), "box" (edges size) or "cylinder"
/// (radius size.x, height size.y, along z; with size.z > 0 without its lids) around the origin.
std::vector<float> shapePoints(const std::string& shape, const Eigen::Vector3d& size, double spacing);

/// How many that are, at most.
double shapePointCount(const std::string& shape, const Eigen::Vector3d& size, double spacing);

} // namespace pcl_bsh::io

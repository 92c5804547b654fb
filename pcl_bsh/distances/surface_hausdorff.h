// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/distances/point_distances.h>

namespace pcl_bsh {

/// The Hausdorff distance where one of the clouds is of triangles, or both are.
/// @pre neither is empty; the accuracy does not stop early; in the DefaultFloatEnvironment
HausdorffDistance surfaceHausdorff(const Placed& a, const Placed& b, const Effort& effort);

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// The ball that holds pieces of a surface, its centre on them: so it reaches beyond the surface by its radius and no
// further.
#pragma once

#include <pcl_bsh/surface/mesh.h>

#include <vector>

namespace pcl_bsh::surface {

/// Sets all of a patch but its pieces. The centre is the point of the pieces that is nearest to the centre of
/// their smallest enclosing ball. Of one convex piece, that ball's radius is not exceeded: no point of a convex set is
/// farther from where a centre is projected to than from the centre.
void fitBall(const std::vector<Vector3d>& corners, Patch& patch);

} // namespace pcl_bsh::surface

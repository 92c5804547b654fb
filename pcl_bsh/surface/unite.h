// SPDX-License-Identifier: BSD-3-Clause
// Fewer balls: patches that one ball can hold become one.
#pragma once

#include <pcl_bsh/surface/mesh.h>

#include <vector>

namespace pcl_bsh::surface {

/// Unites fitted patches of the borders of charts while a ball in the mesh's room holds both, the smallest first, each
/// with what fills the room best.
void unite(const Mesh& mesh, const std::vector<Vector3d>& corners, std::vector<Patch>& patches);

} // namespace pcl_bsh::surface

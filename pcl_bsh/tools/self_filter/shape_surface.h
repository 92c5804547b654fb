// SPDX-License-Identifier: BSD-3-Clause
// The surface of a body as triangles.
#pragma once

#include "read_surface.h"
#include "robot.h"

namespace pcl_bsh::self_filter {

/// In the link's frame. What is round is a polyhedron within it.
/// @param sagitta how far that may be from what is round, m; > 0
/// @pre requireSize() of what is no mesh
/// @throws files::FileError for a mesh that cannot be read or has no faces; std::runtime_error for a size that is too
///   large for the sagitta
Surface surfaceOf(const Shape& shape, double sagitta);

} // namespace pcl_bsh::self_filter

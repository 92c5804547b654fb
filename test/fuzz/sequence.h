// SPDX-License-Identifier: BSD-3-Clause
// Not one call after another, but states: clouds are built, moved, refitted, updated and asked, in any order.
#pragma once

#include "bytes.h"

#include <cstddef>

namespace pcl_bsh::fuzz {

/// Carries out the sequence of operations that the bytes choose; after each, some queries of some clouds, and all
/// scenes, are compared with brute force.
/// @param surfaces most clouds are of triangles
/// @return how many operations that were
/// @throws Finding what differs, after which operations
std::size_t runSequence(Bytes& bytes, bool surfaces = false);

} // namespace pcl_bsh::fuzz

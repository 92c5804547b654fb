// SPDX-License-Identifier: BSD-3-Clause
// Distances of every record, and what closed triangles enclose, against brute force.
#pragma once

#include "support/random.h"

#include <pcl_bsh/query/placed.h>

namespace pcl_bsh::fuzz {

/// From a to b, with limits and accuracies, and both ways. @throws Finding
void askDistances(const Placed& a, const Placed& b, double unit, test::Random& random);

/// Where b is of triangles: which close and which do not, what of a these enclose, at one pose and along a path, and
/// what a question about a solid obstacle answers. @throws Finding
void askSolid(const Placed& a, const Placed& b, double unit, test::Random& random);

} // namespace pcl_bsh::fuzz

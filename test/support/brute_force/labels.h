// SPDX-License-Identifier: BSD-3-Clause
// The oracle of labels: every point against every triangle, in exact arithmetic.
#pragma once

#include <pcl_bsh/solid/labels.h>

namespace pcl_bsh::brute_force {

/// Same contract as its namesake in solid/labels.h. Work counts one exact decision per pair looked at.
LabelsResult labelPoints(const Placed& cloud, const PlacedSolid& solid);

} // namespace pcl_bsh::brute_force

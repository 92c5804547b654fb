// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/seen/unseen_points.h>

namespace pcl_bsh::brute_force {

/// The oracle: each ball against each beam and each cell of directions. Quadratic.
/// @param angle as SeenOptions has it, of all scans
UnseenResult markUnseen(const std::vector<ScanBeams>& scans, double angle, const Placed& model,
                        const UnseenRequest& request, std::vector<Verdict>& verdicts);

} // namespace pcl_bsh::brute_force

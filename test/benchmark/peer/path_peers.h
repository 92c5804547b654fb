// SPDX-License-Identifier: BSD-3-Clause
// Plain code without this project: flags along a path by loops and a k-d tree.
#pragma once

#include "../workload/points.h"

#include <vector>

namespace pcl_bsh::bench {

struct PathFlags {
  std::vector<std::uint8_t> flags; ///< per scan point: within the distance of the model at any of the poses asked
  double build_seconds = 0.0;
  double query_seconds = 0.0;
};

/// The scan's points sorted into cells of 1 m. At each pose, the points of the cells near the model's box are brought
/// into its frame and tested against the box, inflated by d. Points inside that are not yet flagged ask a k-d tree
/// (nanoflann) over the model whether anything is within d.
PathFlags flagsByBoxes(const Points& scan, const Points& model, const std::vector<RigidPose>& poses, double d);

/// The published way (Schauer & Nuechter 2015), with nanoflann's k-d tree over the scan: every point of the model at
/// every `stride`-th pose flags all scan points within d of it.
PathFlags flagsByModelPoints(const Points& scan, const Points& model, const std::vector<RigidPose>& poses, double d,
                             std::size_t stride);

} // namespace pcl_bsh::bench

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/trajectory/trajectory.h>

namespace pcl_bsh::python {

/// A result, and what was asked for.
struct TrajectoryRun {
  TrajectoryRequest request;
  TrajectoryResult result;
};

} // namespace pcl_bsh::python

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/query/request_check.h>

namespace pcl_bsh {

/// @throws InvalidInput naming the value: a max_distance that is negative or NaN, an accuracy or a pose
inline void check(const Placed& a, const Placed& b, const PointDistancesRequest& request)
{
  checkMaxDistance(request.max_distance);
  checkAccuracy(request.accuracy);
  checkPose("pose of a", a.pose);
  checkPose("pose of b", b.pose);
}

} // namespace pcl_bsh

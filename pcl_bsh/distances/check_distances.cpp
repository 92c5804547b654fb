// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/distances/check_distances.h>

#include <pcl_bsh/query/request_check.h>

namespace pcl_bsh {

void check(const Placed& a, const Placed& b, const PointDistancesRequest& request)
{
  checkMaxDistance(request.max_distance);
  checkAccuracy(request.accuracy);
  checkPose("pose of a", a.pose);
  checkPose("pose of b", b.pose);
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/collision/check_request.h>

#include <pcl_bsh/query/request_check.h>

namespace pcl_bsh {

void check(const Placed& a, const Placed& b, const CollisionRequest& request)
{
  checkClearance(request.clearance);
  checkAccuracy(request.accuracy);
  checkPose("pose of a", a.pose);
  checkPose("pose of b", b.pose);
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/pairs/check_request.h>

#include <pcl_bsh/query/request_check.h>

namespace pcl_bsh {

void check(const Placed& a, const Placed& b, const AnyRequest& request)
{
  checkClearance(request.clearance);
  checkAccuracy(request.accuracy);
  checkPoses(a.pose, b.pose);
}

void check(const Placed& a, const Placed& b, const DistanceRequest& request)
{
  checkMaxDistance(request.max_distance);
  checkAccuracy(request.accuracy);
  checkPoses(a.pose, b.pose);
}

void check(const Placed& a, const Placed& b, const ContactsRequest& request)
{
  checkClearance(request.clearance);
  checkExact(request);
  checkPoses(a.pose, b.pose);
}

} // namespace pcl_bsh

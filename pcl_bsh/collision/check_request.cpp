// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/collision/check_request.h>

#include <pcl_bsh/query/request_check.h>

namespace pcl_bsh {
namespace {

void checkPoses(const Placed& a, const Placed& b)
{
  checkPose("pose of a", a.pose);
  checkPose("pose of b", b.pose);
}

} // namespace

void check(const Placed& a, const Placed& b, const AnyRequest& request)
{
  checkClearance(request.clearance);
  checkAccuracy(request.accuracy);
  checkPoses(a, b);
}

void check(const Placed& a, const Placed& b, const FlagsRequest& request)
{
  checkClearance(request.clearance);
  checkAccuracy(request.accuracy);
  checkPoses(a, b);
}

void check(const Placed& a, const Placed& b, const DistanceRequest& request)
{
  checkAccuracy(request.accuracy);
  checkPoses(a, b);
}

void check(const Placed& a, const Placed& b, const ContactsRequest& request)
{
  checkClearance(request.clearance);
  checkPoses(a, b);
}

} // namespace pcl_bsh

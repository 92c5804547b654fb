// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/collision/check_request.h>

#include <pcl_bsh/geometry/invalid_input.h>
#include <pcl_bsh/geometry/plain_text.h>
#include <pcl_bsh/query/request_check.h>

#include <cmath>

namespace pcl_bsh {
namespace {

void checkPoses(const Placed& a, const Placed& b)
{
  checkPose("pose of a", a.pose);
  checkPose("pose of b", b.pose);
}

void checkSpacings(const float* spacings, std::size_t count)
{
  for (std::size_t i = 0; spacings && i < count; ++i)
    if (!(std::isfinite(spacings[i]) && spacings[i] >= 0.0f))
      throw InvalidInput(Input::density, "density guard", plainText("spacing ", spacings[i], " of point ", i),
                         "give finite lengths >= 0")
          .withValue(static_cast<double>(spacings[i]))
          .withIndex(i);
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
  checkSpacings(request.spacings_of_b, b.hierarchy().view().count);
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

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/distances/check_distances.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/query/request_check.h>

namespace pcl_bsh {

void check(const Placed& a, const Placed& b, const PointDistancesRequest& request)
{
  if (!(request.max_distance >= 0.0)) {
    throw InvalidInput(Input::max_distance, "max_distance", plainText(request.max_distance),
                       "give a length >= 0, or infinity")
        .withValue(request.max_distance);
  }
  checkAccuracy(request.accuracy);
  checkPose("pose of a", a.pose);
  checkPose("pose of b", b.pose);
}

} // namespace pcl_bsh

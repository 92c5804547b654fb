// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/query/request_check.h>

#include <cmath>

namespace pcl_bsh {

inline void checkSpacings(const float* spacings, std::size_t count)
{
  for (std::size_t i = 0; spacings && i < count; ++i)
    if (!(std::isfinite(spacings[i]) && spacings[i] >= 0.0f))
      throw InvalidInput(Input::density, "density guard", plainText("spacing ", spacings[i], " of point ", i),
                         "give finite lengths >= 0")
          .withValue(static_cast<double>(spacings[i]))
          .withIndex(i);
}

/// Every query of flags calls this before anything else, whatever it computes.
/// @throws InvalidInput naming the value: a clearance or an accuracy that is negative or not finite; a spacing that is;
///   poses that checkPoses() refuses
inline void check(const Placed& a, const Placed& b, const FlagsRequest& request)
{
  checkClearance(request.clearance);
  checkAccuracy(request.accuracy);
  checkPoses(a.pose, b.pose);
  if (request.spacings_of_b && b.hierarchy().view().triangles)
    throw InvalidInput(Input::density, "density guard", "b is of triangles, which have no holes between them",
                       "give spacings of points alone");
  checkSpacings(request.spacings_of_b, b.hierarchy().view().count);
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// A ball that holds a box, for algorithms that take balls only.
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl_bsh {

struct BoxBall {
  Point3 center;
  double radius; ///< rounded up
};

/// @pre low <= high
inline BoxBall ballAboutBox(const Point3& low, const Point3& high)
{
  BoxBall ball;
  double square = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    ball.center[k] = 0.5 * low[k] + 0.5 * high[k];
    const double half = std::max(high[k] - ball.center[k], ball.center[k] - low[k]); // the centre is rounded
    square += half * half;
  }
  ball.radius = std::sqrt(square) * (1.0 + 0x1p-40);
  return ball;
}

} // namespace pcl_bsh

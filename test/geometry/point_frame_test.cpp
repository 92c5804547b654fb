// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/point_frame.h>

#include <pcl_bsh/geometry/exact_distance.h>

#include "support/random.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pcl_bsh {
namespace {

float squaredFloat(const std::array<float, 3>& x, const std::array<float, 3>& y)
{
  const float a = x[0] - y[0], b = x[1] - y[1], c = x[2] - y[2];
  return a * a + b * b + c * c;
}

/// The band's verdicts hold for stored points, judged exactly; most radii are ties.
TEST(PointFrame, BandHoldsForStoredPoints)
{
  test::Random random(2);
  const ExactDistance distance(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity());
  int decided = 0;
  for (int i = 0; i < 20000; ++i) {
    LocalFrame frame;
    const double far = std::ldexp(1.0, random.integer(-5, 22));
    for (std::size_t k = 0; k < 3; ++k) {
      frame.origin[k] = far * random.uniform(-1, 1);
      frame.reach[k] = 1.0 + 0x1p-20;
    }
    const Point3 p = random.point([&] { return random.uniform(-1, 1); });
    Point3 given, query;
    std::array<float, 3> stored;
    for (std::size_t k = 0; k < 3; ++k) {
      given[k] = frame.origin[k] + 0.999 * p[k];
      stored[k] = roundToFloat(given[k] - frame.origin[k]);
      query[k] = given[k] + random.uniform(-1, 1);
    }
    const double length =
        distance.gap({given, query}) * (random.chance(0.5) ? 1.0 : 1.0 + 1e-6 * random.uniform(-1, 1));
    const PointFrame local(frame, query);
    const DistanceBand band = local.band(length);
    const float squared = squaredFloat(stored, local.at);
    const bool within = distance.compare(given, query, length) <= 0;
    EXPECT_FALSE(squared <= band.hit && !within);
    EXPECT_FALSE(squared > band.miss && within);
    decided += squared <= band.hit || squared > band.miss;
    EXPECT_FALSE(within && local.separates(frame, length));
  }
  EXPECT_GT(decided, 2000) << "a band that never decides is no use";
}

TEST(PointFrame, OutOfRangeDecidesNothing)
{
  LocalFrame frame;
  frame.reach = {1, 1, 1};
  const PointFrame local(frame, {1e30, 0, 0});
  EXPECT_FALSE(local.inRange());
  EXPECT_LT(local.band(1.0).hit, 0.0f);
  EXPECT_FALSE(local.separates(frame, 1.0));
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// The reaches of uncertain children and points are on the safe side by what rounding takes, wherever their terms
// cancel.
#include <pcl_bsh/traversal/uncertain_reach.h>

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "test/flags/uncertain_lanes_test.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/flags/uncertain-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

using Real = long double;

/// Reaches of any size beside each other, the zero included: where nothing but one term is left to be rounded.
inline UncertainReach anyReach(test::Random& random)
{
  const double least = random.uniform(-1, 1), most = least + random.uniform(0, 1);
  const double of_b = random.chance(0.5) ? 0.0 : random.uniform(0, 1), error = random.chance(0.5) ? 0.0 : 1e-4;
  return {error, random.chance(0.5) ? 0.0 : 2e-6, std::exp2(random.integer(-2, 2)), least, most, of_b, 1e9f};
}

inline float anyLength(test::Random& random)
{
  return random.chance(0.3) ? 0.0f : static_cast<float>(random.uniform(0, 1) * std::exp2(random.integer(-6, 0)));
}

/// The name of a bound that is on the wrong side, or farther off than rounding takes.
inline const char* wrongLanes(test::Random& random)
{
  const UncertainReach reach = anyReach(random);
  UncertaintyLanes own;
  alignas(32) float r[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) {
    r[i] = anyLength(random);
    own.least[i] = anyLength(random);
    own.most[i] = own.least[i] + anyLength(random);
  }
  UncertainLanes lanes;
  lanes.may_be_sure = lanes.may_be_possible = 1u << random.integer(0, 7); // of another visit
  lanes.set(reach, r, own);
  for (std::size_t i = 0; i < kLanes; ++i) {
    const Real least = Real{own.least[i]} * reach.scale_down, most = Real{own.most[i]} * reach.scale_up, radius = r[i];
    const Real off = 1e-6L * (radius + most + reach.magnitude);
    const auto isBelow = [off](float bound, Real value) { return bound <= value && bound >= value - off; };
    const auto isAbove = [off](float bound, Real value) { return bound >= value && bound <= value + off; };
    if (!isBelow(lanes.sure[i], reach.sure - radius - most)) return "sure";
    if (!isBelow(lanes.maybe[i], reach.maybe - radius + least)) return "maybe";
    if (!isAbove(lanes.sure_near[i], reach.sure_near + radius - least)) return "sure_near";
    if (!isAbove(lanes.near[i], reach.near + radius + most)) return "near";
    if ((lanes.may_be_sure >> i & 1) != (lanes.sure[i] > 0.0f ? 1u : 0u)) return "may_be_sure";
    if ((lanes.may_be_possible >> i & 1) != (lanes.maybe[i] + reach.most_of_b > 0.0f ? 1u : 0u))
      return "may_be_possible";
  }
  return "";
}

/// Errors of nearestWithLengths(), too: 23 u of the terms, of which sums here take four at most.
inline const char* wrongPoints(test::Random& random)
{
  const UncertainReach reach = anyReach(random);
  alignas(64) float own[kLeafPoints];
  for (float& length : own) length = anyLength(random);
  const UncertainPoints points(reach, own);
  for (std::size_t i = 0; i < kLeafPoints; ++i) {
    const Real least = Real{own[i]} * reach.scale_down, most = Real{own[i]} * reach.scale_up;
    const Real size = most + reach.magnitude, room = 23 * kFloatUnit * size, off = 4e-6L * size;
    const auto isBelow = [&](float bound, Real value) { return bound <= value - room && bound >= value - off; };
    const auto isAbove = [&](float bound, Real value) { return bound >= value + room && bound <= value + off; };
    if (!isBelow(points.sure[i], reach.sure - most)) return "sure";
    if (!isBelow(points.maybe[i], reach.maybe + least)) return "maybe";
    if (!isAbove(points.sure_miss[i], reach.sure_miss - least)) return "sure_miss";
    if (!isAbove(points.miss[i], reach.miss + most)) return "miss";
  }
  return "";
}

void wrongOnTarget(const char** lanes, const char** points)
{
  test::Random random(1);
  for (int i = 0; i < 3000 && **lanes == 0 && **points == 0; ++i) {
    *lanes = wrongLanes(random);
    *points = wrongPoints(random);
  }
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {
namespace {

HWY_EXPORT(wrongOnTarget);

TEST(UncertainReaches, OfChildrenAndPointsHoldAndAreTight)
{
  const char *lanes = "", *points = "";
  HWY_DYNAMIC_DISPATCH(wrongOnTarget)(&lanes, &points);
  EXPECT_STREQ(lanes, "");
  EXPECT_STREQ(points, "");
}

} // namespace
} // namespace pcl_bsh
#endif

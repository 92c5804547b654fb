// SPDX-License-Identifier: BSD-3-Clause
// The reaches of uncertain points between two voxels are on the safe side, and no farther there than rounding takes.
#include <pcl_bsh/traversal/uncertain_reach.h>

#include "support/random.h"

#include <gtest/gtest.h>

namespace pcl_bsh {
namespace {

TEST(UncertainReach, BoundsOnTheSafeSideAndTightly)
{
  test::Random random(1);
  constexpr double skews[] = {0.0, 3e-7, 2e-6};
  for (int i = 0; i < 3000; ++i) {
    double unit = std::exp2(random.integer(-20, 20)) * random.uniform(1, 2), skew = random.pick(skews);
    if (random.chance(0.3)) { // just beside the inverse of a float
      unit = std::nextafter(1.0 / static_cast<float>(unit), random.chance(0.5) ? 0.0 : 1e9);
      skew = 0.0;
    }
    const double least = random.uniform(-1, 2) * unit, most = least + random.uniform(0, 2) * unit;
    const double of_b = random.chance(0.5) ? 0.0 : random.uniform(0, 0.5) * unit, error = random.uniform(0, 1e-3);
    const UncertainReach reach(error, skew, unit, least, most, of_b, 1e9f);

    const long double wide = skew, in_b = 1.0L / unit; // 11 bits more than the double arithmetic that is tested
    const auto shorter = [&](long double d) { return d * in_b * (d < 0 ? 1 + wide : 1 - wide) - error; };
    const auto longer = [&](long double d) { return d * in_b * (d < 0 ? 1 - wide : 1 + wide) + error; };
    const long double blur = of_b * in_b * 2 * wide; // of b's own lengths, carried with the skew
    const long double size = std::max(std::abs(least), most) * in_b + of_b * in_b + error;
    const auto atMost = [&](float bound, long double value, const char* what) {
      EXPECT_LE(bound, value) << what;
      EXPECT_GE(bound, value - 1e-6L * size) << what;
    };
    const auto atLeast = [&](float bound, long double value, const char* what) {
      EXPECT_GE(bound, value) << what;
      EXPECT_LE(bound, value + 1e-6L * size) << what;
    };
    atMost(reach.sure, shorter(least), "sure");
    atMost(reach.maybe, shorter(most) - blur, "maybe");
    atLeast(reach.sure_near, longer(least), "sure_near");
    atLeast(reach.near, longer(most), "near");
    atLeast(reach.miss, longer(most), "miss");
    atLeast(reach.sure_miss, longer(least) + blur, "sure_miss");
    atLeast(reach.most_of_b, of_b * in_b, "most_of_b");
    atLeast(reach.magnitude, size + blur, "magnitude");
    EXPECT_GE(reach.scale_up * unit, 1 + wide);
    EXPECT_LE(reach.scale_up * unit, (1 + wide) * (1 + 2e-7L));
    EXPECT_LE(reach.scale_down * unit, 1 - wide);
    EXPECT_GE(reach.scale_down * unit, (1 - wide) * (1 - 2e-7L));
    ASSERT_FALSE(HasFailure()) << "instance " << i << ", skew " << skew;
  }
}

/// Digits that a sum in double drops are on the safe side, too: lengths that are floats, and an error below their last
/// bits.
TEST(UncertainReach, HasRoomForWhatSumsDrop)
{
  constexpr double error = 0x1p-60;
  for (const float length : {1.0f, 1.25f, 3.0f}) {
    const UncertainReach reach(error, 0.0, 1.0, length, length, 0.0, 1e9f);
    EXPECT_LT(reach.sure, length);
    EXPECT_LT(reach.maybe, length);
    EXPECT_GT(reach.sure_near, length);
    EXPECT_GT(reach.near, length);
    EXPECT_GT(reach.sure_miss, length);
    EXPECT_GT(reach.miss, length);
  }
}

/// Then pairs are decided one by one, and spheres by what is given for them.
TEST(UncertainReach, KnowsNothingBeyondTheRangeOfFloat)
{
  static constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto expectNothing = [](const UncertainReach& reach) {
    EXPECT_EQ(reach.sure, -infinity);
    EXPECT_EQ(reach.maybe, -infinity);
    EXPECT_EQ(reach.sure_near, 3.0f);
    EXPECT_EQ(reach.near, 3.0f);
    EXPECT_EQ(reach.miss, infinity);
    EXPECT_EQ(reach.sure_miss, infinity);
  };
  expectNothing({infinity, 0.0, 1.0, 0.1, 0.2, 0.0, 3.0f});
  expectNothing({1e-3, 0.0, 1e-300, 0.1, 0.2, 0.0, 3.0f});
  expectNothing({1e-3, 0.0, 1e300, 0.1, 0.2, 0.0, 3.0f});
  expectNothing({1e-3, 0.0, 1.0, -1e300, 0.2, 0.0, 3.0f});
  expectNothing({1e-3, 0.0, 1.0, 0.1, 1e300, 0.0, 3.0f});
  expectNothing({1e-3, 0.0, 1.0, 0.1, 0.2, 1e300, 3.0f});
}

} // namespace
} // namespace pcl_bsh

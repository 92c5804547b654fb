// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/upward_ray.h>

#include "support/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

constexpr float kMost = std::numeric_limits<float>::max(), kInfinity = std::numeric_limits<float>::infinity();

/// As the declaration says, in double.
bool mayMeet(const Point3& at, double error, const FloatBox& box)
{
  for (std::size_t k = 0; k < 3; ++k) {
    if (at[k] - error > box.high[k]) return false;
    if (k < 2 && at[k] + error < box.low[k]) return false;
  }
  return true;
}

TEST(UpwardRay, MissesNoBoxThatItMayMeet)
{
  int missed = 0, missable = 0, below = 0;
  for (std::uint64_t seed = 0; seed < 200000; ++seed) {
    test::Random random(seed);
    const double scale = random.pick({1e-44, 1e-39, 1e-3, 1.0, 1e5, 1e37});
    const double error = scale * random.pick({0.0, 1e-9, 1e-6, 0.3});
    Point3 at;
    FloatBox box;
    for (std::size_t k = 0; k < 3; ++k) {
      const double middle = scale * random.uniform(-1, 1), half = scale * random.pick({0.0, 1e-7, 0.1, 1.0});
      box.low[k] = static_cast<float>(middle - half), box.high[k] = static_cast<float>(middle + half);
      const double side = random.pick({box.low[k] - error, box.high[k] + error, middle}); // or beside it, hardly
      at[k] = random.pick({side, std::nextafter(side, -kInfinity), std::nextafter(side, kInfinity), side + 1e-6 * scale,
                           side - 1e-6 * scale});
    }
    const UpwardRay ray(at, error);
    ASSERT_FALSE(mayMeet(at, error, box) && ray.misses(box)) << seed;
    if (!mayMeet(at, error + 3e-7 * scale + 1e-44, box)) ++missable, missed += ray.misses(box);
    ASSERT_FALSE(ray.beginsBelow(box) && at[2] + error >= box.low[2]) << seed;
    below += ray.beginsBelow(box);
  }
  EXPECT_EQ(missed, missable);
  EXPECT_GT(missed, 20000);
  EXPECT_GT(below, 1000);
}

/// One side of six at a time.
TEST(UpwardRay, MissesWhatIsBesideItOrBelow)
{
  const UpwardRay ray({0, 0, 0}, 0.25);
  const FloatBox about = {{-1, -1, -1}, {1, 1, 1}};
  EXPECT_FALSE(ray.misses(about));
  EXPECT_FALSE(ray.beginsBelow(about));
  const auto withSide = [&](bool high, std::size_t k, float x) {
    FloatBox box = about;
    (high ? box.high : box.low)[k] = x;
    return box;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_FALSE(ray.misses(withSide(false, k, 0.2f)));
    EXPECT_EQ(ray.misses(withSide(false, k, 0.3f)), k < 2);
    EXPECT_FALSE(ray.misses(withSide(true, k, -0.2f)));
    EXPECT_TRUE(ray.misses(withSide(true, k, -0.3f)));
    EXPECT_EQ(ray.beginsBelow(withSide(false, k, 0.3f)), k == 2);
    EXPECT_FALSE(ray.beginsBelow(withSide(false, k, 0.2f)));
  }
}

/// Places beyond all floats, and boxes that reach there.
TEST(UpwardRay, HasNoRangeOfFloats)
{
  const FloatBox all = {{-kMost, -kMost, -kMost}, {kMost, kMost, kMost}};
  const FloatBox rounded = {{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}};
  EXPECT_FALSE(UpwardRay({0, 0, 0}, 1e300).misses(all));
  for (std::size_t k = 0; k < 3; ++k)
    for (const double x : {-1e39, 1e39}) {
      Point3 at = {0, 0, 0};
      at[k] = x;
      EXPECT_EQ(UpwardRay(at, 0).misses(all), k < 2 || x > 0);
      EXPECT_FALSE(UpwardRay(at, 0).misses(rounded));
      EXPECT_FALSE(UpwardRay(at, 0).beginsBelow(rounded));
    }
}

} // namespace
} // namespace pcl_bsh

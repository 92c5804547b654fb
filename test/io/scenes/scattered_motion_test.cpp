// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/scenes/scattered_motion.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace pcl_bsh::io {
namespace {

using Place = Eigen::Vector3d;

const ScatterBox kBox{{-1, 2, 3}, {1, 5, 3.5}, 2.0, 10.0};

/// The way of one object, checked: straight and at one speed between its poses, within the box, reflected by its sides.
void expectReflected(const WaypointMotion& motion, const ScatterBox& box)
{
  ASSERT_EQ(motion.times.size(), motion.poses.size());
  ASSERT_GE(motion.times.size(), 2u);
  EXPECT_EQ(motion.times.front(), 0);
  EXPECT_EQ(motion.times.back(), box.duration);
  Place before = Place::Zero();
  for (std::size_t i = 0; i < motion.times.size(); ++i) {
    const Place at = motion.poses[i].translation();
    EXPECT_TRUE((at.array() >= box.low.array()).all() && (at.array() <= box.high.array()).all()) << at.transpose();
    EXPECT_TRUE(motion.poses[i].linear().isIdentity(0));
    if (i == 0) continue;
    const double time = motion.times[i] - motion.times[i - 1];
    ASSERT_GT(time, 0);
    const Place velocity = (at - motion.poses[i - 1].translation()) / time;
    int reflected = 0;
    for (int k = 0; k < 3; ++k) {
      const double tolerance = 1e-9 + 1e-12 / time;
      EXPECT_LE(std::abs(velocity[k]), box.speed + tolerance);
      if (i == 1) continue;
      EXPECT_NEAR(std::abs(velocity[k]), std::abs(before[k]), tolerance);
      if (velocity[k] * before[k] >= 0) continue;
      ++reflected;
      const double place = motion.poses[i - 1].translation()[k];
      EXPECT_NEAR(place, before[k] > 0 ? box.high[k] : box.low[k], 1e-14) << "by the side that it came to";
    }
    if (i > 1) {
      EXPECT_EQ(reflected, 1);
    }
    before = velocity;
  }
}

TEST(ScatteredMotions, AreReflectedByTheSides)
{
  ScatteredMotions motions(kBox, 1);
  std::size_t left = 100000, reflections = 0;
  for (int i = 0; i < 200; ++i) {
    const auto motion = motions.next(left);
    ASSERT_TRUE(motion);
    expectReflected(*motion, kBox);
    reflections += motion->times.size() - 2;
  }
  EXPECT_EQ(left, 100000 - reflections);
  EXPECT_GT(reflections, 200u);
}

/// As often on one side of the middle as on the other, along each axis; so with velocities.
TEST(ScatteredMotions, BeginAnywhere)
{
  ScatterBox box = kBox;
  box.duration = 1e-3;
  ScatteredMotions motions(box, 2);
  std::size_t left = 100000;
  Place sum = Place::Zero(), least = box.high, greatest = box.low, way = Place::Zero(), most = Place::Zero();
  constexpr int count = 2000;
  for (int i = 0; i < count; ++i) {
    const auto motion = motions.next(left);
    ASSERT_TRUE(motion);
    const Place at = motion->poses[0].translation();
    const Place velocity = (motion->poses[1].translation() - at) / motion->times[1];
    sum += at;
    least = least.cwiseMin(at), greatest = greatest.cwiseMax(at);
    way += velocity;
    most = most.cwiseMax(velocity.cwiseAbs());
  }
  const Place side = box.high - box.low;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(sum[k] / count, 0.5 * (box.low[k] + box.high[k]), 0.03 * side[k]);
    EXPECT_LT(least[k], box.low[k] + 0.01 * side[k]);
    EXPECT_GT(greatest[k], box.high[k] - 0.01 * side[k]);
    EXPECT_NEAR(way[k] / count, 0, 0.1);
    EXPECT_GT(most[k], 1.98);
  }
}

TEST(ScatteredMotions, AreThoseOfTheirSeed)
{
  std::size_t left = 100000;
  ScatteredMotions motions(kBox, 7), same(kBox, 7), others(kBox, 8);
  for (int i = 0; i < 3; ++i) {
    const Place at = motions.next(left)->poses[0].translation();
    EXPECT_EQ(at, same.next(left)->poses[0].translation());
    EXPECT_NE(at, others.next(left)->poses[0].translation());
  }
}

/// The numbers of the C++ standard's engine, six each: a scene is equal with any library and compiler.
TEST(ScatteredMotions, AreTheSameEverywhere)
{
  ScatteredMotions motions(kBox, 5);
  std::mt19937_64 engine(5);
  const auto uniform = [&] { return std::ldexp(static_cast<double>(engine() >> 11), -53); };
  std::size_t left = 100000;
  for (int i = 0; i < 20; ++i) {
    const WaypointMotion motion = *motions.next(left);
    const Place way = motion.poses[1].translation() - motion.poses[0].translation();
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(motion.poses[0].translation()[k], kBox.low[k] + uniform() * (kBox.high[k] - kBox.low[k]));
      EXPECT_NEAR(way[k] / motion.times[1], kBox.speed * (2.0 * uniform() - 1.0), 1e-9 + 1e-12 / motion.times[1]);
    }
  }
}

TEST(ScatteredMotions, OfSpeedZeroStay)
{
  ScatterBox box = kBox;
  box.speed = 0;
  std::size_t left = 0;
  const auto motion = ScatteredMotions(box, 1).next(left);
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->times, std::vector<double>{0});
}

/// Not even one reflection more than are left.
TEST(ScatteredMotions, StopWhereNoReflectionIsLeft)
{
  std::size_t left = 1000;
  ASSERT_TRUE(ScatteredMotions(kBox, 3).next(left));
  std::size_t needed = 1000 - left;
  ASSERT_GT(needed, 0u);
  left = needed;
  EXPECT_TRUE(ScatteredMotions(kBox, 3).next(left));
  EXPECT_EQ(left, 0u);
  --needed;
  EXPECT_FALSE(ScatteredMotions(kBox, 3).next(needed));
}

/// A speed so small that velocities are 0: there is no way to any side.
TEST(ScatteredMotions, OfHardlyAnySpeedStay)
{
  ScatterBox box = kBox;
  box.speed = std::numeric_limits<double>::denorm_min();
  std::size_t left = 0;
  ScatteredMotions motions(box, 1);
  for (int i = 0; i < 10; ++i) {
    const auto motion = motions.next(left);
    ASSERT_TRUE(motion);
    EXPECT_EQ(motion->times, (std::vector<double>{0, box.duration}));
    EXPECT_EQ(motion->poses[0].translation(), motion->poses[1].translation());
  }
}

/// Sides that touch would reflect without end.
TEST(ScatteredMotions, StayBetweenSidesThatTouch)
{
  ScatterBox box = kBox;
  box.low.z() = box.high.z();
  std::size_t left = 1;
  const auto motion = ScatteredMotions(box, 4).next(left);
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->times, (std::vector<double>{0, box.duration}));
  EXPECT_EQ(motion->poses[0].translation(), motion->poses[1].translation());
}

} // namespace
} // namespace pcl_bsh::io

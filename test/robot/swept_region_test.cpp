// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/robot/swept_region.h>

#include "made_arms.h"
#include "support/refusal.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace pcl_bsh {
namespace {

using namespace robots;

/// All points that are near enough are kept, in their order, and none that is farther than a cube's diagonal beyond.
TEST(SweptRegion, KeepsWhatIsNear)
{
  test::Random random(1);
  for (int round = 0; round < 20; ++round) {
    std::vector<SweptBall> balls;
    for (int i = 0; i < 10; ++i) balls.push_back({test::madeVector(random, 0.5), random.uniform(0.01, 0.3)});
    const Eigen::Isometry3d pose = test::madePose(random, round % 2 == 0 ? 1.0 : 100.0);
    const double margin = random.uniform(0.0, 0.1), edge = 2 * (0.5 + 0.3 + 0.1) * 1.8 / 40;
    std::vector<double> xyz;
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d p = pose.inverse() * test::madeVector(random, 1.2);
      xyz.insert(xyz.end(), p.data(), p.data() + 3);
    }
    const PointsView view = viewOf(xyz.data(), 3000);
    std::vector<std::int32_t> records;
    SweptRegion(balls, margin, pose).recordsInside(view, records);
    EXPECT_TRUE(std::is_sorted(records.begin(), records.end()));
    std::size_t kept = 0;
    for (std::uint32_t i = 0; i < 3000; ++i) {
      const Point3 p = view.point(i);
      double gap = std::numeric_limits<double>::infinity();
      for (const SweptBall& ball : balls)
        gap = std::min(gap, (pose * Eigen::Vector3d(p[0], p[1], p[2]) - ball.center).norm() - ball.radius);
      const bool is_kept = std::binary_search(records.begin(), records.end(), static_cast<std::int32_t>(i));
      kept += is_kept ? 1 : 0;
      if (gap <= margin) {
        ASSERT_TRUE(is_kept);
      }
      if (gap > margin + std::sqrt(3.0) * edge + 0.01) {
        ASSERT_FALSE(is_kept);
      }
    }
    EXPECT_EQ(kept, records.size());
  }
}

TEST(SweptRegion, LeavesOutWhatIsNoPlace)
{
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const std::vector<float> xyz = {0, 0, 0, 0.1f, 0, 0, nan, 0, 0, inf, 0, 0, 0, -inf, 0, 0, 0.1f, 0};
  PointsView view = viewOf(xyz.data(), 6);
  const SweptRegion region({{Eigen::Vector3d::Zero(), 1.0}}, 0.0, Eigen::Isometry3d::Identity());
  std::vector<std::int32_t> records;
  region.recordsInside(view, records);
  EXPECT_EQ(records, (std::vector<std::int32_t>{1, 5}));
  const std::vector<std::int32_t> some = {5, 0};
  view.restrictTo(some.data(), some.size());
  region.recordsInside(view, records);
  EXPECT_EQ(records, (std::vector<std::int32_t>{5}));
  SweptRegion({}, 0.0, Eigen::Isometry3d::Identity()).recordsInside(view, records);
  EXPECT_TRUE(records.empty());
  EXPECT_THAT(test::refusalOf([] { SweptRegion({}, -1.0, Eigen::Isometry3d::Identity()); }),
              testing::HasSubstr("margin: is -1"));
  Eigen::Isometry3d bent = Eigen::Isometry3d::Identity();
  bent.linear() *= 1.1;
  EXPECT_THAT(test::refusalOf([&] { SweptRegion({}, 0.0, bent); }), testing::HasSubstr("T_world_cloud"));
}

} // namespace
} // namespace pcl_bsh

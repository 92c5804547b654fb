// SPDX-License-Identifier: BSD-3-Clause
// The filter where what nobody saw is not free, and where poses are uncertain.
#include <pcl_bsh/filters/collision_filter.h>

#include "support/made_scans.h"
#include "support/verdicts.h"

#include <pcl/point_types.h>

#include <gmock/gmock.h>

#include <stdexcept>

namespace pcl_bsh {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Beams around (0, 0, 1) in a room, a pillar to the right; and points before and behind it.
class SeenFilter : public testing::Test {
protected:
  SeenFilter()
  {
    test::MadeRoom room{{Eigen::Vector3d(-5, -5, 0), Eigen::Vector3d(5, 5, 3)}, {}};
    room.boxes.emplace_back(Eigen::Vector3d(2, -0.5, 0), Eigen::Vector3d(2.5, 0.5, 3));
    test::Random random(1);
    const std::vector<double> ends = test::makeScan(room, {{0, 0, 1}, 0.03, -1.57, 1.57}, random).returns;
    for (std::size_t i = 0; i < ends.size(); i += 3)
      scan_->emplace_back(static_cast<float>(ends[i]), static_cast<float>(ends[i + 1]),
                          static_cast<float>(ends[i + 2]));
    machine_->emplace_back(1.0f, 0.0f, 1.0f);
    machine_->emplace_back(3.5f, 0.0f, 1.0f);
    filter_.setInputCloud(scan_);
    filter_.setObstacleCloud(machine_);
    filter_.setClearance(0.1);
  }

  Cloud::Ptr scan_{new Cloud}, machine_{new Cloud};
  CollisionFilter<pcl::PointXYZ> filter_;
  std::vector<Verdict> flags_;
};

TEST_F(SeenFilter, TellsWhatOfTheObstacleIsUnseen)
{
  filter_.setSeenOnly(true);
  EXPECT_THAT([&] { filter_.computeFlags(flags_); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("does not say where its scanner stood")));
  filter_.setScanOrigins(ScanOrigins::of({0, 0, 1}));
  filter_.computeFlags(flags_);
  EXPECT_EQ(filter_.getUnseen().count, 1u);
  EXPECT_EQ(filter_.getObstacleFlags(), test::verdictsOf({0, 4}));
  EXPECT_THAT(flags_, testing::Each(Verdict::free)) << "of the input: nothing collides";
  filter_.setSeenOnly(false); // the origin waits
  filter_.computeFlags(flags_);
  EXPECT_EQ(filter_.getUnseen().count, 0u);
  EXPECT_TRUE(filter_.getObstacleFlags().empty());
}

TEST_F(SeenFilter, TakesOriginsByAFieldOfThePoints)
{
  const auto numbered = std::make_shared<pcl::PointCloud<pcl::PointXYZI>>();
  for (const pcl::PointXYZ& p : *scan_) {
    numbered->emplace_back(p.x, p.y, p.z);
    numbered->back().intensity = 1.0f;
  }
  CollisionFilter<pcl::PointXYZI> filter;
  filter.setInputCloud(numbered);
  filter.setObstacleCloud(machine_);
  filter.setClearance(0.1);
  filter.setSeenOnly(true);
  filter.setScanOrigins(ScanOrigins::parse("intensity:1=0,0,1"));
  filter.computeFlags(flags_);
  EXPECT_EQ(filter.getObstacleFlags(), test::verdictsOf({0, 4}));
}

TEST_F(SeenFilter, AsksWithTheAngleThatIsGiven)
{
  filter_.setSeenAngle(0.02);
  EXPECT_EQ(filter_.getQuestion().seen_angle, 0.02);
  filter_.setSeenAngle(0.0); // measured
  EXPECT_FALSE(filter_.getQuestion().seen_angle);
}

TEST_F(SeenFilter, TakesPosesAsUncertainAsTheyAre)
{
  const Eigen::Isometry3d pose(Eigen::Translation3d(0.8, 0, 0)); // 0.2 before the pillar
  filter_.setPose(pose);
  filter_.computeFlags(flags_);
  EXPECT_EQ(filter_.getUndecidedCount(), 0u);
  filter_.setPoseUncertainty({0.15, 0.0, {0, 0, 0}});
  filter_.computeFlags(flags_);
  EXPECT_GT(filter_.getUndecidedCount(), 0u);
}

} // namespace
} // namespace pcl_bsh

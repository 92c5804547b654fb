// SPDX-License-Identifier: BSD-3-Clause
// A point type of the user's own, as PCL's tutorial has it: PCL_NO_PRECOMPILE before the first PCL header.
#define PCL_NO_PRECOMPILE
#include <pcl_bsh/filters/collision_filter.h>

#include "clouds.h"

#include <pcl/point_types.h>
#include <pcl/register_point_struct.h>

#include <gtest/gtest.h>

#ifdef __clang__
#pragma clang diagnostic ignored "-Wgnu-anonymous-struct" // of PCL's macro
#pragma clang diagnostic ignored "-Wnested-anon-types"
#endif
struct EIGEN_ALIGN16 PointFromDrone {
  double time;
  std::uint16_t ring;
  PCL_ADD_POINT4D;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

POINT_CLOUD_REGISTER_POINT_STRUCT(PointFromDrone, (double, time, time)(std::uint16_t, ring,
                                                                       ring)(float, x, x)(float, y, y)(float, z, z))

namespace pcl_bsh {
namespace {

using namespace test;

class CollisionFilterCustomPoint : public testing::Test {
protected:
  CollisionFilterCustomPoint()
  {
    for (std::size_t i = 0; i < input_->size(); ++i) (*input_)[i].ring = static_cast<std::uint16_t>(i);
    filter_.setInputCloud(input_);
    filter_.setObstacleCloud(typedCloud<PointFromDrone>(obstacle_));
    filter_.setClearance(0.1);
  }

  const Points points_ = randomPoints(300, 1);
  const Points obstacle_ = randomPoints(200, 2);
  const std::vector<Verdict> flags_ = doubleLoop(points_, obstacle_, Eigen::Isometry3d::Identity(), 0.1);
  const pcl::PointCloud<PointFromDrone>::Ptr input_ = typedCloud<PointFromDrone>(points_);
  CollisionFilter<PointFromDrone> filter_;
};

TEST_F(CollisionFilterCustomPoint, IsFiltered)
{
  const pcl::Indices expected = where(flags_, false, points_);
  pcl::PointCloud<PointFromDrone> output;
  filter_.filter(output);
  ASSERT_EQ(output.size(), expected.size());
  for (std::size_t i = 0; i < output.size(); ++i) EXPECT_EQ(output[i].ring, expected[i]);
}

TEST_F(CollisionFilterCustomPoint, KeepOrganized)
{
  filter_.setKeepOrganized(true);
  filter_.setUserFilterValue(7.0f);
  pcl::PointCloud<PointFromDrone> output;
  filter_.filter(output);
  ASSERT_EQ(output.size(), points_.size());
  for (std::size_t i = 0; i < output.size(); ++i) EXPECT_EQ(output[i].x == 7.0f, flags_[i] == Verdict::colliding) << i;
}

TEST_F(CollisionFilterCustomPoint, StandardTypesWorkBesideIt)
{
  CollisionFilter<pcl::PointXYZ> filter;
  filter.setInputCloud(typedCloud<pcl::PointXYZ>(points_));
  filter.setObstacleCloud(typedCloud<PointFromDrone>(obstacle_));
  filter.setClearance(0.1);
  pcl::Indices kept;
  filter.filter(kept);
  EXPECT_EQ(kept, where(flags_, false, points_));
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// Real scans, where they are at hand, against an independent kd-tree.
#include <pcl_bsh/filters/collision_filter.h>

#include "shared_scans.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>
#include <nanoflann.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace pcl_bsh {
namespace {

using Cloud = pcl::PCLPointCloud2;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, 3>;

Cloud::Ptr load(const std::string& name)
{
  auto cloud = std::make_shared<Cloud>();
  readScan(name, *cloud);
  return cloud;
}

/// The points less an offset near them, row by row.
Matrix coordinates(const Cloud& cloud, const Eigen::Vector3d& offset)
{
  const PointsView view = viewOf(cloud);
  Matrix result(static_cast<Eigen::Index>(view.count), 3);
  for (std::uint32_t i = 0; i < view.count; ++i) {
    result.row(i) = (Eigen::Vector3d(view.point(i).data()) - offset).transpose();
  }
  return result;
}

/// One verdict per point of a: is the nearest point of b within the clearance? All of b is finite.
std::vector<Verdict> nearestWithin(const Matrix& a, const Matrix& b, double clearance)
{
  const nanoflann::KDTreeEigenMatrixAdaptor<Matrix> tree(3, std::cref(b));
  std::vector<Verdict> flags(static_cast<std::size_t>(a.rows()), Verdict::free);
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const Eigen::Vector3d query = a.row(i);
    if (!query.allFinite()) continue;
    Eigen::Index nearest = 0;
    double squared = 0;
    tree.query(query.data(), 1, &nearest, &squared);
    flags[static_cast<std::size_t>(i)] = test::verdictIf(std::sqrt(squared) <= clearance);
  }
  return flags;
}

std::ptrdiff_t ones(const std::vector<Verdict>& flags)
{
  return std::count(flags.begin(), flags.end(), Verdict::colliding);
}

class CollisionFilterData : public testing::Test {
protected:
  void SetUp() override
  {
    for (const char* const name : {"tabletop_rgbd_organized", "robot_panda_sampled", "terrain_stbarth_utm20_f64"}) {
      if (!hasScan(name)) GTEST_SKIP() << scanFile(name) << " is not there";
    }
  }
};

TEST_F(CollisionFilterData, PandaArmOnTheTable)
{
  const Cloud::Ptr scene = load("tabletop_rgbd_organized");
  const Cloud::Ptr arm = load("robot_panda_sampled");
  constexpr double clearance = 0.02;
  // Upright on the table, between its objects.
  Eigen::Isometry3d pose(Eigen::AngleAxisd(std::atan2(-0.82, 0.57), Eigen::Vector3d::UnitX()));
  pose.translation() = Eigen::Vector3d(0.0, -0.03, -0.77);

  CollisionFilter<Cloud> filter(true);
  filter.setInputCloud(scene);
  filter.setObstacleCloud(arm);
  filter.setPose(pose);
  filter.setClearance(clearance);
  std::vector<Verdict> flags;
  filter.computeFlags(flags);

  const Matrix points = coordinates(*scene, Eigen::Vector3d::Zero());
  const Matrix obstacle = (pose * coordinates(*arm, Eigen::Vector3d::Zero()).transpose()).transpose();
  const std::vector<Verdict> expected = nearestWithin(points, obstacle, clearance);
  ASSERT_GT(ones(expected), 1000);
  EXPECT_EQ(flags, expected);

  filter.setKeepOrganized(true);
  Cloud output;
  filter.filter(output);
  EXPECT_EQ(output.width, 640u);
  EXPECT_EQ(output.height, 480u);
  const Eigen::Index not_finite = points.rows() - points.array().isFinite().rowwise().all().count();
  EXPECT_EQ(filter.getRemovedIndices()->size(), static_cast<std::size_t>(ones(expected) + not_finite));
}

TEST_F(CollisionFilterData, Float64TerrainAgainstItsFloat32Twin)
{
  const Cloud::Ptr precise = load("terrain_stbarth_utm20_f64");
  const Cloud::Ptr rounded = load("terrain_stbarth_utm20_f32");
  constexpr double clearance = 0.0217; // no multiple of a coordinate step: no ties

  CollisionFilter<Cloud> filter;
  filter.setInputCloud(precise);
  filter.setObstacleCloud(rounded);
  filter.setClearance(clearance);
  std::vector<Verdict> flags;
  filter.computeFlags(flags);

  const Eigen::Vector3d corner(515000, 1981000, 0);
  const auto expected = nearestWithin(coordinates(*precise, corner), coordinates(*rounded, corner), clearance);
  ASSERT_GT(ones(expected), 10000);
  ASSERT_LT(ones(expected), 240000);
  EXPECT_EQ(flags, expected);
}

} // namespace
} // namespace pcl_bsh

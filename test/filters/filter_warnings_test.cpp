// SPDX-License-Identifier: BSD-3-Clause
// Warnings of the filters about a question.
#include "support/verdicts.h"

#include <pcl_bsh/filters/collision_filter.h>
#include <pcl_bsh/filters/distance_filter.h>
#include <pcl_bsh/filters/mesh_collision_filter.h>

#include <pcl/PolygonMesh.h>
#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <gmock/gmock.h>

#include <limits>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

using Points = pcl::PointCloud<pcl::PointXYZ>;

/// A floor of 20 x 20 points, one apart.
Points::Ptr floorAt(float x)
{
  auto points = std::make_shared<Points>();
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) points->emplace_back(x + static_cast<float>(i), static_cast<float>(j), 0.0f);
  return points;
}

template <class Filter>
struct Told {
  explicit Told(Filter& filter)
  {
    filter.setWarn([this](const std::string& line) { lines.push_back(line); });
  }
  std::vector<std::string> lines;
};

class FilterWarnings : public testing::Test {
protected:
  FilterWarnings()
  {
    filter_.setClearance(2.0);
    filter_.setInputCloud(floorAt(0));
    filter_.setObstacleCloud(floorAt(0.5));
  }

  void ask() { filter_.computeFlags(flags_); }

  CollisionFilter<pcl::PointXYZ> filter_;
  Told<CollisionFilter<pcl::PointXYZ>> told_{filter_};
  std::vector<Verdict> flags_;
};

TEST_F(FilterWarnings, NoneWhereAllIsInOrder)
{
  ask();
  EXPECT_THAT(told_.lines, IsEmpty());
}

TEST_F(FilterWarnings, HolesThatCollisionsHideIn)
{
  filter_.setClearance(0.5);
  ask();
  EXPECT_THAT(told_.lines, ElementsAre(HasSubstr("points lie 1 apart in the input and 1 in the obstacle: surfaces may "
                                                 "touch with no two points within the clearance of 0.5")));
  ask();
  EXPECT_EQ(told_.lines.size(), 1u) << "clouds come in streams";
}

TEST_F(FilterWarnings, AlongATrajectoryToo)
{
  filter_.setClearance(0.5);
  filter_.setTrajectory({Eigen::Isometry3d::Identity()});
  TrajectoryResult found;
  filter_.computeTrajectory(found);
  EXPECT_THAT(told_.lines, ElementsAre(HasSubstr("points lie 1 apart")));
}

TEST_F(FilterWarnings, EachKindOnceInAStream)
{
  const Points::Ptr gaps = floorAt(0);
  (*gaps)[7].y = std::numeric_limits<float>::quiet_NaN();
  filter_.setInputCloud(gaps);
  ask();
  EXPECT_THAT(told_.lines, ElementsAre("the input: 1 of 400 points is not finite: it is left out"));
  filter_.setObstacleCloud(std::make_shared<Points>());
  for (int frame = 0; frame < 3; ++frame) ask();
  ASSERT_EQ(told_.lines.size(), 2u);
  EXPECT_EQ(told_.lines[1], "the obstacle: has no finite point: nothing collides with it");
  filter_.setInputCloud(floorAt(1 << 23));
  filter_.setObstacleCloud(floorAt(1 << 23));
  ask();
  ASSERT_EQ(told_.lines.size(), 4u) << "of both clouds of one question";
  EXPECT_THAT(told_.lines[2], HasSubstr("the input: its float32 coordinates lie 1 apart, coarse for a clearance of 2"));
  EXPECT_THAT(told_.lines[3], HasSubstr("the obstacle: its float32"));
}

TEST_F(FilterWarnings, FramesThatNeverMeet)
{
  Eigen::Isometry3d far = Eigen::Isometry3d::Identity();
  far.translation().x() = 5e6;
  filter_.setPose(far);
  ask();
  EXPECT_THAT(told_.lines, ElementsAre(HasSubstr("the boxes of the input and of the obstacle, with all of its motion, "
                                                 "are 4.99998e+06 apart")));

  DistanceFilter<pcl::PointXYZ> distances;
  const Told<DistanceFilter<pcl::PointXYZ>> told(distances);
  distances.setInputCloud(floorAt(0));
  distances.setObstacleCloud(floorAt(0.5));
  Points kept;
  distances.filter(kept);
  EXPECT_THAT(told.lines, IsEmpty()) << "distances are seen";
  distances.setPose(far);
  distances.filter(kept);
  EXPECT_THAT(told.lines, ElementsAre(HasSubstr("4.99998e+06 apart")));
  distances.setObstacleCloud(std::make_shared<Points>());
  distances.filter(kept);
  ASSERT_EQ(told.lines.size(), 2u);
  EXPECT_EQ(told.lines[1], "the obstacle: has no finite point: nothing has a distance from it");
}

/// As collisions compare them with the clearance.
TEST_F(FilterWarnings, CoordinatesThatAreCoarseForLimits)
{
  DistanceFilter<pcl::PointXYZ> distances;
  const Told<DistanceFilter<pcl::PointXYZ>> told(distances);
  distances.setInputCloud(floorAt(1 << 23));
  distances.setObstacleCloud(floorAt(1 << 23));
  Points kept;
  distances.filter(kept);
  EXPECT_THAT(told.lines, IsEmpty()) << "no length is compared with";
  distances.setFilterLimits(0.0, 5.0);
  distances.filter(kept);
  EXPECT_THAT(told.lines,
              ElementsAre(HasSubstr("the input: its float32 coordinates lie 1 apart, coarse for a limit of 5"),
                          HasSubstr("the obstacle: its float32 coordinates")));
}

/// Corners of a mesh, whose balls have double coordinates, and which has no holes.
TEST_F(FilterWarnings, OfSurfaces)
{
  Points corners;
  for (const auto& [x, y] : {std::pair(0, 0), {30, 0}, {0, 30}, {9, 9}})
    corners.emplace_back(static_cast<float>((1 << 20) + x), static_cast<float>(y), 0.0f);
  const auto mesh = std::make_shared<pcl::PolygonMesh>();
  pcl::toPCLPointCloud2(corners, mesh->cloud);
  mesh->polygons.emplace_back();
  mesh->polygons.back().vertices = {0, 1, 2};
  const auto same = [](const std::string& name) {
    return std::vector<testing::Matcher<std::string>>{
        HasSubstr(name + ": 1 of its vertices belongs to no face"),
        HasSubstr(name + ": its float32 coordinates lie 0.125 apart, coarse for a clearance of 0.5")};
  };
  Eigen::Isometry3d there = Eigen::Isometry3d::Identity();
  there.translation().x() = -(1 << 20);
  filter_.setInputCloud(floorAt(0));
  filter_.setObstacleSurface(mesh);
  filter_.setPose(there);
  filter_.setClearance(0.5);
  ask();
  auto expected = same("the obstacle");
  expected.emplace_back(
      HasSubstr("points lie 1 apart in the input: what was scanned may touch the surface of the obstacle"));
  EXPECT_THAT(told_.lines, testing::ElementsAreArray(expected));

  MeshCollisionFilter faces;
  const Told<MeshCollisionFilter> told(faces);
  faces.setInputMesh(mesh);
  faces.setObstacleSurface(mesh);
  faces.setClearance(0.5);
  faces.computeFlags(flags_);
  expected = same("the input");
  for (auto& line : same("the obstacle")) expected.push_back(line);
  EXPECT_THAT(told.lines, testing::ElementsAreArray(expected));
}

} // namespace
} // namespace pcl_bsh

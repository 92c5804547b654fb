// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/solids.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/question/options.h>

#include "support/verdicts.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A cube from -1 to 1, and points in it, on it and about it.
class SolidObstacleTest : public testing::Test {
protected:
  SolidObstacleTest()
  {
    for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
    triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    question.solid = true;
    question.clearance = 0.125;
  }

  TrianglesView view() const
  {
    return {viewOf(corners[0].data(), corners.size()), triangles[0].data(), triangles.size()};
  }

  Answer answer()
  {
    Shape input("the scan", viewOf(points[0].data(), points.size())), obstacle("the tank", viewOf(view()));
    return ask(question, input, obstacle);
  }

  std::string refusal()
  {
    try {
      answer();
    }
    catch (const InvalidInput& error) {
      return error.what();
    }
    return "";
  }

  std::vector<Point3> corners;
  std::vector<Triangle> triangles;
  std::vector<Point3> points = {{0, 0, 0}, {0.5, 0, 0}, {1, 0.5, 0.5}, {1.125, 0, 0}, {1.25, 0, 0}, {NAN, 0, 0}};
  Question question;
};

TEST_F(SolidObstacleTest, WhatIsInsideCollidesAtAnyClearance)
{
  question.wanted.flags = true;
  Answer found = answer();
  EXPECT_EQ(found.collisions.flags, test::verdictsOf({1, 1, 1, 1, 0, 0}));
  EXPECT_EQ(found.collisions.colliding, 4u);
  question.clearance = 0.0;
  EXPECT_EQ(answer().collisions.flags, test::verdictsOf({1, 1, 1, 0, 0, 0}));
  question.solid = false;
  EXPECT_EQ(answer().collisions.flags, test::verdictsOf({0, 0, 1, 0, 0, 0}));
  question.solid = true;
  question.pose.translation() = Eigen::Vector3d(0.75, 0, 0);
  EXPECT_EQ(answer().collisions.flags, test::verdictsOf({1, 1, 1, 1, 1, 0}));
}

TEST_F(SolidObstacleTest, UncertainPointsNearTheSurfaceStayUndecided)
{
  question.wanted.flags = true;
  question.clearance = 0.0;
  question.uncertainty.length = 0.25;
  EXPECT_EQ(answer().collisions.flags, test::verdictsOf({1, 1, 2, 2, 2, 0}));
}

TEST_F(SolidObstacleTest, DistancesAreSigned)
{
  question.wanted.distances = question.wanted.within = question.wanted.closest = true;
  question.limits = {-0.5, 0.125};
  Answer found = answer();
  const std::vector<double>& distance = found.distances.a.distance;
  EXPECT_EQ((std::vector<double>(distance.begin(), distance.begin() + 5)),
            (std::vector<double>{-1, -0.5, 0, 0.125, 0.25}));
  EXPECT_TRUE(std::isnan(distance[5]));
  EXPECT_THAT(found.within, ElementsAre(0, 1, 1, 1, 0, 0));
  EXPECT_EQ(found.closest.distance, -1.0);
  EXPECT_EQ(found.closest.pair->a, 0u);
  EXPECT_LE(found.closest.interval.lower, -1.0);
  EXPECT_GE(found.closest.interval.upper, -1.0);
  EXPECT_EQ(found.distances.a.greatest, 0.25);
  question.max_distance = 0.2; // depths are told however great
  found = answer();
  EXPECT_EQ(found.distances.a.distance[0], -1.0);
  EXPECT_TRUE(std::isnan(found.distances.a.distance[4]));
  question.limits = {-2.0, -1.0};
  EXPECT_THAT(answer().within, ElementsAre(1, 0, 0, 0, 0, 0));
  question.limits = {std::nextafter(-1.0, 0.0), -0.5};
  EXPECT_THAT(answer().within, ElementsAre(0, 1, 0, 0, 0, 0));
}

TEST_F(SolidObstacleTest, AlongAPathWhatIsInsideAtAPoseCollidesThere)
{
  const auto at = [](double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)); };
  points = {{0, 0, 0}, {9, 0, 0}};
  question.clearance = 0.0;
  question.path = {at(9), at(0), at(-9)};
  question.wanted.flags = question.wanted.contacts = question.wanted.poses = true;
  Answer found = answer();
  EXPECT_EQ(found.collisions.flags, test::verdictsOf({1, 1}));
  EXPECT_THAT(found.collisions.first_pose, ElementsAre(1, 0));
  EXPECT_THAT(found.collisions.distance, ElementsAre(0.0f, 0.0f));
  ASSERT_EQ(found.collisions.poses.size(), 3u);
  EXPECT_EQ(found.collisions.poses[0].colliding_points, 1u);
  EXPECT_EQ(found.collisions.poses[1].colliding_points, 1u);
  EXPECT_EQ(found.collisions.poses[2].colliding_points, 0u);
  question.wanted.poses = false;
  question.swept = 0.01;
  question.path = {at(0), at(0)};
  found = answer();
  ASSERT_TRUE(found.collisions.first_contact);
  EXPECT_EQ(found.collisions.first_contact->pose, 0u);
  EXPECT_EQ(found.collisions.first_contact->fraction, 0.0);
}

TEST_F(SolidObstacleTest, ASurfaceInsideCollides)
{
  const std::vector<Point3> small = {{0, 0, 0}, {0.25, 0, 0}, {0, 0.25, 0}, {5, 5, 5}};
  const std::vector<Triangle> plate = {{0, 1, 2}, {1, 2, 3}, {3, 3, 3}};
  Shape input("the plate", viewOf(TrianglesView{viewOf(small[0].data(), 4), plate[0].data(), 3}));
  Shape obstacle("the tank", viewOf(view()));
  question.wanted.flags = true;
  EXPECT_EQ(ask(question, input, obstacle).collisions.flags, test::verdictsOf({1, 1, 0}));
}

TEST_F(SolidObstacleTest, WhatDoesNotCloseIsRefused)
{
  question.wanted.flags = true;
  triangles.pop_back();
  EXPECT_THAT(refusal(), testing::AllOf(HasSubstr("the tank"), HasSubstr("3"), HasSubstr("edge")));
  Shape input("the scan", viewOf(points[0].data(), points.size())), cloud("a cloud", viewOf(points[0].data(), 2));
  EXPECT_THROW(ask(question, input, cloud), InvalidOption);
  question.vertices_only = true;
  EXPECT_THROW(answer(), InvalidOption);
}

} // namespace
} // namespace pcl_bsh

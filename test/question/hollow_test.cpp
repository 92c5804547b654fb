// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/warnings/hollow.h>

#include "solid/meshes.h"
#include "support/random.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;

/// A hall of 40 m with a machine of 4 m, and a scan that has few points in its middle.
class HollowTest : public testing::Test {
protected:
  HollowTest()
  {
    machine.add(test::boxMesh(), 4.0, {-2, -2, -2});
    test::Random random(1);
    for (int i = 0; i < 20000; ++i) { // the floor and a wall
      add(random.uniform(-20, 20), random.uniform(-20, 20), -10);
      add(20, random.uniform(-20, 20), random.uniform(-10, 10));
    }
    for (int i = 0; i < 200; ++i) // what stands in the machine's middle
      add(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
    question.clearance = 0.05;
    question.wanted.flags = true;
  }

  void add(double x, double y, double z) { points.insert(points.end(), {x, y, z}); }

  std::vector<Warning> hollow()
  {
    Shape input("hall.ply", viewOf(points.data(), points.size() / 3)), obstacle("robot.stl", viewOf(machine.view()));
    std::vector<Warning> all = ask(question, input, obstacle).warnings;
    all.erase(std::remove_if(all.begin(), all.end(), [](const Warning& w) { return w.kind != WarningKind::hollow; }),
              all.end());
    return all;
  }

  test::ClosedMesh machine;
  std::vector<double> points;
  Question question;
};

TEST_F(HollowTest, ToldWhereFacesCloseRoundFreePoints)
{
  const std::vector<Warning> told = hollow();
  ASSERT_EQ(told.size(), 1u);
  EXPECT_THAT(told[0].text, testing::AllOf(HasSubstr("robot.stl: "), HasSubstr("hall.ply"), HasSubstr("`solid`")));
  question.wanted = {};
  for (bool Wanted::*const what : {&Wanted::any, &Wanted::indices, &Wanted::obstacle_flags, &Wanted::closest,
                                   &Wanted::distances, &Wanted::within, &Wanted::contacts, &Wanted::first_poses}) {
    question.wanted.*what = true;
    EXPECT_EQ(hollow().size(), 1u);
    question.wanted.*what = false;
  }
}

TEST_F(HollowTest, NotOfASolid)
{
  question.solid = true;
  EXPECT_TRUE(hollow().empty());
}

TEST_F(HollowTest, NotWhereFacesDoNotClose)
{
  machine.corners.resize(machine.corners.size() - 3);
  EXPECT_TRUE(hollow().empty());
}

TEST_F(HollowTest, TrianglesThatAreNotFiniteEncloseNothing)
{
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double x : {infinity, std::nan("")}) {
    for (const double side : {-9.0, 9.0}) {
      const test::ClosedMesh sound = machine;
      const auto at = [&](double u, double v, double w) { return machine.vertex(u, v, w); };
      machine.triangle(at(x, side, -9), at(x, -side, -9), at(x, 0, 9));
      machine.triangle(at(9, side, -9), at(x, -side, -9), at(9, 0, 9));
      EXPECT_EQ(hollow().size(), 1u);
      machine = sound;
    }
  }
}

TEST_F(HollowTest, TheSecondQuestionFindsOutWhetherFacesClose)
{
  const auto known = [&] {
    Shape obstacle("robot.stl", viewOf(machine.view()));
    obstacle.hierarchy({}, 1);
    std::vector<std::optional<bool>> found;
    for (int i = 0; i < 3; ++i) found.push_back(obstacle.named("a copy").isKnownToClose());
    return found;
  };
  EXPECT_EQ(known(), (std::vector<std::optional<bool>>{std::nullopt, true, true}));
  machine.corners.resize(machine.corners.size() - 3);
  EXPECT_EQ(known(), (std::vector<std::optional<bool>>{std::nullopt, false, false}));
}

TEST_F(HollowTest, EachQuestionTellsTheSame)
{
  Shape input("hall.ply", viewOf(points.data(), points.size() / 3)), obstacle("robot.stl", viewOf(machine.view()));
  std::vector<std::string> told;
  for (int i = 0; i < 3; ++i)
    for (const Warning& warning : ask(question, input, obstacle).warnings) told.push_back(warning.text);
  ASSERT_EQ(told.size(), 3u);
  EXPECT_EQ(told[0], told[1]);
  EXPECT_EQ(told[0], told[2]);
}

TEST_F(HollowTest, CopiesShareWhatTheyEnclose)
{
  Shape obstacle("robot.stl", viewOf(machine.view()));
  obstacle.hierarchy({}, 1);
  Shape one = obstacle.named("one"), other = obstacle.named("other");
  EXPECT_EQ(&one.solid(), &other.solid());
  EXPECT_EQ(&one.content(), &other.content());
  one.hierarchy({0.5}, 1); // built anew
  EXPECT_NE(&one.content(), &other.content());
}

TEST_F(HollowTest, ToldOfAnInputThatClosesRoundTheObstacle)
{
  Shape input("robot.stl", viewOf(machine.view())), obstacle("hall.ply", viewOf(points.data(), points.size() / 3));
  const auto told = [&] {
    std::vector<Warning> all = ask(question, input, obstacle).warnings;
    all.erase(std::remove_if(all.begin(), all.end(), [](const Warning& w) { return w.kind != WarningKind::hollow; }),
              all.end());
    return all;
  };
  ASSERT_EQ(told().size(), 1u);
  EXPECT_THAT(told()[0].text, testing::AllOf(testing::StartsWith("robot.stl: "), HasSubstr("`input_solid`")));
  question.pose.translation().x() = 10;
  EXPECT_TRUE(told().empty());
  question.pose_of_input.translation().x() = 10;
  EXPECT_EQ(told().size(), 1u);
  question.input_solid = true;
  EXPECT_TRUE(told().empty());
}

/// As faces ask it, which run queries that no question has.
TEST_F(HollowTest, NearestDecidesWhereTheAskerHasTheAnswer)
{
  Shape input("hall.ply", viewOf(points.data(), points.size() / 3)), obstacle("robot.stl", viewOf(machine.view()));
  input.hierarchy({}, 1);
  obstacle.hierarchy({}, 1);
  const auto told = [&](double nearest) { return warningsOfHollow(question, nearest, input, obstacle).size(); };
  EXPECT_EQ(told(nearestOf(std::vector<Verdict>(3, Verdict::free))), 1u);
  EXPECT_EQ(told(nearestOf(std::vector<Verdict>{Verdict::free, Verdict::undecided})), 0u);
  EXPECT_EQ(told(nearestOf(std::vector<double>{std::nan(""), 0.1, 0.01})), 0u);
  EXPECT_EQ(told(nearestOf(std::vector<double>{std::nan(""), 0.1})), 1u) << "farther than a hundredth of 7 m";
  EXPECT_EQ(told(-1.0), 0u);
  TrajectoryResult found;
  EXPECT_EQ(told(nearestOf(found)), 1u);
  found.first_pose = {-1, 0};
  EXPECT_EQ(told(nearestOf(found)), 0u);
}

TEST_F(HollowTest, NotWhereSomethingIsNearTheSurface)
{
  add(2, 0, 0);
  EXPECT_TRUE(hollow().empty());
  question.wanted = {};
  question.wanted.any = true;
  EXPECT_TRUE(hollow().empty());
  question.wanted = {};
  question.wanted.distances = true;
  EXPECT_TRUE(hollow().empty());
}

TEST_F(HollowTest, NotOfATunnelRoundTheScan)
{
  machine.add(test::boxMesh(), 2.0, {-1, -1, -1}, true); // a hollow round the points
  EXPECT_TRUE(hollow().empty());
}

TEST_F(HollowTest, NotWhereItStandsElsewhereButOnItsWay)
{
  question.pose.translation().x() = 10;
  EXPECT_TRUE(hollow().empty());
  const Eigen::Isometry3d there = question.pose;
  question.path = {there, there, Eigen::Isometry3d::Identity(), there};
  EXPECT_EQ(hollow().size(), 1u);
  question.path->pop_back();
  question.path->pop_back();
  EXPECT_TRUE(hollow().empty());
}

TEST_F(HollowTest, ATurnedMachineIsSeenWhereItIs)
{
  question.pose.rotate(Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 1, 0).normalized()));
  question.pose.pretranslate(Eigen::Vector3d(100, 200, 300));
  question.pose_of_input.translation() = Eigen::Vector3d(100, 200, 300);
  EXPECT_EQ(hollow().size(), 1u);
}

} // namespace
} // namespace pcl_bsh

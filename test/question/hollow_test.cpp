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
  EXPECT_EQ(&one.queried(), &other.queried());
  one.hierarchy({0.5}, 1); // built anew
  EXPECT_NE(&one.queried(), &other.queried());
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
  EXPECT_EQ(told(std::nan("")), 0u) << "nobody knows";
  TrajectoryResult found;
  EXPECT_EQ(told(nearestOf(found)), 1u);
  found.first_pose = {-1, 0};
  EXPECT_EQ(told(nearestOf(found)), 0u);
  EXPECT_EQ(warningsOf(question, 0.1, input, obstacle).size(), 1u);
  question.solid = true;
  EXPECT_EQ(told(0.1), 0u);
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

TEST_F(HollowTest, NotWhereSomethingMayBeNearTheSurface)
{
  add(2.1, 0, 0);
  question.uncertainty = 0.1;
  question.wanted = {};
  for (bool Wanted::*const what : {&Wanted::any, &Wanted::flags, &Wanted::indices, &Wanted::obstacle_indices,
                                   &Wanted::obstacle_flags, &Wanted::contacts, &Wanted::first_poses}) {
    question.wanted.*what = true;
    EXPECT_TRUE(hollow().empty());
    question.wanted.*what = false;
  }
}

TEST_F(HollowTest, NearIsAHundredthOfTheSize)
{
  Shape input("hall.ply", viewOf(points.data(), points.size() / 3)), obstacle("robot.stl", viewOf(machine.view()));
  input.hierarchy({}, 1);
  obstacle.hierarchy({}, 1);
  const double near = nearTo(obstacle);
  EXPECT_NEAR(near, 0.04 * std::sqrt(3.0), 1e-15);
  EXPECT_TRUE(warningsOfHollow(question, near, input, obstacle).empty());
  EXPECT_EQ(warningsOfHollow(question, std::nextafter(near, 1.0), input, obstacle).size(), 1u);
}

/// Each part of an answer alone.
TEST(Hollow, NearestIsWhatThePartOfTheAnswerSaysThatWasWanted)
{
  const double infinity = std::numeric_limits<double>::infinity();
  const auto nearest = [](const auto& change) {
    Question question;
    Answer answer;
    change(question.wanted, answer);
    return nearestOf(question, answer);
  };
  for (const Verdict verdict : {Verdict::free, Verdict::colliding, Verdict::undecided, Verdict::unseen}) {
    const double expected = verdict == Verdict::colliding || verdict == Verdict::undecided ? 0.0 : infinity;
    EXPECT_EQ(nearestOf(std::vector<Verdict>{Verdict::free, verdict}), expected);
    EXPECT_EQ(nearest([&](Wanted& wanted, Answer& answer) {
                wanted.obstacle_flags = true;
                answer.obstacle_flags = {Verdict::free, verdict};
              }),
              expected);
    if (verdict == Verdict::unseen) continue;
    EXPECT_EQ(nearest([&](Wanted& wanted, Answer& answer) {
                wanted.any = true;
                answer.any.verdict = verdict;
              }),
              expected);
  }
  for (std::vector<std::int32_t> CollidingIndices::*const list :
       {&CollidingIndices::a, &CollidingIndices::b, &CollidingIndices::undecided_a, &CollidingIndices::undecided_b})
    EXPECT_EQ(nearest([&](Wanted& wanted, Answer& answer) {
                wanted.indices = true;
                answer.indices.*list = {3};
              }),
              0.0);
  const auto ofCollisions = [&](const auto& change) {
    return nearest([&](Wanted& wanted, Answer& answer) {
      wanted.flags = true;
      change(answer.collisions);
    });
  };
  EXPECT_EQ(ofCollisions([](TrajectoryResult&) {}), infinity);
  EXPECT_EQ(ofCollisions([](TrajectoryResult& found) { found.colliding = 1; }), 0.0);
  EXPECT_EQ(ofCollisions([](TrajectoryResult& found) { found.undecided = 1; }), 0.0);
  EXPECT_EQ(ofCollisions([](TrajectoryResult& found) { found.colliding = found.undecided = 1; }), 0.0);
  EXPECT_EQ(ofCollisions([](TrajectoryResult& found) { found.first_contact = FirstContact{0, 0.5}; }), 0.0);
  EXPECT_EQ(ofCollisions([](TrajectoryResult& found) { found.first_pose = {-1, 0}; }), 0.0);
  EXPECT_EQ(ofCollisions([](TrajectoryResult& found) { found.first_pose = {-1, -1}; }), infinity);
  EXPECT_EQ(nearest([](Wanted& wanted, Answer& answer) {
              wanted.closest = true;
              answer.closest.distance = 0.5;
            }),
            0.5);
  EXPECT_EQ(nearest([](Wanted& wanted, Answer& answer) {
              wanted.distances = true;
              answer.distances.a.distance = {2.0, std::nan(""), 0.5};
            }),
            0.5);
  EXPECT_EQ(nearest([](Wanted&, Answer&) {}), 0.0) << "it does not tell";
  Question along;
  along.path.emplace(2, Eigen::Isometry3d::Identity());
  along.wanted.distances = true;
  Answer answer;
  answer.closest.distance = 0.25; // of no meaning
  answer.collisions.distance = {2.0f, std::nanf(""), 0.5f};
  EXPECT_EQ(nearestOf(along, answer), 0.5);
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

/// All corners one from the middle, so that most of its box is outside.
test::ClosedMesh octahedron()
{
  test::ClosedMesh mesh;
  std::uint32_t at[3][2];
  for (int axis = 0; axis < 3; ++axis)
    for (int end = 0; end < 2; ++end)
      at[axis][end] =
          mesh.vertex(axis == 0 ? 2 * end - 1 : 0, axis == 1 ? 2 * end - 1 : 0, axis == 2 ? 2 * end - 1 : 0);
  for (int i = 0; i < 8; ++i) {
    const int x = i & 1, y = i >> 1 & 1, z = i >> 2;
    if ((x + y + z) % 2 == 1)
      mesh.triangle(at[0][x], at[1][y], at[2][z]);
    else
      mesh.triangle(at[0][x], at[2][z], at[1][y]);
  }
  return mesh;
}

bool isInOctahedron(const Eigen::Vector3d& place)
{
  return place.lpNorm<1>() < 1.0;
}

/// Each of eight points is a sample. They lie along a line, so that a box about them turns with their pose.
TEST(Hollow, ToldIfAndOnlyIfAnyIsInsideWhereverTheTwoStand)
{
  const test::ClosedMesh mesh = octahedron();
  test::Random random(4);
  std::size_t told_of = 0;
  for (int i = 0; i < 400; ++i) {
    SCOPED_TRACE(i);
    const bool is_obstacle = i % 2 == 0;
    std::vector<Point3> points;
    for (int k = 0; k < 8; ++k)
      points.push_back({random.uniform(-6, 6), 5 + random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)});
    const Eigen::Isometry3d at = random.pose(50), of_surface = at * random.pose(0.1);
    const Eigen::Isometry3d of_points = at * random.pose(0.7) * Eigen::Translation3d(0, -5, 0);
    Question question;
    question.pose = is_obstacle ? of_surface : of_points;
    question.pose_of_input = is_obstacle ? of_points : of_surface;
    question.wanted.flags = true;
    Shape surface("a tank", viewOf(mesh.view())), scan("a scan", viewOf(points[0].data(), points.size()));
    surface.hierarchy({}, 1);
    scan.hierarchy({}, 1);
    std::vector<std::string> inside;
    for (const Point3& p : points)
      if (isInOctahedron(of_surface.inverse() * of_points * Eigen::Vector3d(p.data())))
        inside.push_back(warningOfHollow("a tank", is_obstacle ? "solid" : "input_solid", "a scan", p).text);
    for (const char* const when : {"at first", "later"}) {
      const std::vector<Warning> told = warningsOfHollow(question, nearestOf(std::vector<Verdict>()),
                                                         is_obstacle ? scan : surface, is_obstacle ? surface : scan);
      ASSERT_EQ(told.size(), inside.empty() ? 0u : 1u) << when;
      if (!told.empty()) {
        EXPECT_THAT(inside, testing::Contains(told[0].text));
      }
    }
    told_of += !inside.empty();
  }
  EXPECT_GT(told_of, 100u);
  EXPECT_LT(told_of, 300u);
}

/// An eighth of many, wherever it stands in the list; and so of poses a sixteenth.
TEST(Hollow, SamplesAreSpread)
{
  const test::ClosedMesh mesh = octahedron();
  const std::vector<Eigen::Isometry3d> here{Eigen::Isometry3d::Identity()};
  HierarchyOptions one_voxel;
  one_voxel.voxel_edge = 8.0;
  test::Random random(5);
  for (const std::size_t count : {9u, 100u, 1000u}) {
    for (std::size_t part = 0; part < 8; ++part) {
      std::vector<Point3> points; // about the middle of a face
      while (points.size() < count) {
        const std::size_t i = points.size();
        const bool in = i >= part * count / 8 && i <= (part + 1) * count / 8 + 4;
        const Point3 p = random.point([&] { return random.uniform(0.3, 0.367); });
        if (isInOctahedron(Eigen::Vector3d(p.data())) == in) points.push_back(p);
      }
      Shape surface("a tank", viewOf(mesh.view()));
      surface.hierarchy({}, 1);
      const SphereHierarchy queried(viewOf(points[0].data(), count), one_voxel);
      const auto place = placeWithin(surface, queried, here);
      ASSERT_TRUE(place) << count << ' ' << part;
      EXPECT_TRUE(isInOctahedron(Eigen::Vector3d(place->data())));
    }
  }
  const Point3 point{0.1, 0.1, 0.1};
  const SphereHierarchy queried(viewOf(point.data(), 1));
  for (const std::size_t count : {1u, 16u, 17u, 160u}) {
    for (std::size_t part = 0; part < std::min<std::size_t>(count, 16); ++part) {
      std::vector<Eigen::Isometry3d> poses(count, Eigen::Isometry3d(Eigen::Translation3d(0.8, 0.8, 0.8)));
      for (std::size_t k = part * count / 16; k < std::min(count, (part + 1) * count / 16 + 1); ++k) poses[k] = here[0];
      Shape surface("a tank", viewOf(mesh.view()));
      surface.hierarchy({}, 1);
      EXPECT_TRUE(placeWithin(surface, queried, poses)) << count << ' ' << part;
    }
  }
}

TEST(Hollow, WhatIsOnTheSurfaceIsNotInside)
{
  const test::ClosedMesh mesh = octahedron();
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d way(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1); // to corners, middles of edges and of faces
    for (const double share : {1.0, 1.0 - 0x1p-50, 1.0 + 0x1p-50}) {
      const double length = std::max(way.lpNorm<1>(), 1.0);
      const Eigen::Vector3d place = way.lpNorm<1>() == 3 ? way.cwiseProduct(Eigen::Vector3d(0.5, 0.25, 0.25)) * share
                                                         : Eigen::Vector3d(way / length * share);
      Shape surface("a tank", viewOf(mesh.view()));
      surface.hierarchy({}, 1);
      const SphereHierarchy queried(viewOf(place.data(), 1));
      for (const char* const when : {"at first", "later"})
        EXPECT_EQ(placeWithin(surface, queried, {Eigen::Isometry3d::Identity()}).has_value(), isInOctahedron(place))
            << when << ' ' << place.transpose();
    }
  }
}

} // namespace
} // namespace pcl_bsh

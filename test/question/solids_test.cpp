// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/solids.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/question/enclosed.h>
#include <pcl_bsh/question/options.h>

#include <pcl_bsh/flags/collision_flags.h>

#include "solid/meshes.h"
#include "support/brute_force/labels.h"
#include "support/random.h"
#include "support/verdicts.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A cube from -1 to 1, and points in it, on it and about it.
class SolidsTest : public testing::Test {
protected:
  SolidsTest()
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

TEST_F(SolidsTest, WhatIsInsideCollidesAtAnyClearance)
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

TEST_F(SolidsTest, UncertainPointsNearTheSurfaceStayUndecided)
{
  question.wanted.flags = true;
  question.clearance = 0.0;
  question.uncertainty.length = 0.25;
  EXPECT_EQ(answer().collisions.flags, test::verdictsOf({1, 1, 2, 2, 2, 0}));
  question.wanted = {};
  question.wanted.indices = question.wanted.obstacle_indices = question.wanted.obstacle_flags = true;
  const Answer lists = answer();
  EXPECT_THAT(lists.indices.a, ElementsAre(0, 1));
  EXPECT_THAT(lists.indices.undecided_a, ElementsAre(2, 3, 4));
  std::vector<std::int32_t> colliding, undecided;
  for (std::int32_t i = 0; i < 12; ++i) {
    const Verdict verdict = lists.obstacle_flags[static_cast<std::size_t>(i)];
    if (verdict == Verdict::colliding) colliding.push_back(i);
    if (verdict == Verdict::undecided) undecided.push_back(i);
  }
  EXPECT_EQ(lists.indices.b, colliding);
  EXPECT_EQ(lists.indices.undecided_b, undecided);
  question.wanted = {};
  question.wanted.indices = true;
  const CollidingIndices of_input = answer().indices;
  EXPECT_EQ(of_input.a, lists.indices.a);
  EXPECT_EQ(of_input.undecided_a, lists.indices.undecided_a);
  EXPECT_TRUE(of_input.b.empty() && of_input.undecided_b.empty()) << "nobody asked for them";
  question.wanted = {};
  question.wanted.obstacle_indices = true;
  const CollidingIndices of_tank = answer().indices;
  EXPECT_EQ(of_tank.b, lists.indices.b);
  EXPECT_EQ(of_tank.undecided_b, lists.indices.undecided_b);
  EXPECT_TRUE(of_tank.a.empty() && of_tank.undecided_a.empty());
  question.uncertainty.length = 3.0;
  question.solid = false;
  const std::vector<std::int32_t> of_surface = answer().indices.undecided_b;
  EXPECT_EQ(of_surface.size(), 12u);
  question.solid = true;
  EXPECT_EQ(answer().indices.undecided_b, of_surface);
}

TEST_F(SolidsTest, DistancesAreSigned)
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
  EXPECT_EQ(found.distances.a.measured, 4u);
  EXPECT_TRUE(std::isnan(found.distances.a.distance[4]));
  question.max_distance = 0.125; // no more than the limits ask for
  question.limits = {-2.0, 1.0};
  EXPECT_EQ(answer().distances.a.distance[3], 0.125);
  question.max_distance = 0.2;
  question.limits = {-2.0, -1.0};
  EXPECT_THAT(answer().within, ElementsAre(1, 0, 0, 0, 0, 0));
  question.limits = {std::nextafter(-1.0, 0.0), -0.5};
  EXPECT_THAT(answer().within, ElementsAre(0, 1, 0, 0, 0, 0));
  question.wanted.distances = false;
  EXPECT_THAT(answer().within, ElementsAre(0, 1, 0, 0, 0, 0));
}

TEST_F(SolidsTest, ABallIsAsDeepAsItsFarSide)
{
  points = {{0.5, 0, 0}, {0.75, 0, 0}, {1, 0, 0}, {1.25, 0, 0}, {2, 0, 0}};
  const std::vector<float> radii{0.0f, 0.5f, 0.5f, 0.5f, 0.5f};
  PointsView balls = viewOf(points[0].data(), points.size());
  balls.radii = radii.data();
  question.wanted.distances = question.wanted.closest = true;
  question.accuracy = Accuracy::tolerance(0.01); // tells intervals
  Shape input("the scan", balls), obstacle("the tank", viewOf(view()));
  const std::vector<double> depths{-0.5, -0.75, -0.5, -0.25, 0.5};
  for (const std::optional<double> told : {std::optional<double>(), std::optional(0.2)}) {
    question.max_distance = told;
    const std::vector<Interval> intervals = ask(question, input, obstacle).distances.a.interval;
    for (std::size_t i = 0; i < (told ? 4 : depths.size()); ++i) {
      EXPECT_LE(intervals[i].lower, depths[i]) << i;
      EXPECT_GE(intervals[i].upper, depths[i]) << i;
      EXPECT_LT(intervals[i].upper - intervals[i].lower, 0.05) << i;
    }
  }
  question.accuracy = {};
  question.max_distance.reset();
  EXPECT_EQ(ask(question, input, obstacle).distances.a.distance, depths);
  EXPECT_EQ(ask(question, input, obstacle).closest.distance, -0.75);
  EXPECT_EQ(ask(question, input, obstacle).closest.pair->a, 1u);
}

/// Where a depth is rounded to a double, and so is its sum with a ball's width.
TEST_F(SolidsTest, IntervalsHoldDepthsToTheLastBit)
{
  test::Random random(1);
  std::vector<float> radii;
  std::vector<long double> depths;
  points.clear();
  for (int i = 0; i < 200; ++i) {
    const double x = random.uniform(0.01, 0.4);
    const auto radius = static_cast<float>(i % 2 == 0 ? 0.0 : random.uniform(0.1, 0.4));
    points.push_back({i % 3 == 0 ? -x : x, 0, 0});
    radii.push_back(radius);
    depths.push_back((1.0L - x) + radius); // exact
  }
  PointsView balls = viewOf(points[0].data(), points.size());
  balls.radii = radii.data();
  question.wanted.distances = true;
  question.accuracy = Accuracy::tolerance(0.01); // tells intervals
  Shape input("the scan", balls), obstacle("the tank", viewOf(view()));
  for (const double told : {0.125, 2.0}) {
    question.max_distance = told;
    const std::vector<Interval> intervals = ask(question, input, obstacle).distances.a.interval;
    for (std::size_t i = 0; i < depths.size(); ++i) {
      EXPECT_LE(intervals[i].lower, -depths[i]) << i;
      EXPECT_GE(intervals[i].upper, -depths[i]) << i;
      EXPECT_LT(intervals[i].upper - intervals[i].lower, told < 1 ? 1e-15 : 0.05) << i;
    }
  }
}

TEST_F(SolidsTest, AlongAPathWhatIsInsideAtAPoseCollidesThere)
{
  const auto at = [](double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)); };
  points = {{0, 0, 0}, {9, 0, 0}};
  question.clearance = 0.0;
  question.path = {at(9), at(0), at(-9)};
  question.wanted.flags = question.wanted.contacts = question.wanted.poses = true;
  Answer found = answer();
  EXPECT_EQ(found.collisions.flags, test::verdictsOf({1, 1}));
  EXPECT_THAT(found.collisions.first_pose, ElementsAre(1, 0));
  EXPECT_THAT(found.collisions.distance, ElementsAre(-1.0f, -1.0f));
  EXPECT_THAT(found.collisions.closest_pose, ElementsAre(1, 0));
  for (const std::uint32_t triangle : found.collisions.closest_point) EXPECT_LT(triangle, 12u) << "of the body";
  ASSERT_EQ(found.collisions.poses.size(), 3u);
  EXPECT_EQ(found.collisions.poses[0].colliding_points, 1u);
  EXPECT_EQ(found.collisions.poses[1].colliding_points, 1u);
  EXPECT_EQ(found.collisions.poses[2].colliding_points, 0u);
  EXPECT_FALSE(found.collisions.first_contact) << "nobody asked for the motion between poses";
  question.wanted = {};
  question.wanted.first_poses = true;
  found = answer();
  EXPECT_THAT(found.collisions.first_pose, ElementsAre(1, 0));
  EXPECT_EQ(found.collisions.colliding, 2u);
  EXPECT_TRUE(found.collisions.flags.empty());
  question.wanted.contacts = true;
  question.swept = 0.01;
  question.path = {at(0), at(0)};
  found = answer();
  ASSERT_TRUE(found.collisions.first_contact);
  EXPECT_EQ(found.collisions.first_contact->pose, 0u);
  EXPECT_EQ(found.collisions.first_contact->fraction, 0.0);
  question.path = {at(0), at(1.5)}; // its wall comes later
  EXPECT_EQ(answer().collisions.first_contact->fraction, 0.0);
  question.path = {at(3), at(0)}; // its wall comes first
  found = answer();
  EXPECT_EQ(found.collisions.first_contact->pose, 0u);
  EXPECT_NEAR(found.collisions.first_contact->fraction, 2.0 / 3.0, 0.01);
  question.path = {at(9), at(9), at(0)};
  points = {{0, 0, 0}};
  EXPECT_EQ(answer().collisions.first_contact->pose, 1u);
}

/// A caller may ask a query for less than a question does. Members that are not there stay empty.
TEST_F(SolidsTest, OnlyWhatAQueryToldIsAddedTo)
{
  points = {{0, 0, 0}, {9, 0, 0}, {20, 0, 0}};
  question.clearance = 0.0;
  question.path = {Eigen::Isometry3d(Eigen::Translation3d(30, 0, 0)), Eigen::Isometry3d::Identity()};
  const SphereHierarchy scan(viewOf(points[0].data(), points.size())), tank(viewOf(view()));
  Shape input("the scan", viewOf(points[0].data(), points.size())), obstacle("the tank", viewOf(view()));
  const auto enclosed = [&](bool flags, bool distances, bool closest_poses, bool first_poses) {
    TrajectoryRequest request;
    request.flags = flags;
    request.distances = distances;
    request.closest_poses = closest_poses;
    request.first_poses = first_poses;
    TrajectoryResult found = collideAlong({scan}, tank, *question.path, request);
    addEnclosed(question, input, obstacle, found);
    return found;
  };
  EXPECT_EQ(enclosed(true, false, false, false).flags, test::verdictsOf({1, 0, 0}));
  TrajectoryResult found = enclosed(false, true, false, false);
  EXPECT_TRUE(found.flags.empty() && found.closest_pose.empty() && found.first_pose.empty());
  EXPECT_EQ(found.distance[0], -1.0f);
  EXPECT_TRUE(std::isnan(found.distance[1]));
  EXPECT_LT(found.closest_point[0], 12u);
  EXPECT_EQ(found.closest_point[1], std::uint32_t{kNothing});
  found = enclosed(false, false, false, true);
  EXPECT_THAT(found.first_pose, ElementsAre(1, -1, -1));
  found = enclosed(true, true, true, true);
  EXPECT_THAT(found.closest_pose, ElementsAre(1, -1, -1));
  found = collideAlong({scan}, tank, *question.path, {});
  found.distance = {NAN, NAN, NAN}; // of a program that keeps these alone
  addEnclosed(question, input, obstacle, found);
  EXPECT_EQ(found.distance[0], -1.0f);
  EXPECT_TRUE(found.closest_pose.empty() && found.closest_point.empty());
}

/// As users meet it: a cube, a point in it and one far away.
TEST_F(SolidsTest, AListTellsTheDepthAndItsPlace)
{
  for (Point3& corner : corners)
    for (double& x : corner) x = 0.5 * (x + 1.0);
  points = {{0.5, 0.5, 0.8}, {5, 5, 5}};
  question.clearance = 0.1;
  question.wanted.flags = question.wanted.contacts = question.wanted.closest = true;
  const Answer found = answer();
  EXPECT_EQ(found.collisions.distance[0], static_cast<float>(-(1.0 - 0.8)));
  EXPECT_THAT(found.collisions.closest_pose, ElementsAre(0, -1));
  EXPECT_THAT(found.collisions.closest_point[0], testing::AnyOf(2u, 3u)); // its top
  EXPECT_EQ(found.closest.distance, -(1.0 - 0.8));                        // not only to a float
  EXPECT_EQ(findClashes(viewOf(points[0].data(), points.size()), found.collisions, 0.5).at(0).distance, -(1.0 - 0.8));
  EXPECT_EQ(*found.closest.pair, (PointPair{0, found.collisions.closest_point[0]}));
  EXPECT_LE(found.collisions.interval[0].lower, -(1.0 - 0.8));
  EXPECT_GE(found.collisions.interval[0].upper, -(1.0 - 0.8));
  EXPECT_TRUE(std::isnan(found.collisions.interval[1].lower));
  const SphereHierarchy scan(viewOf(points[0].data(), points.size())), tank(viewOf(view()));
  SolidDistanceRequest solid;
  solid.solid = true;
  const DistanceResult closest = closestPair({scan}, {tank}, solid);
  EXPECT_EQ(closest.distance, -(1.0 - 0.8));
  EXPECT_EQ(*closest.pair, *found.closest.pair);
  solid.solid = false;
  EXPECT_GT(closestPair({scan}, {tank}, solid).distance, 0.0);
  solid.input_solid = true;
  EXPECT_THROW(closestPair({scan}, {tank}, solid), InvalidOption);
  std::swap(solid.solid, solid.input_solid);
  solid.input_solid = true;
  solid.solid = false;
  EXPECT_EQ(closestPair({tank}, {scan}, solid).distance, -(1.0 - 0.8));
  EXPECT_EQ(*closestPair({tank}, {scan}, solid).pair, (PointPair{closest.pair->b, 0}));
}

/// The deepest pose and its place, in the middle of a path through a cube; swept, between two poses.
TEST_F(SolidsTest, ThroughACubeTheDeepestIsInTheMiddle)
{
  const auto at = [](double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)); };
  points = {{0, 0.25, 0}, {0, 0, 0.9}};
  question.clearance = 0.01;
  question.wanted.flags = question.wanted.contacts = question.wanted.closest = question.wanted.poses = true;
  question.path.emplace();
  for (int k = -4; k <= 4; ++k) question.path->push_back(at(0.5 * k));
  Answer found = answer();
  EXPECT_THAT(found.collisions.distance, ElementsAre(-0.75f, -0.1f));
  EXPECT_EQ(found.collisions.closest_pose[0], 4);
  EXPECT_EQ(found.collisions.first_pose[0], 2);
  EXPECT_EQ(found.closest.distance, -0.75);
  EXPECT_EQ(found.closest.pair->a, 0u);
  for (std::size_t k = 0; k < 9; ++k) {
    const double x = std::abs(0.5 * (static_cast<double>(k) - 4.0));
    if (x <= 1.0) {
      EXPECT_NEAR(found.collisions.poses[k].distance, -std::min(1.0 - x, 0.75), 1e-12) << k;
    }
    else {
      EXPECT_EQ(found.collisions.poses[k].distance, INFINITY) << k;
    }
  }
  question.swept = 0.01;
  question.wanted.poses = false;
  question.path = {at(-1.9), at(2.1)};
  found = answer();
  EXPECT_NEAR(found.collisions.distance[0], -0.75, 0.005);
  EXPECT_NEAR(found.collisions.distance[1], -0.1, 0.005);
  EXPECT_THAT(found.collisions.closest_pose, ElementsAre(0, 0));
  for (const auto& [record, depth] : {std::pair(0, 0.75), {1, 0.1}}) {
    EXPECT_LE(found.collisions.interval[static_cast<std::size_t>(record)].lower, -depth + 1e-12);
    EXPECT_GE(found.collisions.interval[static_cast<std::size_t>(record)].upper, -depth - 1e-12);
  }
}

/// A wall that crosses the surface: its corners are outside.
TEST_F(SolidsTest, AWallThatCrossesIsDeep)
{
  const std::vector<Point3> wall = {{-9, 0.5, -9}, {9, 0.5, -9}, {0, 0.5, 20}};
  const std::vector<Triangle> plate = {{0, 1, 2}};
  Shape input("the wall", viewOf(TrianglesView{viewOf(wall[0].data(), 3), plate[0].data(), 1}));
  Shape obstacle("the tank", viewOf(view()));
  question.wanted.flags = question.wanted.contacts = question.wanted.closest = true;
  Answer found = ask(question, input, obstacle);
  EXPECT_NEAR(found.collisions.distance[0], -0.5, 1e-3);
  EXPECT_LE(found.collisions.interval[0].lower, -0.5);
  EXPECT_GE(found.collisions.interval[0].upper, -0.5);
  question.wanted = {};
  question.wanted.closest = question.wanted.distances = true;
  found = ask(question, input, obstacle);
  EXPECT_LE(found.closest.interval.lower, -0.5);
  EXPECT_GE(found.closest.interval.upper, -0.5);
  EXPECT_NEAR(found.closest.distance, -0.5, 1e-3);
  ASSERT_EQ(found.distances.a.interval.size(), 1u);
  EXPECT_LE(found.distances.a.interval[0].lower, -0.5);
  EXPECT_GE(found.distances.a.interval[0].upper, -0.5);
  question.solid = false;
  EXPECT_EQ(ask(question, input, obstacle).closest.distance, 0.0);
}

/// On the face of one body, in the inside of another.
TEST_F(SolidsTest, APlaceOnTheFaceOfABodyIsHeldByTheOneAboutIt)
{
  question.clearance = 0.0;
  question.wanted.obstacle_flags = true;
  struct Case {
    Point3 point;
    bool outer, inner;
  };
  for (const auto& [point, outer, inner] : {Case{{2, 1.5, 1.5}, true, false},
                                            {{2.001, 1.5, 1.5}, true, false},
                                            {{1.999, 1.5, 1.5}, true, true},
                                            {{2, 2, 1.5}, true, false},
                                            {{1, 1, 1}, true, false},
                                            {{4, 1.5, 1.5}, false, false}}) {
    test::ClosedMesh mesh;
    mesh.add(test::boxMesh(), 4.0);
    mesh.add(test::boxMesh(), 1.0, {1, 1, 1});
    const std::array<double, 3> at = point;
    Shape input("the scan", viewOf(at.data(), 1)), obstacle("the tank", viewOf(mesh.view()));
    const std::vector<Verdict> flags = ask(question, input, obstacle).obstacle_flags;
    question.solid = false;
    const std::vector<Verdict> touched = ask(question, input, obstacle).obstacle_flags;
    question.solid = true;
    for (std::size_t i = 0; i < 24; ++i)
      EXPECT_EQ(flags[i] == Verdict::colliding, touched[i] == Verdict::colliding || (i < 12 ? outer : inner))
          << i << ' ' << point[0];
  }
}

/// Limits that are met exactly, of balls: their depths are compared as they are before rounding.
TEST_F(SolidsTest, DepthsOfBallsAreComparedExactly)
{
  test::Random random(6);
  std::vector<float> radii;
  points.clear();
  for (int i = 0; i < 300; ++i) {
    points.push_back({random.uniform(0.01, 0.4), 0, 0});
    radii.push_back(static_cast<float>(random.uniform(0.1, 0.4)));
  }
  PointsView balls = viewOf(points[0].data(), points.size());
  balls.radii = radii.data();
  question.wanted.within = true;
  Shape input("the scan", balls), obstacle("the tank", viewOf(view()));
  std::size_t below = 0, above = 0;
  for (std::size_t i = 0; i < points.size(); i += 10) {
    const long double depth = (1.0L - points[i][0]) + radii[i]; // exact
    const auto rounded = static_cast<double>(depth);
    question.limits = {-rounded, 9.0};
    const bool within = ask(question, input, obstacle).within[i] != 0;
    EXPECT_EQ(within, depth <= rounded) << i;
    (depth <= rounded ? below : above) += 1;
  }
  EXPECT_GT(below, 5u);
  EXPECT_GT(above, 5u);
}

/// The first contact that is certain is that of points which are enclosed wherever they truly are.
TEST_F(SolidsTest, OnAWayWhatIsCertainlyInsideMeetsForCertain)
{
  const auto at = [](double x) { return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)); };
  points = {{0, 0, 0}};
  question.clearance = 0.0;
  question.wanted.flags = question.wanted.contacts = true;
  question.swept = 0.01;
  question.uncertainty.length = 0.25;
  question.path = {at(0), at(0)};
  Answer found = answer();
  ASSERT_TRUE(found.collisions.certain_contact);
  EXPECT_EQ(found.collisions.certain_contact->pose, 0u);
  EXPECT_EQ(found.collisions.certain_contact->fraction, 0.0);
  EXPECT_THAT(found.collisions.certain_pose, ElementsAre(0));
  question.path = {at(1.125), at(1.125)}; // outside, or inside
  found = answer();
  EXPECT_TRUE(found.collisions.first_contact);
  EXPECT_FALSE(found.collisions.certain_contact);
  EXPECT_THAT(found.collisions.certain_pose, ElementsAre(-1));
  question.path = {at(0.875), at(0.875)}; // inside, as measured
  found = answer();
  EXPECT_TRUE(found.collisions.first_contact);
  EXPECT_FALSE(found.collisions.certain_contact);
  EXPECT_THAT(found.collisions.certain_pose, ElementsAre(-1));
  EXPECT_EQ(found.collisions.flags, test::verdictsOf({2}));
}

TEST_F(SolidsTest, ASurfaceInsideCollides)
{
  const std::vector<Point3> small = {{0, 0, 0}, {0.25, 0, 0}, {0, 0.25, 0}, {5, 5, 5}};
  const std::vector<Triangle> plate = {{0, 1, 2}, {1, 2, 3}, {3, 3, 3}};
  Shape input("the plate", viewOf(TrianglesView{viewOf(small[0].data(), 4), plate[0].data(), 3}));
  Shape obstacle("the tank", viewOf(view()));
  question.wanted.flags = true;
  EXPECT_EQ(ask(question, input, obstacle).collisions.flags, test::verdictsOf({1, 1, 0}));
}

TEST_F(SolidsTest, WhatDoesNotCloseIsRefused)
{
  question.wanted.flags = true;
  triangles.pop_back();
  EXPECT_THAT(refusal(), testing::AllOf(HasSubstr("the tank"), HasSubstr("3"), HasSubstr("edge")));
  Shape input("the scan", viewOf(points[0].data(), points.size())), cloud("a cloud", viewOf(points[0].data(), 2));
  EXPECT_THROW(ask(question, input, cloud), InvalidOption);
  question.vertices_only = true;
  EXPECT_THROW(answer(), InvalidOption);
}

/// Two meshes, and brute force: every record against every other, every place against every triangle.
class TwoSolidsTest : public testing::Test {
protected:
  struct Verdicts {
    std::vector<Verdict> a, b;
    bool any() const { return countOf(a, Verdict::colliding) > 0; }
  };

  Answer answer()
  {
    Shape input("the machine", viewOf(first.view())), obstacle("the tank", viewOf(second.view()));
    return ask(question, input, obstacle);
  }

  /// Records with a place inside, or on the surface.
  static std::vector<std::uint32_t> enclosed(const test::ClosedMesh& queried, const test::ClosedMesh& solid,
                                             const Eigen::Isometry3d& pose_of_queried,
                                             const Eigen::Isometry3d& pose_of_solid)
  {
    const SphereHierarchy corners(queried.view().vertices);
    const auto labels =
        brute_force::labelPoints({corners, pose_of_queried}, {Solid(solid.view()), pose_of_solid}).labels;
    std::vector<std::uint32_t> records;
    for (std::uint32_t i = 0; i < queried.view().count; ++i) {
      const Triangle t = queried.view().cornersOf(i);
      if (std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return labels[v] != 0; })) records.push_back(i);
    }
    return records;
  }

  /// Verdicts for solids of one body each.
  Verdicts bruteForce(const Eigen::Isometry3d& pose) const
  {
    const SphereHierarchy a(viewOf(first.view())), b(viewOf(second.view()));
    FlagsResult surfaces = collisionFlags({a, question.pose_of_input}, {b, pose}, {*question.clearance, Flagged::both});
    Verdicts all{surfaces.a, surfaces.b};
    const auto add = [](const std::vector<std::uint32_t>& queried, std::vector<Verdict>& of_queried,
                        std::vector<Verdict>& of_solid) {
      for (const std::uint32_t record : queried) of_queried[record] = Verdict::colliding;
      if (!queried.empty()) std::fill(of_solid.begin(), of_solid.end(), Verdict::colliding);
    };
    if (question.solid) add(enclosed(first, second, question.pose_of_input, pose), all.a, all.b);
    if (question.input_solid) add(enclosed(second, first, pose, question.pose_of_input), all.b, all.a);
    return all;
  }

  test::ClosedMesh first = test::boxMesh(), second = test::bumpyMesh(6, 0.2);
  Question question;
};

TEST_F(TwoSolidsTest, FlagsListsAndAnyAreThoseOfBruteForce)
{
  test::Random random(7);
  question.clearance = 0.01;
  question.wanted.flags = question.wanted.obstacle_flags = question.wanted.any = true;
  question.wanted.indices = question.wanted.obstacle_indices = true;
  std::size_t enclosed_only = 0;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    question.solid = i % 3 != 0;
    question.input_solid = i % 3 != 1;
    first = test::ClosedMesh();
    first.add(test::boxMesh(), i % 2 == 0 ? 2.0 : 0.15, {i % 2 == 0 ? -0.5 : 0.45, 0, 0.25});
    question.pose = Eigen::Isometry3d::Identity();
    question.pose.rotate(Eigen::AngleAxisd(random.uniform(0, 3), Eigen::Vector3d::UnitY()));
    for (int k = 0; k < 3; ++k) question.pose.translation()[k] = random.uniform(-0.5, 0.5);
    question.pose_of_input = Eigen::Isometry3d(Eigen::Translation3d(random.uniform(-0.2, 0.2), 0, 0));
    const Verdicts expected = bruteForce(question.pose);
    const Answer found = answer();
    EXPECT_EQ(found.collisions.flags, expected.a);
    EXPECT_EQ(found.obstacle_flags, expected.b);
    EXPECT_EQ(found.any.verdict, test::verdictIf(expected.any()));
    EXPECT_EQ(found.any.pair.has_value(), expected.any());
    EXPECT_EQ(found.collisions.colliding, countOf(expected.a, Verdict::colliding));
    EXPECT_EQ(found.indices.a.size(), countOf(expected.a, Verdict::colliding));
    EXPECT_EQ(found.indices.b.size(), countOf(expected.b, Verdict::colliding));
    if (found.any.pair) {
      EXPECT_EQ(expected.a[found.any.pair->a], Verdict::colliding);
      EXPECT_EQ(expected.b[found.any.pair->b], Verdict::colliding);
      enclosed_only += found.any.interval.lower < 0.0;
    }
  }
  EXPECT_GT(enclosed_only, 5u); // else the surfaces tell all
}

TEST_F(TwoSolidsTest, FlagsOfOneSideTakeLessWorkThanOfBoth)
{
  question.solid = true;
  question.clearance = 0.3;
  question.wanted.flags = true;
  first = test::bumpyMesh(12, 0.1);
  question.pose = Eigen::Isometry3d(Eigen::Translation3d(0.5, 0, 0));
  const Work of_one = answer().work;
  question.wanted.obstacle_flags = true;
  const Work of_both = answer().work;
  EXPECT_LT(of_one.node_pairs, of_both.node_pairs);
}

TEST_F(SolidsTest, OfSeveralAtOneDepthTheFirstIsTold)
{
  points = {{NAN, 0, 0}, {0, 0.5, 0}, {NAN, 0, 0}, {0.5, 0, 0}, {-0.5, 0, 0}};
  question.wanted.closest = question.wanted.distances = true;
  const Answer found = answer();
  EXPECT_EQ(found.closest.pair->a, 1u);
  EXPECT_EQ(found.closest.pair->b, found.distances.a.closest_point[1]);
  EXPECT_EQ(found.distances.a.greatest, -0.5);
  EXPECT_EQ(found.distances.a.greatest_pair->a, 1u);
}

/// Expects the greatest distance, of the first record that has it.
void expectGreatest(const PointDistances& found)
{
  std::optional<std::uint32_t> greatest;
  for (std::uint32_t i = 0; i < found.distance.size(); ++i)
    if (!std::isnan(found.distance[i]) && !(greatest && found.distance[i] <= found.distance[*greatest])) greatest = i;
  ASSERT_EQ(found.greatest_pair.has_value(), greatest.has_value());
  if (!greatest) return;
  EXPECT_EQ(found.greatest, found.distance[*greatest]);
  EXPECT_EQ(*found.greatest_pair, (PointPair{*greatest, found.closest_point[*greatest]}));
}

/// A caller of the queries gets the answers of ask() with addEnclosed(), whichever of the two is solid, or neither.
TEST_F(TwoSolidsTest, WhatIsAddedToAQueryMakesItTheAnswer)
{
  test::Random random(9);
  std::size_t changed = 0;
  for (int i = 0; i < 24; ++i) {
    SCOPED_TRACE(i);
    question = Question();
    question.solid = i % 4 == 1 || i % 4 == 3;
    question.input_solid = i % 4 >= 2;
    question.clearance = i % 3 == 0 ? 0.0 : 0.05;
    question.uncertainty.length = i % 5 < 2 ? 0.05 : 0.0;
    first = test::ClosedMesh();
    first.add(test::boxMesh(), i % 8 < 4 ? 2.0 : 0.1, {i % 8 < 4 ? -0.5 : 0.45, 0.2, 0.25});
    question.pose_of_input = Eigen::Isometry3d(Eigen::Translation3d(random.uniform(-0.2, 0.2), 0, 0));
    std::vector<Eigen::Isometry3d> poses;
    for (int k = 0; k < 4; ++k) {
      poses.push_back(Eigen::Isometry3d(Eigen::AngleAxisd(random.uniform(0, 0.5), Eigen::Vector3d::UnitY())));
      for (int axis = 0; axis < 3; ++axis) poses.back().translation()[axis] = random.uniform(-0.15, 0.15);
    }
    poses[2].translation().x() += 9.0;
    question.pose = poses[static_cast<std::size_t>(i % 4)];
    Shape input("the machine", viewOf(first.view())), obstacle("the tank", viewOf(second.view()));
    const Placed a(input.hierarchy(question.uncertaintyOfInput(), 1), question.pose_of_input);
    const SphereHierarchy& tank = obstacle.hierarchy({}, 1);
    const Placed b(tank, question.pose);
    const double clearance = *question.clearance;

    question.wanted.flags = question.wanted.obstacle_flags = question.wanted.any = true;
    Answer expected = ask(question, input, obstacle);
    FlagsResult flags = collisionFlags(a, b, {clearance, Flagged::both});
    const FlagsResult of_surfaces = flags;
    addEnclosed(question, input, obstacle, flags);
    EXPECT_EQ(flags.a, expected.collisions.flags);
    EXPECT_EQ(flags.b, expected.obstacle_flags);
    EXPECT_EQ(flags.colliding_a, countOf(flags.a, Verdict::colliding));
    EXPECT_EQ(flags.colliding_b, countOf(flags.b, Verdict::colliding));
    EXPECT_EQ(flags.undecided_a, countOf(flags.a, Verdict::undecided));
    EXPECT_EQ(flags.undecided_b, countOf(flags.b, Verdict::undecided));
    changed += flags.a != of_surfaces.a || flags.b != of_surfaces.b;
    AnyResult any = anyCollision(a, b, {clearance, {}});
    addEnclosed(question, input, obstacle, any);
    EXPECT_EQ(any.verdict, expected.any.verdict);
    EXPECT_EQ(any.pair, expected.any.pair);

    std::vector<Verdict> verdicts, each;
    for (const Eigen::Isometry3d& pose : poses) {
      verdicts.push_back(anyCollision(a, {tank, pose}, {clearance, {}}).verdict);
      question.pose = pose;
      each.push_back(ask(question, input, obstacle).any.verdict);
    }
    question.pose = b.pose;
    addEnclosed(question, input, obstacle, poses, verdicts);
    EXPECT_EQ(verdicts, each);

    question.path = poses;
    question.wanted = {};
    question.wanted.flags = question.wanted.contacts = true;
    TrajectoryRequest along;
    along.clearance = clearance;
    along.distances = along.first_poses = along.closest_poses = true;
    TrajectoryResult path = collideAlong(a, tank, poses, along);
    expected = ask(question, input, obstacle);
    addEnclosed(question, input, obstacle, path);
    EXPECT_EQ(path.flags, expected.collisions.flags);
    EXPECT_EQ(path.first_pose, expected.collisions.first_pose);
    EXPECT_EQ(path.colliding, expected.collisions.colliding);

    question.uncertainty = {};
    question.path.reset();
    question.wanted = {};
    question.wanted.closest = question.wanted.distances = question.wanted.both_ways = true;
    question.clearance.reset();
    const Placed sure(input.hierarchy({}, 1), question.pose_of_input);
    expected = ask(question, input, obstacle);
    DistanceResult closest = closestPair(sure, b);
    addEnclosed(question, input, obstacle, closest);
    EXPECT_EQ(closest.distance, expected.closest.distance);
    EXPECT_EQ(closest.pair, expected.closest.pair);
    const PointDistances &of_a = expected.distances.a, &of_b = expected.distances.b;
    EXPECT_TRUE(
        (of_a.distance[closest.pair->a] == closest.distance &&
         of_a.closest_point[closest.pair->a] == closest.pair->b) ||
        (of_b.distance[closest.pair->b] == closest.distance && of_b.closest_point[closest.pair->b] == closest.pair->a));
    PointDistances distances = pointDistances(sure, b);
    const bool input_solid = std::exchange(question.input_solid, false); // of which these distances are none
    addEnclosed(question, input, obstacle, distances);
    question.input_solid = input_solid;
    EXPECT_EQ(distances.distance, expected.distances.a.distance);
    EXPECT_EQ(distances.closest_point, expected.distances.a.closest_point);
    for (const PointDistances* const found : {&distances, &expected.distances.a, &expected.distances.b})
      expectGreatest(*found);

    std::vector<double> at_poses, each_distance;
    std::vector<PointPair> pairs, each_pair;
    for (const Eigen::Isometry3d& pose : poses) {
      const DistanceResult here = closestPair(sure, {tank, pose});
      at_poses.push_back(here.distance);
      pairs.push_back(*here.pair);
      question.pose = pose;
      const DistanceResult there = ask(question, input, obstacle).closest;
      each_distance.push_back(there.distance);
      each_pair.push_back(*there.pair);
    }
    std::vector<PointPair> none;
    std::vector<double> unchanged = at_poses;
    addEnclosed(question, input, obstacle, poses, unchanged, none); // as of a cloud that is empty
    EXPECT_EQ(unchanged, at_poses);
    addEnclosed(question, input, obstacle, poses, at_poses, pairs);
    EXPECT_EQ(at_poses, each_distance);
    EXPECT_EQ(pairs, each_pair);
  }
  EXPECT_GT(changed, 4u); // else nothing was enclosed
}

TEST_F(TwoSolidsTest, AlongAPathEachPoseIsThatOfBruteForce)
{
  test::Random random(8);
  question.clearance = 0.0;
  question.wanted.flags = question.wanted.contacts = question.wanted.poses = true;
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    question.solid = i % 3 != 0;
    question.input_solid = i % 3 != 1;
    first = test::ClosedMesh();
    first.add(test::boxMesh(), i % 2 == 0 ? 2.0 : 0.15, {i % 2 == 0 ? -0.5 : 0.45, 0, 0.25});
    question.path.emplace();
    std::vector<std::int32_t> expected(12, -1);
    for (int k = 0; k < 7; ++k) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.rotate(Eigen::AngleAxisd(random.uniform(0, 3), Eigen::Vector3d::UnitZ()));
      for (int axis = 0; axis < 3; ++axis) pose.translation()[axis] = random.uniform(-1.5, 1.5);
      question.path->push_back(pose);
      const Verdicts at_pose = bruteForce(pose);
      for (std::size_t t = 0; t < 12; ++t)
        if (at_pose.a[t] == Verdict::colliding && expected[t] < 0) expected[t] = k;
    }
    const Answer found = answer();
    EXPECT_EQ(found.collisions.first_pose, expected);
    for (std::size_t t = 0; t < 12; ++t)
      if (expected[t] >= 0) {
        EXPECT_LT(found.collisions.closest_point[t], second.view().count);
      }
    for (std::size_t k = 0; k < 7; ++k)
      EXPECT_EQ(found.collisions.poses[k].colliding_points,
                countOf(bruteForce((*question.path)[k]).a, Verdict::colliding));
  }
}

/// Each of its triangles is told the first that its own body holds, which is not the first that any holds.
TEST_F(TwoSolidsTest, AlongAPathEachBodyOfTheInputHasItsOwn)
{
  first = test::ClosedMesh();
  first.add(test::boxMesh());
  first.add(test::boxMesh(), 1.0, {10, 0, 0});
  first.add(test::boxMesh(), 1.0, {20, 0, 0});
  const std::vector<Point3> points = {{30.5, 0.5, 0.5}, {10.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, {10.5, 0.5, 0.25}};
  question.clearance = 0.0;
  question.input_solid = true;
  question.wanted.contacts = true;
  question.path = {Eigen::Isometry3d::Identity(), Eigen::Isometry3d(Eigen::Translation3d(-10, 0, 0))};
  Shape input("the machine", viewOf(first.view())), obstacle("a scan", viewOf(points[0].data(), points.size()));
  const TrajectoryResult found = ask(question, input, obstacle).collisions;
  std::vector<std::int32_t> poses(24, 0);
  poses.insert(poses.end(), 12, 1);
  std::vector<std::uint32_t> enclosed(12, 2);
  enclosed.insert(enclosed.end(), 12, 1);
  enclosed.insert(enclosed.end(), 12, 0);
  EXPECT_EQ(found.first_pose, poses);
  EXPECT_EQ(found.closest_pose, poses);
  EXPECT_EQ(found.closest_point, enclosed);
}

/// Distances of the obstacle that nobody asked for are not turned.
TEST_F(TwoSolidsTest, AnInputThatIsSolidChangesNoDistanceOfItsOwn)
{
  first = test::ClosedMesh();
  first.add(test::boxMesh(), 4.0, {-2, -2, -2});
  second = test::ClosedMesh();
  second.add(test::boxMesh(), 1.0, {-1.5, -0.5, -0.5});
  question.wanted.closest = question.wanted.distances = true;
  const std::vector<double> expected = answer().distances.a.distance;
  question.input_solid = true;
  const Answer found = answer();
  EXPECT_EQ(found.distances.a.distance, expected);
  EXPECT_TRUE(found.distances.b.distance.empty());
  EXPECT_EQ(found.closest.distance, -1.5);
}

TEST_F(TwoSolidsTest, OfWhichOneHoldsTheOtherAreAsDeepAsTheDeepestPlace)
{
  first = test::ClosedMesh();
  first.add(test::boxMesh(), 4.0, {-2, -2, -2});
  second = test::ClosedMesh();
  second.add(test::boxMesh(), 1.0, {-1.5, -0.5, -0.5});
  question.clearance = 0.0;
  question.wanted.closest = question.wanted.any = question.wanted.distances = question.wanted.both_ways = true;
  EXPECT_EQ(answer().closest.distance, 0.5);
  EXPECT_EQ(answer().any.verdict, Verdict::free);
  question.input_solid = true;
  const Answer found = answer();
  EXPECT_EQ(found.any.verdict, Verdict::colliding);
  EXPECT_EQ(found.closest.distance, -1.5); // of the box's far side
  ASSERT_TRUE(found.closest.pair);
  EXPECT_LT(found.closest.pair->a, 12u);
  EXPECT_EQ(found.distances.b.distance[found.closest.pair->b], -1.5);
  EXPECT_EQ(found.distances.a.distance[found.closest.pair->a], answer().distances.a.distance[found.closest.pair->a]);
  std::swap(first, second);
  std::swap(question.solid, question.input_solid);
  EXPECT_EQ(answer().closest.distance, -1.5);
  EXPECT_EQ(answer().any.verdict, Verdict::colliding);
}

TEST_F(TwoSolidsTest, UncertainPlacesLeaveUndecidedWhatMayStillBeOutside)
{
  first = test::ClosedMesh();
  first.add(test::boxMesh(), 4.0, {-2, -2, -2});
  second = test::ClosedMesh();
  second.add(test::boxMesh(), 1.0, {-1.5, -0.5, -0.5});
  question.clearance = 0.0;
  question.input_solid = true;
  question.wanted.flags = question.wanted.obstacle_flags = question.wanted.any = true;
  question.obstacle_uncertainty.length = 0.25;
  Answer found = answer();
  EXPECT_EQ(countOf(found.collisions.flags, Verdict::colliding), 12u);
  EXPECT_EQ(countOf(found.obstacle_flags, Verdict::colliding), 12u);
  EXPECT_EQ(found.any.verdict, Verdict::colliding);
  question.obstacle_uncertainty.length = 0.75; // what is near the wall may stand outside
  found = answer();
  EXPECT_EQ(countOf(found.collisions.flags, Verdict::colliding), 12u);
  EXPECT_GT(countOf(found.obstacle_flags, Verdict::undecided), 0u);
  EXPECT_GT(countOf(found.obstacle_flags, Verdict::colliding), 0u);
  EXPECT_EQ(found.any.verdict, Verdict::colliding);
  question.obstacle_uncertainty.length = 2.0;
  found = answer();
  EXPECT_EQ(countOf(found.collisions.flags, Verdict::undecided), 12u);
  EXPECT_EQ(countOf(found.obstacle_flags, Verdict::undecided), 12u);
  EXPECT_EQ(found.any.verdict, Verdict::undecided);
  question.path = {question.pose};
  question.wanted = {};
  question.wanted.flags = question.wanted.first_poses = true;
  found = answer();
  EXPECT_EQ(found.collisions.flags, std::vector<Verdict>(12, Verdict::undecided));
  question.obstacle_uncertainty.length = 0.75;
  EXPECT_EQ(answer().collisions.flags, std::vector<Verdict>(12, Verdict::colliding));
}

/// Where one of two solids holds nothing, and where each holds a body of its own.
TEST_F(TwoSolidsTest, SummariesOfPosesCountWhatEitherHolds)
{
  const auto add = [](test::ClosedMesh& mesh, double edge) {
    mesh.add(test::boxMesh(), edge, {-0.5 * edge, -0.5 * edge, -0.5 * edge});
  };
  question.clearance = 0.0;
  question.solid = question.input_solid = true;
  question.wanted.poses = true;
  question.path = {Eigen::Isometry3d::Identity()};
  second = test::ClosedMesh();
  add(second, 4.0);
  for (const auto& [edges, enclosed] :
       {std::pair(std::vector<double>{1.0}, 12u), {{9.0}, 12u}, {{1.0, 9.0}, 24u}, {{9.0, 1.0}, 24u}}) {
    first = test::ClosedMesh();
    for (const double edge : edges) add(first, edge);
    const Answer found = answer();
    const PoseSummary& pose = found.collisions.poses.at(0);
    EXPECT_TRUE(pose.colliding);
    EXPECT_EQ(pose.colliding_points, enclosed);
    EXPECT_LT(pose.distance, 0.0);
  }
  for (const double uncertainty : {0.25, 1.75, 9.0}) {
    question.obstacle_uncertainty.length = uncertainty;
    question.path = {Eigen::Isometry3d::Identity()};
    question.wanted = {};
    question.wanted.poses = true;
    const PoseSummary pose = answer().collisions.poses.at(0);
    question.path.reset();
    question.wanted.flags = true;
    question.wanted.poses = false;
    const std::vector<Verdict> flags = answer().collisions.flags;
    EXPECT_EQ(pose.colliding_points, countOf(flags, Verdict::colliding)) << uncertainty;
    EXPECT_EQ(pose.undecided_points, countOf(flags, Verdict::undecided)) << uncertainty;
    EXPECT_EQ(pose.colliding, pose.colliding_points > 0) << uncertainty;
  }
}

TEST_F(TwoSolidsTest, AnInputWithoutFacesIsNoSolid)
{
  question.input_solid = true;
  question.clearance = 0.0;
  question.wanted.flags = true;
  const double points[3] = {0, 0, 0};
  Shape input("the scan", viewOf(points, 1)), obstacle("the tank", viewOf(second.view()));
  EXPECT_THROW(ask(question, input, obstacle), InvalidOption);
  first.corners.resize(first.corners.size() - 3);
  EXPECT_THROW(answer(), InvalidInput);
  question.vertices_only = true;
  EXPECT_THROW(answer(), InvalidOption);
}

} // namespace
} // namespace pcl_bsh

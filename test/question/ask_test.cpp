// SPDX-License-Identifier: BSD-3-Clause
// ask() against the queries that it asks, called directly.
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/question/options.h>

#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <pcl_bsh/collide.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/neighbors/patch_spacings.h>

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Points {
  Points(std::uint64_t seed, std::size_t count, double scale) : random(seed)
  {
    places = test::makePoints(test::Shape::uniform, count, scale, random);
    places[3][1] = std::numeric_limits<double>::quiet_NaN();
  }
  PointsView view() const { return viewOf(places[0].data(), places.size()); }
  Shape shape(const std::string& name) const { return {name, view()}; }

  test::Random random;
  std::vector<Point3> places;
};

Eigen::Isometry3d somePose(double x = 0.2)
{
  Eigen::Isometry3d pose(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, -1).normalized()));
  pose.translation() = Eigen::Vector3d(x, -0.1, 0.05);
  return pose;
}

FlagsRequest within(double clearance)
{
  FlagsRequest request;
  request.clearance = clearance;
  return request;
}

class Ask : public testing::Test {
protected:
  Ask()
  {
    question.pose = somePose();
    question.clearance = 0.1;
  }

  Answer answer() { return ask(question, input, obstacle); }

  std::vector<Eigen::Isometry3d> somePath() const { return {somePose(-1), somePose(-0.4), somePose(0.3)}; }

  TrajectoryRequest along() const
  {
    TrajectoryRequest request;
    request.clearance = *question.clearance;
    request.distances = request.first_poses = request.closest_poses = true;
    return request;
  }

  const Points scan{1, 1500, 1.0}, robot{2, 400, 0.5};
  const SphereHierarchy a{scan.view()}, b{robot.view()};
  Shape input = scan.shape("a"), obstacle = robot.shape("b");
  Question question;
};

TEST_F(Ask, NothingIsComputedThatNobodyWants)
{
  const Answer found = answer();
  EXPECT_THAT(found.collisions.flags, IsEmpty());
  EXPECT_THAT(found.distances.a.distance, IsEmpty());
  EXPECT_FALSE(found.closest.pair);
  EXPECT_EQ(found.work.node_pairs, 0u);
}

TEST_F(Ask, FlagsAtOnePose)
{
  question.wanted.flags = true;
  const FlagsResult expected = collisionFlags({a}, {b, question.pose}, within(*question.clearance));
  const Answer found = answer();
  EXPECT_EQ(found.collisions.flags, expected.a);
  EXPECT_EQ(found.collisions.colliding, expected.colliding_a);
  EXPECT_GT(expected.colliding_a, 50u);
  EXPECT_EQ(found.work.node_pairs, expected.work.node_pairs);
  EXPECT_THAT(found.obstacle_flags, IsEmpty());
  question.wanted.obstacle_flags = true;
  FlagsRequest both = within(*question.clearance);
  both.flagged = Flagged::both;
  EXPECT_EQ(answer().obstacle_flags, collisionFlags({a}, {b, question.pose}, both).b);
  question.wanted.flags = false;
  EXPECT_EQ(answer().obstacle_flags, collisionFlags({a}, {b, question.pose}, both).b);
  EXPECT_THAT(answer().collisions.flags, IsEmpty());
}

TEST_F(Ask, UncertaintiesAndTheirSigmas)
{
  question.wanted.flags = true;
  question.uncertainty = 0.03;
  question.obstacle_uncertainty = 0.01;
  PointsView uncertain = scan.view(), other = robot.view();
  uncertain.uncertainty = 0.03;
  other.uncertainty = 0.01;
  const FlagsResult expected = collisionFlags({SphereHierarchy(uncertain)}, {SphereHierarchy(other), question.pose},
                                              within(*question.clearance));
  const Answer found = answer();
  EXPECT_EQ(found.collisions.flags, expected.a);
  EXPECT_EQ(found.collisions.undecided, expected.undecided_a);
  EXPECT_GT(expected.undecided_a, 50u);

  struct Record {
    double x, y, z;
    float sigma;
  };
  std::vector<Record> records;
  for (const Point3& p : scan.places) records.push_back({p[0], p[1], p[2], 0.015f});
  const PointsView view = viewOf(&records[0].x, records.size(), sizeof(Record));
  input = Shape("a", view, {{"sigma", offsetof(Record, sigma), 7, 1}});
  question.uncertainty = Uncertainty("sigma", 1.0);
  question.sigmas = 2.0;
  question.obstacle_uncertainty = 0.01;
  const std::vector<float> twice(records.size(), 0.03f);
  uncertain.uncertainty = 0.0;
  uncertain.uncertainties = twice.data();
  EXPECT_EQ(
      answer().collisions.flags,
      collisionFlags({SphereHierarchy(uncertain)}, {SphereHierarchy(other), question.pose}, within(*question.clearance))
          .a);
}

TEST_F(Ask, DensityGuard)
{
  question.wanted.flags = true;
  question.density = true;
  for (const std::optional<double> gap : {std::optional<double>(), std::optional(0.05), std::optional(0.3)}) {
    question.widest_gap = gap;
    const double widest = gap.value_or(usualGap(b));
    const std::vector<float> spacings = patchSpacings(b, widest);
    FlagsRequest request;
    request.clearance = *question.clearance;
    request.spacings_of_b = spacings.data();
    const FlagsResult expected = collisionFlags({a}, {b, question.pose}, request);
    const Answer found = answer();
    EXPECT_EQ(found.collisions.flags, expected.a);
    EXPECT_EQ(found.sparse, expected.sparse_a);
    EXPECT_EQ(found.widest_gap, widest);
  }
}

TEST_F(Ask, AlongAPath)
{
  question.path = somePath();
  question.wanted.flags = question.wanted.contacts = question.wanted.poses = question.wanted.closest = true;
  for (const double swept : {0.0, 0.02}) {
    question.swept = swept;
    TrajectoryRequest request = along();
    request.pose_summaries = swept == 0.0;
    if (swept > 0.0) request.swept = swept;
    const TrajectoryResult expected = collideAlong({a}, b, *question.path, request);
    const Answer found = answer();
    EXPECT_EQ(found.collisions.flags, expected.flags);
    EXPECT_EQ(found.collisions.first_pose, expected.first_pose);
    EXPECT_EQ(found.collisions.closest_pose, expected.closest_pose);
    EXPECT_EQ(found.collisions.closest_point, expected.closest_point);
    EXPECT_EQ(found.collisions.poses.size(), 3u);
    EXPECT_EQ(found.pose_pairs.size(), 3u);
    ASSERT_TRUE(found.closest.pair);
    const std::uint32_t nearest = found.closest.pair->a;
    EXPECT_EQ(found.closest.distance, static_cast<double>(expected.distance[nearest]));
    EXPECT_EQ(found.closest.pair->b, expected.closest_point[nearest]);
    for (const float distance : expected.distance) EXPECT_FALSE(static_cast<double>(distance) < found.closest.distance);
  }
}

TEST_F(Ask, APathWithoutPosesCostsItsOneQuery)
{
  question.path = somePath();
  question.wanted.flags = question.wanted.contacts = question.wanted.closest = true;
  for (const double swept : {0.0, 0.02}) {
    question.swept = swept;
    TrajectoryRequest request = along();
    request.pose_summaries = false;
    if (swept > 0.0) request.swept = swept;
    const Answer found = answer();
    EXPECT_EQ(found.work.node_pairs, collideAlong({a}, b, *question.path, request).work.node_pairs);
    EXPECT_THAT(found.collisions.poses, IsEmpty());
    EXPECT_THAT(found.pose_pairs, IsEmpty());
  }
}

TEST_F(Ask, DistancesAlongAPath)
{
  question.path = somePath();
  question.clearance.reset();
  question.max_distance = 0.2;
  question.wanted.distances = true;
  TrajectoryRequest request;
  request.clearance = 0.2;
  request.flags = false;
  request.distances = request.closest_poses = true;
  const TrajectoryResult expected = collideAlong({a}, b, *question.path, request);
  const Answer found = answer();
  EXPECT_EQ(found.collisions.closest_pose, expected.closest_pose);
  EXPECT_THAT(found.collisions.flags, IsEmpty());
  question.max_distance.reset();
  EXPECT_THROW(answer(), InvalidOption);
}

TEST_F(Ask, TheClosestPairHoweverFar)
{
  question.wanted.closest = true;
  question.pose.translation().x() = 20;
  const DistanceResult expected = closestPair({a}, {b, question.pose});
  const Answer found = answer();
  EXPECT_EQ(found.closest.distance, expected.distance);
  ASSERT_TRUE(found.closest.pair == expected.pair);
  EXPECT_EQ(found.closest.interval.lower, expected.interval.lower);
}

TEST_F(Ask, BallsThatOverlapOnAPathHaveANegativeDistance)
{
  const Point3 here = {0, 0, 0}, there = {0.5, 0, 0};
  const float radius = 1.0f;
  PointsView ball = viewOf(here.data(), 1);
  ball.radii = &radius;
  input = Shape("a ball", ball);
  obstacle = Shape("a point", viewOf(there.data(), 1));
  question.path = {Eigen::Isometry3d::Identity()};
  question.wanted.closest = true;
  const Answer found = answer();
  EXPECT_EQ(found.closest.distance, -0.5);
  EXPECT_TRUE(found.closest.pair);
}

TEST_F(Ask, DistancesAndLimits)
{
  question.wanted.distances = question.wanted.both_ways = true;
  const SymmetricDistances expected = symmetricDistances({a}, {b, question.pose});
  EXPECT_EQ(answer().distances.hausdorff_pair, expected.hausdorff_pair);
  EXPECT_EQ(answer().distances.b.closest_point, expected.b.closest_point);

  question.wanted = {};
  question.wanted.distances = question.wanted.within = true;
  question.max_distance = 0.15;
  question.limits = {0.1, 0.4};
  const Answer found = answer();
  for (std::size_t i = 0; i < scan.places.size(); ++i) {
    const double distance = expected.a.distance[i];
    ASSERT_EQ(found.within[i], distance >= 0.1 && distance <= 0.4) << i;
    if (distance <= 0.15) {
      ASSERT_EQ(found.distances.a.distance[i], distance) << i;
    }
    else {
      ASSERT_TRUE(std::isnan(found.distances.a.distance[i])) << i;
    }
  }
}

/// Limits above and below the greatest distance that is told, and none: a distance is compared however great it is.
TEST_F(Ask, DistancesAreWithinAnyLimits)
{
  const std::vector<double> expected = pointDistances({a}, {b, question.pose}).distance;
  question.wanted.within = true;
  for (const DistanceLimits limits : {DistanceLimits(), {0.1, infinity}, {0.0, 0.2}, {0.3, 0.4}, {0.0, 0.0}})
    for (const std::optional<double> told : {std::optional<double>(), std::optional(0.15), std::optional(0.6)})
      for (const bool distances : {false, true}) {
        SCOPED_TRACE(testing::Message() << limits.least << ' ' << limits.most << ' ' << told.value_or(-1));
        question.limits = limits;
        question.max_distance = told;
        question.wanted.distances = distances;
        const Answer found = answer();
        for (std::size_t i = 0; i < expected.size(); ++i) {
          ASSERT_EQ(found.within[i], expected[i] >= limits.least && expected[i] <= limits.most) << i;
          if (distances) {
            ASSERT_EQ(std::isnan(found.distances.a.distance[i]), !(expected[i] <= told.value_or(infinity))) << i;
          }
        }
      }
}

TEST_F(Ask, LimitsThatNobodyAsksAboutChangeNoDistance)
{
  question.wanted.distances = true;
  question.max_distance = 0.15;
  const PointDistances expected = answer().distances.a;
  question.limits = {0.1, 0.4};
  const Answer found = answer();
  EXPECT_EQ(found.distances.a.measured, expected.measured);
  EXPECT_EQ(found.distances.a.closest_point, expected.closest_point);
  EXPECT_THAT(found.within, IsEmpty());
}

TEST_F(Ask, WhetherAnythingCollidesAndListsOfWhatDoes)
{
  question.wanted.any = true;
  Answer found = answer();
  const AnyResult any = anyCollision({a}, {b, question.pose}, {*question.clearance, {}});
  EXPECT_EQ(found.any.verdict, Verdict::colliding);
  EXPECT_EQ(found.any.pair, any.pair);
  EXPECT_EQ(found.work.node_pairs, any.work.node_pairs);
  for (const Flagged side : {Flagged::a, Flagged::b, Flagged::both}) {
    question.wanted = {};
    question.wanted.indices = side != Flagged::b;
    question.wanted.obstacle_indices = side != Flagged::a;
    const CollidingIndices lists = collidingIndices({a}, {b, question.pose}, {*question.clearance, side});
    found = answer();
    EXPECT_EQ(found.indices.a, lists.a);
    EXPECT_EQ(found.indices.b, lists.b);
    EXPECT_EQ(found.work.node_pairs, lists.work.node_pairs);
    EXPECT_TRUE(question.wanted.collisions());
  }
}

TEST_F(Ask, APoseIsSummedUpAsAPathOfOne)
{
  question.wanted.poses = true;
  const std::vector<PoseSummary> alone = answer().collisions.poses;
  question.path = {question.pose};
  question.wanted.flags = true;
  const Answer found = answer();
  ASSERT_EQ(alone.size(), 1u);
  EXPECT_EQ(alone[0].colliding_points, found.collisions.colliding);
  EXPECT_GT(alone[0].colliding_points, 50u);
  EXPECT_EQ(alone[0].distance, found.collisions.poses.at(0).distance);
}

/// An accuracy that stops early knows no distances: none is asked of the query, which would refuse it.
TEST_F(Ask, OfAPathThatStopsEarlyNothingIsClosest)
{
  question.path = somePath();
  question.wanted.flags = question.wanted.closest = true;
  question.accuracy = Accuracy::level(3);
  const Answer found = answer();
  EXPECT_GT(found.collisions.colliding + found.collisions.undecided, 0u);
  EXPECT_FALSE(found.closest.pair);
  question.accuracy = {};
  EXPECT_TRUE(answer().closest.pair);
}

/// Progress of all queries together, whichever are asked.
TEST_F(Ask, ProgressGoesFromNothingToAll)
{
  using Members = std::vector<bool Wanted::*>;
  for (const bool density : {false, true})
    for (const bool along : {false, true})
      for (const Members& members : {Members{&Wanted::flags},
                                     {&Wanted::closest},
                                     {&Wanted::distances},
                                     {&Wanted::within, &Wanted::closest},
                                     {&Wanted::any},
                                     {&Wanted::obstacle_indices, &Wanted::any},
                                     {&Wanted::indices},
                                     {&Wanted::flags, &Wanted::obstacle_flags, &Wanted::closest, &Wanted::distances},
                                     {&Wanted::flags, &Wanted::contacts, &Wanted::closest}}) {
        question.wanted = {};
        for (bool Wanted::*const member : members) question.wanted.*member = true;
        question.density = density;
        question.path.reset();
        if (along) question.path = somePath();
        question.max_distance = 5.0;
        input = scan.shape("a");
        obstacle = robot.shape("b"); // whose spacings nobody has measured
        double last = 0.0;
        question.progress = [&](double done) {
          EXPECT_GE(done, last);
          last = done;
          return true;
        };
        try {
          answer();
        }
        catch (const InvalidOption&) {
          continue; // they do not go together
        }
        EXPECT_EQ(last, 1.0) << density << along << ' ' << members.size();
      }
}

TEST_F(Ask, ContactsAloneTellWhichPointsCollide)
{
  question.path = somePath();
  question.wanted.contacts = true;
  const TrajectoryResult found = answer().collisions, expected = collideAlong({a}, b, *question.path, along());
  EXPECT_EQ(found.flags, expected.flags);
  EXPECT_EQ(found.colliding, expected.colliding);
  EXPECT_GT(found.colliding, 50u);
}

/// Where nobody needs all of them, they cost less.
TEST_F(Ask, FirstPosesAlone)
{
  question.path = somePath();
  question.wanted.first_poses = true;
  const Answer found = answer();
  EXPECT_EQ(found.collisions.first_pose, collideAlong({a}, b, *question.path, along()).first_pose);
  EXPECT_THAT(found.collisions.distance, IsEmpty());
  EXPECT_THAT(found.collisions.flags, IsEmpty());
}

/// The product of the poses would be rounded: a point that touches would be free, or the other way round.
TEST_F(Ask, PosesInAWorldAreThoseOfTheQuery)
{
  question.pose_of_input = somePose(0.7);
  question.wanted.flags = question.wanted.obstacle_flags = true;
  question.wanted.distances = question.wanted.within = true;
  const Placed input_there(a, question.pose_of_input), obstacle_there(b, question.pose);
  const PointDistances distances = pointDistances(input_there, obstacle_there);
  question.limits.most = question.clearance.emplace(distances.distance[0]); // touches
  const Answer found = answer();
  FlagsRequest request = within(*question.clearance);
  request.flagged = Flagged::both;
  const FlagsResult expected = collisionFlags(input_there, obstacle_there, request);
  EXPECT_EQ(found.collisions.flags, expected.a);
  EXPECT_EQ(found.obstacle_flags, expected.b);
  EXPECT_EQ(found.distances.a.closest_point, distances.closest_point);
  EXPECT_EQ(found.within, numbersOf(expected.a));
  question.wanted = {};
  question.wanted.flags = true;
  question.path = somePath();
  EXPECT_EQ(answer().collisions.flags, collideAlong(input_there, b, somePath(), along()).flags);
}

TEST_F(Ask, DistancesThatStopEarly)
{
  question.wanted.distances = true;
  question.accuracy = Accuracy::level(1);
  EXPECT_THROW(answer(), InvalidOption);
  question.wanted.intervals = true;
  PointDistancesRequest request;
  request.accuracy = question.accuracy;
  const PointDistances expected = pointDistances({a}, {b, question.pose}, request);
  const Answer found = answer();
  EXPECT_GT(expected.undecided, 0u);
  EXPECT_EQ(found.distances.a.undecided, expected.undecided);
  EXPECT_EQ(found.distances.a.interval.size(), scan.places.size());
}

/// A square of two triangles.
class AskOfSurfaces : public Ask {
protected:
  AskOfSurfaces() { question.pose = Eigen::Isometry3d::Identity(); }

  Shape square(const std::string& name) const { return {name, viewOf(view)}; }

  /// Distance of a point from the square.
  static double distanceOf(const Point3& p)
  {
    return std::hypot(std::max(std::abs(p[0]) - 1.0, 0.0), std::max(std::abs(p[1]) - 1.0, 0.0), p[2]);
  }

  const std::vector<Point3> corners = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 2, 3}};
  const TrianglesView view{viewOf(corners[0].data(), corners.size()), triangles[0].data(), triangles.size()};
};

TEST_F(AskOfSurfaces, AsObstacleIsAllOfItsTriangles)
{
  question.wanted.flags = question.wanted.closest = true;
  obstacle = square("square");
  EXPECT_TRUE(obstacle.isSurface());
  const Answer found = answer();
  double least = infinity;
  for (std::size_t i = 0; i < scan.places.size(); ++i) {
    const double distance = distanceOf(scan.places[i]);
    if (std::abs(distance - 0.1) > 1e-12) {
      ASSERT_EQ(found.collisions.flags[i], distance < 0.1 ? Verdict::colliding : Verdict::free) << i;
    }
    least = std::fmin(least, distance);
  }
  EXPECT_DOUBLE_EQ(found.closest.distance, least);
  EXPECT_LT(found.closest.pair->b, 2u) << "a triangle";
}

TEST_F(AskOfSurfaces, LimitsAreComparedExactlyWithDistancesOfTriangles)
{
  // Distances of exactly 0.25, of the next double above, and of a corner: 5/4 by 3 and 4 quarters.
  const std::vector<Point3> places = {{0.3, 0.2, 0.25}, {0.3, 0.2, std::nextafter(0.25, 1.0)}, {1.75, 2, 0}};
  input = Shape("points", viewOf(places[0].data(), places.size()));
  obstacle = square("square");
  question.wanted.within = true;
  question.limits = {0.0, 0.25};
  EXPECT_EQ(answer().within, (std::vector<std::uint8_t>{1, 0, 0}));
  question.limits = {0.25, 1.25};
  EXPECT_EQ(answer().within, (std::vector<std::uint8_t>{1, 1, 1}));
  question.limits = {std::nextafter(0.25, 1.0), std::nextafter(1.25, 0.0)};
  EXPECT_EQ(answer().within, (std::vector<std::uint8_t>{0, 1, 0}));
}

TEST_F(AskOfSurfaces, AsInputIsFlaggedByTriangles)
{
  const std::vector<Point3> places = {{0.5, -0.5, 0.25}, {9, 9, 9}};
  const PointsView points = viewOf(places[0].data(), places.size());
  input = square("square");
  obstacle = Shape("points", points);
  question.clearance = 0.25;
  question.wanted.flags = question.wanted.closest = true;
  Answer found = answer();
  EXPECT_EQ(found.collisions.flags, test::verdictsOf({1, 0}));
  EXPECT_EQ(found.collisions.colliding, 1u);
  EXPECT_EQ(found.closest.distance, 0.25);
  EXPECT_EQ(found.closest.pair->a, 0u);
  question.wanted = {};
  question.wanted.distances = question.wanted.within = true;
  question.limits = {0.0, 0.25};
  found = answer();
  ASSERT_EQ(found.distances.a.distance.size(), 2u);
  EXPECT_EQ(found.distances.a.distance[0], 0.25);
  EXPECT_NEAR(found.distances.a.distance[1], std::sqrt(0.5 + 0.0625), 1e-15);
  EXPECT_EQ(found.within, (std::vector<std::uint8_t>{1, 0}));
  question.wanted = {};
  question.wanted.flags = question.wanted.contacts = true;
  EXPECT_EQ(answer().collisions.first_pose, (std::vector<std::int32_t>{0, -1}));
}

TEST_F(AskOfSurfaces, RefuseWhatIsAboutPoints)
{
  const auto refusal = [&] {
    try {
      answer();
    }
    catch (const InvalidInput& error) {
      return optionOf(error, question) + "|" + error.what();
    }
    return std::string();
  };
  question.wanted.flags = true;
  input = square("crate.off");
  EXPECT_EQ(refusal(), "");
  question.density = true;
  EXPECT_THAT(refusal(), HasSubstr("density|density: is about points, and crate.off is a surface"));
  question.density = false;
  question.seen = true;
  EXPECT_THAT(refusal(), HasSubstr("seen|seen: is about points, and crate.off is a surface"));
  question.seen = false;
  question.uncertainty = Uncertainty("sigma", 1.0);
  EXPECT_THAT(refusal(), HasSubstr("crate.off: is a surface, which has no field 'sigma': give a length"));
  question.uncertainty = 0.0;
  input = scan.shape("a");
  obstacle = square("crate.off");
  question.density = true;
  EXPECT_EQ(answer().warnings.at(0).text, "crate.off: is a surface, which has no holes: density guards nothing");
}

TEST_F(Ask, WarnsAsTheFactsDo)
{
  question.wanted.flags = question.wanted.spacings = true;
  question.clearance = 0.001;
  Answer found = answer();
  ASSERT_EQ(found.warnings.size(), 3u);
  EXPECT_EQ(found.warnings[0].text, "a: 1 of 1500 points is not finite: it is left out");
  EXPECT_THAT(found.warnings[2].text, HasSubstr("apart in a and "));
  EXPECT_EQ(found.density.input->median, spacingOf(a).median);
  question.pose.translation().x() = 1e6;
  EXPECT_THAT(answer().warnings.at(2).text, HasSubstr("the boxes of a and of b"));
  obstacle = Shape("none", PointsView());
  EXPECT_THAT(answer().warnings.at(1).text, HasSubstr("none: has no finite point: nothing collides with it"));
  question.clearance.reset();
  question.wanted = {};
  question.wanted.distances = true;
  EXPECT_THAT(answer().warnings.at(1).text, HasSubstr("none: has no finite point: nothing has a distance from it"));
}

/// Distances are compared with their limits, as collisions are with the clearance.
TEST_F(Ask, WarnsOfCoarseCoordinatesForLimits)
{
  std::vector<float> far;
  for (int i = 0; i < 60; ++i) far.push_back(500000.0f + static_cast<float>(i));
  const PointsView view = viewOf(far.data(), 20);
  input = Shape("utm", view);
  obstacle = Shape("utm", view);
  question = {};
  question.wanted.distances = question.wanted.within = true;
  EXPECT_THAT(answer().warnings, IsEmpty());
  question.limits = {0.0, 0.1};
  ASSERT_EQ(answer().warnings.size(), 1u) << "of both the same";
  EXPECT_THAT(answer().warnings[0].text, HasSubstr("lie 0.03125 apart, coarse for a limit of 0.1"));
  question.limits = {};
  question.max_distance = 0.2;
  EXPECT_THAT(answer().warnings.at(0).text, HasSubstr("coarse for a limit of 0.2"));
}

TEST_F(Ask, CheckRefusesBeforeAnythingIsThere)
{
  const auto option = [&] {
    try {
      check(question);
    }
    catch (const InvalidInput& error) {
      return optionOf(error, question);
    }
    return std::string();
  };
  question.wanted.flags = true;
  EXPECT_EQ(option(), "");
  question.accuracy = Accuracy::tolerance(-1);
  EXPECT_EQ(option(), "accuracy");
  question.accuracy = Accuracy::level(1);
  question.path = somePath();
  EXPECT_EQ(option(), "");
  question.wanted.contacts = true;
  EXPECT_EQ(option(), "accuracy");
  question.accuracy = {};
  question.uncertainty = Uncertainty("of nothing", 1.0);
  EXPECT_EQ(option(), "") << "fields are known with the clouds";
  question.sigmas = 2.0;
  EXPECT_EQ(option(), "");
  question.sigmas = -1.0;
  EXPECT_EQ(option(), "sigmas");
  question.sigmas = 1.0;
  question.progress = [](double) { return false; };
  question.wanted.spacings = question.seen = question.solid = question.input_solid = true;
  question.seen_angle = 0.1;
  EXPECT_EQ(option(), "") << "so are scanners and faces; and nothing is asked that could be cancelled";
  question.seen = false;
  EXPECT_EQ(option(), "seen_angle");
  question.seen_angle.reset();
  question.path->at(1).linear() *= 2;
  EXPECT_EQ(option(), "path");
  question.path.reset();
  question.pose.linear() *= 2;
  EXPECT_EQ(option(), "pose");
}

TEST_F(Ask, CanBeCancelled)
{
  question.wanted.distances = true;
  question.progress = [](double) { return false; };
  EXPECT_THROW(answer(), Cancelled);
  question.progress = nullptr;
  EXPECT_EQ(answer().distances.a.closest_point, pointDistances({a}, {b, question.pose}).closest_point);
}

TEST(CheckQuestion, AcceptsNegativeLimitsOfSolids)
{
  Question question;
  question.solid = true;
  question.wanted.within = true;
  question.limits = {-0.5, 0.1};
  EXPECT_NO_THROW(check(question));
  question.solid = false;
  EXPECT_THROW(check(question), InvalidOption);
}

} // namespace
} // namespace pcl_bsh

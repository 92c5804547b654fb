// SPDX-License-Identifier: BSD-3-Clause
// Ways, not only where they end: what responses and first contacts claim is replayed at many instants.
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/scene/scene.h>

#include "scene_worlds.h"
#include "watched_motion.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace pcl_bsh {
namespace {

using test::at;
using test::joined;
using test::Random;
using test::sheet;
using test::Shelf;
using test::WatchedMotion;
using testing::HasSubstr;

constexpr double pi = std::numbers::pi, speeds[] = {0.3, 2.0, 3.5, 2 * pi, 15.0};

SceneOptions responding(Response response, double clearance, double tolerance = 1e-4)
{
  SceneOptions options;
  options.effects.response = response;
  options.clearance = clearance;
  options.tolerance = tolerance;
  return options;
}

SceneOptions timeOfContact(double clearance, double tolerance)
{
  SceneOptions options;
  options.effects.first_contact = options.effects.swept = true;
  options.clearance = clearance;
  options.tolerance = tolerance;
  return options;
}

/// Steps, and replays what was claimed. @return what is wrong
std::string watchedStep(Scene& scene, double dt, int instants = 1000)
{
  WatchedMotion watch(scene);
  const SceneResult result = scene.step(dt);
  return scene.options().effects.response != Response::none ? watch.replayResponses(result, instants)
                                                            : watch.replayFirstContacts(result, instants);
}

TEST(SceneMotion, ASlideMeetsWhatStandsBesideTheStraightWay)
{
  int slid = 0;
  for (int degrees = 20; degrees <= 70; degrees += 10)
    for (int i = 0; i < 16; ++i) {
      const double along = 0.15 + 0.05 * i, angle = degrees * pi / 180;
      SCOPED_TRACE(std::to_string(degrees) + " degrees, plate at " + std::to_string(along));
      const Eigen::Vector3d slope(std::cos(angle), 0, std::sin(angle)), up(-std::sin(angle), 0, std::cos(angle));
      const auto point = [](const Eigen::Vector3d& p) { return Point3{p.x(), p.y(), p.z()}; };
      const double fine = i % 2 == 0 ? 0.02 : 0.03; // few points to follow, or so many that the way is cut in portions
      const auto n = static_cast<int>(std::lround(0.72 / fine));
      const Eigen::Vector3d low = Eigen::Vector3d(1, -0.36, 0) - 0.8 * slope;
      Shelf shelf;
      Scene scene(responding(Response::slide, 0.05));
      scene.add(fixedObject("slope", shelf.add(sheet(point(low), point(fine * slope), {0, fine, 0}, 10 * n / 3, n))));
      const Eigen::Vector3d corner = Eigen::Vector3d(1, -0.2, 0) + along * slope;
      scene.add(fixedObject("plate", shelf.add(sheet(point(corner), {0, 0.02, 0}, point(0.02 * up), 21, 21))));
      SceneObject ball = object("ball", shelf.add({{0, 0, 0}}), at(0, 0, 0));
      ball.motion = VelocityMotion{{3, 0, 0}};
      const ObjectId id = scene.add(ball);
      EXPECT_EQ(watchedStep(scene, 1, 400), "");
      const Eigen::Vector3d end = scene[id].pose.translation();
      ASSERT_LT(std::abs(end.y()), 0.2) << "it went round the plate";
      const double reached = (end - Eigen::Vector3d(1, 0, 0)).dot(slope);
      EXPECT_LT(reached, along - 0.05 + 0.0025); // between its points, the plate is dented
      slid += reached > 0.05;
    }
  EXPECT_GT(slid, 60) << "hardly any slid";
}

/// From (-1, 0) to (1, 0). Turning, it meets a point at (0, 0.9) when an end is within 0.2: |(cos t, sin t) - (0,
/// 0.9)|.
SceneObject bar(Shelf& shelf, const Motion& motion)
{
  auto points = sheet({-0.6, 0, 0}, {0.1, 0, 0}, {0, 0, 0.1}, 13, 1);
  points.insert(points.end(), {{-1, 0, 0}, {1, 0, 0}});
  SceneObject arm = object("arm", shelf.add(points));
  arm.motion = motion;
  return arm;
}

const double bar_contact = std::asin((1 + 0.81 - 0.04) / 1.8); // radians

TEST(SceneMotion, ACircleBeginsWhereTheObjectStandsAndTurnsItIfItIsToBe)
{
  const CircularMotion circle{{1, 0, 0}, {0, 0, 2}, 0.5 * pi, false}; // a quarter of a turn in a second
  const Eigen::Isometry3d start = at(3, 0, 5);
  EXPECT_TRUE(poseAt(circle, start, 0).isApprox(start, 1e-14));
  EXPECT_TRUE(poseAt(circle, start, 1).isApprox(at(1, 2, 5), 1e-14));
  CircularMotion turning = circle;
  turning.turning = true;
  const Eigen::Isometry3d turned = at(1, 2, 5) * Eigen::AngleAxisd(0.5 * pi, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(poseAt(turning, start, 1).isApprox(turned, 1e-14));
}

TEST(SceneMotion, WaypointsStandBeforeTheFirstAndAfterTheLast)
{
  const WaypointMotion motion{{1, 2, 4}, {at(1, 0, 0), at(2, 0, 0), at(2, 8, 0)}};
  for (const auto& [time, expected] : {std::pair(-1.0, at(1, 0, 0)),
                                       {1.0, at(1, 0, 0)},
                                       {1.25, at(1.25, 0, 0)},
                                       {2.0, at(2, 0, 0)},
                                       {2.5, at(2, 2, 0)},
                                       {4.0, at(2, 8, 0)},
                                       {9.0, at(2, 8, 0)}})
    EXPECT_EQ(poseAt(motion, at(7, 7, 7), time).matrix(), expected.matrix()) << time;
}

/// Poses that are just rigid enough stay as they are given; those between are of their nearest rotations.
TEST(SceneMotion, WaypointsAreTakenAsTheyAreGiven)
{
  std::vector<Eigen::Isometry3d> poses(3, at(1, 2, 3));
  for (Eigen::Isometry3d& pose : poses) pose.linear()(0, 1) = 1e-6;
  const WaypointMotion motion{{1, 2, 4}, poses};
  for (const double time : {1.0, 2.0, 4.0})
    EXPECT_EQ(poseAt(motion, at(7, 7, 7), time).matrix(), poses[0].matrix()) << time;
  EXPECT_NE(poseAt(motion, at(7, 7, 7), 1.5).matrix(), poses[0].matrix());
}

TEST(SceneMotion, WhatDoesNotTurnTurnsByNothing)
{
  EXPECT_EQ(turnOf(NoMotion{}, 0, 3), Eigen::Vector3d::Zero());
  EXPECT_EQ(poseAt(NoMotion{}, at(1, 2, 3), 5).matrix(), at(1, 2, 3).matrix());
  const CircularMotion gondola{{0, 0, 0}, {0, 0, 2}, 0.5, false};
  EXPECT_EQ(turnOf(gondola, 0, 3), Eigen::Vector3d::Zero());
  EXPECT_EQ(turnOf(VelocityMotion{{1, 0, 0}, {0, 0, 0.5}}, 1, 3), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(turnOf(CircularMotion{{0, 0, 0}, {0, 0, 2}, 0.5, true}, 1, 3), Eigen::Vector3d(0, 0, 1));
}

TEST(SceneMotion, SaysWhatOfAMotionMakesNoSense)
{
  const auto refusal = [](const Motion& motion) -> std::string {
    try {
      check(motion);
    }
    catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  };
  const Eigen::Isometry3d pose = at(1, 2, 3);
  EXPECT_EQ(refusal(NoMotion{}), "");
  EXPECT_EQ(refusal(VelocityMotion{{1, 2, 3}, {4, 5, 6}}), "");
  EXPECT_EQ(refusal(CircularMotion{{1, 2, 3}, {0, 0, 9}, -1, true}), "");
  EXPECT_EQ(refusal(WaypointMotion{{-1, 2}, {pose, pose}}), "");
  for (const double wrong : {std::nan(""), static_cast<double>(INFINITY)}) {
    for (const Motion& motion :
         {Motion(VelocityMotion{{0, wrong, 0}, {0, 0, 0}}), Motion(VelocityMotion{{0, 0, 0}, {0, 0, wrong}})})
      EXPECT_THAT(refusal(motion), HasSubstr("a velocity is not finite"));
    for (const Motion& motion : {Motion(CircularMotion{{wrong, 0, 0}, {0, 0, 1}, 1, true}),
                                 Motion(CircularMotion{{0, 0, 0}, {0, 0, 1}, wrong, true})})
      EXPECT_THAT(refusal(motion), HasSubstr("a circle's centre or speed is not finite"));
    EXPECT_THAT(refusal(CircularMotion{{0, 0, 0}, {0, 0, wrong}, 1, true}), HasSubstr("a circle's axis is not finite"));
    EXPECT_THAT(refusal(WaypointMotion{{wrong}, {pose}}), HasSubstr("of waypoint 0 does not ascend"));
  }
  EXPECT_THAT(refusal(CircularMotion{{0, 0, 0}, {0, 0, 0}, 1, true}), HasSubstr("or of length 0"));
  EXPECT_THAT(refusal(WaypointMotion{}), HasSubstr("waypoints without a pose"));
  EXPECT_THAT(refusal(WaypointMotion{{1, 2}, {pose}}), HasSubstr("1 waypoint for 2 times"));
  EXPECT_THAT(refusal(WaypointMotion{{1}, {pose, pose}}), HasSubstr("2 waypoints for 1 time"));
  EXPECT_THAT(refusal(WaypointMotion{{1, 1}, {pose, pose}}), HasSubstr("time 1 of waypoint 1 does not ascend"));
  Eigen::Isometry3d scaled = pose;
  scaled.linear() *= 2;
  EXPECT_THAT(refusal(WaypointMotion{{1, 2}, {pose, scaled}}), HasSubstr("waypoint 1"));
}

TEST(SceneMotion, TurnsByAnyAngleWithinAStep)
{
  for (const double speed : {3.0, 3.5, pi, 2 * pi, 7.0, 4 * pi, 20.0, 200 * pi, -3.5, -2 * pi, -9.0}) {
    SCOPED_TRACE(speed);
    for (const bool circle : {false, true}) {
      Shelf shelf;
      Scene scene(timeOfContact(0.2, 1e-6));
      scene.add(bar(shelf, circle ? Motion(CircularMotion{{0, 0, 0}, {0, 0, 1}, speed, true})
                                  : Motion(VelocityMotion{{0, 0, 0}, {0, 0, speed}})));
      scene.add(fixedObject("pole", shelf.add({{0, 0.9, 0}})));
      scene.query();
      WatchedMotion watch(scene);
      const SceneResult result = scene.step(1);
      ASSERT_EQ(result.first_contact.size(), 1u);
      EXPECT_NEAR(result.first_contact[0].fraction, bar_contact / std::abs(speed), 1e-5 / std::abs(speed));
      EXPECT_EQ(watch.replayFirstContacts(result, 1000), "");
    }
  }
}

TEST(SceneMotion, AnArmStopsAndSlidesAtWhatItMeetsInAFullTurn)
{
  for (const Response response : {Response::stop, Response::slide})
    for (const double speed : {3.5, 2 * pi, 30.0}) {
      SCOPED_TRACE(speed);
      Shelf shelf;
      Scene scene(responding(response, 0.2));
      const ObjectId arm = scene.add(bar(shelf, VelocityMotion{{0, 0, 0}, {0, 0, speed}}));
      scene.add(fixedObject("pole", shelf.add({{0, 0.9, 0}})));
      EXPECT_EQ(watchedStep(scene, 1), "");
      const Eigen::Vector3d end = scene[arm].pose * Eigen::Vector3d(1, 0, 0);
      EXPECT_NEAR(std::atan2(end.y(), end.x()), bar_contact, 1e-3);
      EXPECT_EQ(watchedStep(scene, 1), "");
    }
}

TEST(SceneMotion, WaypointsWithinAStepAddUpTheirTurns)
{
  Shelf shelf;
  Scene scene(timeOfContact(0.2, 1e-6));
  const auto turned = [](double angle) {
    return Eigen::Isometry3d(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  };
  WaypointMotion round;
  for (int i = 0; i <= 3; ++i) {
    round.times.push_back(i);
    round.poses.push_back(turned(2 * pi / 3 * i));
  }
  round.poses.back() = round.poses.front(); // back at the very pose it came from
  EXPECT_NEAR(turnOf(round, 0, 3).z(), 2 * pi, 1e-12);
  EXPECT_NEAR(turnOf(round, -1, 0.5).z(), pi / 3, 1e-12);
  EXPECT_NEAR(turnOf(round, 2.5, 9).z(), pi / 3, 1e-12);
  EXPECT_EQ(turnOf(round, 4, 9).norm(), 0.0);
  scene.add(bar(shelf, round));
  scene.add(fixedObject("pole", shelf.add({{0, 0.9, 0}})));
  scene.query();
  const SceneResult result = scene.step(3);
  ASSERT_EQ(result.first_contact.size(), 1u);
  EXPECT_NEAR(result.first_contact[0].fraction, bar_contact / (2 * pi), 1e-6);
}

TEST(SceneMotion, AUsersPoseTurnsTheShorterWayAndAMotionGoesOnFromThere)
{
  Shelf shelf;
  Scene scene(timeOfContact(0.2, 1e-6));
  const ObjectId arm = scene.add(bar(shelf, VelocityMotion{{0, 0, 0}, {0, 0, 2 * pi}}));
  scene.query();
  scene.setPose(arm, Eigen::Isometry3d(Eigen::AngleAxisd(-2.0, Eigen::Vector3d::UnitZ())));
  SceneResult result = scene.query();
  ASSERT_EQ(result.swept_motions.size(), 1u);
  EXPECT_NEAR(result.swept_motions[0].leg.turn.z(), -2.0, 1e-12);
  scene.setPose(arm, Eigen::Isometry3d::Identity());
  result = scene.step(1); // 2 radians to the pose set, then once around
  ASSERT_EQ(result.swept_motions.size(), 1u);
  EXPECT_NEAR(result.swept_motions[0].leg.turn.z(), 2 * pi + 2.0, 1e-9);
  scene.setMotion(arm, VelocityMotion{{0, 0, 0}, {0, 0, -1}});
  result = scene.step(1);
  ASSERT_EQ(result.swept_motions.size(), 1u);
  EXPECT_NEAR(result.swept_motions[0].leg.turn.z(), -1.0, 1e-12);
  EXPECT_TRUE(scene.query().swept_motions.empty());
}

/// Where it was when it began, it stands, and goes on from there as if nobody had asked.
TEST(SceneMotion, AStepThatIsCancelledIsNotMade)
{
  for (const Response response : {Response::none, Response::slide}) {
    Shelf shelf;
    SceneOptions options = responding(response, 0.1);
    options.effects.any = options.effects.first_contact = true;
    bool goes_on = true;
    options.progress = [&](double) { return goes_on; };
    Scene scene(options), twin(responding(response, 0.1));
    const auto points = shelf.add({{0, 0, 0}});
    for (Scene* const each : {&scene, &twin}) {
      SceneObject mover = object("mover", points);
      mover.motion = VelocityMotion{{1, 0, 0}, {0, 0, 1}};
      each->add(mover);
      each->add(fixedObject("at rest", points, at(9, 0, 0)));
      each->add(object("set", points, at(0, 9, 0)));
      each->step(0.5);
    }
    goes_on = false;
    for (int i = 0; i < 2; ++i) {
      EXPECT_THROW(scene.step(0.5), Cancelled);
      EXPECT_EQ(scene.time(), 0.5);
      for (ObjectId id = 0; id < 3; ++id) EXPECT_EQ(scene[id].pose.matrix(), twin[id].pose.matrix()) << id;
    }
    goes_on = true;
    const SceneResult found = scene.step(0.25);
    EXPECT_EQ(found.time, 0.75);
    EXPECT_EQ(found.unswept.empty(), response == Response::none) << "who slides turns first";
    ASSERT_EQ(found.swept_motions.size(), 1u);
    EXPECT_NEAR(found.swept_motions[0].leg.turn.z(), 0.25, 1e-12);
    twin.step(0.25);
    EXPECT_EQ(scene[0].pose.matrix(), twin[0].pose.matrix());
  }
}

TEST(SceneMotion, RefusesWaysOnWhichItsPromisesCannotBeKept)
{
  Shelf shelf;
  for (const bool respond : {false, true}) {
    Scene scene(respond ? responding(Response::stop, 0.2) : timeOfContact(0.2, 1e-4));
    const ObjectId arm = scene.add(bar(shelf, VelocityMotion{{1, 0, 0}, {0, 0, 2e6 * pi}}));
    const Eigen::Isometry3d before = scene[arm].pose;
    EXPECT_THROW(scene.step(1), std::invalid_argument); // a million turns
    EXPECT_EQ(scene[arm].pose.matrix(), before.matrix());
    EXPECT_EQ(scene.time(), 0.0);
    EXPECT_NO_THROW(scene.step(1e-3)); // a thousand
    scene.setMotion(arm, VelocityMotion{{1e12, 0, 0}, {0, 0, 0}});
    EXPECT_THROW(scene.step(1), std::invalid_argument);
    scene.setMotion(arm, VelocityMotion{{1e200, 0, 0}, {0, 0, 0}});
    EXPECT_THROW(scene.step(1), std::invalid_argument);
    scene.setMotion(arm, VelocityMotion{{1, 0, 0}, {0, 0, 0}});
    scene.setPose(arm, at(1e12, 0, 0));
    EXPECT_THROW(scene.step(1), std::invalid_argument);
    if (!respond) {
      EXPECT_THROW(scene.query(), std::invalid_argument);
    }
    scene.setPose(arm, at(3, 0, 0));
    EXPECT_NO_THROW(scene.step(1));
  }
  SceneOptions options; // without effects that look at ways, any motion goes
  options.effects.any = true;
  Scene scene(options);
  scene.add(bar(shelf, VelocityMotion{{1e12, 0, 0}, {0, 0, 2e6 * pi}}));
  EXPECT_NO_THROW(scene.step(1));
}

TEST(SceneMotion, RefusesPartsWhosePoseIsOnlyTogetherWithTheObjectsNotRigid)
{
  Shelf shelf;
  Eigen::Isometry3d almost = Eigen::Isometry3d::Identity(), rather = almost;
  almost.linear() *= 1 + 2.5e-7;
  rather.linear() *= 1 + 1e-8;
  for (const Response response : {Response::none, Response::stop}) {
    Scene scene(responding(response, 0.1));
    SceneObject object = bar(shelf, VelocityMotion{{1, 0, 0}, {0, 0, 1}});
    object.parts[0].pose = object.pose = almost;
    EXPECT_THROW(scene.add(object), std::invalid_argument);
    object.pose = rather;
    scene.add(object);
    EXPECT_THROW(scene.setPose(0, almost), std::invalid_argument);
    scene.setMotion(0, WaypointMotion{{0, 1}, {rather, almost}});
    if (response == Response::none) continue; // with nothing to look at, nobody asks
    EXPECT_THROW(scene.step(1), std::invalid_argument);
    EXPECT_EQ(scene[0].pose.matrix(), rather.matrix());
    EXPECT_NO_THROW(scene.step(0.25));
  }
}

TEST(SceneMotion, ARingTurnsAboutAShaftInFewSteps)
{
  // Points of the ring stay just outside of the zone, or within it from the start, for three turns.
  for (const double gap : {2e-9, 0.6e-9, 0.51e-9, 0.3e-9, 0.26e-9}) {
    SCOPED_TRACE(gap);
    Shelf shelf;
    std::vector<Point3> ring;
    for (int i = 0; i < 24; ++i) ring.push_back({std::cos(i * pi / 12), std::sin(i * pi / 12), 0.0});
    const auto shaft = shelf.add({{0, 0, 0}});
    for (const bool respond : {false, true}) {
      SceneOptions options = respond ? responding(Response::stop, 1 - gap, 1e-9) : timeOfContact(1 - gap, 1e-9);
      Scene scene(options);
      SceneObject turning = object("ring", shelf.add(ring));
      turning.motion = VelocityMotion{{0, 0, 0}, {0, 0, 6 * pi}};
      scene.add(turning);
      scene.add(fixedObject("shaft", shaft));
      EXPECT_EQ(watchedStep(scene, 1, 100), "");
    }
  }
}

// --- random worlds ---

/// Movers of a few points among fixed plates, rods and rocks, some in corners, some next to touching.
class Walk {
public:
  Walk(std::uint64_t seed, double away) : random(seed), shift(away, -away, 0.5 * away) {}

  Scene scene(const SceneOptions& options, bool turning)
  {
    Scene made(options);
    const int fixed = random.integer(1, 15);
    for (int i = 0; i < fixed; ++i) {
      std::vector<Point3> points;
      const double fine = random.uniform(0.03, 0.3);
      const int kind = random.chance(0.1) ? 4 : random.integer(0, 3);
      if (kind == 0) points = sheet({-0.5, -0.5, 0}, {fine, 0, 0}, {0, fine, 0}, 6, 6);
      if (kind == 1) points = sheet({0, 0, -1}, {0, 0, fine}, {0, 0, 0}, 12, 1);
      if (kind == 2) points = test::makePoints(shape(), 25, 0.4, random);
      if (kind == 3) // a corner
        points = joined(joined(sheet({0, 0, 0}, {fine, 0, 0}, {0, fine, 0}, 4, 4),
                               sheet({0, 0, 0}, {fine, 0, 0}, {0, 0, fine}, 4, 4)),
                        sheet({0, 0, 0}, {0, fine, 0}, {0, 0, fine}, 4, 4));
      if (kind == 4) points = sheet({-0.6, -0.6, 0}, {0.03, 0, 0}, {0, 0.03, 0}, 40, 40);
      made.add(fixedObject("fixed " + std::to_string(i), cloud(points), moved(random.pose(1.2))));
    }
    const int movers = random.integer(1, 5);
    for (int i = 0; i < movers; ++i) {
      const auto count = static_cast<std::size_t>(random.chance(0.1) ? 40 : random.integer(1, 12));
      std::vector<Point3> points = test::makePoints(test::Shape::uniform, count, 0.3, random);
      SceneObject mover = object("mover " + std::to_string(i), cloud(points), moved(random.pose(2.0)));
      if (random.chance(0.3)) mover.parts.push_back({"arm", shelf.add(points), at(0.3, 0, 0)});
      const Eigen::Vector3d toward = shift - mover.pose.translation() + direction(0.5);
      VelocityMotion motion{random.uniform(0.3, 2) * toward, Eigen::Vector3d::Zero()};
      if (turning && random.chance(0.8)) motion.angular = random.pick(speeds) * direction(1);
      mover.motion = motion;
      made.add(mover);
    }
    return made;
  }

  Random random;

private:
  test::Shape shape() // without outliers, which are anywhere
  {
    return test::all_shapes[static_cast<std::size_t>(random.integer(0, 6))];
  }

  std::shared_ptr<SphereHierarchy> cloud(const std::vector<Point3>& points)
  {
    test::Cloud made(points, {random.chance(0.5) ? Scalar::float32 : Scalar::float64, 0, 0});
    if (random.chance(0.2)) {
      std::vector<float> radii(points.size());
      for (float& radius : radii) radius = static_cast<float>(random.uniform(0, 0.05));
      made.setRadii(radii);
    }
    return shelf.add(std::move(made));
  }

  Eigen::Vector3d direction(double size)
  {
    const Point3 p = random.point([&] { return random.uniform(-size, size); });
    return {p[0], p[1], p[2]};
  }

  Eigen::Isometry3d moved(Eigen::Isometry3d pose) const
  {
    pose.translation() += shift;
    return pose;
  }

  Shelf shelf;
  Eigen::Vector3d shift;
};

constexpr double far_away[] = {0.0, 0.0, 300.0, 1e5}, tolerances[] = {1e-3, 1e-4, 1e-6};

TEST(SceneMotion, ResponsesCollideAtNoInstant)
{
  int touched = 0, legs = 0, bent = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Walk course(seed, far_away[seed % 4]);
    SceneOptions options =
        responding(seed % 3 == 0 ? Response::stop : Response::slide,
                   course.random.chance(0.2) ? 0.0 : course.random.uniform(0.01, 0.2), course.random.pick(tolerances));
    if (seed % 5 == 0) options.effects.gravity = Gravity{0.2, {0, 0, -1}};
    Scene scene = course.scene(options, seed % 2 == 0);
    for (int step = 0; step < 3; ++step) {
      WatchedMotion watch(scene);
      const SceneResult result = scene.step(0.7);
      ASSERT_EQ(watch.replayResponses(result, 1000), "") << "step " << step;
      for (const Outcome& outcome : result.outcomes) {
        touched += outcome.touched && !outcome.stuck;
        legs += static_cast<int>(outcome.legs.size());
        bent += outcome.legs.size() > 1;
      }
    }
  }
  EXPECT_GT(touched, 60);
  EXPECT_GT(legs, 200);
  EXPECT_GT(bent, 40);
}

TEST(SceneMotion, NothingCollidesBeforeItsFirstContact)
{
  std::size_t contacts = 0;
  for (std::uint64_t seed = 100; seed < 130; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Walk course(seed, far_away[seed % 4]);
    SceneOptions options = timeOfContact(course.random.chance(0.2) ? 0.0 : course.random.uniform(0.01, 0.2),
                                         course.random.pick(tolerances));
    options.effects.swept = false;
    Scene scene = course.scene(options, seed % 3 != 0);
    scene.query();
    for (int step = 0; step < 2; ++step) {
      WatchedMotion watch(scene);
      const SceneResult result = scene.step(0.7);
      contacts += result.first_contact.size();
      ASSERT_EQ(watch.replayFirstContacts(result, 1000), "") << "step " << step;
    }
  }
  EXPECT_GT(contacts, 80u);
}

TEST(SceneMotion, WhatTouchesMayLeaveAndSlideButNotEnter)
{
  Shelf shelf;
  const auto wall = shelf.add(sheet({0, -1, -1}, {0, 0.1, 0}, {0, 0, 0.1}, 21, 21)), point = shelf.add({{0, 0, 0}});
  for (const double gap : {1e-15, 1e-9, 1e-6, 1e-5, 2.5e-5, 4e-5, 5e-5, 1e-4})
    for (const Response response : {Response::stop, Response::slide})
      for (const Eigen::Vector3d& way :
           {Eigen::Vector3d(-1, 0, 0), Eigen::Vector3d(-1, 3, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, 1, 0.3)})
        for (const double turn : {0.0, 5.0}) {
          SCOPED_TRACE(std::to_string(gap) + " " + std::to_string(way.x()) + " " + std::to_string(turn));
          Scene scene(responding(response, 0.25));
          scene.add(fixedObject("wall", wall));
          SceneObject ball = object("ball", point, at(-0.25 - gap, 0, 0));
          ball.motion = VelocityMotion{way, {0, 0, turn}};
          const ObjectId id = scene.add(ball);
          for (int step = 0; step < 2; ++step) EXPECT_EQ(watchedStep(scene, 0.5, 100), "");
          const Eigen::Vector3d place = scene[id].pose.translation();
          if (way.x() < 0 && turn == 0.0) {
            EXPECT_NEAR((place - Eigen::Vector3d(-0.25 - gap, 0, 0) - way).norm(), 0, 1e-9);
          }
          EXPECT_LT(place.x(), -0.2);
        }
}

} // namespace
} // namespace pcl_bsh

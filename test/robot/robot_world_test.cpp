// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/robot/robot_world.h>

#include "made_arms.h"
#include "support/refusal.h"
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/geometry/triangle/triangle_distance.h>
#include <pcl_bsh/hierarchy/triangles_view.h>
#include <pcl_bsh/many_poses/collide_on_motions.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using namespace robots;
using test::LongVector;

/// Gaps again, in long double, over all pairs. Gaps of links from each other: for spheres alone.
class GapTwin {
public:
  GapTwin(const Robot& robot, const PointsView& points) : robot_(robot), kinematics_(robot), points_(points) {}

  /// @param off uncertainties of points, times this, are added
  long double toPoints(const std::vector<long double>& values, double off = 0.0) const
  {
    long double least = std::numeric_limits<long double>::infinity();
    const std::vector<test::LongPose> poses = test::longPoses(kinematics_, values);
    forEachShape([&](std::size_t link, const Eigen::Isometry3d& pose, const Shape& shape) {
      const test::LongPose& body = poses[kinematics_.bodyOf(link)];
      const LongVector at = body * LongVector(pose.translation().cast<long double>());
      const test::LongMatrix turn = body.rotation * pose.linear().cast<long double>();
      for (std::uint32_t i = 0; i < points_.size(); ++i) {
        const Point3 p = points_.point(i);
        if ((LongVector(p[0], p[1], p[2]) - at).norm() > least + kLargest) continue;
        const LongVector seen = turn.transpose() * (LongVector(p[0], p[1], p[2]) - at);
        const auto* ball = std::get_if<Sphere>(&shape.form);
        const long double gap =
            ball ? seen.norm() - ball->radius : signedDistance(*solidOf(shape), Eigen::Vector3d(seen.cast<double>()));
        const double uncertain = points_.uncertainty + points_.ownUncertainty(i);
        least = std::min(least, gap - static_cast<long double>(points_.radius(i)) - robot_.links[link].padding +
                                    static_cast<long double>(off * uncertain));
      }
    });
    return least;
  }

  long double toItself(const std::vector<long double>& values) const
  {
    struct Ball {
      std::size_t link;
      LongVector center;
      double radius;
    };
    std::vector<Ball> balls;
    const std::vector<test::LongPose> poses = test::longPoses(kinematics_, values);
    forEachShape([&](std::size_t link, const Eigen::Isometry3d& pose, const Shape& shape) {
      balls.push_back({link, poses[kinematics_.bodyOf(link)] * LongVector(pose.translation().cast<long double>()),
                       std::get<Sphere>(shape.form).radius});
    });
    long double least = std::numeric_limits<long double>::infinity();
    for (const Ball& a : balls)
      for (const Ball& b : balls) {
        const bool child = robot_.links[b.link].joint && robot_.links[b.link].joint->parent == a.link;
        if (a.link >= b.link || child || kinematics_.bodyOf(a.link) == kinematics_.bodyOf(b.link)) continue;
        least = std::min(least, (a.center - b.center).norm() - a.radius - b.radius);
      }
    return least;
  }

private:
  template <class Visit>
  void forEachShape(const Visit& visit) const
  {
    for (std::size_t link = 0; link < robot_.links.size(); ++link)
      for (const Shape& shape : robot_.links[link].shapes) visit(link, kinematics_.inBody(link) * shape.pose, shape);
  }

  static constexpr long double kLargest = 0.5L; ///< of shapes, points and uncertainties, at least

  const Robot& robot_;
  const Kinematics kinematics_;
  const PointsView points_;
};

struct MadeScene {
  MadeScene(std::uint64_t seed, std::size_t count, bool only_spheres) : random(seed)
  {
    robot = test::madeArm(random, 7, only_spheres);
    for (std::size_t i = 0; i < 3 * count; ++i) xyz.push_back(static_cast<float>(random.uniform(-0.9, 0.9)));
    for (std::size_t i = 0; i < count; ++i) radii.push_back(static_cast<float>(random.uniform(0, 0.02)));
    view = viewOf(xyz.data(), count);
    if (seed % 2 == 0) view.radii = radii.data();
    cloud = std::make_unique<SphereHierarchy>(view);
  }

  void setUncertain(double all, double most_own)
  {
    view.uncertainty = all;
    for (std::size_t i = 0; i < view.count; ++i) own.push_back(static_cast<float>(random.uniform(0, most_own)));
    if (most_own > 0.0) view.uncertainties = own.data();
    cloud = std::make_unique<SphereHierarchy>(view);
  }

  test::Random random;
  Robot robot;
  std::vector<float> xyz, radii, own;
  PointsView view;
  std::unique_ptr<SphereHierarchy> cloud;
};

/// Never free where one of 1,025 samples collides; what collides does at the fraction that is told; undecided only near
/// the clearance.
TEST(RobotWorld, CertifiesMotions)
{
  std::array<int, 3> seen = {};
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u}) {
    MadeScene scene(seed, 80, seed <= 4);
    WorldOptions options;
    options.clearance = seed % 3 == 0 ? 0.02 : 0.0;
    options.with_self = false;
    const RobotWorld world(scene.robot, {scene.cloud.get()}, options);
    const GapTwin twin(scene.robot, scene.view);
    for (int i = 0; i < 8; ++i) {
      const RobotState from = test::madeState(scene.random, scene.robot);
      RobotState to = test::madeState(scene.random, scene.robot);
      for (std::size_t k = 0; k < to.size(); ++k) to[k] = from[k] + 0.2 * (to[k] - from[k]);
      const MotionCheck check = world.checkMotion(from, to, true);
      long double least = std::numeric_limits<long double>::infinity();
      for (int sample = 0; sample <= 1024; ++sample) {
        const long double t = sample / 1024.0L;
        const long double gap = twin.toPoints(test::longValues(scene.robot, from, to, t));
        least = std::min(least, gap);
        if (t < check.last_valid) {
          ASSERT_GT(gap, options.clearance) << seed << " " << i << " " << sample;
        }
      }
      ++seen[static_cast<std::size_t>(check.verdict)];
      if (check.verdict == Verdict::free) {
        EXPECT_EQ(check.last_valid, 1.0);
        continue;
      }
      ASSERT_TRUE(check.meeting.has_value());
      const auto there = test::longValues(scene.robot, from, to, check.fraction);
      EXPECT_LE(check.last_valid, check.fraction);
      if (check.verdict == Verdict::colliding) {
        EXPECT_LE(twin.toPoints(there), options.clearance + 1e-12L);
      }
      else {
        EXPECT_NEAR(static_cast<double>(least), options.clearance, 2e-4);
      }
      // Just behind the last valid instant something is near.
      const auto end = test::longValues(scene.robot, from, to, check.last_valid);
      EXPECT_LT(twin.toPoints(end), options.clearance + 2 * options.tolerance);
    }
  }
  EXPECT_GT(seen[0], 8);
  EXPECT_GT(seen[1], 8);
  EXPECT_LT(seen[2], 2);
}

TEST(RobotWorld, CertifiesMotionsAmongItsLinks)
{
  std::array<int, 3> seen = {};
  for (const std::uint64_t seed : {21u, 22u, 23u, 24u, 25u, 26u}) {
    MadeScene scene(seed, 0, true);
    const RobotWorld world(scene.robot, {});
    const GapTwin twin(scene.robot, scene.view);
    for (int i = 0; i < 25; ++i) {
      const RobotState from = test::madeState(scene.random, scene.robot);
      RobotState to = test::madeState(scene.random, scene.robot);
      for (std::size_t k = 0; k < to.size(); ++k) to[k] = from[k] + 0.3 * (to[k] - from[k]);
      const MotionCheck check = world.checkMotion(from, to);
      ++seen[static_cast<std::size_t>(check.verdict)];
      for (int sample = 0; sample <= 1024 && check.verdict == Verdict::free; ++sample)
        ASSERT_GT(twin.toItself(test::longValues(scene.robot, from, to, sample / 1024.0L)), 0.0) << seed << " " << i;
      if (check.verdict != Verdict::colliding) continue;
      EXPECT_TRUE(check.meeting->other_link.has_value());
      EXPECT_LE(twin.toItself(test::longValues(scene.robot, from, to, check.fraction)), 1e-12L);
    }
  }
  EXPECT_GT(seen[0], 10);
  EXPECT_GT(seen[1], 10);
}

TEST(RobotWorld, MeasuresClearances)
{
  for (const std::uint64_t seed : {31u, 32u, 33u, 34u}) {
    MadeScene scene(seed, 40, true);
    scene.robot.links[2].padding = 0.01;
    WorldOptions options;
    options.with_self = false;
    const RobotWorld world(scene.robot, {scene.cloud.get()}, options);
    const GapTwin twin(scene.robot, scene.view);
    for (int i = 0; i < 20; ++i) {
      const RobotState state = test::madeState(scene.random, scene.robot);
      const auto exact = static_cast<double>(twin.toPoints({state.begin(), state.end()}));
      const ClearanceResult found = world.clearance(state);
      EXPECT_LE(found.gap.lower, exact + 1e-15);
      EXPECT_GE(found.gap.upper, exact - 1e-15);
      EXPECT_LT(found.gap.upper - found.gap.lower, 1e-6);
      const ClearanceResult limited = world.clearance(state, 0.5 * std::abs(exact));
      EXPECT_EQ(limited.meeting.has_value(), exact <= 0.0);
      const StateCheck check = world.checkState(state);
      EXPECT_EQ(check.verdict, exact > 0.0 ? Verdict::free : Verdict::colliding);
    }
  }
}

/// An arm of one link, 1 m long with a ball at its end, that turns about z.
Robot pendulum()
{
  Robot robot{"pendulum", {{"base", {}, {}}, {"bob", {{Sphere{0.1}, {}}}, Joint{"turn"}}}};
  robot.links[1].joint->kind = Joint::Kind::revolute;
  robot.links[1].joint->axis = Eigen::Vector3d::UnitZ();
  robot.links[1].shapes[0].pose.setIdentity();
  robot.links[1].shapes[0].pose.translation() = Eigen::Vector3d(1, 0, 0);
  return robot;
}

TEST(RobotWorld, FindsWhereAndWhenAndWhat)
{
  const double angle = 1.0;
  const std::vector<double> xyz = {5, 5, 5, 1.2 * std::cos(angle), 1.2 * std::sin(angle), 0};
  const SphereHierarchy cloud(viewOf(xyz.data(), 2));
  const RobotWorld below(pendulum(), {&cloud}, {0.0998}), above(pendulum(), {&cloud}, {0.1002});
  EXPECT_EQ(below.checkMotion({0}, {2}).verdict, Verdict::free);
  const MotionCheck hit = above.checkMotion({0}, {2}, true);
  EXPECT_EQ(hit.verdict, Verdict::colliding);
  EXPECT_EQ(hit.meeting->link, 1u);
  EXPECT_EQ(hit.meeting->record, 1u);
  EXPECT_NEAR(hit.fraction, 0.5, 0.02);
  EXPECT_LT(hit.last_valid, hit.fraction);
  EXPECT_GT(hit.last_valid, 0.45);
  const ClearanceResult clearance = above.clearance({angle});
  EXPECT_NEAR(clearance.gap.lower, 0.1, 1e-7);
  EXPECT_EQ(clearance.meeting->record, 1u);
}

/// The tip of an arm that folds goes along a line, and stands still when the arm is straight.
TEST(RobotWorld, SeesWhereWhatStandsStillHasBeen)
{
  Robot robot = pendulum();
  robot.links[1].shapes.clear();
  Joint elbow{"elbow", Joint::Kind::revolute, 1, Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0))};
  elbow.axis = Eigen::Vector3d::UnitZ();
  Shape tip{Sphere{0.1}};
  tip.pose.translation() = Eigen::Vector3d(1, 0, 0);
  robot.links.push_back({"forearm", {tip}, elbow});
  const std::vector<double> xyz = {1.3, 0, 0};
  const SphereHierarchy cloud(viewOf(xyz.data(), 1));
  const RobotWorld world(robot, {&cloud});
  EXPECT_EQ(world.checkMotion({-0.7, 1.4}, {0.7, -1.4}).verdict, Verdict::free);
  EXPECT_EQ(world.checkMotion({-1.0, 2.0}, {1.0, -2.0}).verdict, Verdict::colliding);
}

TEST(RobotWorld, TurnsContinuousJointsTheShorterWay)
{
  Robot robot = pendulum();
  robot.links[1].joint->kind = Joint::Kind::continuous;
  const std::vector<double> xyz = {1, 0, 0};
  const SphereHierarchy cloud(viewOf(xyz.data(), 1));
  const RobotWorld world(robot, {&cloud});
  EXPECT_EQ(world.checkMotion({-3.0}, {3.0}).verdict, Verdict::free); // by way of pi
  EXPECT_EQ(world.checkMotion({-1.0}, {1.0}).verdict, Verdict::colliding);
}

TEST(RobotWorld, AttachesAndDetaches)
{
  Robot robot = pendulum();
  const std::vector<double> xyz = {0, 1.5, 0};
  const SphereHierarchy cloud(viewOf(xyz.data(), 1));
  RobotWorld world(robot, {&cloud});
  EXPECT_EQ(world.checkMotion({0}, {3}).verdict, Verdict::free);
  Shape stick{Capsule{0.05, 0.6}};
  stick.pose.translation() = Eigen::Vector3d(1.3, 0, 0);
  stick.pose.linear() = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  world.attach("stick", 1, {stick}, {0});
  const MotionCheck hit = world.checkMotion({0}, {3});
  EXPECT_EQ(hit.verdict, Verdict::colliding);
  EXPECT_EQ(world.robot().links[hit.meeting->link].name, "stick");
  EXPECT_THAT(test::refusalOf([&] { world.attach("stick", 0, {}); }), testing::HasSubstr("name of a link"));
  EXPECT_THAT(test::refusalOf([&] { world.detach("bob"); }), testing::HasSubstr("is not attached"));
  world.detach("stick");
  EXPECT_EQ(world.checkMotion({0}, {3}).verdict, Verdict::free);
  world.setBase(Eigen::Isometry3d(Eigen::Translation3d(0, 0.5, 0)));
  EXPECT_EQ(world.checkMotion({0}, {3}).verdict, Verdict::colliding);
  world.setObstacles({});
  EXPECT_EQ(world.checkMotion({0}, {3}).verdict, Verdict::free);
}

/// A robot of one link moves as a cloud of its balls does along a straight path of two poses.
TEST(RobotWorld, AgreesWithAPathWhereOneLinkMoves)
{
  std::size_t free = 0, colliding = 0, alike = 0;
  for (std::uint64_t seed = 140; seed < 540; ++seed) {
    MadeScene scene(seed, 60, true);
    Robot robot{"one", {{"base", {}, {}}, {"link", {}, Joint{"moves"}}}};
    Joint& joint = *robot.links[1].joint;
    const bool slides = seed % 2 == 0;
    joint.kind = slides ? Joint::Kind::prismatic : Joint::Kind::continuous;
    joint.origin = test::madePose(scene.random, 0.3);
    joint.axis = test::madeVector(scene.random, 1.0).normalized();
    joint.lower = -2.0, joint.upper = 2.0;
    std::vector<double> centers;
    std::vector<float> radii;
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector3d center = test::madeVector(scene.random, 0.4);
      const auto radius = static_cast<float>(scene.random.uniform(0.02, 0.08));
      robot.links[1].shapes.push_back({Sphere{radius}, Eigen::Isometry3d(Eigen::Translation3d(center))});
      centers.insert(centers.end(), {center.x(), center.y(), center.z()});
      radii.push_back(radius);
    }
    PointsView balls = viewOf(centers.data(), radii.size());
    balls.radii = radii.data();
    const RobotState from = {scene.random.uniform(-1.5, 1.5)}, to = {from[0] + scene.random.uniform(-0.5, 0.5)};
    const double clearance = scene.random.uniform(0.0, 0.05), swept = 1e-4;
    const RobotWorld world(robot, {scene.cloud.get()}, {clearance});
    const Verdict verdict = world.checkMotion(from, to).verdict;
    const std::vector<Eigen::Isometry3d> poses = {world.kinematics().linkPoses(from)[1],
                                                  world.kinematics().linkPoses(to)[1]};
    const auto along = [&](double within) {
      MotionsRequest request;
      request.clearance = within;
      request.swept = swept;
      return anyCollisionOnMotions({*scene.cloud}, SphereHierarchy(balls), poses, {{0, 1}}, request).flags[0];
    };
    const Verdict path = along(clearance);
    if (path == Verdict::free) {
      EXPECT_NE(verdict, Verdict::colliding) << seed;
    }
    if (clearance >= swept && along(clearance - swept) == Verdict::colliding) {
      EXPECT_NE(verdict, Verdict::free) << seed;
    }
    free += path == Verdict::free ? 1 : 0;
    colliding += path == Verdict::colliding ? 1 : 0;
    alike += path == verdict ? 1 : 0;
  }
  EXPECT_GT(free, 40u);
  EXPECT_GT(colliding, 40u);
  EXPECT_GT(alike, 390u); // of 400: others are near the clearance
}

TEST(RobotWorld, HoldsMeshesAgainstAll)
{
  const std::vector<float> corners = {0.9f, -0.1f, 0, 1.1f, -0.1f, 0, 1, 0.1f, 0};
  const std::vector<std::uint32_t> triangle = {0, 1, 2};
  const PointsView plate = viewOf(TrianglesView{viewOf(corners.data(), 3), triangle.data(), 1});
  Robot robot = pendulum();
  robot.links[1].shapes = {{Mesh{"plate.stl", {1, 1, 1}, std::make_shared<SphereHierarchy>(plate)}}};
  const std::vector<double> xyz = {0, 1, 0.005};
  const SphereHierarchy cloud(viewOf(xyz.data(), 1));
  EXPECT_EQ(RobotWorld(robot, {&cloud}, {0.004}).checkMotion({0}, {3}).verdict, Verdict::free);
  EXPECT_EQ(RobotWorld(robot, {&cloud}, {0.006}).checkMotion({0}, {3}).verdict, Verdict::colliding);
  EXPECT_NEAR(RobotWorld(robot, {&cloud}).clearance({std::numbers::pi / 2}).gap.lower, 0.005, 1e-7);
  // against a box of another link
  Shape post{Box{{0.2, 0.2, 0.2}}};
  post.pose.translation() = Eigen::Vector3d(0, 1, 0);
  robot.links[0].shapes = {post};
  robot.links.push_back(robot.links[1]);
  robot.links[2].name = "twin";
  robot.links[2].joint->name = "twin";
  robot.links[2].joint->parent = 1;
  const RobotWorld world(robot, {});
  EXPECT_EQ(world.checkMotion({0.0, 0.3}, {0.5, 0.3}).verdict, Verdict::free);
  EXPECT_EQ(world.checkMotion({0.0, 0.3}, {1.5, 0.3}).verdict, Verdict::colliding);
  // against a mesh that it crosses
  const std::vector<float> upright = {-0.1f, 1, -0.2f, 0.1f, 1, -0.2f, 0, 1, 0.3f};
  const PointsView wall = viewOf(TrianglesView{viewOf(upright.data(), 3), triangle.data(), 1});
  robot.links[0].shapes = {{Mesh{"wall.stl", {1, 1, 1}, std::make_shared<SphereHierarchy>(wall)}}};
  const RobotWorld walled(robot, {});
  EXPECT_EQ(walled.checkState({0.5, std::numbers::pi / 2 - 0.5}).verdict, Verdict::colliding);
  EXPECT_EQ(walled.checkMotion({0.0, 0.3}, {0.5, 0.3}).verdict, Verdict::free);
  EXPECT_EQ(walled.checkMotion({0.0, 0.3}, {1.5, 0.3}).verdict, Verdict::colliding);
  robot.links[1].shapes = {{Mesh{"unread.stl"}}};
  EXPECT_THAT(test::refusalOf([&] { RobotWorld(robot, {}); }), testing::HasSubstr("unread.stl, which is not read"));
}

/// Two links with meshes of many patches, on a base that has one, too, and a cloud.
struct MeshScene {
  explicit MeshScene(std::uint64_t seed) : random(seed)
  {
    Joint turn{"turn", Joint::Kind::continuous, 0}, bend{"bend", Joint::Kind::continuous, 1};
    turn.axis = Eigen::Vector3d::UnitZ();
    bend.axis = Eigen::Vector3d::UnitY();
    bend.origin.translation() = Eigen::Vector3d(0.5, 0, 0);
    robot = {"meshes", {{"base", {madeMesh()}, {}}, {"upper", {madeMesh()}, turn}, {"lower", {madeMesh()}, bend}}};
    for (std::size_t i = 0; i < 3 * kPoints; ++i) xyz.push_back(static_cast<float>(random.uniform(-1.2, 1.2)));
    for (std::size_t i = 0; i < kPoints; ++i) radii.push_back(static_cast<float>(random.uniform(0.02, 0.05)));
    view = viewOf(xyz.data(), kPoints);
    view.radii = radii.data();
    cloud = std::make_unique<SphereHierarchy>(view);
  }

  Shape madeMesh()
  {
    corners.push_back(std::make_unique<std::vector<float>>());
    numbers.push_back(std::make_unique<std::vector<std::uint32_t>>());
    for (std::uint32_t i = 0; i < kTriangles; ++i) {
      const Eigen::Vector3d middle = test::madeVector(random, 0.2);
      for (std::uint32_t k = 0; k < 3; ++k) {
        const Eigen::Vector3d corner = middle + test::madeVector(random, 0.05);
        for (const double x : {corner.x(), corner.y(), corner.z()}) corners.back()->push_back(static_cast<float>(x));
        numbers.back()->push_back(3 * i + k);
      }
    }
    const TrianglesView triangles{viewOf(corners.back()->data(), 3 * kTriangles), numbers.back()->data(), kTriangles};
    return {Mesh{"made.stl", {1, 1, 1}, std::make_shared<SphereHierarchy>(viewOf(triangles))}};
  }

  static const PointsView& surfaceOf(const Robot& robot, std::size_t link)
  {
    return std::get<Mesh>(robot.links[link].shapes[0].form).surface->view();
  }

  /// All pairs.
  double toPoints(const RobotState& state) const
  {
    double least = std::numeric_limits<double>::infinity();
    const std::vector<Eigen::Isometry3d> poses = Kinematics(robot).linkPoses(state);
    for (std::size_t link = 0; link < poses.size(); ++link) {
      const TriangleDistance distance(Eigen::Isometry3d::Identity(), poses[link]);
      for (std::uint32_t t = 0; t < kTriangles; ++t)
        for (std::uint32_t p = 0; p < kPoints; ++p) {
          const Triangle3 triangle = surfaceOf(robot, link).triangles->triangle(t);
          least = std::min(least, distance.enclose(view.point(p), triangle).high - view.radius(p));
        }
    }
    return least;
  }

  /// The base and the lower link.
  double toItself(const RobotState& state) const
  {
    double least = std::numeric_limits<double>::infinity();
    const std::vector<Eigen::Isometry3d> poses = Kinematics(robot).linkPoses(state);
    const TriangleDistance distance(poses[0], poses[2]);
    for (std::uint32_t i = 0; i < kTriangles; ++i)
      for (std::uint32_t k = 0; k < kTriangles; ++k)
        least = std::min(
            least,
            distance.enclose(surfaceOf(robot, 0).triangles->triangle(i), surfaceOf(robot, 2).triangles->triangle(k))
                .high);
    return least;
  }

  static constexpr std::uint32_t kTriangles = 12;
  static constexpr std::size_t kPoints = 60;

  test::Random random;
  std::vector<std::unique_ptr<std::vector<float>>> corners;
  std::vector<std::unique_ptr<std::vector<std::uint32_t>>> numbers;
  Robot robot;
  std::vector<float> xyz, radii;
  PointsView view;
  std::unique_ptr<SphereHierarchy> cloud;
};

TEST(RobotWorld, AnswersForMeshesAsAllTheirTrianglesDo)
{
  std::array<int, 3> of_states = {}, of_motions = {};
  for (std::uint64_t seed = 101; seed < 109; ++seed) {
    MeshScene scene(seed);
    WorldOptions options;
    options.clearance = seed % 2 == 0 ? 0.0 : 0.01;
    options.self_clearance = 0.02;
    options.with_self = seed % 4 < 2;
    const RobotWorld world(scene.robot, {scene.cloud.get()}, options);
    const auto over = [&](const RobotState& state) { // by so much it is free
      const double self = options.with_self ? scene.toItself(state) : std::numeric_limits<double>::infinity();
      return std::min(scene.toPoints(state) - options.clearance, self - options.self_clearance);
    };
    for (int i = 0; i < 40; ++i) {
      const RobotState from = {scene.random.uniform(-3, 3), scene.random.uniform(-3, 3)};
      const RobotState to = {from[0] + scene.random.uniform(-0.2, 0.2), from[1] + scene.random.uniform(-0.2, 0.2)};
      const StateCheck state = world.checkState(from);
      ++of_states[static_cast<std::size_t>(state.verdict)];
      EXPECT_EQ(state.verdict, over(from) > 0.0 ? Verdict::free : Verdict::colliding) << seed << " " << i;
      const MotionCheck motion = world.checkMotion(from, to);
      ++of_motions[static_cast<std::size_t>(motion.verdict)];
      const auto at = [&](double t) {
        return RobotState{from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])};
      };
      for (int sample = 0; sample <= 4 && motion.verdict == Verdict::free; ++sample)
        ASSERT_GT(over(at(sample / 4.0)), 0.0) << seed << " " << i;
      if (motion.verdict == Verdict::colliding) {
        EXPECT_LE(over(at(motion.fraction)), 1e-12) << seed << " " << i;
      }
    }
  }
  EXPECT_GT(of_states[0], 10);
  EXPECT_GT(of_states[1], 10);
  EXPECT_GT(of_motions[0], 10);
  EXPECT_GT(of_motions[1], 10);
  EXPECT_LT(of_motions[2], 3);
}

auto tied(const std::optional<Meeting>& meeting)
{
  const Meeting m = meeting.value_or(Meeting{99});
  return std::tuple(m.link, m.shape, m.other_link, m.other_shape, m.obstacle, m.record);
}

TEST(RobotWorld, AnswersManyAtOnce)
{
  MadeScene scene(41, 60, true);
  const RobotWorld world(scene.robot, {scene.cloud.get()});
  std::vector<RobotState> states;
  std::vector<RobotWorld::Motion> motions;
  for (int i = 0; i < 300; ++i) {
    states.push_back(test::madeState(scene.random, scene.robot));
    motions.push_back({states.back(), test::madeState(scene.random, scene.robot)});
  }
  for (const unsigned threads : {1u, 2u}) {
    const RobotWorld anew(scene.robot, {scene.cloud.get()});
    const std::vector<StateCheck> of_states = anew.checkStates(states, threads);
    const std::vector<MotionCheck> of_motions = anew.checkMotions(motions, true, threads);
    const std::vector<ClearanceResult> of_gaps = anew.clearances(states, 0.1, threads);
    for (std::size_t i = 0; i < states.size(); ++i) {
      const StateCheck state = world.checkState(states[i]);
      const MotionCheck motion = world.checkMotion(motions[i].from, motions[i].to, true);
      const ClearanceResult nearest = world.clearance(states[i], 0.1);
      EXPECT_EQ(of_states[i].verdict, state.verdict);
      EXPECT_EQ(tied(of_states[i].meeting), tied(state.meeting));
      EXPECT_EQ(of_motions[i].verdict, motion.verdict);
      EXPECT_EQ(of_motions[i].fraction, motion.fraction);
      EXPECT_EQ(of_motions[i].last_valid, motion.last_valid);
      EXPECT_EQ(of_gaps[i].gap.lower, nearest.gap.lower);
      EXPECT_EQ(of_gaps[i].gap.upper, nearest.gap.upper);
      EXPECT_EQ(tied(of_gaps[i].meeting), tied(nearest.meeting));
    }
  }
}

TEST(RobotWorld, TellsHowFarManyAreAndStops)
{
  const RobotWorld world(pendulum(), {});
  const std::vector<RobotState> states(100, RobotState{0.0});
  std::vector<double> told;
  const Effort effort(2, [&](double done) {
    told.push_back(done);
    return true;
  });
  world.checkStates(states, effort);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1.0);
  const Effort stop(1, [](double) { return false; });
  EXPECT_THROW(world.checkStates(states, stop), Cancelled);
  EXPECT_THROW(world.checkMotions({{{0.0}, {1.0}}}, true, stop), Cancelled);
  EXPECT_THROW(world.clearances(states, 1.0, stop), Cancelled);
  EXPECT_THAT(test::refusalOf([&] { world.checkStates(states, Effort(Accuracy::level(1))); }),
              testing::HasSubstr("exact"));
}

/// Values of joints at the ends of their intervals, all of these, and some between.
std::vector<std::vector<long double>> valuesAbout(test::Random& random, const std::vector<long double>& values,
                                                  const std::vector<double>& uncertainties)
{
  std::vector<std::vector<long double>> all;
  if (uncertainties.empty()) return {values};
  const std::size_t corners = std::size_t{1} << values.size();
  for (std::size_t k = 0; k < corners + 20; ++k) {
    all.push_back(values);
    for (std::size_t i = 0; i < values.size(); ++i)
      all.back()[i] += uncertainties[i] * (k >= corners ? random.uniform(-1, 1) : (k >> i & 1u) != 0 ? 1.0 : -1.0);
  }
  return all;
}

/// Free and colliding hold at all corners of joints' intervals and in them, wherever points truly are. Where joints are
/// certain, undecided is no more than what depends on where the points are.
TEST(RobotWorld, AnswersForAllUncertainPlacesAndValues)
{
  std::array<std::array<int, 3>, 2> seen = {};
  for (std::uint64_t seed = 51; seed < 67; ++seed) {
    MadeScene scene(seed, 60, seed % 4 < 2);
    scene.setUncertain(seed % 3 == 0 ? 0.0 : 0.01, seed % 3 == 1 ? 0.0 : 0.03);
    WorldOptions options;
    options.clearance = 0.03;
    options.with_self = false;
    const bool of_joints = seed % 2 == 1;
    for (std::size_t i = 0; of_joints && i < variablesOf(scene.robot).size(); ++i)
      options.joint_uncertainties.push_back(scene.random.uniform(0, 0.008));
    const RobotWorld world(scene.robot, {scene.cloud.get()}, options);
    const GapTwin twin(scene.robot, scene.view);
    for (int i = 0; i < 40; ++i) {
      const RobotState state = test::madeState(scene.random, scene.robot);
      const StateCheck check = world.checkState(state);
      const ClearanceResult nearest = world.clearance(state);
      ++seen[of_joints ? 1 : 0][static_cast<std::size_t>(check.verdict)];
      EXPECT_EQ(check.meeting.has_value(), check.verdict != Verdict::free);
      for (const auto& values : valuesAbout(scene.random, {state.begin(), state.end()}, options.joint_uncertainties)) {
        const long double low = twin.toPoints(values, -1), high = twin.toPoints(values, 1);
        ASSERT_LE(nearest.gap.lower, low + 1e-12L);
        ASSERT_GE(nearest.gap.upper, high - 1e-12L);
        if (check.verdict == Verdict::free) {
          ASSERT_GT(low, options.clearance) << seed << " " << i;
        }
        if (check.verdict == Verdict::colliding) {
          ASSERT_LE(high, options.clearance + 1e-12L) << seed << " " << i;
        }
        if (check.verdict == Verdict::undecided && !of_joints) {
          ASSERT_LE(low, options.clearance + 1e-12L);
          ASSERT_GT(high, options.clearance - 1e-12L);
        }
      }
    }
  }
  for (const std::array<int, 3>& verdicts : seen)
    for (const int count : verdicts) EXPECT_GT(count, 5);
}

TEST(RobotWorld, CertifiesMotionsOfUncertainPlacesAndValues)
{
  std::array<int, 3> seen = {};
  for (std::uint64_t seed = 71; seed < 77; ++seed) {
    MadeScene scene(seed, 60, seed % 2 == 0);
    scene.setUncertain(0.002, seed % 3 == 0 ? 0.01 : 0.0);
    WorldOptions options;
    options.with_self = false;
    options.joint_uncertainties.assign(variablesOf(scene.robot).size(), seed % 4 == 0 ? 0.0 : 0.001);
    const RobotWorld world(scene.robot, {scene.cloud.get()}, options);
    const GapTwin twin(scene.robot, scene.view);
    for (int i = 0; i < 8; ++i) {
      const RobotState from = test::madeState(scene.random, scene.robot);
      RobotState to = test::madeState(scene.random, scene.robot);
      for (std::size_t k = 0; k < to.size(); ++k) to[k] = from[k] + 0.2 * (to[k] - from[k]);
      const MotionCheck check = world.checkMotion(from, to, true);
      ++seen[static_cast<std::size_t>(check.verdict)];
      for (int sample = 0; sample <= 16; ++sample) {
        const long double t = sample / 16.0L;
        if (!(t < check.last_valid)) break;
        for (const auto& values :
             valuesAbout(scene.random, test::longValues(scene.robot, from, to, t), options.joint_uncertainties)) {
          ASSERT_GT(twin.toPoints(values, -1), 0.0L) << seed << " " << i << " " << sample;
        }
      }
      if (check.verdict != Verdict::colliding) continue;
      for (const auto& values : valuesAbout(scene.random, test::longValues(scene.robot, from, to, check.fraction),
                                            options.joint_uncertainties)) {
        ASSERT_LE(twin.toPoints(values, 1), 1e-12L);
      }
    }
  }
  EXPECT_GT(seen[0], 2);
  EXPECT_GT(seen[1], 5);
  EXPECT_GT(seen[2], 0);
}

TEST(RobotWorld, NamesWhatIsUncertain)
{
  // Point 0 is certain and nearer, point 1 may be nearer.
  const std::vector<double> xyz = {1.2, 0, 0, 1, 0, 0.3};
  const std::vector<float> own = {0.0f, 0.25f};
  PointsView view = viewOf(xyz.data(), 2);
  view.uncertainties = own.data();
  const SphereHierarchy cloud(view);
  WorldOptions options;
  options.clearance = 0.05;
  const StateCheck state = RobotWorld(pendulum(), {&cloud}, options).checkState({0});
  EXPECT_EQ(state.verdict, Verdict::undecided);
  EXPECT_EQ(state.meeting->record, 1u);
  // 5 mrad at 1 m, where the gap is 0.1
  options.joint_uncertainties = {0.005};
  view.uncertainties = nullptr;
  const SphereHierarchy certain(view);
  for (const auto& [clearance, verdict] :
       {std::pair(0.0949, Verdict::free), std::pair(0.0951, Verdict::undecided), std::pair(0.1049, Verdict::undecided),
        std::pair(0.1051, Verdict::colliding)}) {
    options.clearance = clearance;
    EXPECT_EQ(RobotWorld(pendulum(), {&certain}, options).checkState({0}).verdict, verdict) << clearance;
  }
  // A motion is free until the first instant that may not be.
  options.clearance = 0.0;
  const MotionCheck motion = RobotWorld(pendulum(), {&cloud}, options).checkMotion({-1}, {1}, true);
  EXPECT_EQ(motion.verdict, Verdict::undecided);
  EXPECT_EQ(motion.meeting->record, 1u);
  // The point is 0.35 + 0.005 from the bob's centre there: a chord of sqrt(0.355^2 - 0.3^2).
  EXPECT_NEAR(motion.last_valid, 0.5 - std::asin(0.5 * std::sqrt(0.355 * 0.355 - 0.09)), 2e-4);
}

/// Each shape is in its ball at all instants, wherever uncertain joints are.
TEST(RobotWorld, HoldsMotionsInBalls)
{
  for (const std::uint64_t seed : {91u, 92u, 93u, 94u}) {
    MadeScene scene(seed, 0, seed % 2 == 0);
    WorldOptions options;
    if (seed > 92) options.joint_uncertainties.assign(variablesOf(scene.robot).size(), 0.02);
    const RobotWorld world(scene.robot, {}, options);
    const RobotState from = test::madeState(scene.random, scene.robot), to = test::madeState(scene.random, scene.robot);
    const std::size_t parts = seed % 3 + 1;
    const std::vector<SweptBall> balls = world.sweptBalls(from, to, parts);
    std::size_t shapes = 0;
    for (const Link& link : scene.robot.links) shapes += link.shapes.size();
    ASSERT_EQ(balls.size(), parts * shapes);
    for (int sample = 0; sample <= 100; ++sample) {
      const long double t = sample / 100.0L;
      const std::size_t part = std::min(static_cast<std::size_t>(t * static_cast<long double>(parts)), parts - 1);
      for (const auto& values :
           valuesAbout(scene.random, test::longValues(scene.robot, from, to, t), options.joint_uncertainties)) {
        const std::vector<test::LongPose> poses = test::longPoses(world.kinematics(), values);
        for (std::size_t link = 0; link < scene.robot.links.size(); ++link)
          for (const Shape& shape : scene.robot.links[link].shapes) {
            const LongVector at = test::longCenter(poses, world.kinematics(), link, shape);
            const double radius = enclosingRadius(*solidOf(shape));
            const bool held = std::any_of(
                balls.begin() + static_cast<std::ptrdiff_t>(part * shapes),
                balls.begin() + static_cast<std::ptrdiff_t>((part + 1) * shapes), [&](const SweptBall& ball) {
                  return (at - ball.center.cast<long double>()).norm() + radius <= ball.radius;
                });
            ASSERT_TRUE(held) << seed << " " << sample << " " << link;
          }
      }
    }
  }
}

TEST(RobotWorld, RefusesUncertaintiesWithoutMeaning)
{
  const auto refused = [](const std::vector<double>& uncertainties) {
    WorldOptions options;
    options.joint_uncertainties = uncertainties;
    return test::refusalOf([&] { RobotWorld(pendulum(), {}, options); });
  };
  EXPECT_THAT(refused({0.1, 0.1}), testing::HasSubstr("joint_uncertainties: are 2"));
  EXPECT_THAT(refused({-0.1}), testing::HasSubstr("has -0.100000 for joint 'turn'"));
  EXPECT_THAT(refused({std::numeric_limits<double>::infinity()}), testing::HasSubstr("for joint 'turn'"));
}

/// An obstacle that is moved is one whose points are.
TEST(RobotWorld, MovesObstacles)
{
  for (const std::uint64_t seed : {81u, 82u, 83u, 84u}) {
    MadeScene scene(seed, 60, seed % 2 == 0);
    const Eigen::Isometry3d pose = test::madePose(scene.random, 0.5);
    std::vector<double> moved;
    for (std::uint32_t i = 0; i < scene.view.size(); ++i) {
      const Point3 p = scene.view.point(i);
      const Eigen::Vector3d there = pose * Eigen::Vector3d(p[0], p[1], p[2]);
      moved.insert(moved.end(), there.data(), there.data() + 3);
    }
    PointsView view = viewOf(moved.data(), scene.view.size());
    view.radii = scene.view.radii;
    const SphereHierarchy cloud(view);
    WorldOptions options;
    options.with_self = false;
    RobotWorld world(scene.robot, {&cloud, scene.cloud.get()}, options);
    world.checkState(test::madeState(scene.random, scene.robot)); // what it keeps of gaps is of the old places
    world.setObstaclePoses({Eigen::Isometry3d::Identity(), pose});
    RobotWorld alone(scene.robot, {scene.cloud.get()}, options), expected(scene.robot, {&cloud}, options);
    alone.setObstaclePoses({pose});
    RobotWorld at_once(scene.robot, {}, options);
    at_once.setObstacles({scene.cloud.get()}, {pose});
    for (int i = 0; i < 20; ++i) {
      const RobotState from = test::madeState(scene.random, scene.robot);
      RobotState to = test::madeState(scene.random, scene.robot);
      for (std::size_t k = 0; k < to.size(); ++k) to[k] = from[k] + 0.2 * (to[k] - from[k]);
      EXPECT_EQ(alone.checkState(from).verdict, expected.checkState(from).verdict);
      EXPECT_EQ(at_once.clearance(from).gap.lower, alone.clearance(from).gap.lower);
      EXPECT_EQ(alone.checkMotion(from, to).verdict, expected.checkMotion(from, to).verdict);
      const Interval a = alone.clearance(from).gap, b = expected.clearance(from).gap;
      EXPECT_NEAR(a.lower, b.lower, 1e-6);
      EXPECT_NEAR(a.upper, b.upper, 1e-6);
    }
    const RobotState state = test::madeState(scene.random, scene.robot);
    EXPECT_NEAR(world.clearance(state).gap.lower, expected.clearance(state).gap.lower, 1e-6);
    EXPECT_THAT(test::refusalOf([&] { world.setObstaclePoses({pose}); }),
                testing::HasSubstr("get 1 poses: give one for each of the 2"));
    Eigen::Isometry3d bent = pose;
    bent.linear() *= 1.0 + 1e-9;
    EXPECT_THAT(test::refusalOf([&] {
                  world.setObstaclePoses({pose, bent});
                }),
                testing::HasSubstr("pose of obstacle 1: is not rigid"));
  }
}

TEST(RobotWorld, RefusesWhatHasNoMeaning)
{
  const RobotWorld world(pendulum(), {});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using testing::HasSubstr;
  EXPECT_THAT(test::refusalOf([&] { world.checkState({}); }), HasSubstr("has 0 values"));
  EXPECT_THAT(test::refusalOf([&] { world.checkMotion({0}, {nan}); }), HasSubstr("joint 'turn': has the value nan"));
  EXPECT_THAT(test::refusalOf([&] { world.clearance({0}, nan); }), HasSubstr("limit"));
  EXPECT_THAT(test::refusalOf([&] { RobotWorld(pendulum(), {}, {-1.0}); }), HasSubstr("clearance: is -1"));
  EXPECT_THAT(test::refusalOf([&] { RobotWorld(pendulum(), {}, {0.0, 0.0, 0.0}); }), HasSubstr("tolerance: is 0"));
  Robot robot = pendulum();
  robot.links[1].joint->upper = 1.0;
  EXPECT_THAT(test::refusalOf([&] { RobotWorld(robot, {}).checkState({1.5}); }), HasSubstr("its limits are"));
  EXPECT_THAT(test::refusalOf([&] { world.checkStates({{0}, {0, 1}}); }), HasSubstr("state 1: has 2 values"));
  EXPECT_THAT(test::refusalOf([&] { world.clearances({{0}, {nan}}); }), HasSubstr("state 1: joint 'turn': has the"));
  EXPECT_THAT(test::refusalOf([&] { world.checkMotions({{{0}, {nan}}}); }), HasSubstr("motion 0: joint 'turn'"));
}

} // namespace
} // namespace pcl_bsh

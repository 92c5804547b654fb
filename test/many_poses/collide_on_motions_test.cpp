// SPDX-License-Identifier: BSD-3-Clause
// Many motions at once: each verdict is that of the motion by itself, whatever else the list holds.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/many_poses/collide_on_motions.h>
#include <pcl_bsh/many_poses/motions_query.h>

#include "support/brute_force/many_poses.h"
#include "support/journeys.h"
#include "support/verdicts.h"
#include "support/work_counts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::flagsOnly;
using test::identity;
using test::Poses;
using test::Random;
using test::Scene;
using Motions = std::vector<PoseMotion>;

/// The verdict of one motion by itself, in the direction that both directions have.
Verdict verdictAlone(const Placed& scan, const SphereHierarchy& model, const Eigen::Isometry3d& one,
                     const Eigen::Isometry3d& other, const MotionsRequest& request)
{
  const RigidMotion motion = motionBetween(one, other, request.pivot);
  TrajectoryRequest alone = flagsOnly(request.clearance);
  alone.swept = request.swept;
  alone.pivot = request.pivot;
  const TrajectoryResult found = collideAlong(scan, model, {motion.from(), motion.to()}, alone);
  return found.colliding > 0 ? Verdict::colliding : found.undecided > 0 ? Verdict::undecided : Verdict::free;
}

/// The definition at many instants of a motion, in exact arithmetic at each.
struct Instants {
  bool collides = false; ///< within the clearance, less what poses are rounded by
  bool nears = false;    ///< within clearance + tolerance, as far as instants between these can tell
};

Instants lookAt(const Placed& scan, const Cloud& scan_cloud, const Cloud& model, const RigidMotion& motion,
                const MotionsRequest& request, int count)
{
  Instants found;
  const auto isFinite = [](const Point3& p) { return std::isfinite(p[0] + p[1] + p[2]); };
  const PointsView a = scan_cloud.view(), b = model.view();
  const auto away = [&](double s) {
    const Eigen::Isometry3d pose = motion.at(s);
    const ExactDistance distance(scan.pose, pose);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t j = 0; j < b.size(); ++j) {
        const std::uint32_t p = a.record(i), q = b.record(j);
        if (!isFinite(a.point(p)) || !isFinite(b.point(q))) continue;
        least = std::min(least, distance.gap({a.point(p), b.point(q), a.radius(p), b.radius(q)}));
      }
    return least;
  };
  double step = 0.0; // that any point of the model makes
  for (std::size_t j = 0; j < b.size(); ++j) {
    const Point3 q = b.point(b.record(j));
    if (!isFinite(q)) continue;
    const double length = (Eigen::Vector3d(q[0], q[1], q[2]) - motion.pivot()).norm();
    step = std::max(step, (motion.shift().norm() + motion.turningSpeed(length)) / count);
  }
  double rounding = 0.0;
  for (const Eigen::Isometry3d* pose : {&motion.from(), &motion.to(), &scan.pose})
    rounding += pose->translation().lpNorm<1>();
  rounding = 1e-15 * (rounding + motion.pivot().lpNorm<1>() + request.clearance);
  for (int i = 0; i <= count; ++i) {
    const double least = away(static_cast<double>(i) / count);
    const bool at_end = i == 0 || i == count;
    found.collides = found.collides || least <= request.clearance - (at_end ? 0.0 : rounding);
    found.nears = found.nears || least <= request.clearance + request.swept + 0.5 * step + rounding;
  }
  return found;
}

/// Around the scene's pose of b: on the spot, near and far, turned or not, some not quite rigid.
Poses anyPoses(const Scene& scene, std::size_t count, double length, Random& random)
{
  Poses poses;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Isometry3d pose = scene.pose_b;
    const double spread = length * std::pow(10.0, random.integer(-4, 0));
    if (i % 6 != 0) pose = pose * random.pose(spread);
    if (i % 6 >= 4) pose.linear() = scene.pose_b.linear();
    if (i % 6 == 1) pose.linear() *= 1.0 + 2.8e-7 * random.uniform(-1, 1);
    poses.push_back(pose);
  }
  return poses;
}

Motions anyMotions(std::size_t poses, std::size_t count, Random& random)
{
  Motions motions;
  const auto any = [&] { return static_cast<std::uint32_t>(random.integer(0, static_cast<int>(poses) - 1)); };
  for (std::size_t i = 0; i < count; ++i) {
    motions.push_back({any(), any()});
    if (i % 5 == 0) motions.push_back({motions.back().to, motions.back().from}); // back
    if (i % 7 == 0) motions.push_back(motions.back());                           // again
    if (i % 11 == 0) motions.push_back({motions.back().to, motions.back().to});  // on the spot
  }
  return motions;
}

double sizeOf(const Scene& scene)
{
  double size = scene.clearance + scene.pose_a.translation().lpNorm<1>() + scene.pose_b.translation().lpNorm<1>();
  for (const Cloud* cloud : {&scene.a, &scene.b}) {
    const PointsView view = cloud->view();
    double far = 0.0;
    for (std::size_t i = 0; i < view.size(); ++i) {
      const Point3 p = view.point(view.record(i));
      if (std::isfinite(p[0] + p[1] + p[2])) far = std::max(far, std::abs(p[0]) + std::abs(p[1]) + std::abs(p[2]));
    }
    size += far;
  }
  return size;
}

struct Asked {
  MotionsRequest request;
  Poses poses;
  Motions motions;
};

Asked anyQuestion(const Scene& scene, std::size_t poses, std::size_t motions, Random& random)
{
  Asked asked;
  const double size = sizeOf(scene), length = scene.clearance > 0.0 ? 4 * scene.clearance : 1.0;
  asked.request.clearance = scene.clearance;
  asked.request.swept = std::max(1e-9 * size, length * std::exp2(random.uniform(-8, 0)));
  asked.poses = anyPoses(scene, poses, length, random);
  asked.motions = anyMotions(poses, motions, random);
  if (random.chance(0.5)) {
    const PointsView view = scene.b.view();
    for (std::size_t i = 0; i < view.size(); ++i) {
      const Point3 p = view.point(view.record(i));
      if (std::isfinite(p[0] + p[1] + p[2])) asked.request.pivot = p;
    }
  }
  return asked;
}

TEST(OnMotions, EachIsThatOfTheMotionAloneForRandomCloudsAndThreads)
{
  Random random(31);
  std::size_t free = 0, colliding = 0;
  for (std::uint64_t seed = 800; seed < 836; ++seed) {
    const Scene scene = test::anyScene(seed, seed % 10 == 0 ? 2000 : 150);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    const Placed scan{a, scene.pose_a};
    Asked asked = anyQuestion(scene, 12, 30, random);
    asked.request.threads = static_cast<unsigned>(seed % 3) + 1;
    const AnyOnMotions found = anyCollisionOnMotions(scan, b, asked.poses, asked.motions, asked.request);
    ASSERT_EQ(found.flags.size(), asked.motions.size());
    std::size_t count = 0;
    for (std::size_t m = 0; m < asked.motions.size(); ++m) {
      const Eigen::Isometry3d &from = asked.poses[asked.motions[m].from], &to = asked.poses[asked.motions[m].to];
      ASSERT_EQ(found.flags[m], verdictAlone(scan, b, from, to, asked.request)) << "motion " << m;
      ASSERT_EQ(motionBetween(from, to, {0, 0, 0}).from().matrix(), motionBetween(to, from, {0, 0, 0}).from().matrix());
      count += found.flags[m] == Verdict::colliding;
    }
    EXPECT_EQ(found.colliding, count);
    colliding += count;
    free += asked.motions.size() - count;
  }
  EXPECT_GT(free, 200u);
  EXPECT_GT(colliding, 200u);
}

TEST(OnMotions, OfUncertainPointsEachIsThatOfTheMotionAlone)
{
  Random random(34);
  std::size_t verdicts[3] = {};
  for (std::uint64_t seed = 840; seed < 856; ++seed) {
    Scene scene = test::anyScene(seed, 40);
    SCOPED_TRACE(scene.name);
    const double scale = scene.clearance > 0.0 ? scene.clearance : 0.01;
    if (random.chance(0.7)) test::makeUncertain(scene.a, scale, random);
    test::makeUncertain(scene.b, scale, random);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    const Placed scan{a, scene.pose_a};
    Asked asked = anyQuestion(scene, 8, 12, random);
    asked.request.threads = static_cast<unsigned>(seed % 3) + 1;
    double done = 0.0;
    asked.request.progress = [&](double now) {
      EXPECT_GE(now, done);
      done = now;
      return true;
    };
    const AnyOnMotions found = anyCollisionOnMotions(scan, b, asked.poses, asked.motions, asked.request);
    asked.request.progress = {};
    std::size_t counts[3] = {};
    for (std::size_t m = 0; m < asked.motions.size(); ++m) {
      const Eigen::Isometry3d &from = asked.poses[asked.motions[m].from], &to = asked.poses[asked.motions[m].to];
      ASSERT_EQ(found.flags[m], verdictAlone(scan, b, from, to, asked.request)) << "motion " << m;
      ++counts[test::numberOf(found.flags[m])];
    }
    EXPECT_EQ(found.colliding, counts[1]);
    EXPECT_EQ(found.undecided, counts[2]);
    for (int i = 0; i < 3; ++i) verdicts[i] += counts[i];
  }
  for (const std::size_t count : verdicts) EXPECT_GT(count, 10u);
}

Eigen::Isometry3d at(double x, double y = 0.0, double angle = 0.0)
{
  Eigen::Isometry3d pose(Eigen::Translation3d(x, y, 0.0));
  pose.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return pose;
}

TEST(OnMotions, OfUncertainPointsBothEdgesHold)
{
  // 0.5 + 0.375 and 0.5 - 0.375, passed by on a straight way at both poses' height
  Cloud still({{0, 0, 0}}, {Scalar::float64}), moving({{0, 0, 0}}, {Scalar::float64});
  still.setUncertainties(0.125, {});
  moving.setUncertainties(0.125, {0.125f});
  const SphereHierarchy scan(still.view()), model(moving.view());
  MotionsRequest request;
  request.clearance = 0.5;
  request.swept = 1e-6;
  const auto pass = [&](double distance) {
    const Poses poses = {at(-2, distance, 0), at(2, distance, 0)};
    const AnyOnMotions found = anyCollisionOnMotions({scan}, model, poses, {{0, 1}, {1, 0}}, request);
    const AnyOnMotions brute = brute_force::anyCollisionOnMotions({scan}, model, poses, {{0, 1}, {1, 0}}, request);
    EXPECT_EQ(found.flags, brute.flags) << distance;
    EXPECT_EQ(found.flags[0], found.flags[1]);
    return found.flags[0];
  };
  EXPECT_EQ(pass(0.125), Verdict::colliding);
  EXPECT_EQ(pass(0.125 + 1.1e-6), Verdict::undecided);
  EXPECT_EQ(pass(0.875), Verdict::undecided);
  EXPECT_EQ(pass(0.875 + 1.1e-6), Verdict::free);
  // The verdict at a pose alone, to the last bit.
  const auto rest = [&](double distance) {
    const Poses poses = {at(0, distance, 0)};
    request.swept = 1e-12;
    return anyCollisionOnMotions({scan}, model, poses, {{0, 0}}, request).flags[0];
  };
  EXPECT_EQ(rest(0.125), Verdict::colliding);
  EXPECT_EQ(rest(0.875), Verdict::undecided);
}

TEST(OnMotions, HoldsAtEachInstantAsBruteForceDoes)
{
  Random random(32);
  for (std::uint64_t seed = 900; seed < 924; ++seed) {
    const Scene scene = test::anyScene(seed, 12);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    const Placed scan{a, scene.pose_a};
    const Asked asked = anyQuestion(scene, 8, 8, random);
    const AnyOnMotions found = anyCollisionOnMotions(scan, b, asked.poses, asked.motions, asked.request);
    const AnyOnMotions brute = brute_force::anyCollisionOnMotions(scan, b, asked.poses, asked.motions, asked.request);
    for (std::size_t m = 0; m < asked.motions.size(); ++m) {
      const RigidMotion motion =
          motionBetween(asked.poses[asked.motions[m].from], asked.poses[asked.motions[m].to], asked.request.pivot);
      const Instants truth = lookAt(scan, scene.a, scene.b, motion, asked.request, 40);
      for (const Verdict verdict : {found.flags[m], brute.flags[m]}) {
        EXPECT_GE(verdict, test::verdictIf(truth.collides)) << "motion " << m;
        EXPECT_LE(verdict, test::verdictIf(truth.nears)) << "motion " << m;
      }
    }
  }
}

/// A bumpy body in a room of bumpy walls, and a roadmap: vertices with edges to their neighbours.
struct Roadmap {
  Roadmap(int points, std::size_t vertices, double step)
  : random(33),
    hall_cloud(surface(points, 4.0, random)),
    body_cloud(surface(points / 4, 0.5, random)),
    hall(hall_cloud.view()),
    body(body_cloud.view())
  {
    for (std::size_t k = 0; k < vertices; ++k) {
      Eigen::Isometry3d pose = random.pose(3.2);
      pose.linear() =
          Eigen::AngleAxisd(random.uniform(-1, 1), Eigen::Vector3d(random.uniform(-1, 1), 1, 0.3).normalized())
              .toRotationMatrix();
      poses.push_back(pose);
    }
    for (std::uint32_t i = 0; i < vertices; ++i)
      for (std::uint32_t j = 0; j < i; ++j)
        if ((poses[i].translation() - poses[j].translation()).norm() < step) motions.push_back({i, j});
    request.clearance = 0.02;
    request.swept = 0.005;
  }

  static std::vector<Point3> surface(int points, double radius, Random& random)
  {
    std::vector<Point3> all = test::makePoints(test::Shape::sphere, static_cast<std::size_t>(points), 1.0, random);
    for (Point3& p : all) {
      const double bump = radius * (1.0 + 0.1 * std::sin(5 * p[0]) * std::cos(7 * p[1] + 3 * p[2]));
      for (double& x : p) x *= bump;
    }
    return all;
  }

  Random random;
  Cloud hall_cloud, body_cloud;
  SphereHierarchy hall, body;
  Poses poses;
  Motions motions;
  MotionsRequest request;
};

TEST(OnMotions, InAnyOrderByAnyNumberOfThreads)
{
  Roadmap map(4000, 260, 1.1);
  const AnyOnMotions one = anyCollisionOnMotions({map.hall}, map.body, map.poses, map.motions, map.request);
  EXPECT_GT(map.motions.size(), 300u);
  EXPECT_GT(one.colliding, 50u);
  EXPECT_LT(one.colliding, map.motions.size() - 50);
  for (std::size_t m = 0; m < map.motions.size(); m += 3)
    ASSERT_EQ(one.flags[m], verdictAlone({map.hall}, map.body, map.poses[map.motions[m].from],
                                         map.poses[map.motions[m].to], map.request));
  for (const unsigned threads : {2u, 3u, 0u}) {
    map.request.threads = threads;
    const AnyOnMotions several = anyCollisionOnMotions({map.hall}, map.body, map.poses, map.motions, map.request);
    EXPECT_EQ(several.flags, one.flags);
    EXPECT_EQ(test::countsOf(several.work).at("node_pairs"), test::countsOf(one.work).at("node_pairs"));
  }
  std::vector<std::size_t> order(map.motions.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  Motions shuffled;
  for (const std::size_t i : order) shuffled.push_back(map.motions[i]);
  for (std::size_t i = 0; i < shuffled.size(); i += 2) std::swap(shuffled[i].from, shuffled[i].to);
  const AnyOnMotions other = anyCollisionOnMotions({map.hall}, map.body, map.poses, shuffled, map.request);
  for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(other.flags[i], one.flags[order[i]]);
}

/// Counted, not timed.
TEST(OnMotions, ShareWhatTheyHaveInCommon)
{
  const Roadmap map(20000, 260, 1.1);
  map.hall.buildAll();
  map.body.buildAll();
  const Work together = anyCollisionOnMotions({map.hall}, map.body, map.poses, map.motions, map.request).work;
  Work alone;
  for (const PoseMotion& motion : map.motions) {
    TrajectoryRequest request = flagsOnly(map.request.clearance);
    request.swept = map.request.swept;
    alone += collideAlong({map.hall}, map.body, {map.poses[motion.from], map.poses[motion.to]}, request).work;
  }
  EXPECT_LT(4 * together.node_pairs, alone.node_pairs);
}

/// Free at both ends and in the middle, and a single point is met on the way.
TEST(OnMotions, FindsWhatIsMetAtOneInstantOnly)
{
  const Cloud body({{0, 0, 0}});
  const SphereHierarchy model(body.view());
  const Poses poses = {at(-1), at(1), at(1, 1e-9)};
  MotionsRequest request;
  request.clearance = 0x1p-20;
  request.swept = 0x1p-24;
  for (int i = -97; i <= 97; ++i) {
    const Cloud post({{i / 100.0, 0, 0}}, {Scalar::float64, 0, 0});
    const SphereHierarchy scan(post.view());
    EXPECT_EQ(anyCollisionOnMotions({scan}, model, poses, {{0, 1}, {1, 0}, {0, 2}, {0, 0}}, request).flags,
              test::verdictsOf({1, 1, 1, 0}));
    const Cloud beside_cloud({{i / 100.0, 0x1p-20 + 0x1p-23, 0}}, {Scalar::float64, 0, 0});
    const SphereHierarchy beside(beside_cloud.view());
    EXPECT_EQ(anyCollisionOnMotions({beside}, model, poses, {{0, 1}, {1, 0}}, request).colliding, 0u);
  }
}

/// The tip of a rod swings in an arc, which the straight line between its ends does not follow; and past what lies
/// behind the arc by little more than clearance + tolerance.
TEST(OnMotions, FollowsTheArcOfATip)
{
  std::vector<Point3> rod;
  for (int i = 0; i <= 200; ++i) rod.push_back({0.01 * i, 0, 0});
  const Cloud body(rod, {Scalar::float64, 0, 0});
  const SphereHierarchy model(body.view());
  const Poses poses = {at(0, 0, -1.4), at(0, 0, 1.4)};
  MotionsRequest request;
  request.clearance = 0.001;
  request.swept = 0.0005;
  for (double angle = -1.39; angle < 1.4; angle += 0.037) {
    for (const auto& [length, verdict] : {std::pair(2.0 + 0.00099, 1), std::pair(2.0 + 0.00151, 0)}) {
      const Cloud post({{length * std::cos(angle), length * std::sin(angle), 0}}, {Scalar::float64, 0, 0});
      const SphereHierarchy scan(post.view());
      EXPECT_EQ(anyCollisionOnMotions({scan}, model, poses, {{0, 1}}, request).colliding, verdict) << angle;
    }
  }
}

/// Points beside the path of a point of the model, at random instants, as far from it as the clearance or just beyond
/// the tolerance. Many motions make a batch, so that bounds for groups of them are tested.
TEST(OnMotions, GrazesAreRightInBatches)
{
  Random random(34);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Point3> body_points = test::makePoints(test::Shape::uniform, 60, 1.0, random);
    const Cloud body(body_points, {Scalar::float64, 0, 0});
    const SphereHierarchy model(body.view());
    MotionsRequest request;
    request.clearance = 0.01;
    request.swept = 0.002;
    request.pivot = random.point([&] { return random.uniform(-1, 1); });
    const double spread = std::pow(10.0, random.uniform(-2, 1));
    Poses poses;
    Motions motions;
    for (std::uint32_t k = 0; k < 60; ++k) {
      Eigen::Isometry3d pose = random.pose(spread);
      const Eigen::AngleAxisd turn(pose.linear());
      pose.linear() = Eigen::AngleAxisd(0.4 * turn.angle(), turn.axis()).toRotationMatrix();
      poses.push_back(pose);
      if (k > 0) motions.push_back({k - 1, k});
    }
    // One point of the scan, outside what the other motions come near to as often as not.
    const auto m = static_cast<std::size_t>(random.integer(0, 58));
    const RigidMotion motion = motionBetween(poses[motions[m].from], poses[motions[m].to], request.pivot);
    const Point3 q = body_points[static_cast<std::size_t>(random.integer(0, 59))];
    const Eigen::Vector3d at = motion.at(random.uniform(0, 1)) * Eigen::Vector3d(q[0], q[1], q[2]);
    const Eigen::Vector3d away = Eigen::Vector3d{random.uniform(-1, 1), random.uniform(-1, 1), 0.2}.normalized();
    const Eigen::Vector3d post = at + 0.00999 * away;
    const Cloud scan_cloud({{post[0], post[1], post[2]}}, {Scalar::float64, 0, 0});
    const SphereHierarchy scan(scan_cloud.view());
    const AnyOnMotions found = anyCollisionOnMotions({scan}, model, poses, motions, request);
    EXPECT_EQ(found.flags[m], Verdict::colliding) << trial;
    for (std::size_t i = 0; i < motions.size(); ++i)
      ASSERT_EQ(found.flags[i], verdictAlone({scan}, model, poses[motions[i].from], poses[motions[i].to], request));
  }
}

TEST(OnMotions, NoPointOfTheBodyLeavesTheExtentAroundTheMiddle)
{
  Random random(35);
  double most = 0.0;
  for (int trial = 0; trial < 100; ++trial) {
    const double scale = std::pow(10.0, random.integer(-3, 6)), far = random.chance(0.3) ? 1e6 * scale : 0.0;
    std::vector<Point3> points = test::makePoints(test::Shape::uniform, 20, scale, random);
    for (Point3& p : points) p[0] += far;
    const Cloud cloud(points, {Scalar::float64, 0, 0});
    const SphereHierarchy body(cloud.view());
    const Point3 pivot = {random.chance(0.5) ? far : 0.0, 0, 0};
    Eigen::Isometry3d from = random.pose(scale), to = random.chance(0.7) ? random.pose(scale) : from;
    if (random.chance(0.5)) from.linear() *= 1.0 + 2e-7, to.linear() *= 1.0 - 2e-7;
    const RigidMotion motion = motionBetween(from, to, pivot);
    const Eigen::Isometry3d middle = motion.at(0.5);
    const double extent = extentAround(middle, motion, BodyBall(body));
    for (int i = 0; i <= 16; ++i) {
      const ExactDistance distance(middle, motion.at(i / 16.0));
      for (const Point3& p : points) {
        ASSERT_LE(distance.compare(p, p, extent), 0) << trial;
        if (extent > 0.0) most = std::max(most, distance.gap({p, p, 0.0, 0.0}) / extent);
      }
    }
  }
  EXPECT_GT(most, 0.7) << "the bound is loose";
}

TEST(OnMotions, EmptyListsAndClouds)
{
  const Cloud point({{0, 0, 0}}), none(std::vector<Point3>{});
  const SphereHierarchy a(point.view()), empty(none.view());
  MotionsRequest request;
  request.swept = 0.1;
  EXPECT_TRUE(anyCollisionOnMotions({a}, a, Poses(), {}, request).flags.empty());
  const AnyOnMotions of_none = anyCollisionOnMotions({a}, a, Poses{identity}, {}, request);
  EXPECT_TRUE(of_none.flags.empty());
  EXPECT_EQ(of_none.work.volumes_built, 0u);
  EXPECT_EQ(anyCollisionOnMotions({a}, empty, Poses{identity}, {{0, 0}}, request).flags[0], Verdict::free);
  EXPECT_EQ(anyCollisionOnMotions({empty}, a, Poses{identity}, {{0, 0}}, request).flags[0], Verdict::free);
  EXPECT_EQ(anyCollisionOnMotions({a}, a, Poses{identity}, {{0, 0}}, request).flags[0], Verdict::colliding);
}

template <class Call>
std::string messageOf(const Call& call)
{
  try {
    call();
  }
  catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(OnMotions, CollideAtTheirEndsWhateverTheTolerance)
{
  const Cloud point({{0, 0, 0}});
  const SphereHierarchy a(point.view());
  const Poses poses = {at(0.45), at(6.45)};
  MotionsRequest request;
  request.clearance = 0.5;
  for (const double swept : {0.01, 0.2, 1.0}) {
    request.swept = swept;
    const AnyOnMotions found = anyCollisionOnMotions({a}, a, poses, {{0, 1}, {1, 0}}, request);
    EXPECT_EQ(found.flags, std::vector<Verdict>(2, Verdict::colliding)) << swept;
    EXPECT_LT(found.work.volumes_built + found.work.node_pairs, 100u);
  }
}

TEST(OnMotions, RefusesWhatHasNoMeaningAndNamesIt)
{
  const Cloud point({{0, 0, 0}}), none(std::vector<Point3>{});
  const SphereHierarchy a(point.view()), empty(none.view());
  Poses poses(3000, at(5));
  poses[1] = at(5, 0, M_PI);
  poses[2] = at(0);
  MotionsRequest good;
  good.swept = 0.1;
  const auto refusal = [&](const Motions& motions, const MotionsRequest& request) {
    const std::string message = messageOf([&] { anyCollisionOnMotions({a}, a, poses, motions, request); });
    MotionsRequest threads = request;
    threads.threads = 3;
    EXPECT_EQ(messageOf([&] { anyCollisionOnMotions({a}, a, poses, motions, threads); }), message);
    EXPECT_EQ(messageOf([&] { brute_force::anyCollisionOnMotions({a}, a, poses, motions, request); }), message);
    return message;
  };
  EXPECT_EQ(refusal({{0, 0}, {2, 3000}}, good),
            "motion 1, from pose 2 to pose 3000: the list has 3000 poses: name poses by their indices in the list, "
            "from 0");
  EXPECT_EQ(refusal({{0, 0}, {3000, 2}}, good),
            "motion 1, from pose 3000 to pose 2: the list has 3000 poses: name poses by their indices in the list, "
            "from 0");
  EXPECT_EQ(refusal({{0, 2}, {0, 1}, {1, 0}}, good),
            "motion 1, from pose 0 to pose 1: half a turn, both directions are as short: give a pose between them");
  EXPECT_EQ(refusal(Motions(5000, {0, 2}), good), "");
  Motions late(5000, {0, 2});
  late[4000] = late[4500] = {2, 1}; // pose 2 collides: refused nevertheless
  EXPECT_THAT(refusal(late, good), testing::HasSubstr("motion 4000, from pose 2 to pose 1: half a turn"));
  MotionsRequest wrong = good;
  wrong.swept = 0.0;
  EXPECT_THAT(refusal({{0, 2}}, wrong), testing::HasSubstr("swept: 0: give"));
  wrong.swept = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal({{0, 2}}, wrong), testing::HasSubstr("swept"));
  wrong.swept = 1e-18;
  EXPECT_THAT(refusal({{0, 2}}, wrong), testing::HasSubstr("too small"));
  wrong = good;
  wrong.clearance = -1.0;
  EXPECT_THAT(refusal({{0, 2}}, wrong), testing::HasSubstr("clearance"));
  wrong = good;
  wrong.pivot[1] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal({{0, 2}}, wrong), testing::HasSubstr("pivot"));
  Eigen::Isometry3d stretched = Eigen::Isometry3d::Identity();
  stretched.linear() *= 1.1;
  EXPECT_THAT(messageOf([&] {
                anyCollisionOnMotions({a, stretched}, a, poses, {{0, 2}}, good);
              }),
              testing::HasSubstr("pose of the scan: not rigid"));
  poses[2000].translation().z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal({{0, 2}}, good), testing::HasSubstr("pose 2000 of the model: not finite"));
  poses[1999].linear() *= 1.1;
  EXPECT_THAT(refusal({{0, 2}}, good), testing::HasSubstr("pose 1999 of the model: not rigid"));
  EXPECT_THAT(messageOf([&] { anyCollisionOnMotions({empty}, a, poses, {{0, 2}}, good); }), testing::HasSubstr("1999"));
}

/// Motions that cannot be cut, and would be refused nowhere else.
TEST(OnMotions, RefusesATightToleranceByTheMotion)
{
  const Cloud point({{0, 0, 0}, {3e4, 0, 0}});
  const SphereHierarchy a(point.view());
  const Poses poses = {at(1e6), at(1e6, 1), at(1e6, 0, 3.1), at(1e6, 0, 3)};
  MotionsRequest request;
  request.swept = 1e-5;
  EXPECT_EQ(anyCollisionOnMotions({a}, a, poses, {{0, 1}, {0, 2}}, request).colliding, 0u);
  request.swept = 1e-8;
  for (const Motions& motions : {Motions{{0, 1}, {0, 2}}, Motions{{0, 1}, {0, 3}}}) {
    const std::string message = messageOf([&] { anyCollisionOnMotions({a}, a, poses, motions, request); });
    TrajectoryRequest alone = flagsOnly(0.0);
    alone.swept = request.swept;
    const std::string expected = messageOf([&] { collideAlong({a}, a, {poses[0], poses[motions[1].to]}, alone); });
    EXPECT_EQ(message.empty(), expected.empty()) << expected;
  }
}

TEST(OnMotions, ACallbackStopsItInThreads)
{
  struct Mine {};
  Roadmap map(2000, 150, 1.5);
  PointsView view = map.hall.view();
  view.uncertainty = 0.02; // which is decided in two parts
  const SphereHierarchy uncertain(view);
  const SphereHierarchy& certain = map.hall;
  for (const auto& [hall, threads] : {std::pair(&certain, 1u), {&certain, 2u}, {&uncertain, 1u}}) {
    map.request.threads = threads;
    double last = 0.0;
    map.request.progress = [&](double done) {
      EXPECT_GE(done, last);
      EXPECT_LE(done, 1.0);
      last = done;
      return true;
    };
    const AnyOnMotions whole = anyCollisionOnMotions({*hall}, map.body, map.poses, map.motions, map.request);
    EXPECT_EQ(last, 1.0);
    for (const int stop_at : {1, 2, 5}) {
      int calls = 0;
      map.request.progress = [&](double) { return ++calls < stop_at; };
      EXPECT_THROW(anyCollisionOnMotions({*hall}, map.body, map.poses, map.motions, map.request), Cancelled);
      EXPECT_EQ(calls, stop_at) << "no call after the one that asked to stop";
      calls = 0;
      map.request.progress = [&](double) -> bool {
        if (++calls == stop_at) throw Mine();
        return true;
      };
      EXPECT_THROW(anyCollisionOnMotions({*hall}, map.body, map.poses, map.motions, map.request), Mine);
    }
    map.request.progress = nullptr;
    EXPECT_EQ(anyCollisionOnMotions({*hall}, map.body, map.poses, map.motions, map.request).flags, whole.flags);
  }
}

} // namespace
} // namespace pcl_bsh

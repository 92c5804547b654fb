// SPDX-License-Identifier: BSD-3-Clause
// Many poses at once: each answer is that of the single query, for any order of the list and any number of threads.
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>

#include "support/brute_force/many_poses.h"
#include "support/random_clouds.h"
#include "support/refusal.h"
#include "support/verdicts.h"
#include "support/work_counts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <random>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::refusalOf;
using test::Scene;
using Poses = std::vector<Eigen::Isometry3d>;

/// Around the scene's pose of b: alike, near, and all over the place.
Poses posesNear(const Scene& scene, std::size_t count, double length, Random& random)
{
  Poses poses;
  for (std::size_t i = 0; i < count; ++i) {
    const double spread = length * std::pow(10.0, random.integer(-6, 0));
    Eigen::Isometry3d pose = scene.pose_b;
    if (i % 8 != 0) pose = pose * random.pose(spread);
    if (i % 8 == 7) pose.linear() = scene.pose_b.linear();
    if (i % 16 == 3) pose.translation() += Eigen::Vector3d(1e9, 0, 0);
    poses.push_back(pose);
  }
  return poses;
}

void expectSingleAnswers(const Scene& scene, const Poses& poses, double clearance, unsigned threads)
{
  SCOPED_TRACE(scene.name);
  const SphereHierarchy a(scene.a.view()), b(scene.b.view());
  const Placed placed{a, scene.pose_a};
  for (const Accuracy& accuracy : {Accuracy::exact(), Accuracy::tolerance(0.1)}) {
    const AnyAtPoses any = anyCollisionAtPoses(placed, b, poses, {clearance, {accuracy, threads}});
    const DistancesAtPoses closest = closestPairAtPoses(placed, b, poses, {accuracy, threads});
    ASSERT_EQ(any.flags.size(), poses.size());
    ASSERT_EQ(closest.distances.size(), poses.size());
    std::size_t colliding = 0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const AnyResult single = anyCollision(placed, {b, poses[i]}, {clearance, accuracy});
      ASSERT_EQ(any.flags[i], single.verdict) << i << ", " << accuracy.text();
      colliding += single.verdict == Verdict::colliding;
      const DistanceResult nearest = closestPair(placed, {b, poses[i]}, {accuracy});
      ASSERT_EQ(closest.distances[i], nearest.distance) << i;
      ASSERT_EQ(closest.pairs.empty(), !nearest.pair);
      if (nearest.pair) {
        ASSERT_EQ(closest.pairs[i], *nearest.pair) << i;
      }
    }
    ASSERT_EQ(any.colliding, colliding);
  }
}

TEST(AtPoses, SameAsSingleQueriesOnRandomCloudsAndThreads)
{
  Random random(21);
  for (std::uint64_t seed = 500; seed < 560; ++seed) {
    const Scene scene = test::anyScene(seed, seed % 10 == 0 ? 3000 : 200);
    const double length = scene.clearance > 0.0 ? 4 * scene.clearance : 1.0;
    expectSingleAnswers(scene, posesNear(scene, seed % 3 == 0 ? 1 : 40, length, random), scene.clearance,
                        static_cast<unsigned>(seed % 5) + 1);
  }
}

TEST(AtPoses, SameAsBruteForce)
{
  Random random(22);
  for (std::uint64_t seed = 600; seed < 640; ++seed) {
    const Scene scene = test::anyScene(seed, 40);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    const Placed placed{a, scene.pose_a};
    const Poses poses = posesNear(scene, 20, scene.clearance + 0.5, random);
    const AnyRequest any{scene.clearance, {}};
    const AnyAtPoses expected = brute_force::anyCollisionAtPoses(placed, b, poses, any);
    const AnyAtPoses result = anyCollisionAtPoses(placed, b, poses, any);
    EXPECT_EQ(result.flags, expected.flags) << scene.name;
    EXPECT_EQ(result.colliding, expected.colliding);
    const DistancesAtPoses closest = closestPairAtPoses(placed, b, poses);
    const DistancesAtPoses brute = brute_force::closestPairAtPoses(placed, b, poses);
    EXPECT_EQ(closest.distances, brute.distances) << scene.name;
    EXPECT_EQ(closest.pairs, brute.pairs) << scene.name;
    DistanceRequest up_to;
    up_to.max_distance = brute.distances.empty() ? 0.0 : std::max(0.0, brute.distances[poses.size() / 2]);
    const DistancesAtPoses near = closestPairAtPoses(placed, b, poses, up_to);
    const DistancesAtPoses brute_near = brute_force::closestPairAtPoses(placed, b, poses, up_to);
    EXPECT_EQ(near.distances, brute_near.distances) << scene.name;
    EXPECT_EQ(near.pairs, brute_near.pairs) << scene.name;
  }
}

/// Bodies with a bumpy surface, and poses around a place where they just touch.
struct Bodies {
  explicit Bodies(int points, std::size_t count, double spread)
  : random(23),
    cloud_a(surface(points, random)),
    cloud_b(surface(points, random)),
    a(cloud_a.view()),
    b(cloud_b.view())
  {
    for (std::size_t i = 0; i < count; ++i) {
      Eigen::Isometry3d pose = random.pose(1.0);
      pose.translation() *= spread;
      const Eigen::AngleAxisd turn(pose.linear());
      pose.linear() = Eigen::AngleAxisd(spread * turn.angle(), turn.axis()).toRotationMatrix();
      pose.translation().x() += 2.0;
      poses.push_back(pose);
    }
  }

  static std::vector<Point3> surface(int points, Random& random)
  {
    std::vector<Point3> all = test::makePoints(test::Shape::sphere, static_cast<std::size_t>(points), 1.0, random);
    for (Point3& p : all) {
      const double bump = 1.0 + 0.03 * std::sin(9 * p[0]) * std::cos(11 * p[1] + 3 * p[2]);
      for (double& x : p) x *= bump;
    }
    return all;
  }

  Random random;
  Cloud cloud_a, cloud_b;
  SphereHierarchy a, b;
  Poses poses;
};

/// All lengths times a power of two: frames have a unit of their own there.
TEST(AtPoses, AreTheSameAtAnyScale)
{
  Random random(171);
  const std::vector<Point3> body = test::makePoints(test::Shape::sphere, 400, 1.0, random);
  const std::vector<Point3> hall = test::makePoints(test::Shape::clusters, 600, 4.0, random);
  Poses poses;
  for (int i = 0; i < 300; ++i) poses.push_back(random.pose(2.0));
  const auto answersAt = [&](double scale) {
    const auto scaled = [&](std::vector<Point3> points) {
      for (Point3& p : points)
        for (double& x : p) x *= scale;
      return Cloud(points, {Scalar::float64, 0, 0});
    };
    const Cloud of_a = scaled(hall), of_b = scaled(body);
    Poses there = poses;
    for (Eigen::Isometry3d& pose : there) pose.translation() *= scale;
    const SphereHierarchy a(of_a.view()), b(of_b.view());
    AnyRequest request;
    request.clearance = 0.5 * scale;
    DistancesAtPoses closest = closestPairAtPoses({a}, b, there, {});
    for (double& distance : closest.distances) distance /= scale;
    return std::pair(anyCollisionAtPoses({a}, b, there, request).flags, closest.distances);
  };
  const auto expected = answersAt(1.0);
  EXPECT_GT(countOf(expected.first, Verdict::colliding), 50u);
  EXPECT_GT(countOf(expected.first, Verdict::free), 50u);
  for (const double scale : {0x1p-70, 0x1p70}) {
    SCOPED_TRACE(scale);
    EXPECT_EQ(answersAt(scale), expected);
  }
}

TEST(AtPoses, TenThousandInAnyOrderByAnyNumberOfThreads)
{
  for (const double spread : {0.001, 0.05, 0.5}) {
    Bodies bodies(3000, 10000, spread);
    AnyRequest request{0.03, {}};
    const AnyAtPoses one = anyCollisionAtPoses({bodies.a}, bodies.b, bodies.poses, request);
    for (std::size_t i = 0; i < bodies.poses.size(); i += 7) {
      const AnyResult single = anyCollision({bodies.a}, {bodies.b, bodies.poses[i]}, request);
      ASSERT_EQ(one.flags[i], single.verdict) << i;
    }
    if (spread > 0.001) {
      EXPECT_GT(one.colliding, 500u);
      EXPECT_LT(one.colliding, 9500u);
    }
    for (const unsigned threads : {2u, 5u}) {
      request.threads = threads;
      const AnyAtPoses several = anyCollisionAtPoses({bodies.a}, bodies.b, bodies.poses, request);
      ASSERT_EQ(several.flags, one.flags);
      ASSERT_EQ(test::countsOf(several.work).at("node_pairs"), test::countsOf(one.work).at("node_pairs"));
    }
    std::vector<std::size_t> order(bodies.poses.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    Poses shuffled;
    for (const std::size_t i : order) shuffled.push_back(bodies.poses[i]);
    const AnyAtPoses other = anyCollisionAtPoses({bodies.a}, bodies.b, shuffled, request);
    for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(other.flags[i], one.flags[order[i]]);

    const Poses some(bodies.poses.begin(), bodies.poses.begin() + 300);
    Poses reversed(some.rbegin(), some.rend());
    const DistancesAtPoses closest = closestPairAtPoses({bodies.a}, bodies.b, some, {{}, 2});
    DistancesAtPoses back = closestPairAtPoses({bodies.a}, bodies.b, reversed);
    std::reverse(back.distances.begin(), back.distances.end());
    std::reverse(back.pairs.begin(), back.pairs.end());
    EXPECT_EQ(back.distances, closest.distances);
    EXPECT_EQ(back.pairs, closest.pairs);
  }
}

/// The pair that collides at one pose is tried first at the next.
TEST(AtPoses, NeighboursShareTheirWitness)
{
  const Bodies bodies(20000, 640, 1e-6);
  const AnyRequest request{0.1};
  const AnyAtPoses together = anyCollisionAtPoses({bodies.a}, bodies.b, bodies.poses, request);
  EXPECT_EQ(together.colliding, bodies.poses.size());
  Work alone;
  for (const Eigen::Isometry3d& pose : bodies.poses) alone += anyCollision({bodies.a}, {bodies.b, pose}, request).work;
  EXPECT_LT(32 * together.work.node_pairs, alone.node_pairs);
}

TEST(AtPoses, CostNoMoreThanSingleQueries)
{
  Random random(31);
  const Bodies bodies(20000, 0, 0.0);
  bodies.a.buildAll();
  bodies.b.buildAll();
  for (const double farthest : {2.1, 2.5}) {
    Poses poses;
    for (int i = 0; i < 2000; ++i) {
      Eigen::Isometry3d pose = random.pose(1.0);
      pose.translation() = pose.translation().normalized() * random.uniform(1.7, farthest);
      poses.push_back(pose);
    }
    const AnyRequest request{0.01, {}};
    const AnyAtPoses together = anyCollisionAtPoses({bodies.a}, bodies.b, poses, request);
    EXPECT_GT(together.colliding, 100u);
    EXPECT_LT(together.colliding, 1900u);
    Work alone;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const AnyResult single = anyCollision({bodies.a}, {bodies.b, poses[i]}, request);
      ASSERT_EQ(together.flags[i], single.verdict) << i;
      alone += single.work;
    }
    EXPECT_LT(static_cast<double>(together.work.node_pairs), 1.02 * static_cast<double>(alone.node_pairs));
  }
}

/// Makes its poses as they are asked for.
struct Shelf {
  std::size_t size() const { return 50; }
  Eigen::Isometry3d operator[](std::size_t i) const
  {
    return Eigen::Isometry3d(Eigen::Translation3d(0.1 * static_cast<double>(i), 0, 0));
  }
};

TEST(AtPoses, TakesAnyListAndEmptyOnes)
{
  const Cloud point({{0, 0, 0}}), none(std::vector<Point3>{});
  const SphereHierarchy a(point.view()), empty(none.view());
  const AnyRequest request{1.05, {}};
  EXPECT_EQ(anyCollisionAtPoses({a}, a, Shelf(), request).colliding, 11u);
  EXPECT_EQ(anyCollisionAtPoses({a}, a, std::deque<Eigen::Isometry3d>(3, Eigen::Isometry3d::Identity())).colliding, 3u);
  EXPECT_TRUE(anyCollisionAtPoses({a}, a, Poses()).flags.empty());
  EXPECT_TRUE(closestPairAtPoses({a}, a, Poses()).distances.empty());
  EXPECT_EQ(anyCollisionAtPoses({a}, empty, Shelf(), request).colliding, 0u);
  EXPECT_EQ(anyCollisionAtPoses({empty}, a, Shelf(), request).flags, std::vector<Verdict>(50, Verdict::free));
  EXPECT_TRUE(closestPairAtPoses({a}, empty, Shelf()).pairs.empty());
  EXPECT_EQ(closestPairAtPoses({a}, empty, Shelf()).distances[49], std::numeric_limits<double>::infinity());
}

TEST(AtPoses, RefusesWhatTheSingleQueriesRefuseByTheIndexOfThePose)
{
  const Cloud point({{0, 0, 0}});
  const SphereHierarchy a(point.view());
  Poses poses(2000, Eigen::Isometry3d::Identity());
  poses[1234].translation().x() = std::numeric_limits<double>::quiet_NaN();
  poses[1300].linear() *= 2.0;
  for (const unsigned threads : {1u, 4u}) {
    EXPECT_THAT(refusalOf([&] {
                  anyCollisionAtPoses({a}, a, poses, {0.0, threads});
                }),
                testing::HasSubstr("pose 1234 of b"));
    EXPECT_THAT(refusalOf([&] {
                  closestPairAtPoses({a}, a, poses, {{}, threads});
                }),
                testing::HasSubstr("pose 1234 of b"));
  }
  poses.resize(10);
  EXPECT_THAT(refusalOf([&] { anyCollisionAtPoses({a}, a, poses, {-1.0, {}}); }), testing::HasSubstr("clearance"));
  EXPECT_THAT(refusalOf([&] {
                anyCollisionAtPoses({a}, a, poses, {1.0, Accuracy::time(1)});
              }),
              testing::HasSubstr("stops early"));
  Eigen::Isometry3d scaled = poses[0];
  scaled.linear() *= 2.0;
  EXPECT_THAT(refusalOf([&] { closestPairAtPoses({a, scaled}, a, poses); }), testing::HasSubstr("pose of a"));
}

TEST(AtPoses, ACallbackStopsThemInThreads)
{
  struct Mine {};
  const Bodies bodies(300, 1500, 0.05);
  PointsView view = bodies.a.view();
  view.uncertainty = 0.01; // which is decided in two parts
  const SphereHierarchy uncertain(view);
  for (const unsigned threads : {1u, 2u})
    for (const Accuracy& accuracy : {Accuracy::exact(), Accuracy::tolerance(0.1)}) {
      const auto any = [&](const std::function<bool(double)>& progress) {
        const Effort effort(accuracy, threads, progress);
        return anyCollisionAtPoses({bodies.a}, bodies.b, bodies.poses, {0.03, effort}).flags;
      };
      const auto any_uncertain = [&](const std::function<bool(double)>& progress) {
        const Effort effort(accuracy, threads, progress);
        return anyCollisionAtPoses({uncertain}, bodies.b, bodies.poses, {0.03, effort}).flags;
      };
      const auto closest = [&](const std::function<bool(double)>& progress) {
        const Poses some(bodies.poses.begin(), bodies.poses.begin() + 300);
        return closestPairAtPoses({bodies.a}, bodies.b, some, {accuracy, threads, progress}).distances;
      };
      const auto expectStops = [](const auto& query) {
        double last = 0.0;
        const auto whole = query([&](double done) {
          EXPECT_GE(done, last);
          last = done;
          return true;
        });
        EXPECT_EQ(last, 1.0);
        for (const int stop_at : {1, 2, 3}) {
          int calls = 0;
          const auto stops = [&](double) { return ++calls < stop_at; };
          const auto throws = [&](double) -> bool {
            if (++calls == stop_at) throw Mine();
            return true;
          };
          try {
            query(stops);
            EXPECT_LT(calls, stop_at) << "it went on"; // the other thread may have left the caller few of the batches
          }
          catch (const Cancelled&) {
            EXPECT_EQ(calls, stop_at) << "no call after the one that asked to stop";
          }
          calls = 0;
          try {
            query(throws);
            EXPECT_LT(calls, stop_at);
          }
          catch (const Mine&) {
            EXPECT_EQ(calls, stop_at);
          }
        }
        EXPECT_EQ(query({}), whole);
      };
      expectStops(any);
      expectStops(any_uncertain);
      expectStops(closest);
    }
}

} // namespace
} // namespace pcl_bsh

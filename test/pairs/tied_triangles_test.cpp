// SPDX-License-Identifier: BSD-3-Clause
// Closest pairs of surfaces of which all triangles are equally near: bounds cannot tell them apart, and the answer is
// the pair with the smallest numbers.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>

#include "support/tied_meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;
using test::Tied;
using test::TiedPair;

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

void expectAsBruteForce(const Placed& a, const Placed& b)
{
  const DistanceResult expected = brute_force::closestPair(a, b);
  for (const unsigned threads : {1u, 2u}) {
    DistanceRequest request;
    request.threads = threads;
    const DistanceResult found = closestPair(a, b, request);
    ASSERT_EQ(found.distance, expected.distance);
    ASSERT_EQ(found.pair->a, expected.pair->a);
    ASSERT_EQ(found.pair->b, expected.pair->b);
    ASSERT_LE(found.interval.lower, found.distance);
    ASSERT_GE(found.interval.upper, found.distance);
    ASSERT_LE(found.interval.upper - found.interval.lower, 1e-12);
  }
  DistanceRequest roughly;
  roughly.accuracy = Accuracy::tolerance(1e-13);
  const DistanceResult near = closestPair(a, b, roughly);
  ASSERT_LE(near.distance, expected.distance + 1e-13);
}

TEST(TiedTriangles, AnswerAsBruteForce)
{
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(seed);
    const TiedPair pair = test::anyTies(seed);
    const SphereHierarchy a(viewOf(pair.a.trianglesView())), b(viewOf(pair.b.trianglesView()));
    expectAsBruteForce({a, pair.pose_a}, {b, pair.pose_b});
  }
}

TEST(TiedTriangles, AnswerAsBruteForceBesidePoints)
{
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    SCOPED_TRACE(seed);
    const TiedPair pair = test::anyTies(seed);
    const SphereHierarchy a(viewOf(pair.a.trianglesView())), b(viewOf(pair.b.trianglesView()));
    std::vector<Point3> corners; // tips are there many times
    for (const Triangle& t : pair.b.triangles)
      for (const std::uint32_t corner : t) corners.push_back(pair.b.vertices[corner]);
    std::vector<float> radii(corners.size());
    Random random(seed);
    for (float& radius : radii) radius = static_cast<float>(random.pick({0.0, 0.0625, 0.125}));
    PointsView view = viewOf(corners[0].data(), corners.size());
    for (const float* own : {static_cast<const float*>(nullptr), static_cast<const float*>(radii.data())}) {
      view.radii = own;
      const SphereHierarchy points(view);
      expectAsBruteForce({a, pair.pose_a}, {points, pair.pose_b});
      expectAsBruteForce({points, pair.pose_b}, {a, pair.pose_a});
    }
  }
}

/// All pairs would be n / 2 decisions a triangle, and more.
TEST(TiedTriangles, TakeWorkInProportion)
{
  const Eigen::Isometry3d turned = Random(1).pose(3);
  for (const Tied& tied : test::tied())
    for (const Eigen::Isometry3d& pose : {identity, turned})
      for (const std::uint32_t n : {1000u, 4000u, 16000u})
        for (const bool swapped : {false, true}) {
          if (swapped && n > 4000) continue; // takes longer than all else here
          const TiedPair pair = tied.make(n);
          const SphereHierarchy a(viewOf(pair.a.trianglesView())), b(viewOf(pair.b.trianglesView()));
          const Placed both[2] = {{a, pose}, {b, pose}};
          const Work work = closestPair(both[swapped], both[!swapped]).work;
          const std::size_t triangles = pair.a.triangles.size() + pair.b.triangles.size();
          EXPECT_LE(work.node_pairs + 16 * work.leaf_pairs + work.exact_decisions, 40 * triangles)
              << tied.name << ", " << n << ", " << swapped;
        }
}

/// There are many triangles before the one that the other's tip is near, and all of the other share that tip.
TEST(TiedTriangles, TakeWorkInProportionBesideOneTip)
{
  for (const std::uint32_t n : {1000u, 4000u})
    for (const double turn : {2.0, 6.2}) {
      const test::TestMesh disc = test::cone(n, 1, 0, {0, 0, 0}),
                           cone = test::cone(n, 1, 1, {0.5 * std::cos(turn), 0.5 * std::sin(turn), 0.3});
      const SphereHierarchy a(viewOf(disc.trianglesView())), b(viewOf(cone.trianglesView()));
      for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
        const Work work = closestPair({*one}, {*other}).work;
        EXPECT_LE(work.node_pairs + 16 * work.leaf_pairs + work.exact_decisions, 80 * n) << n << ", " << turn;
      }
    }
}

/// One tip's answer for a disc's triangles tells nothing about another tip, which is as near to those with smaller
/// numbers.
TEST(TiedTriangles, AnswerAsBruteForceBesideTwoTips)
{
  const auto tip = [](std::uint32_t sides, double turn) {
    return test::cone(sides, 0.1, 0.1, {0.5 * std::cos(turn), 0.5 * std::sin(turn), 0.25});
  };
  for (const std::uint32_t few : {3u, 10u, 60u})
    for (double turn = 0.3; turn < 6; turn += 0.7) {
      const test::TestMesh disc = test::cone(60, 1, 0, {0, 0, 0});
      test::TestMesh tips = tip(60, turn);
      test::append(tips, tip(few, turn / 3));
      const SphereHierarchy a(viewOf(disc.trianglesView())), b(viewOf(tips.trianglesView()));
      expectAsBruteForce({a}, {b});
      expectAsBruteForce({b}, {a});
    }
}

/// The pair with the smallest numbers is at one end of an edge, and nearly all else is at the other.
TEST(TiedTriangles, AnswerAsBruteForceBesideAnEdge)
{
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const auto some = [&](int most) { return static_cast<std::uint32_t>(random.integer(3, most)); };
    const double apart = random.pick({0.1, 1.0, 4.0});
    test::TestMesh below;
    below.add({apart - 0.3, -0.3, 0}, {apart + 0.3, -0.3, 0}, {apart, 0.3, 0});
    test::append(below, test::cone(some(30), 0.4 * apart, 0, {0, 0, 0}, random.uniform(0, 1)));
    test::TestMesh above;
    above.add({apart, 0, 0.25}, {apart + 0.1, 0, 0.5}, {apart, 0.1, 0.5});
    above.add({0, 0, 0.25}, {apart, 0, 0.25}, {0, 0.2, 0.5});
    test::append(above, test::cone(some(30), 0.1, 0.1, {0, 0, 0.25}));
    test::append(above, test::cone(some(10), 0.1, 0.1, {random.uniform(0, 1.2) * apart, random.uniform(-1, 1), 0.25}));
    const SphereHierarchy a(viewOf(below.trianglesView())), b(viewOf(above.trianglesView()));
    expectAsBruteForce({a}, {b});
    expectAsBruteForce({b}, {a});
  }
}

/// It is found by what is nearer to one of the best pair, among all of the other cloud.
TEST(TiedTriangles, TakeLittleWorkWhereOneIsNearer)
{
  TiedPair pair = test::tied()[1].make(600);
  const double height = 0.3 * (1 - 1e-8);
  pair.b.add({0, 0, height}, {0.1, 0, 0.8}, {0, 0.1, 0.8});
  const SphereHierarchy a(viewOf(pair.a.trianglesView())), b(viewOf(pair.b.trianglesView()));
  for (const Eigen::Isometry3d& pose : {identity, Random(1).pose(3)})
    for (const bool turned : {false, true}) {
      const Placed discs[2] = {{a, pose}, {b, pose}};
      const std::uint64_t decisions = closestPair(discs[turned], discs[!turned]).work.exact_decisions;
      EXPECT_LE(decisions, 10 * (pair.a.triangles.size() + pair.b.triangles.size())) << turned;
    }
}

} // namespace
} // namespace pcl_bsh

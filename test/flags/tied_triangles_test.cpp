// SPDX-License-Identifier: BSD-3-Clause
// Flags of surfaces of which all triangles are hardly farther apart than the clearance.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/flags/colliding_indices.h>

#include "support/tied_meshes.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;
using test::Tied;
using test::TiedPair;

void expectAsBruteForce(const Placed& a, const Placed& b, double clearance)
{
  FlagsRequest request(clearance, Flagged::both);
  const FlagsResult expected = brute_force::collisionFlags(a, b, request);
  const Work work = collisionFlags(a, b, request).work; // what it fits is there for those that follow
  for (const unsigned threads : {1u, 2u}) {
    request.threads = threads;
    const FlagsResult found = collisionFlags(a, b, request);
    ASSERT_EQ(found.a, expected.a) << clearance;
    ASSERT_EQ(found.b, expected.b) << clearance;
    ASSERT_EQ(collidingIndices(a, b, request).a.size(), expected.colliding_a);
    ASSERT_LE(found.work.exact_decisions, work.exact_decisions);
  }
  for (const Accuracy& accuracy : {Accuracy::level(3), Accuracy::nodePairs(20000), Accuracy::time(1e-3)}) {
    request.accuracy = accuracy;
    const FlagsResult early = collisionFlags(a, b, request);
    for (std::size_t i = 0; i < early.a.size(); ++i) {
      const bool is_decided = early.a[i] != Verdict::undecided;
      ASSERT_EQ(early.a[i], is_decided ? expected.a[i] : Verdict::undecided) << i << ' ' << clearance;
    }
  }
}

TEST(TiedFlags, AreThoseOfBruteForce)
{
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TiedPair pair = test::anyTies(seed);
    PointsView view_a = viewOf(pair.a.trianglesView());
    std::vector<float> own(view_a.count);
    for (float& uncertainty : own) uncertainty = static_cast<float>(random.pick({0.0, 0.0625}));
    if (seed % 3 == 1) view_a.uncertainty = 0.0625;
    if (seed % 3 == 2) view_a.uncertainties = own.data();
    const SphereHierarchy a(view_a), b(viewOf(pair.b.trianglesView()));
    const Placed placed_a(a, pair.pose_a), placed_b(b, pair.pose_b);
    for (const double at : {pair.gap, pair.gap - 0.0625, pair.gap + 0.0625})
      expectAsBruteForce(placed_a, placed_b, test::clearanceAbout(at, random));
  }
}

TEST(TiedFlags, AreThoseOfBruteForceBesidePointsAndBalls)
{
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const TiedPair pair = test::anyTies(seed);
    const SphereHierarchy a(viewOf(pair.a.trianglesView()));
    std::vector<float> radii(pair.b.vertices.size());
    for (float& radius : radii) radius = static_cast<float>(random.pick({0.0, 0.0625, 0.125, 1.0}));
    PointsView view = pair.b.view();
    if (seed % 3 == 1) view.radii = radii.data();
    if (seed % 3 == 2) view.uncertainty = 0.0625;
    const SphereHierarchy b(view);
    expectAsBruteForce({a, pair.pose_a}, {b, pair.pose_b}, test::clearanceAbout(pair.gap, random));
  }
}

/// As many nearer triangles as there are places beside: no plane is between the wholes, nor is all of one free.
TEST(TiedFlags, FindWhatCollidesAmongTies)
{
  for (const Tied& tied : test::tied()) {
    SCOPED_TRACE(tied.name);
    TiedPair pair = tied.make(200);
    Random random(1);
    for (int i = 0; i < 10; ++i) {
      const double x = random.uniform(-0.5, 0.5), y = random.uniform(-0.5, 0.5);
      pair.b.add({x, y, 0.3 * (1 - random.pick({1e-3, 1e-8, 1e-10}))}, {x + 0.1, y, 0.8}, {x, y + 0.1, 0.8});
    }
    test::shuffle(pair.b, 1);
    const SphereHierarchy a(viewOf(pair.a.trianglesView())), b(viewOf(pair.b.trianglesView()));
    const Eigen::Isometry3d pose = random.pose(3);
    expectAsBruteForce({a, pose}, {b, pose}, 0.3 * (1 - 1e-9));
  }
}

/// All pairs would be n / 2 decisions a triangle, and more.
TEST(TiedFlags, TakeWorkInProportion)
{
  const Eigen::Isometry3d turned = Random(1).pose(3);
  for (const Tied& tied : test::tied())
    for (const Eigen::Isometry3d& pose : {Eigen::Isometry3d(Eigen::Isometry3d::Identity()), turned})
      for (const double uncertainty : {0.0, 0.1})
        for (const std::uint32_t n : {1000u, 4000u, 16000u}) {
          const TiedPair pair = tied.make(n);
          PointsView view = viewOf(pair.a.trianglesView());
          view.uncertainty = uncertainty;
          const SphereHierarchy a(view), b(viewOf(pair.b.trianglesView()));
          const double clearance = 0.3 * (1 - 1e-9) - uncertainty;
          const FlagsResult found = collisionFlags({a, pose}, {b, pose}, {clearance, Flagged::both});
          const std::size_t triangles = pair.a.triangles.size() + pair.b.triangles.size();
          EXPECT_EQ(found.colliding_a + found.undecided_a, 0u) << tied.name;
          EXPECT_LE(found.work.exact_decisions, 60 * triangles) << tied.name << ", " << n;
        }
}

} // namespace
} // namespace pcl_bsh

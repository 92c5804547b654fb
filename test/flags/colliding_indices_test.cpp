// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/flags/colliding_indices.h>

#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Scene;
using test::Shape;

FlagsRequest within(double clearance, Flagged flagged = Flagged::both, const Accuracy& accuracy = {},
                    unsigned threads = 1)
{
  return {clearance, flagged, {accuracy, threads}};
}

std::vector<std::int32_t> recordsOf(const std::vector<Verdict>& flags, Verdict verdict)
{
  std::vector<std::int32_t> records;
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (flags[i] == verdict) records.push_back(static_cast<std::int32_t>(i));
  return records;
}

void expectSame(const CollidingIndices& found, const FlagsResult& expected)
{
  EXPECT_EQ(found.a, recordsOf(expected.a, Verdict::colliding));
  EXPECT_EQ(found.b, recordsOf(expected.b, Verdict::colliding));
  EXPECT_EQ(found.undecided_a, recordsOf(expected.a, Verdict::undecided));
  EXPECT_EQ(found.undecided_b, recordsOf(expected.b, Verdict::undecided));
}

void expectSameAsFlags(const Scene& scene, const Accuracy& accuracy, const HierarchyOptions& options = {})
{
  SCOPED_TRACE(scene.name + " at " + accuracy.text());
  const SphereHierarchy a(scene.a.view(), options), b(scene.b.view(), options);
  const Placed placed_a{a, scene.pose_a}, placed_b{b, scene.pose_b};
  CollidingIndices found;
  for (const Flagged side : {Flagged::a, Flagged::b, Flagged::both})
    for (const unsigned threads : {1u, 4u}) {
      const FlagsRequest request = within(scene.clearance, side, accuracy, threads);
      collisionFlags(placed_a, placed_b, request); // builds voxels, which are work
      const FlagsResult expected = collisionFlags(placed_a, placed_b, request);
      collidingIndices(placed_a, placed_b, request, found);
      expectSame(found, expected);
      EXPECT_EQ(found.work.node_pairs, expected.work.node_pairs);
      EXPECT_EQ(found.work.leaf_pairs, expected.work.leaf_pairs);
      EXPECT_EQ(found.work.exact_decisions, expected.work.exact_decisions);
    }
}

TEST(CollidingIndices, SameAsBruteForce)
{
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Scene scene = test::anyScene(seed, 100);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    const FlagsRequest request = within(scene.clearance);
    expectSame(collidingIndices({a, scene.pose_a}, {b, scene.pose_b}, request),
               brute_force::collisionFlags({a, scene.pose_a}, {b, scene.pose_b}, request));
  }
}

TEST(CollidingIndices, SameAsFlagsForAnySideAndNumberOfThreads)
{
  for (std::uint64_t seed = 0; seed < 100; ++seed) expectSameAsFlags(test::anyScene(seed, 100), Accuracy::exact());
  for (std::uint64_t seed = 1000; seed < 1010; ++seed) expectSameAsFlags(test::anyScene(seed, 1000), Accuracy::exact());
}

TEST(CollidingIndices, SameAsFlagsForAnyAccuracy)
{
  for (std::uint64_t seed = 300; seed < 360; ++seed)
    for (const Accuracy& accuracy :
         {Accuracy::tolerance(0.01), Accuracy::level(0), Accuracy::level(1), Accuracy::level(2), Accuracy::nodePairs(0),
          Accuracy::nodePairs(30), Accuracy::nodePairs(300), Accuracy::nodePairs(3000), Accuracy::nodePairs(1u << 30),
          Accuracy::time(0), Accuracy::time(1000)})
      expectSameAsFlags(test::anyScene(seed, seed % 2 == 0 ? 100 : 700), accuracy);
}

/// A point that one pass takes for possible, and a later one finds to collide, is on one list alone.
TEST(CollidingIndices, OfUncertainPointsAreTheirFlagsForAnyAccuracy)
{
  for (std::uint64_t seed = 400; seed < 440; ++seed) {
    Scene scene = test::anyScene(seed, seed % 2 == 0 ? 100 : 700);
    Random random(seed);
    test::makeUncertain(scene.a, scene.clearance, random);
    test::makeUncertain(scene.b, scene.clearance, random);
    HierarchyOptions options;
    if (seed % 4 < 2) options.voxel_edge = 1e7; // deep trees: passes end within them
    for (const Accuracy& accuracy : {Accuracy::exact(), Accuracy::level(2), Accuracy::nodePairs(300),
                                     Accuracy::nodePairs(3000), Accuracy::nodePairs(1u << 30)})
      expectSameAsFlags(scene, accuracy, options);
  }
}

TEST(CollidingIndices, OfCoincidentPointsAreAllOfThem)
{
  const Cloud many(std::vector<Point3>(100, Point3{1, 2, 3})), one({{1, 2, 3.5}});
  const SphereHierarchy a(many.view()), b(one.view());
  const CollidingIndices found = collidingIndices({a}, {b}, within(0.5));
  EXPECT_EQ(found.a.size(), 100u);
  EXPECT_EQ(found.b, std::vector<std::int32_t>{0});
  EXPECT_TRUE(collidingIndices({a}, {b}, within(0.49)).a.empty());
}

TEST(CollidingIndices, CostNothingForPointsThatAreFar)
{
  Random random(77);
  const Cloud near_cloud(test::makePoints(Shape::uniform, 3000, 1, random));
  std::vector<Point3> points = test::makePoints(Shape::uniform, 3000, 1, random);
  const std::size_t near_points = points.size();
  for (Point3 p : test::makePoints(Shape::uniform, 200000, 50, random)) points.push_back({p[0] + 500, p[1], p[2]});
  const Cloud all(points), few(std::vector<Point3>(points.begin(), points.begin() + static_cast<long>(near_points)));
  HierarchyOptions options;
  options.voxel_edge = 0.5;
  const SphereHierarchy large(all.view(), options), small(few.view(), options), obstacle(near_cloud.view(), options);
  CollidingIndices of_large, of_small;
  collidingIndices({large}, {obstacle}, within(0.05, Flagged::a), of_large);
  collidingIndices({small}, {obstacle}, within(0.05, Flagged::a), of_small);
  EXPECT_EQ(of_large.a, of_small.a);
  EXPECT_GT(of_large.a.size(), 10u);
  EXPECT_LT(of_large.a.capacity(), 4 * of_large.a.size() + 64); // no memory for each point
  // Grids that begin elsewhere cut the same points otherwise.
  EXPECT_LT(of_large.work.leaf_pairs, 1.5 * static_cast<double>(of_small.work.leaf_pairs));
  EXPECT_LT(of_large.work.voxels_built, 1.5 * static_cast<double>(of_small.work.voxels_built));
  EXPECT_LT(of_large.work.node_pairs, of_small.work.node_pairs + 2000); // of the tree above the voxels
}

TEST(CollidingIndices, OfEmptyCloudsAndRefusals)
{
  const SphereHierarchy nothing{PointsView{}};
  const Cloud one({{1, 2, 3}});
  const SphereHierarchy point(one.view());
  CollidingIndices found = collidingIndices({point}, {point}, within(1));
  EXPECT_EQ(found.a.size() + found.b.size(), 2u);
  for (const Accuracy& accuracy : {Accuracy::exact(), Accuracy::level(0), Accuracy::nodePairs(0)}) {
    collidingIndices({nothing}, {point}, within(1, Flagged::both, accuracy), found);
    EXPECT_EQ(found.a.size() + found.b.size() + found.undecided_a.size() + found.undecided_b.size(), 0u);
  }
  EXPECT_THROW(collidingIndices({point}, {point}, within(-1)), std::invalid_argument);
}

} // namespace
} // namespace pcl_bsh

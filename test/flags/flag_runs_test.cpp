// SPDX-License-Identifier: BSD-3-Clause
// Points that follow each other in a scan, flagged by their first query without a tree of theirs: the same answers as
// with it, whatever comes before and between.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/hierarchy/update.h>

#include "support/random_clouds.h"
#include "support/verdicts.h"
#include "support/work_counts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;

constexpr std::size_t kRow = 48;

FlagsRequest within(double clearance, Flagged flagged = Flagged::a, unsigned threads = 1)
{
  return {clearance, flagged, threads};
}

/// Rows over hills, one unit apart, to and fro or always forth. Some returns are missing.
std::vector<Point3> scan(bool to_and_fro, double rough, Random& random)
{
  std::vector<Point3> points;
  for (std::size_t row = 0; row < kRow; ++row)
    for (std::size_t k = 0; k < kRow; ++k) {
      const auto x = static_cast<double>(to_and_fro && row % 2 == 1 ? kRow - 1 - k : k), y = static_cast<double>(row);
      Point3 p = {x, y, std::sin(x / 9) * std::cos(y / 7)};
      for (double& c : p) c += rough * random.uniform(-1, 1);
      if (random.chance(0.01)) p[1] = std::numeric_limits<double>::quiet_NaN();
      points.push_back(p);
    }
  return points;
}

HierarchyOptions withEdge(double edge)
{
  HierarchyOptions options;
  options.voxel_edge = edge;
  return options;
}

/// Where all is built, as other tests compare it with brute force.
FlagsResult withTrees(const Placed& a, const Placed& b, double clearance)
{
  const SphereHierarchy ha(a.hierarchy().view()), hb(b.hierarchy().view());
  ha.buildAll();
  hb.buildAll();
  return collisionFlags({ha, a.pose}, {hb, b.pose}, within(clearance, Flagged::both));
}

/// First and later queries are as brute force has them. @return voxels of a that the first query did not build
std::size_t expectFlags(const Cloud& a, const Cloud& b, const Eigen::Isometry3d& pose_a,
                        const Eigen::Isometry3d& pose_b, double clearance, const HierarchyOptions& options,
                        const std::string& what)
{
  const SphereHierarchy ha(a.view(), options), hb(b.view(), options), again(a.view(), options);
  const Placed at_a(ha, pose_a), at_b(hb, pose_b);
  const std::vector<Verdict> expected = brute_force::collisionFlags(at_a, at_b, within(clearance)).a;
  EXPECT_EQ(collisionFlags(at_a, at_b, within(clearance)).a, expected) << what << ", first";
  const std::size_t without_tree = ha.statistics().voxels - ha.statistics().voxels_built;
  EXPECT_EQ(collisionFlags(at_a, at_b, within(clearance)).a, expected) << what << ", second";
  EXPECT_EQ(collisionFlags(at_a, at_b, within(clearance)).a, expected) << what << ", third";
  const std::vector<std::int32_t> listed = collidingIndices({again, pose_a}, at_b, within(clearance)).a;
  std::vector<Verdict> flags(expected.size(), Verdict::free);
  for (const std::int32_t record : listed) flags[static_cast<std::size_t>(record)] = Verdict::colliding;
  EXPECT_EQ(flags, expected) << what << ", listed";
  EXPECT_TRUE(ha.validate().none()) << what;
  return without_tree;
}

TEST(FlagRuns, AnswersAreThoseOfBruteForce)
{
  Random random(71);
  std::size_t without_tree = 0;
  for (int round = 0; round < 8; ++round) {
    const bool tie = round % 4 == 3; // all points at just the clearance
    const double rough = tie ? 0.0 : 0.3 * random.uniform(0, 1), lift = random.uniform(0, 6);
    const std::vector<Point3> points = scan(round % 2 == 0, rough, random);
    std::vector<Point3> others = tie ? points : scan(round % 3 == 0, rough, random);
    const double clearance = tie ? 0.5 : round % 3 == 2 ? 1.5 : 5.0;
    for (Point3& p : others) p[2] += tie ? clearance : lift;
    const Cloud a(points, {round % 2 == 0 ? Scalar::float32 : Scalar::float64}), b(others, {Scalar::float64});
    const Eigen::Isometry3d pose_a = round % 3 == 1 ? random.pose(3.0) : Eigen::Isometry3d::Identity();
    Eigen::Isometry3d pose_b = pose_a;
    if (!tie) pose_b.translate(Eigen::Vector3d{random.uniform(-20, 20), random.uniform(-20, 20), 0});
    without_tree +=
        expectFlags(a, b, pose_a, pose_b, clearance, withEdge(round % 2 == 0 ? 24 : 16), std::to_string(round));
  }
  EXPECT_GE(without_tree, 20u);
}

TEST(FlagRuns, OfASubsetInShortRuns)
{
  Random random(72);
  const Cloud b(scan(true, 0.2, random));
  const std::vector<Point3> points = scan(false, 0.2, random);
  for (const int most : {1, 3, 9, 40}) { // records that follow each other
    std::vector<std::int32_t> records;
    for (std::size_t i = 0; i < points.size(); i += 2)
      for (int left = random.integer(1, most); left > 0 && i < points.size(); --left, ++i)
        records.push_back(static_cast<std::int32_t>(i));
    Cloud a(points);
    PointsView view = a.view();
    view.indices = records.data();
    view.index_count = records.size();
    const SphereHierarchy ha(view, withEdge(16)), hb(b.view(), withEdge(16));
    const Placed at_b(hb, Eigen::Isometry3d(Eigen::Translation3d(9.3, 3, 4)));
    for (int query = 0; query < 2; ++query)
      EXPECT_EQ(collisionFlags({ha}, at_b, within(4.5)).a, withTrees({ha}, at_b, 4.5).a) << most;
  }
}

/// Rows of sixteen in any direction, and obstacles in their line, near to their last point alone.
struct Rows {
  std::vector<Point3> points, beyond;

  Rows(std::size_t count, double away, double scale, Random& random)
  {
    for (std::size_t row = 0; row < count; ++row) {
      const Eigen::Vector3d along =
          Eigen::Vector3d{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}.normalized();
      const Eigen::Vector3d from(60.0 * static_cast<double>(row % 8), 60.0 * static_cast<double>(row / 8), 0.0);
      const auto at = [&](double k) {
        const Eigen::Vector3d place = scale * (from + k * along);
        return Point3{place.x(), place.y(), place.z()};
      };
      for (int k = 0; k < 16; ++k) points.push_back(at(k));
      points.push_back(Point3{std::numeric_limits<double>::quiet_NaN(), 0, 0}); // no group has points of two rows
      beyond.push_back(at(15 + away));
      beyond.push_back(at(15 + away + (row % 2 == 0 ? 0.25 : 5.0))); // voxels of two points, near and apart
    }
  }
};

TEST(FlagRuns, ReachBeyondTheEndsOfRows)
{
  Random random(76);
  for (const double edge : {20.0, 1000.0}) {
    const Rows rows(64, 4.0, 1.0, random);
    const Cloud a(rows.points), b(rows.beyond);
    EXPECT_GT(expectFlags(a, b, random.pose(10), random.pose(10), 4.001, withEdge(edge), "elsewhere"), 0u);
    const Eigen::Isometry3d pose = random.pose(10);
    EXPECT_GT(expectFlags(a, b, pose, pose, 4.001, withEdge(edge), "edge " + std::to_string(edge)), 0u);
    const SphereHierarchy ha(a.view(), withEdge(edge)), hb(b.view());
    EXPECT_EQ(collisionFlags({ha, pose}, {hb, pose}, within(4.001)).colliding_a, 64u);
  }
}

/// More obstacles than are tested at once, which cover one voxel of a.
TEST(FlagRuns, AmongManyObstacles)
{
  Random random(78);
  const Rows rows(64, 4.0, 1.0, random);
  const Cloud a(rows.points), b(rows.beyond);
  const SphereHierarchy ha(a.view(), withEdge(1000)), hb(b.view(), withEdge(1));
  ASSERT_GT(hb.statistics().voxels, 70u);
  const FlagsResult found = collisionFlags({ha}, {hb}, within(4.001));
  EXPECT_EQ(found.a, brute_force::collisionFlags({ha}, {hb}, within(4.001)).a);
  EXPECT_EQ(found.colliding_a, 64u);
  EXPECT_EQ(ha.statistics().voxels_built, 0u);
}

/// Voxels of a large cloud have frames of their own units.
TEST(FlagRuns, AmongObstaclesOfOtherUnits)
{
  Random random(78);
  const double scale = 0x1p70;
  const Rows rows(64, 4.0, scale, random);
  const Cloud a(rows.points, {Scalar::float64}), b(rows.beyond, {Scalar::float64});
  const SphereHierarchy ha(a.view(), withEdge(1000 * scale)), hb(b.view(), withEdge(30 * scale));
  const FlagsResult found = collisionFlags({ha}, {hb}, within(4.001 * scale));
  EXPECT_EQ(found.a, brute_force::collisionFlags({ha}, {hb}, within(4.001 * scale)).a);
  EXPECT_EQ(found.colliding_a, 64u);
}

TEST(FlagRuns, BuildATreeForTheSecondQuery)
{
  Random random(73);
  const Cloud a(scan(true, 0.2, random)), b(scan(true, 0.2, random));
  const SphereHierarchy ha(a.view(), withEdge(16)), hb(b.view(), withEdge(16));
  const Placed at_b(hb, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 1)));
  collisionFlags({ha}, at_b, within(5));
  const std::size_t built = ha.statistics().voxels_built; // where the first points are far from each other
  EXPECT_LE(built, ha.statistics().voxels / 4);
  collisionFlags({ha}, at_b, within(5));
  EXPECT_GE(ha.statistics().voxels_built, ha.statistics().voxels / 2);
  EXPECT_EQ(collisionFlags({ha}, at_b, within(5)).work.voxels_built, 0u);

  // Groups of points that are wide beside the clearance are left to the tree; and answers that may stop early.
  const SphereHierarchy narrow(a.view(), withEdge(16)), early(a.view(), withEdge(16));
  collisionFlags({narrow}, at_b, within(1.1));
  EXPECT_GT(narrow.statistics().voxels_built, 0u);
  FlagsRequest request = within(5);
  request.accuracy = Accuracy::level(3);
  collisionFlags({early}, at_b, request);
  EXPECT_GT(early.statistics().voxels_built, 0u);

  // And balls.
  Cloud balls(scan(true, 0.2, random));
  balls.setRadii(std::vector<float>(kRow * kRow, 0.5f));
  const SphereHierarchy of_balls(balls.view(), withEdge(16));
  EXPECT_EQ(collisionFlags({of_balls}, at_b, within(4)).a, withTrees({of_balls}, at_b, 4).a);
  EXPECT_GT(of_balls.statistics().voxels_built, 0u);
}

TEST(FlagRuns, WithinOneCloudNeedItsTree)
{
  Random random(74);
  const Cloud a(scan(true, 0.2, random));
  Work expected;
  for (const unsigned threads : {1u, 2u, 4u}) {
    const SphereHierarchy ha(a.view(), withEdge(12));
    const Placed other(ha, Eigen::Isometry3d(Eigen::Translation3d(15, 0, 3)));
    const FlagsResult found = collisionFlags({ha}, other, within(4, Flagged::both, threads));
    const FlagsResult right = withTrees({ha}, other, 4);
    EXPECT_EQ(found.a, right.a);
    EXPECT_EQ(found.b, right.b);
    if (threads == 1) expected = found.work;
    EXPECT_EQ(test::countsOf(found.work), test::countsOf(expected)) << threads;
  }
}

TEST(FlagRuns, CostTheSameForAnyNumberOfThreads)
{
  Random random(75);
  const Cloud a(scan(true, 0.2, random)), b(scan(false, 0.2, random));
  Work expected;
  for (const unsigned threads : {1u, 2u, 4u, 0u}) {
    const SphereHierarchy ha(a.view(), withEdge(12)), hb(b.view(), withEdge(12));
    const Placed at_b(hb, Eigen::Isometry3d(Eigen::Translation3d(15, 5, 3)));
    const Work work = collisionFlags({ha}, at_b, within(4, Flagged::both, threads)).work;
    if (threads == 1) expected = work;
    EXPECT_EQ(test::countsOf(work), test::countsOf(expected)) << threads;
  }
}

TEST(FlagRuns, OfPointsThatMovedMeanwhile)
{
  Random random(76);
  const std::vector<Point3> before = scan(true, 0.2, random), after = scan(true, 0.4, random);
  const Cloud old(before), now(after), b(scan(false, 0.2, random));
  for (const int queries : {0, 1, 2}) {
    SphereHierarchy ha(old.view(), withEdge(16));
    const SphereHierarchy hb(b.view(), withEdge(16));
    const Placed at_b(hb, Eigen::Isometry3d(Eigen::Translation3d(12, 0, 3.5)));
    for (int query = 0; query < queries; ++query) collisionFlags({ha}, at_b, within(4));
    ha.refit(now.view());
    for (int query = 0; query < 2; ++query)
      EXPECT_EQ(collisionFlags({ha}, at_b, within(4)).a, withTrees({ha}, at_b, 4).a) << queries;

    std::vector<Point3> changed = after;
    std::vector<std::int32_t> records;
    for (std::int32_t i = 500; i < 900; ++i) records.push_back(i);
    HierarchyUpdate update(ha, records.data(), records.size());
    for (const std::int32_t i : records) changed[static_cast<std::size_t>(i)][2] += 2.0;
    const Cloud later(changed);
    update.commit(later.view());
    EXPECT_EQ(collisionFlags({ha}, at_b, within(4)).a, withTrees({ha}, at_b, 4).a) << queries;
    EXPECT_TRUE(ha.validate().none());
  }
}

/// Each is the other's obstacle: both read what the other wants to build.
TEST(FlagRuns, OfBothCloudsAtOnce)
{
  Random random(77);
  const Cloud a(scan(true, 0.2, random)), b(scan(false, 0.2, random));
  const Eigen::Isometry3d pose(Eigen::Translation3d(12, 10, 3));
  std::vector<Verdict> expected_a, expected_b;
  for (int round = 0; round < 15; ++round) {
    const SphereHierarchy ha(a.view(), withEdge(8)), hb(b.view(), withEdge(8));
    FlagsResult of_a, of_b;
    std::thread other([&] { collisionFlags({hb, pose}, {ha}, within(4, Flagged::a, 2), of_b); });
    collisionFlags({ha}, {hb, pose}, within(4, Flagged::a, 2), of_a);
    other.join();
    if (round == 0) {
      const FlagsResult right = withTrees({ha}, {hb, pose}, 4);
      expected_a = right.a, expected_b = right.b;
    }
    EXPECT_EQ(of_a.a, expected_a);
    EXPECT_EQ(of_b.a, expected_b);
  }
}

/// A group that one leaf settles is looked at once.
TEST(FlagRuns, GroupsThatOneLeafSettlesLookAtNothingElse)
{
  std::vector<Point3> row, place;
  for (int i = 0; i < 16; ++i) {
    row.push_back({0.5 * i, 0, 0});
    place.push_back({0.5 * i, 0, 1});
  }
  const Cloud a(row), b(place);
  const SphereHierarchy ha(a.view(), withEdge(16)), hb(b.view(), withEdge(16));
  const FlagsResult found = collisionFlags({ha}, {hb}, within(4));
  EXPECT_EQ(found.colliding_a, 16u);
  EXPECT_EQ(ha.statistics().voxels_built, 0u);
  EXPECT_EQ(found.work.leaf_pairs, 1u);
  EXPECT_EQ(found.work.volumes_carried, 3u); // the voxel's sphere from above and its own, and the box around the group
}

/// Where spheres tell little, the tree takes over before much is lost.
TEST(FlagRuns, GiveUpWhatTakesTooMany)
{
  std::vector<Point3> ball, circle;
  Random random(78);
  for (int i = 0; i < 4000; ++i) {
    const double angle = 2 * 3.14159265358979 * i / 4000;
    circle.push_back({std::cos(angle), std::sin(angle), 0});
    ball.push_back({1e-4 * i / 4000, 1e-5 * random.uniform(-1, 1), 1e-5 * random.uniform(-1, 1)});
  }
  const Cloud a(circle), b(ball);
  const auto stepsOf = [](const Work& work) { return work.node_pairs + 16 * work.leaf_pairs + work.exact_decisions; };
  const SphereHierarchy first(a.view()), built(a.view()), hb(b.view());
  built.buildAll();
  hb.buildAll();
  const double clearance = 0.99989;
  const FlagsResult found = collisionFlags({first}, {hb}, within(clearance)),
                    expected = collisionFlags({built}, {hb}, within(clearance));
  EXPECT_EQ(found.a, expected.a);
  EXPECT_GT(found.work.voxels_built, 0u);
  // Lost work: the allowance of each voxel, and a list of leaves.
  EXPECT_LT(stepsOf(found.work), stepsOf(expected.work) + 20 * 4000 + first.statistics().voxels * (2048 + 64 * 17));
}

} // namespace
} // namespace pcl_bsh

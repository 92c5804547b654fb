// SPDX-License-Identifier: BSD-3-Clause
// One search by several threads: the answer, and of any collision the work, of one thread.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/traversal/shared_stack.h>

#include "support/random_clouds.h"
#include "support/verdicts.h"
#include "support/work_counts.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

/// A rough sheet of side x side points, one unit apart: heights in steps of a half, so that there are many ties.
std::vector<Point3> sheet(int side, double height, Random& random)
{
  std::vector<Point3> points;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const double wave = std::round(4 * std::sin(i / 3.0) * std::cos(j / 4.0)) / 2;
      points.push_back({1.0 * i, 1.0 * j, height + wave + (random.chance(0.5) ? 0.5 : 0.0)});
    }
  }
  return points;
}

/// Counts that do not depend on which voxels were built before.
std::map<std::string, std::uint64_t> workOf(Work work)
{
  work.voxels_built = work.volumes_built = 0;
  return test::countsOf(work);
}

TEST(ThreadsOfAnyCollision, GiveTheFirstWitnessAndTheWorkOfOneThread)
{
  Random random(11);
  std::size_t shared = 0, hits = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const int side = trial % 2 == 0 ? 45 : 120;
    std::vector<Point3> below = sheet(side, 0, random), above = sheet(side, 3, random);
    for (int touching = trial % 4; touching > 0; --touching) // few, so that the search takes long
      above[static_cast<std::size_t>(random.integer(0, side * side - 1))][2] -= 1.5;
    const Cloud cloud_a(below), cloud_b(above);
    for (const Accuracy& accuracy : {Accuracy::exact(), Accuracy::tolerance(0.01), Accuracy::tolerance(0.02)}) {
      AnyRequest request{1.4, accuracy};
      const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
      const AnyResult one = anyCollision({a}, {b}, request);
      shared += one.work.node_pairs > std::uint64_t{8} * kStepsAlone;
      hits += one.verdict == Verdict::colliding;
      for (const unsigned threads : {2u, 5u}) {
        const SphereHierarchy fresh_a(cloud_a.view()), fresh_b(cloud_b.view());
        request.threads = threads;
        const AnyResult several = anyCollision({fresh_a}, {fresh_b}, request);
        ASSERT_EQ(several.verdict, one.verdict) << trial;
        ASSERT_EQ(several.pair, one.pair) << trial;
        ASSERT_EQ(several.interval.lower, one.interval.lower);
        ASSERT_EQ(several.interval.upper, one.interval.upper);
        ASSERT_EQ(workOf(several.work), workOf(one.work)) << trial;
        ASSERT_GE(several.work.voxels_built, one.work.voxels_built);
        if (one.verdict == Verdict::free) {
          ASSERT_EQ(test::countsOf(several.work), test::countsOf(one.work));
        }
      }
    }
  }
  EXPECT_GT(shared, 15u);
  EXPECT_GT(hits, 6u);
}

TEST(ThreadsOfClosestPair, GiveTheSmallestOfEqualPairs)
{
  Random random(12);
  std::size_t shared = 0;
  for (int trial = 0; trial < 8; ++trial) {
    const int side = trial == 0 ? 40 : 120; // brute force takes the small one
    std::vector<Point3> below = sheet(side, 0, random), above = sheet(side, 4, random);
    if (trial % 2 == 0) {
      std::shuffle(above.begin(), above.end(), std::mt19937(static_cast<unsigned>(trial)));
      std::shuffle(below.begin(), below.end(), std::mt19937(static_cast<unsigned>(trial) + 100));
    }
    const Cloud cloud_a(below), cloud_b(above);
    Eigen::Isometry3d pose = identity;
    if (trial % 4 == 3) pose = random.pose(0.5);
    const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
    const DistanceResult one = closestPair({a}, {b, pose});
    shared += one.work.node_pairs > std::uint64_t{8} * kStepsAlone;
    if (trial == 0) {
      const DistanceResult brute = brute_force::closestPair({a}, {b, pose});
      ASSERT_EQ(one.pair, brute.pair);
      ASSERT_EQ(one.distance, brute.distance);
    }
    for (const Accuracy& accuracy : {Accuracy::exact(), Accuracy::tolerance(0.3)}) {
      const DistanceResult expected = closestPair({a}, {b, pose}, {accuracy});
      for (const unsigned threads : {2u, 5u}) {
        const SphereHierarchy fresh_a(cloud_a.view()), fresh_b(cloud_b.view());
        const DistanceResult several = closestPair({fresh_a}, {fresh_b, pose}, {accuracy, threads});
        ASSERT_EQ(several.pair, expected.pair) << trial;
        ASSERT_EQ(several.distance, expected.distance) << trial;
        ASSERT_EQ(several.interval.lower, expected.interval.lower);
        ASSERT_EQ(several.interval.upper, expected.interval.upper);
      }
    }
  }
  EXPECT_GT(shared, 4u);
}

TEST(ThreadsOfAQuery, AreNotNeededBySmallOrEmptyClouds)
{
  const Cloud none(std::vector<Point3>{}), point({{0, 0, 0}});
  const SphereHierarchy empty(none.view()), one(point.view());
  EXPECT_EQ(anyCollision({empty}, {one}, {1.0, 2}).verdict, Verdict::free);
  EXPECT_EQ(anyCollision({one}, {one}, {0.0, 2}).pair, (PointPair{0, 0}));
  EXPECT_FALSE(closestPair({empty}, {one}, {{}, 2}).pair);
  EXPECT_EQ(closestPair({one}, {one}, {{}, 2}).distance, 0.0);
}

using Stack = SharedStack<std::uint32_t>;

/// Walks the complete tree in which node n has the children 4n + 1 to 4n + 4, first to last. Looks for any of the
/// `wanted` nodes, some steps of a piece at a time.
class TreeWalk {
public:
  TreeWalk(std::vector<std::uint32_t> wanted, std::uint32_t nodes) : wanted_(std::move(wanted)), nodes_(nodes) {}

  void operator()(Stack::Piece& piece)
  {
    for (int steps = 0; steps < 7 && !piece.pairs.empty() && !piece.dropped; ++steps) {
      const std::uint32_t node = piece.pairs.back();
      piece.pairs.pop_back();
      ++piece.work.node_pairs;
      if (std::find(wanted_.begin(), wanted_.end(), node) != wanted_.end()) {
        piece.found = PointPair{node, node};
        return;
      }
      for (std::uint32_t child = 4 * node + 4; child > 4 * node; --child)
        if (child < nodes_) piece.pairs.push_back(child);
    }
  }

private:
  std::vector<std::uint32_t> wanted_;
  std::uint32_t nodes_;
};

TEST(ThreadsOfASharedStack, FindTheFirstInDepthFirstOrder)
{
  Random random(13);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<std::uint32_t> wanted;
    for (int i = trial % 4; i > 0; --i) wanted.push_back(static_cast<std::uint32_t>(random.integer(0, 1999)));
    Stack one({0}), several({0});
    one.visit(1, [&] { return TreeWalk(wanted, 2000); });
    several.visit(threadCount(2 + static_cast<unsigned>(trial) % 4), [&] { return TreeWalk(wanted, 2000); });
    ASSERT_EQ(several.found(), one.found()) << trial;
    ASSERT_EQ(several.work().node_pairs, one.work().node_pairs) << trial;
    ASSERT_TRUE(!wanted.empty() || one.work().node_pairs == 2000u);
  }
}

/// The first piece finds while another thread has the second one, which is then given back for nothing: what it built
/// counts all the same.
TEST(ThreadsOfASharedStack, CountWhatDroppedPiecesBuilt)
{
  using namespace std::chrono_literals;
  std::vector<std::uint32_t> nodes(64);
  for (std::uint32_t i = 0; i < 64; ++i) nodes[i] = 63 - i;
  Stack stack(nodes);
  std::atomic<unsigned> begun{0};
  std::atomic<std::uint64_t> built{0};
  const auto waitFor = [](const auto& isSo) { // where there is no second thread, in vain
    const auto end = std::chrono::steady_clock::now() + 500ms;
    while (!isSo() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
  };
  stack.visit(threadCount(2), [&] {
    return [&](Stack::Piece& piece) {
      ++begun;
      piece.work.voxels_built = 1;
      ++built;
      if (piece.pairs.back() == 0) {
        waitFor([&] { return begun == 2; });
        piece.found = PointPair{0, 0};
        return;
      }
      waitFor([&] { return piece.dropped.load(); });
      if (!piece.dropped) piece.pairs.clear();
    };
  });
  EXPECT_EQ(stack.found(), (PointPair{0, 0}));
  EXPECT_EQ(stack.work().voxels_built, built);
}

TEST(ThreadsOfASharedStack, EndWhenOneFails)
{
  for (int trial = 0; trial < 50; ++trial) {
    Stack stack({0});
    EXPECT_THROW(stack.visit(threadCount(4),
                             [&] {
                               return [walk = TreeWalk({}, 5000), trial](Stack::Piece& piece) mutable {
                                 if (!piece.pairs.empty() && piece.pairs.back() > 400u + static_cast<unsigned>(trial))
                                   throw std::runtime_error("no more");
                                 walk(piece);
                               };
                             }),
                 std::runtime_error);
  }
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// Many small queries: a thread's scratch memory is used again, so that all but the first allocate nothing.
#include <pcl_bsh/base/retained_memory.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/manifold/contact_manifold.h>
#include <pcl_bsh/pairs/contacts.h>

#include "support/allocations.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <functional>
#include <optional>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Shape;

class RepeatedQueries : public testing::Test {
protected:
  RepeatedQueries() : a_(makeCloud(1)), b_(makeCloud(2)), scan_(a_.view(), fine()), model_(b_.view(), fine()) {}

  /// Allocations of asking at many poses again, after all of them were asked at once.
  std::size_t allocationsOf(const std::function<void(const Placed&, const Placed&)>& ask) const
  {
    const auto askAll = [&] {
      for (int i = 0; i < 20; ++i)
        ask({scan_}, {model_, Eigen::Isometry3d(Eigen::Translation3d(0.9 + 0.02 * i, 0, 0))});
    };
    askAll();
    askAll(); // memory that was handed from one list to another has found its largest
    const std::size_t before = test::allocations();
    askAll();
    return test::allocations() - before;
  }

private:
  static Cloud makeCloud(std::uint64_t seed)
  {
    Random random(seed);
    return Cloud(test::makePoints(Shape::sphere, 3000, 1, random));
  }
  static HierarchyOptions fine()
  {
    HierarchyOptions options;
    options.voxel_edge = 0.25; // many voxels, and as many frames
    return options;
  }

  Cloud a_, b_;
  SphereHierarchy scan_, model_;
};

TEST_F(RepeatedQueries, OfAnyCollisionAllocateNothing)
{
  EXPECT_EQ(allocationsOf([](const Placed& a, const Placed& b) { anyCollision(a, b, {0.001, {}}); }), 0u);
}

TEST_F(RepeatedQueries, OfTheClosestPairAllocateNothing)
{
  EXPECT_EQ(allocationsOf([](const Placed& a, const Placed& b) { closestPair(a, b); }), 0u);
}

TEST_F(RepeatedQueries, OfFlagsAllocateNothing)
{
  FlagsResult result;
  std::size_t colliding = 0;
  EXPECT_EQ(allocationsOf([&](const Placed& a, const Placed& b) {
              collisionFlags(a, b, {0.02, Flagged::both}, result);
              colliding += result.colliding_a + result.colliding_b;
            }),
            0u);
  EXPECT_GT(colliding, 0u);
}

TEST_F(RepeatedQueries, OfCollidingIndicesAllocateNothing)
{
  CollidingIndices result;
  std::size_t colliding = 0;
  EXPECT_EQ(allocationsOf([&](const Placed& a, const Placed& b) {
              collidingIndices(a, b, {0.02, Flagged::both}, result);
              colliding += result.a.size() + result.b.size();
            }),
            0u);
  EXPECT_GT(colliding, 0u);
}

TEST_F(RepeatedQueries, OfContactsAllocateNothing)
{
  ContactsResult result;
  std::size_t contacts = 0;
  EXPECT_EQ(allocationsOf([&](const Placed& a, const Placed& b) {
              nearestContacts(a, b, {0.02, 50}, result);
              contacts += result.contacts.size();
            }),
            0u);
  EXPECT_GT(contacts, 0u);
}

TEST_F(RepeatedQueries, OfManifoldsAllocateNothing)
{
  std::optional<Collider> of_a, of_b;
  Manifold result;
  ManifoldRequest request;
  request.margin = 0.02;
  request.previous = &result;
  std::size_t contacts = 0, kept = 0;
  EXPECT_EQ(allocationsOf([&](const Placed& a, const Placed& b) {
              if (!of_a) of_a.emplace(a.hierarchy()), of_b.emplace(b.hierarchy());
              const std::uint32_t next_id = result.next_id;
              contactManifold({*of_a, a.pose}, {*of_b, b.pose}, request, result);
              for (const Contact& contact : result.contacts) kept += contact.id < next_id ? 1 : 0;
              contacts += result.contacts.size();
            }),
            0u);
  EXPECT_GT(contacts, kept);
  EXPECT_GT(kept, 0u);
}

TEST_F(RepeatedQueries, OfPointDistancesAllocateNothing)
{
  for (const double max : {0.05, std::numeric_limits<double>::infinity()}) {
    PointDistancesRequest request;
    request.max_distance = max;
    PointDistances result;
    std::size_t measured = 0;
    EXPECT_EQ(allocationsOf([&](const Placed& a, const Placed& b) {
                pointDistances(a, b, request, result);
                measured += result.measured;
              }),
              0u);
    EXPECT_GT(measured, 0u);
  }
}

TEST_F(RepeatedQueries, AllocateAnewWhereNothingMayBeKept)
{
  setRetainedMemoryLimit(0);
  EXPECT_GT(allocationsOf([](const Placed& a, const Placed& b) { anyCollision(a, b, {0.001, {}}); }), 0u);
  setRetainedMemoryLimit(std::size_t{256} << 20);
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// Every query whose answer has arrays fills a result that is there, too: with the same answer, in the same memory.
#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/many_poses/collide_on_motions.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/random_clouds.h"

#include <gtest/gtest.h>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Shape;

Eigen::Isometry3d at(int k)
{
  return Eigen::Isometry3d(Eigen::Translation3d(1.5 + 0.1 * k, 0, 0));
}

class KeptResults : public testing::Test {
protected:
  KeptResults() : cloud_a_(makeCloud(1)), cloud_b_(makeCloud(2)), a_(cloud_a_.view()), b_(cloud_b_.view()) {}

  /// Asks at one pose, at another, and at the first again.
  /// @param ask(k) by value @param fill(k, result) @param arrayOf(result) what is compared
  template <class Ask, class Fill, class ArrayOf>
  void expectKept(const Ask& ask, const Fill& fill, const ArrayOf& arrayOf)
  {
    auto kept = ask(0);
    const auto expected = arrayOf(kept), others = arrayOf(ask(9));
    ASSERT_FALSE(expected.empty());
    EXPECT_NE(expected, others);
    fill(9, kept);
    EXPECT_EQ(arrayOf(kept), others);
    fill(0, kept);
    const auto* const memory = arrayOf(kept).data(); // large enough for both
    fill(9, kept);
    fill(0, kept);
    EXPECT_EQ(arrayOf(kept), expected);
    EXPECT_EQ(arrayOf(kept).data(), memory);
  }

  static Cloud makeCloud(std::uint64_t seed)
  {
    Random random(seed);
    return Cloud(test::makePoints(Shape::sphere, 500, 1, random));
  }

  const Cloud cloud_a_, cloud_b_;
  const SphereHierarchy a_, b_;
};

/// Both forms of a query of two clouds.
#define PCL_BSH_KEPT(query, request, array)                                                                            \
  expectKept(                                                                                                          \
      [&](int k) {                                                                                                     \
        return query({a_}, {b_, at(k)}, request);                                                                      \
      },                                                                                                               \
      [&](int k, auto& kept) {                                                                                         \
        query({a_}, {b_, at(k)}, request, kept);                                                                       \
      },                                                                                                               \
      [](const auto& found) -> const auto& { return array; })

TEST_F(KeptResults, OfTwoClouds)
{
  const FlagsRequest flags(0.3, Flagged::both);
  PCL_BSH_KEPT(collisionFlags, flags, found.a);
  PCL_BSH_KEPT(collisionFlags, flags, found.b);
  PCL_BSH_KEPT(collidingIndices, flags, found.a);
  PCL_BSH_KEPT(pairsWithin, ContactsRequest(0.3), found.pairs);
  PCL_BSH_KEPT(pointDistances, PointDistancesRequest(), found.closest_point);
  PCL_BSH_KEPT(symmetricDistances, PointDistancesRequest(), found.b.closest_point);
}

TEST_F(KeptResults, OfPathsPosesAndMotions)
{
  const auto poses = [](int k) { return std::vector<Eigen::Isometry3d>{at(k), at(k + 8), at(k + 3)}; };
  TrajectoryRequest path;
  path.clearance = 0.2;
  path.closest_poses = path.first_poses = true;
  const auto ask = [&](int k) { return collideAlong({a_}, b_, poses(k), path); };
  const auto fill = [&](int k, TrajectoryResult& kept) { collideAlong({a_}, b_, poses(k), path, kept); };
  expectKept(
      ask, fill, [](const TrajectoryResult& found) -> const auto& { return found.flags; });
  expectKept(
      ask, fill, [](const TrajectoryResult& found) -> const auto& { return found.closest_point; });
  expectKept(
      ask, fill, [](const TrajectoryResult& found) -> const auto& { return found.first_pose; });

  const auto list = [](int k) { return std::vector<Eigen::Isometry3d>{at(k), at(2 * k), at(4 * k)}; };
  expectKept([&](int k) { return anyCollisionAtPoses({a_}, b_, list(k), {0.1}); },
             [&](int k, AnyAtPoses& kept) { anyCollisionAtPoses({a_}, b_, list(k), {0.1}, kept); },
             [](const AnyAtPoses& found) -> const auto& { return found.flags; });
  expectKept([&](int k) { return closestPairAtPoses({a_}, b_, list(k)); },
             [&](int k, DistancesAtPoses& kept) { closestPairAtPoses({a_}, b_, list(k), {}, kept); },
             [](const DistancesAtPoses& found) -> const auto& { return found.distances; });
  MotionsRequest motions;
  motions.clearance = 0.1;
  motions.swept = 0.01;
  const std::vector<PoseMotion> edges = {{0, 1}, {1, 2}, {2, 2}};
  expectKept([&](int k) { return anyCollisionOnMotions({a_}, b_, list(k), edges, motions); },
             [&](int k, AnyOnMotions& kept) { anyCollisionOnMotions({a_}, b_, list(k), edges, motions, kept); },
             [](const AnyOnMotions& found) -> const auto& { return found.flags; });
}

TEST_F(KeptResults, OfOneCloud)
{
  const auto apart = [](int k) { return 0.05 + 0.01 * k; };
  expectKept([&](int k) { return euclideanClusters(a_, apart(k)); },
             [&](int k, Clusters& kept) { euclideanClusters(a_, apart(k), kept); },
             [](const Clusters& found) -> const auto& { return found.of; });
  const auto place = [](int k) { return Point3{0.9, 0.01 * k, 0}; };
  const auto indices = [](const auto& found) -> const auto&
  {
    return found.indices;
  };
  expectKept([&](int k) { return radiusSearch(a_, place(k), 0.5); },
             [&](int k, Neighbors& kept) { radiusSearch(a_, place(k), 0.5, kept); }, indices);
  expectKept([&](int k) { return nearestKSearch(a_, place(k), 7); },
             [&](int k, Neighbors& kept) { nearestKSearch(a_, place(k), 7, kept); }, indices);
  expectKept([&](int k) { return radiusSearch(a_, b_.view(), apart(k)); },
             [&](int k, NeighborLists& kept) { radiusSearch(a_, b_.view(), apart(k), kept); }, indices);
  const auto k_of = [](int k) { return static_cast<std::size_t>(9 - k / 2); };
  expectKept([&](int k) { return nearestKSearch(a_, b_.view(), k_of(k)); },
             [&](int k, NeighborLists& kept) { nearestKSearch(a_, b_.view(), k_of(k), kept); }, indices);
  const auto whole = [](const auto& found) -> const auto&
  {
    return found;
  };
  expectKept([&](int k) { return flagAnyInRadius(a_, b_.view(), apart(k)); },
             [&](int k, std::vector<std::uint8_t>& kept) { flagAnyInRadius(a_, b_.view(), apart(k), kept); }, whole);
  expectKept(
      [&](int k) {
        return boxSearch(a_, {-1, -1, 0.05 * k}, {1, 1, 1});
      },
      [&](int k, std::vector<std::int32_t>& kept) {
        boxSearch(a_, {-1, -1, 0.05 * k}, {1, 1, 1}, kept);
      },
      whole);
}

} // namespace
} // namespace pcl_bsh

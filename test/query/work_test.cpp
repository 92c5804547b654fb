// SPDX-License-Identifier: BSD-3-Clause
// Work that queries report: by hand where the trees are small, and consistent elsewhere.
#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/update.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/random_clouds.h"
#include "support/verdicts.h"
#include "support/work_counts.h"

#include <gmock/gmock.h>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::countsOf;
using test::Random;
using test::Shape;

/// A request of what is wanted: any collision, flags or contacts.
template <class Request>
Request within(double clearance)
{
  Request request;
  request.clearance = clearance;
  return request;
}

auto counts(std::uint64_t tests, std::uint64_t carried, std::uint64_t built, std::uint64_t leaf_pairs,
            std::uint64_t exact, std::uint64_t voxels)
{
  Work work;
  work.node_pairs = tests;
  work.volumes_carried = carried;
  work.volumes_built = built;
  work.leaf_pairs = leaf_pairs;
  work.exact_decisions = exact;
  work.voxels_built = voxels;
  return countsOf(work);
}

/// Spheres in the voxels that are built.
std::uint64_t spheresBuilt(const SphereHierarchy& hierarchy)
{
  const SphereHierarchy::Storage& storage = hierarchy.storage();
  std::uint64_t count = 0;
  for (std::size_t v = 0; v < storage.voxel_count; ++v) count += countChildren(storage.voxels[v].nodes);
  return count;
}

/// `count` points on a line in one voxel, 1 / 64 apart.
Cloud row(int count)
{
  std::vector<Point3> points;
  for (int i = 0; i < count; ++i) points.push_back({0.25 + i / 64.0, 0.5, 0.5});
  return Cloud(points);
}

HierarchyOptions oneVoxel()
{
  HierarchyOptions options;
  options.voxel_edge = 8;
  return options;
}

TEST(Work, OfSeveralQueriesIsTheSumOfAllCounts)
{
  Work one;
  one.voxels_built = 1, one.volumes_built = 2, one.node_pairs = 3, one.volumes_carried = 4, one.leaf_pairs = 5;
  one.exact_decisions = 6, one.ranked = 7;
  Work sum = one;
  sum += one;
  std::size_t counts = 0;
  for (const auto& [name, count] : countsOf(one)) {
    EXPECT_EQ(countsOf(sum).at(name), 2 * count) << name;
    ++counts;
  }
  EXPECT_GE(counts, 6u);
  EXPECT_EQ(sum.ranked, 14u);
  EXPECT_EQ(sum.updates(), 12u);
}

// One point each: above the voxels a root with one child, in the voxel a root with one leaf.
TEST(Work, OfTwoPoints)
{
  const Cloud one = row(1);
  const SphereHierarchy a(one.view(), oneVoxel()), b(one.view(), oneVoxel());
  const Eigen::Isometry3d pose(Eigen::Translation3d(1, 0, 0));
  // Tested: the two voxels' spheres, b's leaf against a's voxel, a's leaf against b's. Each test carries a sphere of a.
  // Decided exactly: two spheres of radius 0, their supports, and their two points.
  EXPECT_EQ(countsOf(anyCollision({a}, {b, pose}, within<AnyRequest>(1)).work), counts(3, 3, 2, 1, 3, 2));
  EXPECT_EQ(countsOf(anyCollision({a}, {b, pose}, within<AnyRequest>(1)).work), counts(3, 3, 0, 1, 3, 0));
  EXPECT_EQ(countsOf(anyCollision({a}, {b, pose}, within<AnyRequest>(0.5)).work),
            counts(0, 0, 0, 0, 0, 0)); // the clouds' bounds
}

// 32 points in a row are a root with leaves of sixteen, or a few more of fewer points.
TEST(Work, OfARowOfPointsAgainstOne)
{
  const Cloud points = row(32), point = row(1);
  const SphereHierarchy a(points.view(), oneVoxel()), b(point.view(), oneVoxel());
  const Eigen::Isometry3d beside(Eigen::Translation3d(0, 0.25, 0));
  // Points in the order of a scan are flagged without a tree the first time.
  EXPECT_EQ(collisionFlags({a}, {b, beside}, within<FlagsRequest>(0.25)).work.volumes_built, 1u);
  const Work cold = collisionFlags({a}, {b, beside}, within<FlagsRequest>(0.25)).work;
  const std::uint64_t leaves = a.statistics().leaves;
  EXPECT_EQ(cold.volumes_built, leaves);
  // Carried: a's voxel twice, to find which voxels are near and for its own walk, its leaves, and the sphere that they
  // share. Tested: the voxels twice; b's leaf against a's, which a point of b may settle, and which may be near at all.
  EXPECT_EQ(cold.volumes_carried, 3 + leaves);
  EXPECT_EQ(cold.node_pairs, 2 + 2 * leaves);
  EXPECT_EQ(cold.updates(), cold.volumes_built + cold.volumes_carried);
}

TEST(Work, OfNeighborSearchesCarriesTheBallOnce)
{
  const Cloud points = row(32);
  const SphereHierarchy cloud(points.view(), oneVoxel());
  Neighbors found;
  Work work;
  radiusSearch(cloud, {0.3, 0.5, 0.5}, 0.01, found, {}, &work);
  EXPECT_EQ(work.volumes_carried, 1u);
  EXPECT_EQ(work.volumes_built, cloud.statistics().leaves);
  EXPECT_EQ(work.node_pairs, cloud.statistics().leaves);
  work = Work();
  nearestKSearch(cloud, {0.3, 0.5, 0.5}, 1, found, &work);
  EXPECT_EQ(work.volumes_carried, 1u);
  EXPECT_EQ(work.volumes_built, 0u);
  work = Work();
  std::vector<std::int32_t> indices;
  boxSearch(cloud, {0, 0, 0}, {0.3, 1, 1}, indices, &work);
  EXPECT_EQ(work.volumes_carried, 2u); // above the voxels, and in the voxel
}

struct Clouds {
  Random random{31};
  Cloud a{test::makePoints(Shape::sphere, 20000, 1, random)};
  Cloud b{test::makePoints(Shape::uniform, 20000, 1, random)};
  Eigen::Isometry3d pose = Eigen::Translation3d(0.5, 0, 0) * random.pose(0.1);
};

// Flags need nothing but spheres: what they build is what there is afterwards.
TEST(Work, BuildsEachVolumeOnce)
{
  const Clouds clouds;
  const SphereHierarchy a(clouds.a.view()), b(clouds.b.view());
  const Work first = collisionFlags({a}, {b, clouds.pose}, within<FlagsRequest>(0.02)).work;
  EXPECT_GT(first.volumes_built, 0u);
  EXPECT_EQ(first.volumes_built, spheresBuilt(a) + spheresBuilt(b));
  const Work second = collisionFlags({a}, {b, clouds.pose}, within<FlagsRequest>(0.02)).work;
  EXPECT_EQ(second.volumes_built, 0u);
  EXPECT_EQ(second.volumes_carried, first.volumes_carried);
  EXPECT_EQ(second.node_pairs, first.node_pairs);
}

// The others ask for slabs, one for each sphere that is no leaf, and paths for boxes.
TEST(Work, BuildsWhatIsBesideSpheresOnce)
{
  const Clouds clouds;
  const SphereHierarchy a(clouds.a.view()), b(clouds.b.view());
  a.buildAll();
  b.buildAll();
  const Placed placed{b, Eigen::Isometry3d(Eigen::Translation3d(2.05, 0, 0))};
  const HierarchyStatistics of_a = a.statistics(), of_b = b.statistics();
  const Work first = closestPair({a}, placed).work;
  EXPECT_GT(first.volumes_built, 0u);
  EXPECT_LE(first.volumes_built, of_a.nodes + of_b.nodes);
  EXPECT_EQ(first.voxels_built, 0u);
  EXPECT_EQ(closestPair({a}, placed).work.volumes_built, 0u);
}

TEST(Work, OfEveryQueryThatDescendsHasUpdates)
{
  const Clouds clouds;
  const SphereHierarchy a(clouds.a.view()), b(clouds.b.view());
  const Placed placed{b, clouds.pose};
  const auto expectUpdates = [](const char* query, const Work& work) {
    EXPECT_GT(work.node_pairs, 0u) << query;
    EXPECT_GT(work.volumes_carried, 0u) << query;
    EXPECT_LE(work.volumes_carried, 2 * work.node_pairs) << query;
  };
  expectUpdates("any", anyCollision({a}, placed, within<AnyRequest>(0.01)).work);
  expectUpdates("flags", collisionFlags({a}, placed, within<FlagsRequest>(0.01)).work);
  expectUpdates("distance", closestPair({a}, placed).work);
  expectUpdates("distances", pointDistances({a}, placed).work);
  expectUpdates("contacts", nearestContacts({a}, placed, {0.01, 20}).work);
  expectUpdates("pairs", pairsWithin({a}, placed, {0.01, 100000}).work);
  expectUpdates("clusters", euclideanClusters(a, 0.05).work);
  expectUpdates("interval", closestPair({a}, placed, {Accuracy::level(2)}).work);
  TrajectoryRequest request;
  request.clearance = 0.01;
  request.distances = true;
  const std::vector<Eigen::Isometry3d> poses = {clouds.pose, Eigen::Isometry3d::Identity()};
  expectUpdates("trajectory", collideAlong({a}, b, poses, request).work);
}

TEST(Work, AlongAPathIsTheSameForAnyNumberOfThreads)
{
  const Clouds clouds;
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < 50; ++i) poses.emplace_back(Eigen::Translation3d(0.04 * i, 0, 0));
  TrajectoryRequest request;
  request.clearance = 0.02;
  Work expected;
  for (const unsigned threads : {1u, 2u, 4u}) {
    const SphereHierarchy a(clouds.a.view()), b(clouds.b.view());
    request.threads = threads;
    const Work work = collideAlong({a}, b, poses, request).work;
    if (threads == 1) expected = work;
    EXPECT_EQ(countsOf(work), countsOf(expected)) << threads;
  }
  EXPECT_GT(expected.volumes_carried, 0u);
  EXPECT_GT(expected.volumes_built, 0u);
}

TEST(Work, OfARefitIsEverySphere)
{
  const Clouds clouds;
  SphereHierarchy hierarchy(clouds.a.view());
  hierarchy.buildAll();
  const std::uint64_t spheres =
      hierarchy.storage().voxel_count + countChildren(hierarchy.storage().top) + spheresBuilt(hierarchy);
  const RefitReport report = hierarchy.refit(clouds.a.view());
  ASSERT_EQ(report.voxels_dropped, 0u);
  EXPECT_EQ(report.volumes_refitted, spheres);
}

TEST(Work, OfAnUpdateIsWhatWasTouchedAndAbove)
{
  const Clouds clouds;
  SphereHierarchy hierarchy(clouds.a.view());
  const std::int32_t record = 17;
  HierarchyUpdate update(hierarchy, &record, 1);
  const UpdateReport report = update.commit(clouds.a.view());
  ASSERT_FALSE(report.sorted_anew);
  ASSERT_EQ(report.voxels_touched, 1u);
  EXPECT_EQ(report.volumes_built, 1 + countChildren(hierarchy.storage().top));
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// Every query asks its caller often: however much it finds in one voxel, few pairs lie between two calls.
#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/made_meshes.h"
#include "support/random.h"
#include "support/tied_meshes.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

namespace pcl_bsh {
namespace {

using test::Random;
using test::TestMesh;

/// A query of two clouds, with a report of its progress. @return its work
using Query = std::function<Work(const Placed&, const Placed&, const std::function<bool(double)>&)>;

struct NamedQuery {
  const char* name;
  Query ask;
  bool is_of_points = false; ///< alone
};

/// @param reach of what collides
std::vector<NamedQuery> queries(double reach)
{
  using Report = std::function<bool(double)>;
  const auto alongPath = [reach](double swept) {
    return [reach, swept](const Placed& a, const Placed& b, const Report& report) {
      std::vector<Eigen::Isometry3d> poses(5, Eigen::Isometry3d::Identity());
      for (int k = 0; k < 5; ++k) poses[static_cast<std::size_t>(k)].translation().z() = 0.01 * reach * k;
      TrajectoryRequest request;
      request.clearance = reach;
      request.distances = swept == 0.0;
      if (swept > 0.0) request.swept = swept;
      request.progress = report;
      return collideAlong(a, b.hierarchy(), poses, request).work;
    };
  };
  return {
      {"any",
       [reach](const Placed& a, const Placed& b, const Report& r) {
         return anyCollision(a, b, {0.999 * reach, {1, r}}).work;
       }},
      {"closest",
       [](const Placed& a, const Placed& b, const Report& r) {
         return closestPair(a, b, {1, r}).work;
       }},
      {"flags",
       [reach](const Placed& a, const Placed& b, const Report& r) {
         return collisionFlags(a, b, {reach, Flagged::both, {1, r}}).work;
       }},
      {"indices",
       [reach](const Placed& a, const Placed& b, const Report& r) {
         return collidingIndices(a, b, {reach, Flagged::both, {1, r}}).work;
       }},
      {"distances",
       [](const Placed& a, const Placed& b, const Report& r) {
         PointDistancesRequest request;
         request.progress = r;
         return pointDistances(a, b, request).work;
       }},
      {"Hausdorff", [](const Placed& a, const Placed& b,
                       const Report& r) { return hausdorffDistance(a, b, HausdorffRequest(1, r)).work; }},
      {"contacts",
       [reach](const Placed& a, const Placed& b, const Report& r) {
         ContactsRequest request;
         request.clearance = reach;
         request.most = 1000;
         request.progress = r;
         return nearestContacts(a, b, request).work;
       }},
      {"clusters",
       [reach](const Placed& a, const Placed&, const Report& r) {
         return euclideanClusters(a.hierarchy(), 0.02 * reach, {1, r}).work;
       },
       true},
      {"path", alongPath(0.0)},
      {"swept path", alongPath(0.01 * reach)},
  };
}

constexpr std::uint64_t kMostBetween = 100'000;

void expectAsks(const Placed& a, const Placed& b, double reach)
{
  a.hierarchy().buildAll(); // so that each time is as the first
  b.hierarchy().buildAll();
  for (const NamedQuery& query : queries(reach)) {
    if (query.is_of_points && a.hierarchy().view().triangles) continue;
    SCOPED_TRACE(query.name);
    std::uint64_t calls = 0;
    const Work work = query.ask(a, b, [&](double) {
      ++calls;
      return true;
    });
    EXPECT_LE(work.node_pairs + work.leaf_pairs, kMostBetween * calls);
    if (calls < 4) continue;
    std::uint64_t left = calls / 2;
    EXPECT_THROW(query.ask(a, b, [&](double) { return --left != 0; }), Cancelled);
    EXPECT_EQ(left, 0u) << "it asks no more";
    left = calls / 2;
    const auto refuse = [&](double) -> bool { return --left != 0 ? true : throw std::out_of_range("enough"); };
    EXPECT_THROW(query.ask(a, b, refuse), std::out_of_range);
    EXPECT_EQ(query.ask(a, b, nullptr).node_pairs, work.node_pairs) << "the same after that";
  }
}

HierarchyOptions oneVoxel()
{
  HierarchyOptions options;
  options.voxel_edge = 1e9;
  return options;
}

TEST(Cancelling, OfTiedSurfaces)
{
  for (const test::Tied& tied : test::tied()) {
    SCOPED_TRACE(tied.name);
    const test::TiedPair pair = tied.make(24);
    const SphereHierarchy a(viewOf(pair.a.trianglesView()), oneVoxel()), b(viewOf(pair.b.trianglesView()), oneVoxel());
    expectAsks(a, b, 0.3);
  }
}

TEST(Cancelling, OfASphereAboutAPoint)
{
  Random random(31);
  std::vector<Point3> shell, core;
  for (int i = 0; i < 20'000; ++i) {
    Eigen::Vector3d at(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    at.normalize();
    shell.push_back({at.x(), at.y(), at.z()});
    at *= 1e-3 * random.uniform(0, 1);
    core.push_back({at.x(), at.y(), at.z()});
  }
  const SphereHierarchy a(viewOf(core[0].data(), 1000), oneVoxel()),
      b(viewOf(shell[0].data(), shell.size()), oneVoxel());
  expectAsks(a, b, 0.9995);
}

TEST(Cancelling, OfFlatScansThatFaceEachOther)
{
  Random random(32);
  std::vector<Point3> lower, upper;
  for (int i = 0; i < 30'000; ++i) {
    lower.push_back({random.uniform(0, 1), random.uniform(0, 1), 0});
    upper.push_back({random.uniform(0, 1), random.uniform(0, 1), 0.5});
  }
  const SphereHierarchy a(viewOf(lower[0].data(), lower.size()), oneVoxel()),
      b(viewOf(upper[0].data(), upper.size()), oneVoxel());
  expectAsks(a, b, 0.5);
}

/// Many voxels, each of which is compared with all of the other cloud's.
TEST(Cancelling, OfFineVoxels)
{
  Random random(33);
  std::vector<Point3> one, other;
  for (int i = 0; i < 15'000; ++i) {
    one.push_back({random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)});
    other.push_back({random.uniform(0, 1) + 50, random.uniform(0, 1), random.uniform(0, 1)});
  }
  HierarchyOptions fine;
  fine.voxel_edge = 1e-3;
  const SphereHierarchy a(viewOf(one[0].data(), one.size()), fine), b(viewOf(other[0].data(), other.size()), fine);
  expectAsks(a, b, 49.1);
}

/// Places that thousands of points share.
TEST(Cancelling, OfCoincidentPoints)
{
  const std::vector<Point3> one(3000, {0, 0, 0}), other(3000, {0, 0, 1});
  const SphereHierarchy a(viewOf(one[0].data(), one.size())), b(viewOf(other[0].data(), other.size()));
  std::uint64_t calls = 0;
  ContactsRequest request;
  request.clearance = 1.0;
  request.most = 10'000'000;
  request.progress = [&](double) { return ++calls < 20; };
  PairsWithin found;
  EXPECT_THROW(pairsWithin(a, b, request, found), Cancelled);
  EXPECT_EQ(calls, 20u);
}

/// Work of a question beside its queries is watched, too: building, and finding records that solids hold.
TEST(Cancelling, OfWhatIsNoQuery)
{
  Random random(34);
  std::vector<Point3> points;
  for (int i = 0; i < 200'000; ++i)
    points.push_back({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  std::uint64_t calls = 0;
  const std::function<bool(double)> report = [&](double) { return ++calls < 3; };
  Progress progress(report);
  EXPECT_THROW(
      {
        const SphereHierarchy cloud(viewOf(points[0].data(), points.size()));
        cloud.buildAll();
      },
      Cancelled);
  EXPECT_EQ(calls, 3u);
}

} // namespace
} // namespace pcl_bsh

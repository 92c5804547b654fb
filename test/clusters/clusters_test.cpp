// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/clusters/clusters.h>

#include "support/brute_force/clusters.h"
#include "support/meshes.h"
#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace pcl_bsh {
namespace {

using test::Cloud;

void expectSameAsBruteForce(const SphereHierarchy& cloud, double distance)
{
  SCOPED_TRACE("distance " + std::to_string(distance));
  const Clusters clusters = euclideanClusters(cloud, distance);
  const Clusters expected = brute_force::euclideanClusters(cloud, distance);
  EXPECT_EQ(clusters.of, expected.of);
  EXPECT_EQ(clusters.sizes, expected.sizes);
}

TEST(Clusters, SameAsBruteForce)
{
  test::Random random(11);
  for (const test::Shape shape : test::all_shapes) {
    for (const std::size_t count : {1u, 2u, 17u, 300u, 501u}) {
      for (const Scalar scalar : {Scalar::float32, Scalar::float64}) {
        SCOPED_TRACE("shape " + std::to_string(static_cast<int>(shape)) + ", " + std::to_string(count) + " points");
        const Cloud cloud(test::makePoints(shape, count, 8.0, random), {scalar, 1, 2});
        HierarchyOptions options;
        options.voxel_edge = count % 2 == 0 ? 0.0 : 2.0;
        const SphereHierarchy hierarchy(cloud.view(), options);
        // On the grid the spacing is 1: a step of exactly that length counts.
        for (const double distance : {0.0, 0.01, 0.3, std::nextafter(1.0, 0.0), 1.0, 3.0, 100.0}) {
          expectSameAsBruteForce(hierarchy, distance);
        }
      }
    }
  }
}

TEST(Clusters, SameAsBruteForceOfTriangles)
{
  test::Random random(12);
  for (const test::MeshKind kind : test::kMeshKinds)
    for (const std::size_t count : {1u, 17u, 120u}) {
      SCOPED_TRACE("mesh " + std::to_string(static_cast<int>(kind)) + ", " + std::to_string(count) + " triangles");
      test::Mesh mesh = test::makeMesh(kind, count, 8.0, random);
      Cloud cloud(mesh.vertices);
      cloud.setTriangles(mesh.corners);
      const SphereHierarchy hierarchy(cloud.view());
      for (const double distance : {0.0, 0.01, std::nextafter(1.0, 0.0), 1.0, 3.0})
        expectSameAsBruteForce(hierarchy, distance);
    }
}

TEST(Clusters, BruteForceComparesEachPairOnce)
{
  const Cloud cloud({{0, 0, 0}, {1, 0, 0}, {std::nan(""), 0, 0}, {5, 0, 0}, {6, 0, 0}});
  const Clusters clusters = brute_force::euclideanClusters(SphereHierarchy(cloud.view()), 1.0);
  EXPECT_EQ(clusters.work.exact_decisions, 6u);
  EXPECT_EQ(clusters.sizes, (std::vector<std::size_t>{2, 2}));
}

TEST(Clusters, StepsOfExactlyTheDistanceJoin)
{
  const std::vector<float> line = {0, 0, 0, 1, 0, 0, 2, 0, 0, 3.5f, 0, 0};
  const SphereHierarchy cloud(viewOf(line.data(), 4));
  EXPECT_EQ(euclideanClusters(cloud, 1.0).of, (std::vector<std::int32_t>{0, 0, 0, 1}));
  EXPECT_EQ(euclideanClusters(cloud, std::nextafter(1.0, 0.0)).sizes.size(), 4u);
  EXPECT_EQ(euclideanClusters(cloud, 1.5).sizes, std::vector<std::size_t>{4});
}

TEST(Clusters, OnlyFinitePointsOfTheSubsetBelongSomewhere)
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> points = {5, 0, 0, nan, 0, 0, 5.5f, 0, 0, 0, 0, 0, 5.2f, 0, 0};
  const std::vector<std::int32_t> subset = {4, 3, 1, 0, 4};
  PointsView view = viewOf(points.data(), 5);
  view.indices = subset.data();
  view.index_count = subset.size();
  const Clusters clusters = euclideanClusters(SphereHierarchy(view), 0.25);
  EXPECT_EQ(clusters.of, (std::vector<std::int32_t>{0, -1, -1, 1, 0}));
  EXPECT_EQ(clusters.sizes, (std::vector<std::size_t>{2, 1}));
}

TEST(Clusters, NothingHasNone)
{
  const Clusters clusters = euclideanClusters(SphereHierarchy(PointsView{}), 1.0);
  EXPECT_TRUE(clusters.of.empty());
  EXPECT_TRUE(clusters.sizes.empty());
}

TEST(Clusters, RadiiPlayNoPart)
{
  test::Random random(5);
  Cloud cloud(test::makePoints(test::Shape::uniform, 400, 8.0, random));
  const Clusters bare = euclideanClusters(SphereHierarchy(cloud.view()), 1.0);
  cloud.setRadii(std::vector<float>(400, 0.7f));
  EXPECT_EQ(euclideanClusters(SphereHierarchy(cloud.view()), 1.0).of, bare.of);
}

TEST(Clusters, GreatDistancesCostLittle)
{
  test::Random random(3);
  const Cloud cloud(test::makePoints(test::Shape::plane, 20000, 8.0, random));
  const SphereHierarchy hierarchy(cloud.view());
  const Clusters near = euclideanClusters(hierarchy, 0.5), far = euclideanClusters(hierarchy, 4.0);
  EXPECT_EQ(far.sizes.size(), 1u);
  EXPECT_LT(far.work.leaf_pairs, 20000u);
  EXPECT_LT(near.work.leaf_pairs, 200000u);
}

TEST(Clusters, RefusesDistances)
{
  const SphereHierarchy nothing{PointsView{}};
  for (const double distance : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(euclideanClusters(nothing, distance), std::invalid_argument);
}

} // namespace
} // namespace pcl_bsh

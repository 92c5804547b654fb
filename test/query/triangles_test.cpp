// SPDX-License-Identifier: BSD-3-Clause
// Clouds of triangles in every query: uncertain places, every accuracy, refits, one centre for many, what is refused.
// Exact answers are compared with brute force beside the tests of each query.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/flags/colliding_indices.h>
#include <pcl_bsh/hierarchy/update.h>
#include <pcl_bsh/many_poses/collide_at_poses.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/neighbors/patch_spacings.h>
#include <pcl_bsh/neighbors/spacing.h>
#include <pcl_bsh/pairs/contacts.h>
#include <pcl_bsh/pairs/trace.h>

#include "support/brute_force/many_poses.h"
#include "support/meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Scene;

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

FlagsRequest flagsWithin(double clearance, const Accuracy& accuracy = {})
{
  FlagsRequest request;
  request.clearance = clearance;
  request.flagged = Flagged::both;
  request.accuracy = accuracy;
  return request;
}

TEST(Triangles, UncertainPlacesAreThoseOfBruteForce)
{
  std::size_t undecided = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Scene scene = test::anyMeshScene(seed, 60);
    SCOPED_TRACE(scene.name);
    Random random(seed);
    const double scale = std::max(scene.clearance, 0x1p-10);
    if (seed % 3 != 1) makeUncertain(scene.a, scale, random);
    if (seed % 3 != 0) makeUncertain(scene.b, scale, random);
    const SphereHierarchy ha(scene.a.view()), hb(scene.b.view());
    const Placed a(ha, scene.pose_a), b(hb, scene.pose_b);
    const FlagsRequest request = flagsWithin(scene.clearance);
    const FlagsResult expected = brute_force::collisionFlags(a, b, request), found = collisionFlags(a, b, request);
    ASSERT_EQ(found.a, expected.a);
    ASSERT_EQ(found.b, expected.b);
    undecided += expected.undecided_a;
    const AnyRequest any{scene.clearance, {}};
    ASSERT_EQ(anyCollision(a, b, any).verdict, brute_force::anyCollision(a, b, any).verdict);
  }
  EXPECT_GT(undecided, 100u);
}

/// No verdict claims what is not so; what need not be decided may be left.
TEST(Triangles, EveryAccuracyClaimsWhatIsSo)
{
  std::size_t decided = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const Scene scene = test::anyMeshScene(seed, 80);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy ha(scene.a.view()), hb(scene.b.view());
    const Placed a(ha, scene.pose_a), b(hb, scene.pose_b);
    const double tolerance = scene.clearance / 4;
    const FlagsResult exact = brute_force::collisionFlags(a, b, flagsWithin(scene.clearance));
    const FlagsResult wide = brute_force::collisionFlags(a, b, flagsWithin(scene.clearance + tolerance));
    const double closest = brute_force::closestPair(a, b).distance;
    const PointDistances distances = pointDistances(a, b);
    for (const Accuracy& accuracy : {Accuracy::tolerance(tolerance), Accuracy::level(0), Accuracy::level(1),
                                     Accuracy::level(3), Accuracy::nodePairs(40), Accuracy::nodePairs(4000)}) {
      SCOPED_TRACE(accuracy.text());
      const FlagsResult found = collisionFlags(a, b, flagsWithin(scene.clearance, accuracy));
      const auto check = [&](const auto& flags, const auto& is, const auto& may_be) {
        ASSERT_EQ(flags.size(), is.size());
        for (std::size_t i = 0; i < flags.size(); ++i) {
          if (flags[i] == Verdict::undecided) {
            ASSERT_TRUE(accuracy.stopsEarly());
            continue;
          }
          ++decided;
          if (flags[i] == Verdict::free) {
            ASSERT_EQ(is[i], Verdict::free) << i;
          }
          else {
            ASSERT_EQ((accuracy.stopsEarly() ? is : may_be)[i], Verdict::colliding) << i;
          }
        }
      };
      check(found.a, exact.a, wide.a);
      check(found.b, exact.b, wide.b);

      const DistanceResult nearest = closestPair(a, b, {accuracy});
      EXPECT_LE(nearest.interval.lower, closest);
      EXPECT_GE(nearest.interval.upper, closest);
      const AnyResult any = anyCollision(a, b, {scene.clearance, accuracy});
      EXPECT_LE(any.interval.lower, closest);
      EXPECT_GE(any.interval.upper, closest);

      PointDistancesRequest request;
      request.accuracy = accuracy;
      const PointDistances roughly = pointDistances(a, b, request);
      for (std::size_t i = 0; i < distances.distance.size(); ++i) {
        if (std::isnan(distances.distance[i])) continue;
        ASSERT_LE(roughly.interval[i].lower, distances.distance[i]) << i;
        ASSERT_GE(roughly.interval[i].upper, distances.distance[i]) << i;
      }
    }
  }
  EXPECT_GT(decided, 1000u);
}

TEST(Triangles, OthersOfTheSameQueriesAgree)
{
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const Scene scene = test::anyMeshScene(seed, 80);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy ha(scene.a.view()), hb(scene.b.view());
    const Placed a(ha, scene.pose_a), b(hb, scene.pose_b);
    FlagsRequest request = flagsWithin(scene.clearance);
    const FlagsResult flags = collisionFlags(a, b, request);
    request.threads = 3;
    const CollidingIndices lists = collidingIndices(a, b, request);
    std::vector<std::int32_t> listed;
    for (std::size_t i = 0; i < flags.a.size(); ++i)
      if (flags.a[i] == Verdict::colliding) listed.push_back(static_cast<std::int32_t>(i));
    ASSERT_EQ(lists.a, listed);
    ASSERT_EQ(traceCollision(a, b, {scene.clearance, {}}).result.verdict,
              anyCollision(a, b, {scene.clearance, {}}).verdict);
    const SymmetricDistances both = symmetricDistances(a, b);
    const HausdorffDistance hausdorff = hausdorffDistance(a, b);
    if (std::isnan(both.hausdorff)) {
      EXPECT_TRUE(std::isnan(hausdorff.distance));
    }
    else {
      ASSERT_EQ(hausdorff.distance, both.hausdorff);
      ASSERT_EQ(hausdorff.pair, both.hausdorff_pair);
    }
    ASSERT_TRUE(ha.validate().none()) << ha.validate().lines.front();
    ASSERT_TRUE(hb.validate().none()) << hb.validate().lines.front();
  }
}

TEST(Triangles, AtListsOfPoses)
{
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Scene scene = test::anyMeshScene(seed, 40);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy ha(scene.a.view()), hb(scene.b.view());
    const Placed a(ha, scene.pose_a);
    Random random(seed);
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i < 30; ++i) poses.push_back(scene.pose_b * random.pose(i % 3 == 0 ? 1e-3 : 0.5));
    const AnyRequest any{scene.clearance, {}};
    EXPECT_EQ(anyCollisionAtPoses(a, hb, poses, any).flags, brute_force::anyCollisionAtPoses(a, hb, poses, any).flags);
    EXPECT_EQ(closestPairAtPoses(a, hb, poses, {}).distances,
              brute_force::closestPairAtPoses(a, hb, poses, {}).distances);
  }
}

TEST(Triangles, NormalsPointFromTheNearestPlaces)
{
  const Cloud point({{0.25, 0.25, 0.5}});
  Cloud triangle({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  triangle.setTriangles({0, 1, 2});
  const SphereHierarchy p(point.view()), t(triangle.view());
  const ContactsResult above = nearestContacts(p, t, {0.5, 9}), below = nearestContacts(t, p, {0.5, 9});
  ASSERT_EQ(above.contacts.size(), 1u);
  EXPECT_EQ(above.contacts[0].distance, 0.5);
  EXPECT_EQ(above.contacts[0].normal, Eigen::Vector3d(0, 0, 1));
  ASSERT_EQ(below.contacts.size(), 1u);
  EXPECT_EQ(below.contacts[0].normal, Eigen::Vector3d(0, 0, -1));
  const Placed beside(t, Eigen::Isometry3d(Eigen::Translation3d(1.25, 0, 0)));
  const ContactsResult edges = nearestContacts(beside, t, {0.25, 9});
  ASSERT_EQ(edges.contacts.size(), 1u);
  EXPECT_EQ(edges.contacts[0].distance, 0.25);
  EXPECT_EQ(edges.contacts[0].normal, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(nearestContacts(t, t, {0, 9}).contacts.at(0).normal, Eigen::Vector3d::Zero());

  Random random(3); // any features: along the normal by the distance, they meet
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Scene scene = test::anyMeshScene(seed, 40);
    const SphereHierarchy ha(scene.a.view()), hb(scene.b.view());
    const Placed a(ha, scene.pose_a), b(hb, scene.pose_b);
    for (const Contact& contact : nearestContacts(a, b, {scene.clearance + 0.1, 20}).contacts) {
      if (!(contact.distance > 1e-3 * scene.clearance && contact.distance > 1e-6)) continue;
      Placed moved = b;
      moved.pose.pretranslate(contact.distance * contact.normal);
      const double left = RecordDistance(ha.view(), a.pose, hb.view(), moved.pose).gap(contact.pair);
      const double radii = ha.view().ownRadius(contact.pair.a) + hb.view().ownRadius(contact.pair.b);
      EXPECT_LE(std::abs(left), 1e-6 * (contact.distance + radii) + 1e-9 * moved.pose.translation().norm());
    }
  }
}

/// Segments, ball by ball one: what they are is told apart.
TEST(Triangles, OneCentreAndOneBallForMany)
{
  std::vector<Point3> vertices;
  std::vector<std::uint32_t> corners;
  for (std::uint32_t i = 0; i < 200; ++i) { // lattice vectors of one length: (3, 4), (5, 0) and so on
    const double ways[][2] = {{5, 0}, {3, 4}, {4, 3}, {0, 5}, {-3, 4}, {-4, 3}};
    const double x = ways[i % 6][0], y = ways[i % 6][1];
    vertices.insert(vertices.end(), {{x, y, 0}, {-x, -y, 0}});
    corners.insert(corners.end(), {2 * i, 2 * i + 1, 2 * i});
  }
  Cloud stars(vertices);
  stars.setTriangles(corners);
  const Cloud points({{3, 4, 0}, {4, 3, 0.25}, {-4, 3, 0}, {3, -4, 0}, {5, 0, 0.5}, {4.5, -2, 0}});
  const SphereHierarchy t(stars.view()), p(points.view());
  EXPECT_TRUE(t.validate().none());
  for (const double clearance : {0.0, 0.25, 0.5, 1.0}) {
    const FlagsRequest request = flagsWithin(clearance);
    const FlagsResult expected = brute_force::collisionFlags(p, t, request), found = collisionFlags(p, t, request);
    EXPECT_EQ(found.a, expected.a);
    EXPECT_EQ(found.b, expected.b);
  }
  EXPECT_EQ(closestPair(p, t).pair, (PointPair{0, 1}));
}

TEST(Triangles, FollowTheirVerticesThroughRefits)
{
  Random random(9);
  for (const test::MeshKind kind : test::kMeshKinds) {
    const test::Mesh mesh = test::makeMesh(kind, 150, 1.0, random);
    std::vector<Point3> moved = mesh.vertices;
    for (Point3& q : moved)
      for (double& x : q) x += 0.05 * std::sin(5 * q[0] + 7 * q[1]);
    Cloud before(mesh.vertices), after(moved);
    before.setTriangles(mesh.corners);
    after.setTriangles(mesh.corners);
    const Cloud points(test::makePoints(test::Shape::uniform, 100, 1.0, random));
    const SphereHierarchy p(points.view());
    SphereHierarchy t(before.view());
    collisionFlags(p, t, flagsWithin(0.05)); // builds its voxels
    t.refit(after.view());
    EXPECT_TRUE(t.validate().none());
    const FlagsRequest request = flagsWithin(0.05);
    EXPECT_EQ(collisionFlags(p, t, request).a, brute_force::collisionFlags(p, t, request).a);
    EXPECT_EQ(collisionFlags(p, t, request).a, collisionFlags(p, SphereHierarchy(after.view()), request).a);
  }
}

TEST(Triangles, AreRefusedWhereOnlyPointsHaveAMeaning)
{
  Cloud triangle({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  triangle.setTriangles({0, 1, 2});
  const Cloud point({{0, 0, 0}});
  const SphereHierarchy t(triangle.view()), p(point.view());
  Neighbors found;
  EXPECT_THROW(nearestKSearch(t, {0, 0, 0}, 1, found), InvalidInput);
  EXPECT_THROW(radiusSearch(t, {0, 0, 0}, 1.0, found), InvalidInput);
  EXPECT_THROW(anyInRadius(t, {0, 0, 0}, 1.0), InvalidInput);
  std::vector<std::int32_t> indices;
  EXPECT_THROW(boxSearch(t, {0, 0, 0}, {1, 1, 1}, indices), InvalidInput);
  EXPECT_THROW(patchSpacings(t, 1.0), InvalidInput);
  EXPECT_EQ(spacingOf(t).samples, 0u);
  const float spacing = 0.5f;
  FlagsRequest guarded = flagsWithin(0.1);
  guarded.spacings_of_b = &spacing;
  EXPECT_THROW(collisionFlags(p, t, guarded), InvalidInput);
  EXPECT_NO_THROW(collisionFlags(t, p, guarded)) << "b's are asked for";
}

} // namespace
} // namespace pcl_bsh

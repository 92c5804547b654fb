// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/manifold/contact_manifold.h>

#include "manifold_twin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <set>

namespace pcl_bsh {
namespace {

using test::TestMesh;
using test::Thing;

Manifold manifoldOf(const Thing& a, const Eigen::Isometry3d& pose_a, const Thing& b, const ManifoldRequest& request)
{
  return contactManifold({*a.collider, pose_a}, {*b.collider}, request);
}

ManifoldRequest within(double margin, std::size_t most = 4)
{
  ManifoldRequest request;
  request.margin = margin;
  request.most = most;
  return request;
}

Eigen::Isometry3d at(double x, double y, double z)
{
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

Thing floor()
{
  return Thing(test::gridMesh(1, 1, [](double u, double v) -> Point3 { return {20 * u - 10, 20 * v - 10, 0}; }));
}

TEST(ContactManifold, OfABoxOnAFloorHasItsCorners)
{
  const Thing box(test::boxMesh(2, 1, 1)), ground = floor();
  const Manifold found = manifoldOf(box, at(0.5, 0.25, 0.125), ground, within(0.25));
  ASSERT_EQ(found.contacts.size(), 4u);
  std::set<std::pair<double, double>> places;
  for (const Contact& contact : found.contacts) {
    EXPECT_EQ(contact.distance, 0.125);
    EXPECT_EQ(contact.normal, Eigen::Vector3d::UnitZ());
    EXPECT_EQ(contact.place_a.z(), 0.125);
    EXPECT_EQ(contact.place_b, Eigen::Vector3d(contact.place_a.x(), contact.place_a.y(), 0));
    places.emplace(contact.place_a.x(), contact.place_a.y());
  }
  EXPECT_EQ(places, (std::set<std::pair<double, double>>{{0.5, 0.25}, {2.5, 0.25}, {0.5, 1.25}, {2.5, 1.25}}));
}

TEST(ContactManifold, OfTheFloorUnderABoxHasNormalsDown)
{
  const Thing box(test::boxMesh(2, 1, 1)), ground = floor();
  const Manifold found = contactManifold({*ground.collider}, {*box.collider, at(0, 0, 0.125)}, within(0.25));
  ASSERT_EQ(found.contacts.size(), 4u);
  for (const Contact& contact : found.contacts) EXPECT_EQ(contact.normal, -Eigen::Vector3d::UnitZ());
}

/// Bars that cross touch where their edges do, and no corner is near.
TEST(ContactManifold, OfBarsThatCrossHasTheCrossingsOfTheirEdges)
{
  const Thing along(test::boxMesh(6, 1, 1), true), across(test::boxMesh(1, 6, 1), true);
  for (const double gap : {0.125, -0.125}) {
    const Eigen::Isometry3d pose = at(-2.5, 2, 1 + gap) * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ());
    const Manifold found = manifoldOf(along, pose, across, within(0.25));
    ASSERT_EQ(found.contacts.size(), 4u) << gap;
    for (const Contact& contact : found.contacts) {
      EXPECT_NEAR(contact.distance, gap, 1e-12);
      EXPECT_NEAR(contact.normal.z(), 1.0, 1e-12);
    }
  }
}

TEST(ContactManifold, OfABoxInACornerHasAPatchOnEachWall)
{
  TestMesh walls = test::boxMesh(10, 10, 10); // seen from within
  const Thing box(test::boxMesh(1, 1, 1)), room(std::move(walls));
  ManifoldRequest request = within(0.25);
  request.height = 0.25;
  const Manifold found = manifoldOf(box, at(0.125, 0.1875, 0.0625), room, request);
  std::set<std::uint32_t> patches;
  std::set<int> axes;
  for (const Contact& contact : found.contacts) {
    patches.insert(contact.patch);
    for (int k = 0; k < 3; ++k)
      if (std::abs(contact.normal[k]) > 0.999) axes.insert(k);
  }
  EXPECT_EQ(patches.size(), 3u);
  EXPECT_EQ(axes.size(), 3u);
}

TEST(ContactManifold, OfWhatASolidHoldsHasGapsBelowZero)
{
  const Thing tank(test::boxMesh(4, 4, 4), true), dots({{1, 2, 0.25}, {3, 2, 0.5}, {2, 3, -0.125}, {2, 2, -3}});
  ManifoldRequest request = within(0.25);
  request.thickness = 0.0;
  const Manifold found = manifoldOf(dots, Eigen::Isometry3d::Identity(), tank, request);
  ASSERT_EQ(found.contacts.size(), 3u);
  EXPECT_EQ(found.contacts[0].distance, -0.5);
  EXPECT_EQ(found.contacts[0].normal, -Eigen::Vector3d::UnitZ()); // out of the tank
  for (const Contact& contact : found.contacts)
    if (contact.pair.a == 2) {
      EXPECT_EQ(contact.distance, 0.125);
    }
}

TEST(ContactManifold, OfBallsTakesRadiiAndThicknessFromDistances)
{
  const Thing ball({{0, 0, 0}}, {0.5f}), ground = floor();
  ManifoldRequest request = within(0.5);
  request.thickness = 0.25;
  const Manifold found = manifoldOf(ball, at(0, 0, 1), ground, request);
  ASSERT_EQ(found.contacts.size(), 1u);
  EXPECT_EQ(found.contacts[0].distance, 0.25);
  EXPECT_EQ(found.contacts[0].place_a, Eigen::Vector3d(0, 0, 0.5));
}

std::vector<Point3> sheet(int side, double spacing, double noise, std::uint64_t seed)
{
  test::Random random(seed);
  std::vector<Point3> points;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      points.push_back({spacing * (i - 0.5 * side), spacing * (j - 0.5 * side), noise * random.uniform(-1, 1)});
  return points;
}

/// From point to point the way may lie at any angle to the surface.
TEST(ContactManifold, OfPointsHasNormalsOfFittedPlanes)
{
  const Thing scan(sheet(60, 0.125, 0.005, 1)), body(sheet(8, 0.11, 0.0, 2));
  const Manifold found = manifoldOf(body, at(0.03, 0.05, 0.06), scan, within(0.0625));
  EXPECT_NEAR(found.thickness, 0.0625, 0.002);
  ASSERT_EQ(found.contacts.size(), 4u);
  for (const Contact& contact : found.contacts) {
    EXPECT_GT(contact.normal.z(), 0.999);
    EXPECT_GT(contact.residual, 0.0005);
    EXPECT_LT(contact.residual, 0.01);
  }
  EXPECT_LT((found.contacts[1].place_a - found.contacts[1].place_b).normalized().z(), 0.99);
}

TEST(ContactManifold, OfPointsHasTheNormalsThatAreGiven)
{
  const Thing scan(sheet(20, 0.125, 0.005, 1)), body(sheet(4, 0.125, 0.0, 2));
  std::vector<float> normals;
  for (int i = 0; i < 400; ++i) normals.insert(normals.end(), {0.0f, 0.6f, 0.8f});
  const Collider with_normals(*scan.hierarchy, nullptr, {normals.data()});
  const Eigen::Isometry3d turn(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()));
  for (const bool of_b : {true, false}) {
    const Manifold found = of_b ? contactManifold({*body.collider, at(0, 0, 0.05)}, {with_normals, turn}, within(0.1))
                                : contactManifold({with_normals, turn}, {*body.collider, at(0, 0, -0.05)}, within(0.1));
    ASSERT_FALSE(found.contacts.empty());
    const Eigen::Vector3d normal = (of_b ? 1.0 : -1.0) * Eigen::Vector3d(-0.6, 0, 0.8);
    EXPECT_TRUE(found.contacts[0].normal.isApprox(normal, 1e-6)) << found.contacts[0].normal.transpose();
    EXPECT_EQ(found.contacts[0].residual, 0.0);
  }
}

/// A place that goes round an edge and a corner at one distance: its normal turns no faster than it goes.
TEST(ContactManifold, NormalsAreContinuousAroundEdgesAndCorners)
{
  const Thing box(test::boxMesh(2, 2, 2), true), dot({{0, 0, 0}});
  ManifoldRequest request = within(1.0, 1);
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (int i = 0; i <= 2000; ++i) {
    const double turn = 2.5 * i / 2000.0;
    const Eigen::Vector3d way(std::sin(turn), 0.4 * std::cos(turn), std::cos(turn));
    const Eigen::Vector3d place = Eigen::Vector3d::Ones() + 1.9 * way;
    const Manifold found = manifoldOf(dot, at(place.x(), place.y(), place.z()), box, request);
    ASSERT_EQ(found.contacts.size(), 1u);
    const Eigen::Vector3d normal = found.contacts[0].normal;
    if (i > 0) {
      EXPECT_LT((normal - before).norm(), 0.01) << i;
    }
    before = normal;
  }
}

TEST(ContactManifold, IdsLiveWhileContactsDo)
{
  const Thing box(test::boxMesh(2, 1, 1)), ground = floor();
  ManifoldRequest request = within(0.25);
  request.same_within = 0.01;
  Manifold before = manifoldOf(box, at(0, 0, 0.125), ground, request);
  std::set<std::uint32_t> first;
  for (const Contact& contact : before.contacts) first.insert(contact.id);
  EXPECT_EQ(first, (std::set<std::uint32_t>{1, 2, 3, 4}));
  for (int i = 1; i < 10000; ++i) { // it slides: its corners stay where they are in its own frame
    request.previous = &before;
    Manifold now = manifoldOf(box, at(1e-4 * i, 0, 0.125 + 1e-6 * (i % 7)), ground, request);
    std::set<std::uint32_t> ids;
    for (const Contact& contact : now.contacts) ids.insert(contact.id);
    ASSERT_EQ(ids, first) << i;
    before = std::move(now);
  }
}

TEST(ContactManifold, IdsDieWhereAPlaceMovesOnBothBodies)
{
  const Thing ball({{0, 0, 0}}, {1.0f}), ground = floor();
  ManifoldRequest request = within(0.25);
  request.same_within = 0.125;
  Manifold before = manifoldOf(ball, at(0, 0, 1), ground, request);
  ASSERT_EQ(before.contacts[0].id, 1u);
  for (const double roll : {0.1, 0.5}) { // a little, then far
    request.previous = &before;
    const Eigen::Isometry3d pose = at(roll, 0, 1) * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitY());
    Manifold now = manifoldOf(ball, pose, ground, request);
    EXPECT_EQ(now.contacts[0].id, roll < 0.2 ? 1u : 2u);
    before = std::move(now);
  }
}

/// Candidates that cannot be chosen are not decided: work counts, not time.
TEST(ContactManifold, DecidesFewOfManyCandidates)
{
  const Thing body(sheet(100, 0.02, 0.001, 3)), scan(sheet(200, 0.02, 0.001, 4));
  ManifoldRequest request = within(0.01);
  const Manifold found = manifoldOf(body, at(0.001, 0.002, 0.01), scan, request);
  ASSERT_EQ(found.contacts.size(), 4u);
  EXPECT_LT(found.work.exact_decisions, 100u);
  EXPECT_LT(found.work.node_pairs, 100000u);
}

TEST(ContactManifold, RefusesWhatHasNoMeaning)
{
  const Thing ball({{0, 0, 0}}, {1.0f}), ground = floor();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  ManifoldRequest margin = within(-1), thickness = within(1), height = within(1), fit = within(1), same = within(1),
                  hasty = within(1);
  thickness.thickness = nan, height.height = -1, fit.fit = 0, same.same_within = nan;
  hasty.accuracy = Accuracy::tolerance(1);
  for (const ManifoldRequest& request : {margin, thickness, height, fit, same, hasty})
    EXPECT_THROW(manifoldOf(ball, at(0, 0, 1), ground, request), InvalidInput);
  Eigen::Isometry3d bad = Eigen::Isometry3d::Identity();
  bad.linear() *= 2;
  EXPECT_THROW(manifoldOf(ball, bad, ground, within(1)), InvalidInput);
}

TEST(ContactManifold, OfNothingIsEmpty)
{
  const Thing none(std::vector<Point3>{}), no_mesh((TestMesh())), ball({{0, 0, 0}}, {1.0f}), ground = floor();
  EXPECT_TRUE(manifoldOf(none, at(0, 0, 0), ground, within(1)).contacts.empty());
  EXPECT_TRUE(manifoldOf(ball, at(0, 0, 1), no_mesh, within(1)).contacts.empty());
  EXPECT_TRUE(manifoldOf(no_mesh, at(0, 0, 1), ground, within(1)).contacts.empty());
  EXPECT_TRUE(manifoldOf(ball, at(0, 0, 1), ground, within(1, 0)).contacts.empty());
}

} // namespace
} // namespace pcl_bsh

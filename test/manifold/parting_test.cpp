// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/manifold/parting.h>

#include "manifold_twin.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pcl_bsh {
namespace {

using test::Thing;

Eigen::Isometry3d lifted(double x, double y, double z)
{
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

Contact along(double x, double y, double z)
{
  Contact contact;
  contact.normal = Eigen::Vector3d(x, y, z).normalized();
  return contact;
}

TEST(Parting, OfABoxInAFloorIsItsDepthAlongTheNormal)
{
  const Thing box(test::boxMesh(1, 1, 1), true), ground(test::boxMesh(8, 8, 2), true);
  const Eigen::Isometry3d sunk = lifted(3, 3, 1.75);
  ManifoldRequest request;
  request.thickness = 0.0;
  const PlacedCollider a(*box.collider, sunk), b(*ground.collider);
  const Manifold found = contactManifold(a, b, request);
  ASSERT_FALSE(found.contacts.empty());
  const Interval way = partingOf(a, b, found.contacts.front(), 1e-6, 10);
  EXPECT_NEAR(way.lower, 0.25, 1e-6);
  EXPECT_LE(way.lower, 0.25);
  EXPECT_GT(way.upper, 0.25); // where they touch, they meet
  EXPECT_NEAR(way.upper, 0.25, 2e-6);
}

TEST(Parting, IsLongerAlongADirectionThatIsAslant)
{
  const Thing box(test::boxMesh(1, 1, 1), true), ground(test::boxMesh(8, 8, 2), true);
  const Interval way = partingOf({*box.collider, lifted(3, 3, 1.75)}, {*ground.collider}, along(0.6, 0, 0.8), 1e-6, 10);
  EXPECT_NEAR(way.upper, 0.3125, 2e-6);
  EXPECT_NEAR(way.lower, 0.3125, 2e-6);
  EXPECT_LE(way.lower, 0.3125);
}

/// No corner is inside: only what parts them is known.
TEST(Parting, OfBarsThatCrossIsKnownFromAbove)
{
  const Thing bar(test::boxMesh(6, 1, 1), true), other(test::boxMesh(1, 6, 1), true);
  const Interval way = partingOf({*bar.collider, lifted(-2.5, 2, 0.875)}, {*other.collider}, along(0, 0, 1), 1e-6, 10);
  EXPECT_LE(way.lower, 0.125);
  EXPECT_GT(way.upper, 0.125);
  EXPECT_NEAR(way.upper, 0.125, 2e-6);
}

TEST(Parting, OfPointsInATankIsKnown)
{
  const Thing dots({{1, 1, 0.5}, {3, 2, 0.25}}), tank(test::boxMesh(4, 4, 4), true);
  const Interval way = partingOf({*dots.collider}, {*tank.collider}, along(0, 0, -1), 1e-9, 10);
  EXPECT_NEAR(way.lower, 0.5, 1e-8);
  EXPECT_NEAR(way.upper, 0.5, 1e-8);
}

TEST(Parting, HasNoUpperEndWhereTheDirectionDoesNotPart)
{
  const Thing dot({{1, 1, 0.5}}), tank(test::boxMesh(4, 4, 4), true);
  const Interval way = partingOf({*dot.collider}, {*tank.collider}, along(0, 0, 1), 0.01, 2);
  EXPECT_TRUE(std::isinf(way.upper));
  EXPECT_GE(way.lower, 2.0);
}

TEST(Parting, RefusesWhatHasNoInside)
{
  const Thing dot({{1, 1, 0.5}}), open(test::boxMesh(4, 4, 4));
  EXPECT_THROW(partingOf({*dot.collider}, {*open.collider}, along(0, 0, 1), 0.01, 2), InvalidInput);
  const Thing tank(test::boxMesh(4, 4, 4), true);
  EXPECT_THROW(partingOf({*dot.collider}, {*tank.collider}, along(0, 0, 1), 0, 2), InvalidInput);
  EXPECT_THROW(partingOf({*dot.collider}, {*tank.collider}, along(0, 0, 1), 1, -1), InvalidInput);
}

} // namespace
} // namespace pcl_bsh

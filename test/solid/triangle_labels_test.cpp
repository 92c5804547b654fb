// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/labels.h>
#include <pcl_bsh/solid/triangle_labels.h>

#include "meshes.h"

#include <gtest/gtest.h>

namespace pcl_bsh {
namespace {

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

TEST(TriangleLabels, OfCorners)
{
  const test::ClosedMesh box = test::boxMesh();
  const Solid solid(box.view());
  test::ClosedMesh mesh;
  const std::uint32_t in = mesh.vertex(0.5, 0.5, 0.5), on = mesh.vertex(1, 0.5, 0.5), out = mesh.vertex(2, 0.5, 0.5),
                      up = mesh.vertex(2, 2, 2), nan = mesh.vertex(NAN, 0, 0);
  mesh.triangle(out, up, in);
  mesh.triangle(out, on, up);
  mesh.triangle(out, up, up);
  mesh.triangle(on, in, out);
  mesh.triangle(nan, in, in);
  EXPECT_EQ(labelTriangles(mesh.view(), identity, solid), (std::vector<std::uint8_t>{1, 2, 0, 1, 0}));
}

TEST(TriangleLabels, OfBodiesOfWhichOneHoldsTheOther)
{
  test::ClosedMesh bodies;
  bodies.add(test::boxMesh(), 1.0, {10, 0, 0});
  bodies.add(test::boxMesh(), 0.2, {0.4, 0.4, 0.4});
  const test::ClosedMesh tank = test::boxMesh();
  const Solid solid(tank.view());
  const std::vector<std::uint32_t> shells = firstOfShells(bodies.view());
  EXPECT_EQ(shells, (std::vector<std::uint32_t>{0, 12}));
  EXPECT_TRUE(holdsAny(solid, bodies.view(), shells, identity));
  EXPECT_FALSE(holdsAny(Solid(bodies.view()), tank.view(), firstOfShells(tank.view()), identity));
  Eigen::Isometry3d away = identity;
  away.translation().x() = 2.0;
  EXPECT_FALSE(holdsAny({solid, away}, bodies.view(), shells, identity));
  EXPECT_FALSE(holdsAny(solid, bodies.view(), {0}, identity));
}

/// A triangle that is nowhere joins no bodies, is the first of none, and is held by nothing.
TEST(TriangleLabels, OfBodiesWithTrianglesThatAreNotFinite)
{
  test::ClosedMesh bodies;
  const std::uint32_t nan = bodies.vertex(0.5, NAN, 0.5), inside = bodies.vertex(0.5, 0.5, 0.5);
  bodies.triangle(nan, inside, inside);
  bodies.add(test::boxMesh(), 1.0, {10, 0, 0});
  bodies.triangle(2, nan, 10);
  bodies.add(test::boxMesh(), 0.2, {0.4, 0.4, 0.4});
  const std::vector<std::uint32_t> shells = firstOfShells(bodies.view());
  EXPECT_EQ(shells, (std::vector<std::uint32_t>{1, 14}));
  const test::ClosedMesh tank = test::boxMesh();
  const Solid solid(tank.view());
  EXPECT_TRUE(holdsAny(solid, bodies.view(), shells, identity));
  EXPECT_FALSE(holdsAny(solid, bodies.view(), {0, 1, 13}, identity));
}

} // namespace
} // namespace pcl_bsh

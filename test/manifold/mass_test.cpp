// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/manifold/mass.h>

#include "support/made_meshes.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <vector>

namespace pcl_bsh {
namespace {

using test::TestMesh;

MassProperties massOfMesh(const TestMesh& mesh, double density = 1.0)
{
  return massOf(Solid(mesh.trianglesView()), density);
}

/// As far from the origin as it may be: sums of doubles lose all digits there.
TEST(Mass, OfABoxIsExactWhereverItIs)
{
  for (const double far : {0.0, 1.0, 0x1p20, 0x1p40}) {
    TestMesh box = test::boxMesh(2, 3, 4);
    box.move(Eigen::Isometry3d(Eigen::Translation3d(far, -far, 0.5 * far)));
    const MassProperties of = massOfMesh(box, 2.0);
    EXPECT_EQ(of.mass, 48.0);
    EXPECT_EQ(of.center, Eigen::Vector3d(far + 1, -far + 1.5, 0.5 * far + 2));
    const Eigen::Matrix3d expected = Eigen::Vector3d(4 * (9 + 16), 4 * (4 + 16), 4 * (4 + 9)).asDiagonal();
    EXPECT_EQ(of.inertia, expected) << far;
  }
}

TEST(Mass, IsTheSameForTrianglesThatAreTurnedInward)
{
  TestMesh box = test::boxMesh(2, 3, 4);
  const MassProperties before = massOfMesh(box);
  for (Triangle& t : box.triangles) std::swap(t[0], t[1]);
  const MassProperties now = massOfMesh(box);
  EXPECT_EQ(now.mass, before.mass);
  EXPECT_EQ(now.center, before.center);
  EXPECT_EQ(now.inertia, before.inertia);
}

/// A corner of a cube has products of inertia.
TEST(Mass, OfATetrahedronIsThatOfItsFormula)
{
  TestMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const MassProperties of = massOfMesh(mesh);
  EXPECT_EQ(of.mass, 1.0 / 6.0);
  EXPECT_EQ(of.center, Eigen::Vector3d::Constant(0.25));
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) EXPECT_EQ(of.inertia(k, l), k == l ? 1.0 / 80.0 : 1.0 / 480.0) << k << l;
}

TEST(Mass, OfABallMadeOfTrianglesIsNearlyThatOfABall)
{
  // Its seam has coordinates that differ by roundings: it is nearly closed.
  EXPECT_THROW(massOfMesh(test::sphereMesh(1.0, 64)), InvalidInput);
  const MassProperties of = massOfMesh(test::fanMesh(2000, 1.0, 1.0, true)); // two cones
  EXPECT_NEAR(of.mass, 2.0 * std::numbers::pi / 3.0, 1e-5);
  EXPECT_NEAR(of.inertia(2, 2), 0.3 * of.mass, 1e-5);
}

TEST(Mass, OfBallsIsTheirSum)
{
  const std::vector<double> places = {0, 0, 0, 4, 0, 0};
  const std::vector<float> radii = {1.0f, 1.0f};
  PointsView balls = viewOf(places.data(), 2);
  balls.radii = radii.data();
  const MassProperties of = massOf(balls);
  const double ball = 4.0 * std::numbers::pi / 3.0;
  EXPECT_DOUBLE_EQ(of.mass, 2.0 * ball);
  EXPECT_EQ(of.center, Eigen::Vector3d(2, 0, 0));
  EXPECT_DOUBLE_EQ(of.inertia(0, 0), 2 * ball * 0.4);
  EXPECT_DOUBLE_EQ(of.inertia(1, 1), 2 * ball * 4.4);
  EXPECT_EQ(of.withMass(1.0).mass, 1.0);
  EXPECT_DOUBLE_EQ(of.withMass(1.0).inertia(1, 1), 4.4);
}

TEST(Mass, RefusesWhatHasNone)
{
  TestMesh open = test::boxMesh(1, 1, 1);
  open.triangles.pop_back();
  EXPECT_NE(test::refusalOf([&] { massOfMesh(open); }).find("3 edges are open"), std::string::npos);
  TestMesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  flat.triangles = {{0, 1, 2}, {0, 2, 1}};
  EXPECT_NE(test::refusalOf([&] { massOfMesh(flat); }).find("volume is 0"), std::string::npos);
  for (const double density : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(massOfMesh(test::boxMesh(1, 1, 1), density), InvalidInput);
  const std::vector<float> place = {0, 0, 0};
  EXPECT_THROW(massOf(viewOf(place.data(), 1)), InvalidInput);
}

} // namespace
} // namespace pcl_bsh

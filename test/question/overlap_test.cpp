// SPDX-License-Identifier: BSD-3-Clause
// Areas of surfaces in solids, against closed forms and against triangles clipped by planes.
#include <pcl_bsh/question/overlap.h>

#include "support/made_meshes.h"
#include "support/random.h"

#include <pcl_bsh/base/invalid_input.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using test::TestMesh;

/// From -x to x, -y to y and -z to z, moved.
TestMesh box(double x, double y, double z, const Eigen::Isometry3d& at = Eigen::Isometry3d::Identity())
{
  TestMesh mesh = test::boxMesh(2 * x, 2 * y, 2 * z);
  Eigen::AlignedBox3d bounds;
  for (const Point3& p : mesh.vertices) bounds.extend(Eigen::Vector3d(p.data()));
  mesh.move(at * Eigen::Translation3d(-bounds.center()));
  return mesh;
}

Interval areaOf(const TestMesh& surface, const TestMesh& solid, const Question& question = {})
{
  Shape one("surface", viewOf(surface.trianglesView())), other("solid", viewOf(solid.trianglesView()));
  return areaWithin(question, one, other);
}

void expectHolds(const Interval& area, double expected, double rounding = 0.0)
{
  EXPECT_LE(area.lower, expected + rounding);
  EXPECT_GE(area.upper, expected - rounding);
  EXPECT_LE(area.upper - area.lower, 0x1p-8 * area.upper + 1e-12);
}

Eigen::Isometry3d turned(double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& to = {0, 0, 0})
{
  return Eigen::Translation3d(to) * Eigen::Isometry3d(Eigen::AngleAxisd(angle, axis.normalized()));
}

Eigen::Isometry3d moved(double x, double y, double z)
{
  return turned(0.0, Eigen::Vector3d::UnitX(), {x, y, z});
}

TEST(Overlap, OfBoxesIsThatOfTheirFaces)
{
  const TestMesh crate = box(0.5, 0.5, 0.5);
  expectHolds(areaOf(crate, box(2, 2, 1, moved(0, 0, 1.25))), 1.0 + 4 * 0.25);
  expectHolds(areaOf(crate, box(2, 2, 1, moved(0, 0, 1.2))), 1.0 + 4 * 0.3);
  expectHolds(areaOf(crate, box(1, 1, 1, moved(1.1, 1.2, 1.3))), 0.4 * 0.3 + 0.4 * 0.2 + 0.3 * 0.2);
  expectHolds(areaOf(crate, box(0.25, 0.25, 1)), 2 * 0.25); // a pillar through it
}

TEST(Overlap, OfWhatIsWholeOnOneSideIsExact)
{
  const TestMesh crate = box(0.5, 0.5, 0.5);
  const Interval inside = areaOf(crate, box(2, 2, 2)), outside = areaOf(crate, box(1, 1, 1, moved(3, 0, 0)));
  EXPECT_NEAR(inside.lower, 6.0, 1e-13);
  EXPECT_NEAR(inside.upper, 6.0, 1e-13);
  EXPECT_LE(inside.lower, 6.0);
  EXPECT_GE(inside.upper, 6.0);
  EXPECT_EQ(outside.lower, 0.0);
  EXPECT_EQ(outside.upper, 0.0);
  EXPECT_EQ(areaOf(box(2, 2, 2), crate).upper, 0.0) << "the crate encloses nothing of what is about it";
}

/// A plane through the middle has half of the surface on either side, however the box is turned.
TEST(Overlap, OfTurnedBoxesIsHalfOfThem)
{
  test::Random random(3);
  for (int i = 0; i < 5; ++i) {
    expectHolds(areaOf(box(0.5, 0.75, 0.25, random.pose(0.0)), box(4, 4, 4, moved(0, 0, 4))), 2.75, 1e-9);
  }
}

/// Poses that place both into a country's grid, and corners that have its coordinates.
TEST(Overlap, IsTheSameInUtmCoordinates)
{
  const Eigen::Isometry3d far = moved(412004.5, 5653210.25, 98.125);
  const Eigen::Isometry3d turn = turned(0.7, {1, 2, 3});
  Question question;
  question.pose_of_input = far * turn;
  question.pose = far * turn * moved(0, 0, 1.25);
  expectHolds(areaOf(box(0.5, 0.5, 0.5), box(2, 2, 1), question), 1.0 + 4 * 0.25, 1e-8);
  expectHolds(areaOf(box(0.5, 0.5, 0.5, far), box(2, 2, 1, far * moved(0, 0, 1.25))), 2.0, 1e-8);
}

/// Inside a shell that points inwards the surface winds round nothing; where two boxes overlap, it winds twice.
TEST(Overlap, CountsPlacesByTheirWindingNumber)
{
  TestMesh shell = box(2, 2, 2), twice = box(2, 2, 2);
  const TestMesh inner = box(1, 1, 1);
  for (std::array<std::uint32_t, 3> triangle : inner.triangles) {
    const auto first = static_cast<std::uint32_t>(8);
    const Triangle of_two = {triangle[0] + first, triangle[1] + first, triangle[2] + first};
    shell.triangles.push_back({of_two[1], of_two[0], of_two[2]});
    twice.triangles.push_back(of_two);
  }
  ASSERT_EQ(shell.vertices.size(), 8U);
  for (TestMesh* const mesh : {&shell, &twice})
    mesh->vertices.insert(mesh->vertices.end(), inner.vertices.begin(), inner.vertices.end());
  EXPECT_EQ(areaOf(box(0.5, 0.5, 0.5), shell).upper, 0.0);
  EXPECT_NEAR(areaOf(box(0.5, 0.5, 0.5), twice).lower, 6.0, 1e-12);
  expectHolds(areaOf(box(0.5, 0.5, 1.5), shell), 2 * 1.0 + 8 * 0.5);
}

TEST(Overlap, OfASurfaceInTheSurfaceStaysOpen)
{
  const Interval area = areaOf(box(0.5, 0.5, 0.5), box(2, 2, 1, moved(0, 0, -1.5)));
  EXPECT_EQ(area.lower, 0.0) << "it stands on the other";
  EXPECT_GE(area.upper, 1.0);
  EXPECT_LE(area.upper, 1.1);
}

/// The corner of a crate stands on the other's face: halving ends.
TEST(Overlap, OfACornerThatTouchesIsNothing)
{
  TestMesh crate = test::boxMesh(1, 1, 1);
  for (Point3& p : crate.vertices) p[2] += p[0] + p[1]; // a parallelepiped on its corner
  const Interval area = areaOf(crate, box(4, 4, 4, moved(0, 0, -4)));
  EXPECT_EQ(area.lower, 0.0);
  EXPECT_LE(area.upper, 1e-9);
}

/// Its parts on the inner side of six planes.
double clippedArea(const Triangle3& triangle, const Eigen::Isometry3d& into_box, const Eigen::Vector3d& half)
{
  std::vector<Eigen::Vector3d> polygon;
  for (const Point3& p : triangle) polygon.push_back(into_box * Eigen::Vector3d(p.data()));
  for (int k = 0; k < 3; ++k) {
    for (const double side : {-1.0, 1.0}) {
      const std::vector<Eigen::Vector3d> whole = std::move(polygon);
      polygon.clear();
      for (std::size_t i = 0; i < whole.size(); ++i) {
        const Eigen::Vector3d &p = whole[i], &q = whole[(i + 1) % whole.size()];
        const double beyond_p = side * p[k] - half[k], beyond_q = side * q[k] - half[k];
        if (beyond_p <= 0) polygon.push_back(p);
        if ((beyond_p < 0) != (beyond_q < 0)) polygon.push_back(p + beyond_p / (beyond_p - beyond_q) * (q - p));
      }
    }
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i)
    sum += 0.5 * (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  return sum.norm();
}

TEST(Overlap, IsThatOfClippedTriangles)
{
  test::Random random(17);
  for (int i = 0; i < 8; ++i) {
    const TestMesh surface = test::soup(static_cast<std::uint64_t>(i), 40, 1.0, 0.7);
    const Eigen::Vector3d half(0.6, 0.4, 0.9);
    Question question;
    question.pose_of_input = random.pose(0.3);
    question.pose = random.pose(0.3);
    const Eigen::Isometry3d into_box = question.pose.inverse() * question.pose_of_input;
    double expected = 0.0;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
      expected += clippedArea(surface.trianglesView().triangle(t), into_box, half);
    expectHolds(areaOf(surface, box(half.x(), half.y(), half.z()), question), expected, 1e-9);
    EXPECT_GT(expected, 0.0);
  }
}

TEST(Overlap, RefusesWhatDoesNotClose)
{
  TestMesh open = box(1, 1, 1);
  open.triangles.pop_back();
  EXPECT_THROW(areaOf(box(0.5, 0.5, 0.5), open), InvalidInput);
}

} // namespace
} // namespace pcl_bsh

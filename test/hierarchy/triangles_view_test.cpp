// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/triangles_view.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/hierarchy/points_checksum.h>
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using Corners = std::vector<std::uint32_t>;

template <class Coordinate>
TrianglesView trianglesOf(const std::vector<Coordinate>& xyz, const Corners& corners)
{
  TrianglesView view;
  view.vertices = viewOf(xyz.data(), xyz.size() / 3);
  view.corners = corners.data();
  view.count = corners.size() / 3;
  return view;
}

/// Whether the ball of each triangle holds its corners, in exact arithmetic.
void expectHeld(const PointsView& balls)
{
  const ExactDistance distance(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity());
  for (std::uint32_t i = 0; i < balls.count; ++i)
    for (const Point3& corner : balls.triangles->triangle(i))
      EXPECT_LE(distance.compare(balls.point(i), corner, balls.radius(i)), 0) << "triangle " << i;
}

/// Soups whose triangles are of many sizes and shapes, needles, segments and points among them.
template <class Coordinate>
std::vector<Coordinate> soup(std::size_t triangles, double scale, double offset)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Coordinate> xyz;
  for (std::size_t i = 0; i < triangles; ++i) {
    const double size = scale * std::pow(10.0, 3.0 * unit(random));
    const double thin = i % 3 == 0 ? 1e-5 : i % 7 == 0 ? 0.0 : 1.0;
    double at[3], along[3];
    for (std::size_t k = 0; k < 3; ++k) at[k] = offset + 10.0 * scale * unit(random), along[k] = size * unit(random);
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (std::size_t k = 0; k < 3; ++k)
        xyz.push_back(
            static_cast<Coordinate>(at[k] + static_cast<double>(corner) * along[k] + thin * size * unit(random)));
  }
  return xyz;
}

Corners inTurn(std::size_t vertices)
{
  Corners corners(vertices);
  for (std::size_t i = 0; i < vertices; ++i) corners[i] = static_cast<std::uint32_t>(i);
  return corners;
}

TEST(TrianglesView, BallsHoldTheirTriangles)
{
  for (const double offset : {0.0, 4.5e5}) {
    const std::vector<float> single = soup<float>(3000, 1.0, offset);
    expectHeld(viewOf(trianglesOf(single, inTurn(single.size() / 3))));
    const std::vector<double> twofold = soup<double>(3000, 1.0, offset);
    expectHeld(viewOf(trianglesOf(twofold, inTurn(twofold.size() / 3))));
  }
  const std::vector<double> small = soup<double>(500, 1e-200, 0.0), large = soup<double>(500, 1e32, 0.0);
  expectHeld(viewOf(trianglesOf(small, inTurn(small.size() / 3))));
  expectHeld(viewOf(trianglesOf(large, inTurn(large.size() / 3))));
}

/// Eight are found at once, and the last ones by themselves.
TEST(TrianglesView, BallsAreTheSameByThemselves)
{
  const auto expectSame = [](const auto& xyz) {
    const PointsView all = viewOf(trianglesOf(xyz, inTurn(xyz.size() / 3)));
    for (std::uint32_t i = 0; i < all.count; ++i) {
      const Corners corners = {3 * i, 3 * i + 1, 3 * i + 2};
      const PointsView one = viewOf(trianglesOf(xyz, corners));
      ASSERT_EQ(one.radii[0], all.radii[i]) << "triangle " << i;
      if (isFinite(one.point(0)))
        ASSERT_EQ(one.point(0), all.point(i)) << "triangle " << i;
      else
        ASSERT_FALSE(isFinite(all.point(i))) << "triangle " << i;
    }
  };
  expectSame(soup<float>(2001, 1.0, 4.5e5));
  expectSame(soup<double>(2001, 1.0, 4.5e5));
  expectSame(soup<double>(501, 1e-200, 0.0));
  expectSame(soup<double>(501, 1e32, 0.0));
  std::vector<float> some = soup<float>(40, 1.0, 0.0);
  some[9 * 5 + 4] = std::numeric_limits<float>::quiet_NaN();
  some[9 * 17] = std::numeric_limits<float>::infinity();
  for (std::size_t k = 0; k < 9; ++k) some[9 * 20 + k] = 1e-40f * static_cast<float>(k);
  expectSame(some);
}

TEST(TrianglesView, SlabsHoldTheirTriangles)
{
  for (const double offset : {0.0, 4.5e5}) {
    const std::vector<double> xyz = soup<double>(3000, 1.0, offset);
    const Corners corners = inTurn(xyz.size() / 3);
    const SphereHierarchy cloud(viewOf(trianglesOf(xyz, corners)));
    cloud.buildAll(1);
    const SphereHierarchy::Storage& storage = cloud.storage();
    BuildWork work;
    for (std::size_t v = 0; v < storage.voxel_count; ++v) {
      Voxel& voxel = storage.voxels[v];
      voxel.slabs.of(voxel, storage.view, work);
      voxel.cross_slabs.of(voxel, storage.view, work);
    }
    const HierarchyDefects defects = cloud.validate();
    EXPECT_TRUE(defects.none()) << defects.lines.front();
  }
}

TEST(TrianglesView, BallsAreTheSmallest)
{
  // Equilateral, right, obtuse, a segment, a point: the radius is that of the circumcircle, or half the longest side.
  const std::vector<double> xyz = {0, 0, 0, 2, 0, 0, 1, std::sqrt(3.0),
                                   0, 0, 0, 0, 4, 0, 0, 0,
                                   3, 0, 0, 0, 0, 6, 0, 0,
                                   2, 1, 0, 0, 0, 0, 8, 0,
                                   0, 5, 0, 0, 7, 7, 7, 7,
                                   7, 7, 7, 7, 7};
  const Corners corners = inTurn(15);
  const PointsView balls = viewOf(trianglesOf(xyz, corners));
  const double expected[5] = {2 / std::sqrt(3.0), 2.5, 3.0, 4.0, 0.0};
  for (std::uint32_t i = 0; i < 5; ++i) EXPECT_NEAR(balls.radius(i), expected[i], 1e-6) << i;
  expectHeld(balls);
}

TEST(TrianglesView, ReadsCornersInPlace)
{
  const std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const Corners corners = {9, 0, 1, 2, 9, 1, 2, 3}; // four numbers each, the first of another meaning
  TrianglesView view = trianglesOf(xyz, corners);
  view.corners = corners.data() + 1;
  view.count = 2;
  view.stride = 4 * sizeof(std::uint32_t);
  EXPECT_EQ(view.cornersOf(1), (std::array<std::uint32_t, 3>{1, 2, 3}));
  EXPECT_EQ(view.triangle(1)[2], (Point3{0, 0, 1}));
}

TEST(TrianglesView, LeavesOutWhatIsNotFinite)
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, nan, 1};
  const Corners corners = {0, 1, 2, 1, 2, 3};
  const SphereHierarchy hierarchy(viewOf(trianglesOf(xyz, corners)));
  EXPECT_EQ(hierarchy.size(), 1u);
  EXPECT_TRUE(hierarchy.validate().none());
}

TEST(TrianglesView, LivesAsLongAsTheHierarchy)
{
  const std::vector<float> xyz = soup<float>(5000, 1.0, 0.0);
  const Corners corners = inTurn(xyz.size() / 3);
  const SphereHierarchy hierarchy = [&] { return SphereHierarchy(viewOf(trianglesOf(xyz, corners))); }();
  EXPECT_EQ(hierarchy.view().triangles->count, 5000u);
  const HierarchyDefects defects = hierarchy.validate();
  EXPECT_TRUE(defects.none()) << defects.lines.front();
}

TEST(TrianglesView, RefusesWhatCannotBeRead)
{
  const std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const Corners corners = {0, 1, 3};
  const auto messageOf = [](const TrianglesView& view) -> std::string {
    try {
      viewOf(view);
    }
    catch (const InvalidInput& error) {
      return error.input() == Input::surface ? error.what() : "another input";
    }
    return "taken";
  };
  TrianglesView view = trianglesOf(xyz, corners);
  EXPECT_EQ(messageOf(view), "triangles: triangle 0 names vertex 3 of 3");
  view.corners = nullptr;
  EXPECT_EQ(messageOf(view), "triangles: corners are null, of 1 triangle");
  const Corners two = {0, 1, 2, 2, 1, 0};
  view = trianglesOf(xyz, two);
  view.stride = 8;
  EXPECT_EQ(messageOf(view), "triangles: a stride of 8 bytes puts triangles over each other: give the bytes from one "
                             "triangle's corners to the next one's");
  view = trianglesOf(xyz, two);
  const float radius[3] = {0, 0, 0};
  view.vertices.radii = radius;
  EXPECT_NE(messageOf(view).find("give all of them, without"), std::string::npos);
  view = trianglesOf(xyz, two);
  view.vertices.uncertainties = radius;
  EXPECT_NE(messageOf(view).find("give all of them, without"), std::string::npos);
  view = trianglesOf(xyz, two);
  const std::int32_t all[3] = {0, 1, 2};
  view.vertices.indices = all;
  view.vertices.index_count = 3;
  EXPECT_NE(messageOf(view).find("give all of them, without"), std::string::npos);
  view = trianglesOf(xyz, two);
  view.corners = nullptr; // none of these is looked at
  view.count = std::size_t{1} << 31;
  EXPECT_EQ(messageOf(view), "triangles: 2147483648 triangles are more than an index can name");
  --view.count;
  EXPECT_EQ(messageOf(view), "triangles: corners are null, of 2147483647 triangles");
  for (const double size : {1e300, 1.7e308}) { // sides of the second are beyond all doubles
    const std::vector<double> huge = {-size, 0, 0, -size, 0, 0, size, 0, 0};
    EXPECT_NE(messageOf(trianglesOf(huge, two)).find("triangle 0 is too large for a float32 radius"),
              std::string::npos);
  }
}

TEST(TrianglesView, OfAListIsKeptAlive)
{
  PointsView view;
  std::weak_ptr<const void> vertices_left, list_left;
  {
    const auto vertices = std::make_shared<const std::vector<double>>(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 2, 0});
    const auto list = std::make_shared<const std::vector<Triangle>>(std::vector<Triangle>{{0, 1, 2}});
    PointsView corners = viewOf(vertices->data(), 3);
    corners.owner = vertices;
    view = viewOf(pcl_bsh::trianglesOf(corners, list));
    vertices_left = vertices;
    list_left = list;
  }
  EXPECT_FALSE(vertices_left.expired() || list_left.expired());
  EXPECT_EQ(view.triangles->triangle(0)[2], (Point3{0, 2, 0}));
  view = PointsView();
  EXPECT_TRUE(vertices_left.expired() && list_left.expired());
}

TEST(TrianglesView, CountsVerticesThatNoTriangleHas)
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5, nan, 0, 0, 6, 6, 6};
  const Corners one = {0, 1, 2}, two = {0, 1, 2, 3, 3, 5};
  EXPECT_EQ(looseVertices(trianglesOf(xyz, one)), 2u) << "but for the one that is no place";
  EXPECT_EQ(looseVertices(trianglesOf(xyz, two)), 0u);
  EXPECT_EQ(looseVertices(TrianglesView()), 0u);
}

TEST(TrianglesView, MiddlesArePointsOnTheTriangles)
{
  const std::vector<double> xyz = {0, 0, 0, 4, 0, 0, 1, 1, 0};
  const Corners corners = {0, 1, 2, 1, 1, 1};
  const PointsView view = viewOf(trianglesOf(xyz, corners)), middles = middlesOf(view);
  EXPECT_EQ(middles.triangles, nullptr);
  EXPECT_EQ(middles.radii, nullptr);
  EXPECT_EQ(middles.count, 2u);
  EXPECT_EQ(middles.point(0), (Point3{2, 0, 0})) << "of the longest side";
  EXPECT_EQ(middles.point(1), (Point3{4, 0, 0}));
}

/// A vertex that moves and a corner that is another vertex change it, bytes that no triangle reads do not.
TEST(TrianglesView, HasAChecksum)
{
  std::vector<float> xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5};
  Corners corners = {0, 1, 2};
  const PointsView view = viewOf(trianglesOf(xyz, corners));
  const std::uint64_t before = checksumOf(view);
  xyz[1] = 0.5f;
  EXPECT_NE(checksumOf(view), before);
  xyz[1] = 0.0f;
  EXPECT_EQ(checksumOf(view), before);
  std::swap(corners[0], corners[1]);
  EXPECT_NE(checksumOf(view), before);
}

/// So that their trees are as fine as the vertices, and cost no more memory.
TEST(TrianglesView, BallsHaveTheTypeOfTheVertices)
{
  const std::vector<float> single = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::vector<double> twofold(single.begin(), single.end());
  const Corners corners = {0, 1, 2};
  const PointsView of_floats = viewOf(trianglesOf(single, corners)), of_doubles = viewOf(trianglesOf(twofold, corners));
  EXPECT_EQ(of_floats.scalar, Scalar::float32);
  EXPECT_EQ(of_floats.stride, 3 * sizeof(float));
  EXPECT_EQ(of_doubles.scalar, Scalar::float64);
  EXPECT_EQ(of_doubles.stride, 3 * sizeof(double));
  EXPECT_LT(of_doubles.off_middle, 1e-7 * of_floats.off_middle);
}

} // namespace
} // namespace pcl_bsh

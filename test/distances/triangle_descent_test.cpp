// SPDX-License-Identifier: BSD-3-Clause
// Triangles that look for what is nearest to them, each by itself: against brute force, and how much they look at.
#include "expect_distances.h"

#include "support/made_meshes.h"
#include "support/meshes.h"
#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Balls where asked for.
Cloud anyScan(std::size_t count, double scale, bool balls, Random& random)
{
  std::vector<Point3> points(count);
  for (Point3& p : points) p = random.point([&] { return scale * random.uniform(-1.5, 1.5); });
  Cloud cloud(points);
  std::vector<float> radii(balls ? count : 0);
  for (float& radius : radii) radius = static_cast<float>(scale * random.uniform(0, 0.2));
  if (balls) cloud.setRadii(radii);
  return cloud;
}

/// A mesh whose triangles are there twice, with other corners first: of equals the smaller record counts.
Cloud doubledMesh(std::size_t count, double scale, Random& random)
{
  test::Mesh mesh = test::makeMesh(random.pick({test::MeshKind::soup, test::MeshKind::needles, test::MeshKind::fan}),
                                   count / 2 + 1, scale, random);
  for (std::size_t i = mesh.corners.size() / 3; i-- > 0;)
    for (const std::size_t k : {1u, 2u, 0u}) mesh.corners.push_back(mesh.corners[3 * i + k]);
  Cloud cloud(mesh.vertices);
  cloud.setTriangles(std::move(mesh.corners));
  return cloud;
}

/// Places on the triangles of a mesh within a billionth, which floats cannot tell apart; or small triangles there.
Cloud touching(const Cloud& mesh, std::size_t count, double scale, bool triangles, Random& random)
{
  const PointsView view = mesh.view();
  std::vector<Point3> places;
  for (std::size_t i = 0; i < count; ++i) {
    const auto record = static_cast<std::uint32_t>(random.integer(0, static_cast<int>(view.count) - 1));
    const Triangle3 corners = view.triangles->triangle(record);
    const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
    const auto beside = [&](double reach) {
      Point3 p;
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = corners[0][k] + u * (corners[1][k] - corners[0][k]) + v * (corners[2][k] - corners[0][k]) +
               reach * scale * random.uniform(-1, 1);
      return p;
    };
    for (const double reach : {1e-9, 0.05, 0.05})
      if (triangles || reach < 0.05) places.push_back(beside(reach));
  }
  Cloud cloud(places);
  if (triangles) {
    std::vector<std::uint32_t> corners(places.size());
    std::iota(corners.begin(), corners.end(), 0u);
    cloud.setTriangles(std::move(corners));
  }
  return cloud;
}

/// The cloud to which the triangles are measured.
enum class Other { points, balls, mesh, doubled_mesh, touching_points, touching_mesh };

Cloud makeOther(Other kind, std::size_t count, double scale, const Cloud& mesh, Random& random)
{
  switch (kind) {
  case Other::points:
  case Other::balls:
    return anyScan(count, scale, kind == Other::balls, random);
  case Other::mesh:
    return test::anyMesh(count / 4 + 1, scale, {}, random);
  case Other::doubled_mesh:
    return doubledMesh(count / 4, scale, random);
  case Other::touching_points:
  case Other::touching_mesh:
    break;
  }
  return touching(mesh, count / 4 + 1, scale, kind == Other::touching_mesh, random);
}

TEST(TriangleDescent, FindsWhatBruteForceFinds)
{
  constexpr Other kinds[] = {Other::points,       Other::balls,           Other::mesh,
                             Other::doubled_mesh, Other::touching_points, Other::touching_mesh};
  for (std::uint64_t seed = 0; seed < 180; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Other kind = kinds[seed % std::size(kinds)];
    const double scale = random.pick({1.0, 1.0, 1e3, 0x1p-70, 0x1p70});
    const bool touches = kind == Other::touching_points || kind == Other::touching_mesh;
    const Point3 offset = !touches && random.chance(0.3) ? Point3{5e5 * scale, -3e5 * scale, 7 * scale} : Point3{};
    const Cloud mesh = test::anyMesh(static_cast<std::size_t>(random.integer(1, 120)), scale, offset, random);
    const Cloud other = makeOther(kind, static_cast<std::size_t>(random.integer(1, 400)), scale, mesh, random);
    HierarchyOptions options;
    if (random.chance(0.5)) options.voxel_edge = scale * random.pick({0.3, 100.0});
    const SphereHierarchy ha(mesh.view(), options), hb(other.view(), options);
    Eigen::Isometry3d there(Eigen::Translation3d(-offset[0], -offset[1], -offset[2]));
    if (random.chance(0.5)) there = random.pose(0.0) * there;
    there.pretranslate(scale * random.pick({0.0, 0.0, 1.0, 30.0}) * random.rotation().toRotationMatrix().col(0));
    if (touches) there = random.chance(0.5) ? Eigen::Isometry3d::Identity() : random.pose(scale);
    const Eigen::Isometry3d here = random.chance(0.5) ? Eigen::Isometry3d::Identity() : random.pose(scale);
    const Placed a(ha, there), b(hb, touches ? there : here);
    for (const double max : {kInfinity, scale}) {
      PointDistancesRequest request;
      request.max_distance = max;
      test::expectSame(pointDistances(a, b, request), brute_force::pointDistances(a, b, request));
      if (testing::Test::HasFailure()) return;
    }
    const HausdorffDistance greatest = hausdorffDistance(a, b);
    const SymmetricDistances both = symmetricDistances(a, b);
    EXPECT_TRUE(greatest.distance == both.hausdorff || (std::isnan(greatest.distance) && std::isnan(both.hausdorff)));
  }
}

/// Within budgets, what is certain holds what brute force finds, and what is measured is it.
TEST(TriangleDescent, KeepsWhatIsCertainWithinBudgets)
{
  int measured = 0, left = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed + 1000);
    const Cloud mesh = test::anyMesh(60, 1.0, {}, random);
    const Cloud other = seed % 2 == 0 ? anyScan(600, 1.0, false, random) : test::anyMesh(100, 1.0, {}, random);
    const SphereHierarchy ha(mesh.view()), hb(other.view());
    const Placed a(ha, random.pose(0.5)), b(hb);
    const PointDistances truth = brute_force::pointDistances(a, b);
    PointDistancesRequest request;
    request.accuracy = random.pick({Accuracy::level(2), Accuracy::nodePairs(300), Accuracy::nodePairs(3000)});
    const PointDistances found = pointDistances(a, b, request);
    for (std::size_t i = 0; i < truth.distance.size(); ++i) {
      if (std::isnan(truth.distance[i])) continue;
      EXPECT_LE(found.interval[i].lower, truth.distance[i]) << i;
      EXPECT_GE(found.interval[i].upper, truth.distance[i]) << i;
      const bool is_measured = found.closest_point[i] != kNothing;
      ++(is_measured ? measured : left);
      if (is_measured) {
        EXPECT_EQ(found.distance[i], truth.distance[i]) << i;
      }
    }
  }
  EXPECT_GT(measured, 500);
  EXPECT_GT(left, 500);
}

/// A needle's ball holds most of the scan. By balls, each of 1,000 needles of a fan met 200 leaves in a scan of 4,000
/// points, and every point of these.
TEST(TriangleDescent, ComparesNeedlesWithWhatIsNearThemAlone)
{
  const test::TestMesh fan = test::fanMesh(1000, 1.0, 0.0, false);
  Random random(7);
  std::vector<Point3> points(4000);
  for (Point3& p : points) p = {random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2), random.uniform(-0.2, 0.2)};
  const Cloud scan(points);
  const SphereHierarchy triangles(viewOf(fan.trianglesView())), cloud(scan.view());
  const Work work = pointDistances({triangles}, {cloud}).work;
  EXPECT_LT(work.leaf_pairs, 25u * 1000u);
  EXPECT_LT(work.exact_decisions, 10u * 1000u);
}

} // namespace
} // namespace pcl_bsh

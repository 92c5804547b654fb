// SPDX-License-Identifier: BSD-3-Clause
// Distances of surfaces that face each other from far away: all of one is about as far from each triangle of the other.
#include "expect_distances.h"

#include "support/made_meshes.h"
#include "support/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;
using test::TestMesh;

TestMesh sheet(std::uint32_t cells, double size, double height, double phase)
{
  return test::gridMesh(cells, cells, [&](double u, double v) -> Point3 {
    return {size * (u - 0.5), size * (v - 0.5), height * size * std::sin(7 * u + phase) * std::cos(5 * v)};
  });
}

PointDistancesRequest within(double max)
{
  PointDistancesRequest request;
  request.max_distance = max;
  return request;
}

TEST(PointDistances, OfSurfacesThatFaceEachOther)
{
  for (std::uint64_t seed = 0; seed < 80; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const auto any = [&] {
      return sheet(static_cast<std::uint32_t>(random.integer(2, 9)), random.pick({0.125, 1.0, 1.0, 16.0, 0x1p-45}),
                   random.pick({0.0, 0.0, 1e-7, 1e-3, 0.1}), random.uniform(0, 6));
    };
    const TestMesh first = any(), second = any();
    HierarchyOptions options;
    if (random.chance(0.5)) options.voxel_edge = random.pick({0.3, 4.0, 100.0});
    const std::vector<float> radii(random.chance(0.5) ? second.vertices.size() : 0, 0.1f);
    const auto hierarchyOf = [&](const TestMesh& mesh, bool is_mesh, const std::vector<float>& balls) {
      if (is_mesh) return SphereHierarchy(viewOf(mesh.trianglesView()), options);
      PointsView view = mesh.view();
      if (!balls.empty()) view.radii = balls.data();
      return SphereHierarchy(view, options);
    };
    const SphereHierarchy ha = hierarchyOf(first, seed % 4 != 0, {}), hb = hierarchyOf(second, seed % 4 != 1, radii);
    const double apart = random.pick({0.1, 0.7, 1.5, 3.0, 20.0, 300.0});
    Eigen::Isometry3d facing(Eigen::Translation3d{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), apart});
    if (random.chance(0.5)) facing.rotate(Eigen::AngleAxisd(random.uniform(0, 6), Eigen::Vector3d::UnitZ()));
    if (random.chance(0.5)) facing.rotate(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
    if (random.chance(0.3)) facing.rotate(Eigen::AngleAxisd(random.uniform(0, 0.2), Eigen::Vector3d::UnitY()));
    const Eigen::Isometry3d world = random.chance(0.5) ? Eigen::Isometry3d::Identity() : random.pose(10);
    const Placed a(ha, world), b(hb, world * facing);
    for (const double max : {std::numeric_limits<double>::infinity(), apart}) {
      test::expectSame(pointDistances(a, b, within(max)), brute_force::pointDistances(a, b, within(max)));
      if (testing::Test::HasFailure()) return;
    }
  }
}

/// Four times the triangles: as many decisions for each, and leaves, where spheres leave four times as many.
TEST(PointDistances, TakeNoMoreWorkForEachTriangleOfFinerSheets)
{
  const auto workOf = [](std::uint32_t cells, bool of_points) {
    const TestMesh mesh = sheet(cells, 1.0, 0.0, 0.0);
    const SphereHierarchy a(viewOf(mesh.trianglesView()));
    const SphereHierarchy b = of_points ? SphereHierarchy(mesh.view()) : SphereHierarchy(viewOf(mesh.trianglesView()));
    const PointDistances found = pointDistances({a}, {b, Eigen::Isometry3d(Eigen::Translation3d(0.003, 0.002, 1.0))});
    EXPECT_EQ(found.measured, mesh.triangles.size());
    const auto work = static_cast<double>(found.work.exact_decisions + found.work.leaf_pairs);
    return work / static_cast<double>(mesh.triangles.size());
  };
  for (const bool of_points : {false, true}) {
    const double coarse = workOf(24, of_points), fine = workOf(48, of_points);
    EXPECT_LT(fine, 1.75 * coarse);
  }
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// Distances of points against brute force: random clouds of every shape and layout, poses, radii, limits, threads.
#include "../query/random_clouds.h"
#include "expect_distances.h"

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Scene;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

PointDistancesRequest within(double max_distance, unsigned threads = 1)
{
  PointDistancesRequest request;
  request.max_distance = max_distance;
  request.threads = threads;
  return request;
}

HierarchyOptions optionsFor(const Scene& scene, std::uint64_t seed)
{
  HierarchyOptions options;
  constexpr SphereFit fits[] = {SphereFit::box_center, SphereFit::ritter, SphereFit::minimal};
  options.fit = fits[seed % 3];
  if (seed % 2 == 0) options.voxel_edge = std::max(1e-3, 4 * scene.clearance);
  return options;
}

TEST(PointDistances, OfRandomClouds)
{
  for (std::uint64_t seed = 0; seed < 1500; ++seed) {
    const Scene scene = test::anyScene(seed, 300);
    SCOPED_TRACE(scene.name);
    const HierarchyOptions options = optionsFor(scene, seed);
    const SphereHierarchy ha(scene.a.view(), options), hb(scene.b.view(), options);
    const Placed a(ha, scene.pose_a), b(hb, scene.pose_b);
    for (const double max : {kInfinity, scene.clearance}) {
      test::expectSame(pointDistances(a, b, within(max)), brute_force::pointDistances(a, b, within(max)));
      if (testing::Test::HasFailure()) return;
    }
  }
}

} // namespace
} // namespace pcl_bsh

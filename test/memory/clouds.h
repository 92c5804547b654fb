// SPDX-License-Identifier: BSD-3-Clause
// Small clouds with everything that allocates: several voxels, crowded cells, one place many times over, radii.
#pragma once

#include <pcl_bsh/collide.h>

#include "support/random_clouds.h"

#include <memory>

namespace pcl_bsh::test {

/// Points within some [-1.5, 1.5]^3, about ten voxels of an edge of 1, some of them too crowded for floats.
inline Cloud richCloud(std::uint64_t seed, std::size_t count, bool radii = false)
{
  Random random(seed);
  std::vector<Point3> points = makePoints(Shape::uniform, count, 1.5, random);
  for (std::size_t i = 0; i < count / 6; ++i) points[i] = {0.25, 0.5, -0.75};
  for (std::size_t i = count / 6; i < count / 3; ++i)
    points[i] = random.point([&] { return 0.25 + 0x1p-24 * random.integer(0, 64); });
  Cloud cloud(points, Layout{Scalar::float64, 0, 0});
  if (radii) cloud.setRadii(std::vector<float>(count, 0.01f));
  return cloud;
}

inline HierarchyOptions fineOptions(SphereFit fit = SphereFit::box_center)
{
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  options.fit = fit;
  return options;
}

/// Two hierarchies that nobody has visited yet.
struct FreshPair {
  FreshPair(const Cloud& cloud_a, const Cloud& cloud_b, SphereFit fit = SphereFit::box_center)
  : a(cloud_a.view(), fineOptions(fit)),
    b(cloud_b.view(), fineOptions(fit))
  {
    T_world_b.translate(Eigen::Vector3d(0.4, 0.1, 0.2));
    T_world_b.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
  }

  Placed placedA() const { return {a}; }
  Placed placedB() const { return {b, T_world_b}; }

  SphereHierarchy a, b;
  Eigen::Isometry3d T_world_b = Eigen::Isometry3d::Identity();
};

} // namespace pcl_bsh::test

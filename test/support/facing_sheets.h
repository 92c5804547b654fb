// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "support/random_clouds.h"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace pcl_bsh::test {

/// Two bent sheets that face each other a fraction of their size apart: where spheres overlap and slabs decide.
struct FacingSheets {
  explicit FacingSheets(std::uint64_t seed, int count) : random(seed)
  {
    const bool bent = seed % 3 != 2, thick = seed % 3 == 1; // what is not bent has two thorns, point to point
    const double bend_x = bent ? random.uniform(-0.3, 0.3) : 0.0, bend_y = bent ? random.uniform(-0.3, 0.3) : 0.0;
    const double gap = std::exp2(random.uniform(-9, -2)), far = random.chance(0.3) ? 1e5 : 1.0;
    const double thickness = gap * (thick ? 0.45 : 0.02);
    const Eigen::Isometry3d place = random.pose(far), other = random.pose(random.chance(0.5) ? 1.0 : 1e3);
    std::vector<Point3> points_a, points_b;
    const auto put = [&](std::vector<Point3>& points, const Eigen::Isometry3d& pose, double height,
                         const std::array<double, 2>& at) {
      const auto [x, y] = at;
      const double z = bend_x * x * x + bend_y * y * y + height + thickness * random.uniform(-1, 1);
      const Eigen::Vector3d p = pose * Eigen::Vector3d(x, y, z);
      points.push_back({p.x(), p.y(), p.z()});
    };
    for (int i = 0; i < count; ++i) {
      put(points_a, Eigen::Isometry3d::Identity(), 0.0, {random.uniform(-1, 1), random.uniform(-1, 1)});
      put(points_b, other, gap, {random.uniform(-1, 1), random.uniform(-1, 1)});
    }
    if (!bent) {
      const double x = random.uniform(-0.9, 0.9), y = random.uniform(-0.9, 0.9);
      put(points_a, Eigen::Isometry3d::Identity(), 0.3 * gap, {x, y});
      put(points_b, other, 0.7 * gap, {x, y});
    }
    a.emplace(points_a, random.chance(0.5) ? Layout{Scalar::float32, 0, 0} : Layout{Scalar::float64, 0, 0});
    b.emplace(points_b, random.chance(0.5) ? Layout{Scalar::float32, 0, 0} : Layout{Scalar::float64, 0, 0});
    pose_a = place;
    pose_b = place * other.inverse();
  }

  Random random;
  std::optional<Cloud> a, b;
  Eigen::Isometry3d pose_a, pose_b;
};

} // namespace pcl_bsh::test

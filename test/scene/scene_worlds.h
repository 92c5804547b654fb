// SPDX-License-Identifier: BSD-3-Clause
// Clouds for scenes: what a test needs to build one without a word about memory.
#pragma once

#include <pcl_bsh/scene/scene.h>

#include "support/random_clouds.h"

#include <deque>
#include <memory>

namespace pcl_bsh::test {

inline Eigen::Isometry3d at(double x, double y, double z)
{
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

/// Keeps clouds alive as long as hierarchies look at them.
class Shelf {
public:
  std::shared_ptr<SphereHierarchy> add(const std::vector<Point3>& points)
  {
    clouds_.emplace_back(points, Layout{Scalar::float64, 0, 0});
    return std::make_shared<SphereHierarchy>(clouds_.back().view());
  }

  std::shared_ptr<SphereHierarchy> add(Cloud cloud)
  {
    clouds_.push_back(std::move(cloud));
    return std::make_shared<SphereHierarchy>(clouds_.back().view());
  }

private:
  std::deque<Cloud> clouds_;
};

/// Points of a rectangle: origin + i u + j v, i < m, j < n.
inline std::vector<Point3> sheet(const Point3& origin, const Point3& u, const Point3& v, int m, int n)
{
  std::vector<Point3> points;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < n; ++j)
      points.push_back(
          {origin[0] + i * u[0] + j * v[0], origin[1] + i * u[1] + j * v[1], origin[2] + i * u[2] + j * v[2]});
  return points;
}

inline std::vector<Point3> joined(std::vector<Point3> a, const std::vector<Point3>& b)
{
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

} // namespace pcl_bsh::test

// SPDX-License-Identifier: BSD-3-Clause
// Numbers, points and poses that are equal on every run. They are also equal with every compiler, if no two of them are
// arguments of one call, which are evaluated in any order. Braces are evaluated from left to right.
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <Eigen/Geometry>

#include <cmath>
#include <cstdint>
#include <random>

namespace pcl_bsh::test {

class Random {
public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high)
  {
    return low + (high - low) * std::ldexp(static_cast<double>(engine_() >> 11), -53);
  }

  /// Both ends included.
  int integer(int low, int high)
  {
    return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }

  bool chance(double probability) { return uniform(0, 1) < probability; }

  /// One of the values listed.
  template <class Value, std::size_t Count>
  const Value& pick(const Value (&values)[Count])
  {
    return values[static_cast<std::size_t>(integer(0, static_cast<int>(Count) - 1))];
  }

  /// @param coordinate called for x, y and z
  template <class Coordinate>
  Point3 point(Coordinate coordinate)
  {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    return {x, y, z};
  }

  Eigen::Quaterniond rotation()
  {
    const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1), w = uniform(-1, 1);
    return Eigen::Quaterniond(w, x, y, z).normalized();
  }

  /// Any rotation; a translation up to `reach` along each axis.
  Eigen::Isometry3d pose(double reach)
  {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.rotate(rotation());
    const Point3 shift = point([&] { return uniform(-reach, reach); });
    pose.pretranslate(Eigen::Vector3d(shift[0], shift[1], shift[2]));
    return pose;
  }

private:
  std::mt19937_64 engine_;
};

} // namespace pcl_bsh::test

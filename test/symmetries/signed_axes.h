// SPDX-License-Identifier: BSD-3-Clause
// Axes in another order, some of them reversed: quarter turns and mirrors, which round nothing.
#pragma once

#include "support/random.h"

#include <utility>

namespace pcl_bsh::symmetries {

class SignedAxes {
public:
  static SignedAxes any(test::Random& random)
  {
    SignedAxes axes;
    for (int i = 2; i > 0; --i) {
      const int j = random.integer(0, i);
      if (j != i) axes.mirrored_ = !axes.mirrored_;
      std::swap(axes.from_[i], axes.from_[j]);
    }
    for (double& sign : axes.signs_)
      if (random.chance(0.5)) {
        sign = -1.0;
        axes.mirrored_ = !axes.mirrored_;
      }
    return axes;
  }

  /// Not mirrored.
  static SignedAxes anyTurn(test::Random& random)
  {
    SignedAxes axes = any(random);
    if (axes.mirrored_)
      for (double& sign : axes.signs_) sign = -sign;
    axes.mirrored_ = false;
    return axes;
  }

  Point3 operator()(const Point3& p) const
  {
    Point3 turned;
    for (int k = 0; k < 3; ++k) turned[static_cast<std::size_t>(k)] = signs_[k] * p[static_cast<std::size_t>(from_[k])];
    return turned;
  }

  /// This after the pose.
  Eigen::Isometry3d before(const Eigen::Isometry3d& pose) const
  {
    Eigen::Isometry3d turned = pose;
    for (int k = 0; k < 3; ++k) turned.matrix().row(k) = signs_[k] * pose.matrix().row(from_[k]);
    return turned;
  }

  /// The pose of what this has turned in its own frame.
  Eigen::Isometry3d undoneBy(const Eigen::Isometry3d& pose) const
  {
    Eigen::Isometry3d turned = pose;
    for (int k = 0; k < 3; ++k) turned.linear().col(k) = signs_[k] * pose.linear().col(from_[k]);
    return turned;
  }

  /// Both: the pose where all frames are turned.
  Eigen::Isometry3d conjugated(const Eigen::Isometry3d& pose) const { return before(undoneBy(pose)); }

private:
  int from_[3] = {0, 1, 2};
  double signs_[3] = {1.0, 1.0, 1.0};
  bool mirrored_ = false;
};

} // namespace pcl_bsh::symmetries

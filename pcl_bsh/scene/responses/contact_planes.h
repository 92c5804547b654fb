// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>

namespace pcl_bsh {

/// The planes that a sliding object may not cross: it has met them and has not moved off since.
class ContactPlanes {
public:
  void forget() { count_ = 0; }

  /// Returns the part of a motion that enters neither the new plane nor those before it; 0 in a corner.
  Eigen::Vector3d add(const Eigen::Vector3d& normal, const Eigen::Vector3d& motion)
  {
    if (count_ < normals_.size()) normals_[count_++] = normal;
    Eigen::Vector3d along = motion - std::min(0.0, motion.dot(normal)) * normal;
    if (allowed(along)) return along;
    for (std::size_t i = 0; i + 1 < count_; ++i) {
      const Eigen::Vector3d edge = normal.cross(normals_[i]);
      if (edge.squaredNorm() < 1e-12) continue;
      along = edge * (motion.dot(edge) / edge.squaredNorm());
      if (allowed(along)) return along;
    }
    return Eigen::Vector3d::Zero();
  }

private:
  bool allowed(const Eigen::Vector3d& motion) const
  {
    const double slack = 1e-12 * motion.norm();
    for (std::size_t i = 0; i < count_; ++i)
      if (motion.dot(normals_[i]) < -slack) return false;
    return true;
  }

  std::array<Eigen::Vector3d, 8> normals_;
  std::size_t count_ = 0;
};

} // namespace pcl_bsh

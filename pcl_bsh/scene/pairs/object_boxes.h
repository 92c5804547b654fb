// SPDX-License-Identifier: BSD-3-Clause
// Where an object can be: boxes that hold all of its points, whatever rounding does.
#pragma once

#include <Eigen/Geometry>

#include <limits>

namespace pcl_bsh {

struct LocalFrame;
struct SceneObject;
class SphereHierarchy;

/// Closed; empty when low > high.
struct Box3 {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const { return !(low.array() <= high.array()).all(); }
  Eigen::Vector3d center() const { return 0.5 * low + 0.5 * high; }
  Eigen::Vector3d half() const { return 0.5 * high - 0.5 * low; }

  void merge(const Box3& other)
  {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }

  void grow(double reach)
  {
    low.array() -= reach;
    high.array() += reach;
  }

  bool meets(const Box3& other) const
  {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

/// Returns a box around a box that a pose has moved.
Box3 moved(const Box3& box, const Eigen::Isometry3d& pose);

/// How far places of a part may be from its points: their radii and uncertainties.
double outreach(const SphereHierarchy& hierarchy);

/// Box of all places that a frame stores, within rounding.
Box3 boxOf(const LocalFrame& frame);

/// Box of all places that a cloud's points and their radii may take, in its frame.
Box3 boxOf(const SphereHierarchy& hierarchy);

/// Box of all parts, in the object's frame.
Box3 boxOf(const SceneObject& object);

/// No point of a box moves farther than this when its pose changes.
double motionBound(const Box3& box, const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// The poses of a trajectory, and a binary tree over them: how far from straight do the scan's points move, seen by the
// model?
#pragma once

#include <pcl_bsh/geometry/point3.h>

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// Seen by the model at this pose, point x of the world is at R' (x - center), from the model's centre.
struct PathPose {
  std::array<double, 9> back; ///< R', row-major
  Point3 center;              ///< of the model, in the world
  std::array<float, 9> turn;  ///< R' R_scan, row-major
  std::uint32_t given = 0;    ///< index of the caller's pose (the first of equal ones in a row)
  double fraction = 0.0;      ///< swept: of the motion from there to the next

  Point3 see(const Point3& world) const
  {
    const double x = world[0] - center[0], y = world[1] - center[1], z = world[2] - center[2];
    return {back[0] * x + back[1] * y + back[2] * z, back[3] * x + back[4] * y + back[5] * z,
            back[6] * x + back[7] * y + back[8] * z};
  }
};

/// Poses first..last of the path. A point of the world, seen by the model, strays from the straight line between where
/// it is seen at the first and at the last pose by at most drift + turn * (its distance from the pivot): at pose k from
/// the line's point at (k - first) / (last - first).
struct PathInterval {
  std::uint32_t first = 0, last = 0;
  std::uint32_t left = 0, right = 0; ///< its halves, as indices of intervals; 0: not divided further
  double drift = 0.0, turn = 0.0;
  Point3 pivot = {0, 0, 0};

  bool divided() const { return left != 0; }
};

class PosePath {
public:
  /// Exactly the given poses. @param center a point in the model's frame, near its middle.
  PosePath(const Eigen::Isometry3d& scan_pose, const std::vector<Eigen::Isometry3d>& model_poses, const Point3& center);

  /// What the motion between poses is cut into: between two poses of the path no point of the model, nor one within
  /// `reach` of it, strays farther than `stray`.
  struct Sweep {
    Point3 pivot;  ///< of the motion, in the model's frame
    double radius; ///< of the model around it
    double reach;
    double stray;
  };

  /// The motion from each of the given poses to the next. @throws std::invalid_argument when that takes too many poses.
  PosePath(const Eigen::Isometry3d& scan_pose, const std::vector<Eigen::Isometry3d>& model_poses, const Point3& center,
           const Sweep& sweep);

  std::vector<PathPose> poses;
  std::vector<PathInterval> intervals; ///< intervals[0] is the whole path; empty when that has no pose
  double skew = 0.0; ///< how far the rotations are from rigid: bounds |R'R - I|, of pose and scan summed
  double far = 0.0;  ///< the largest coordinate of a centre, in the world
  bool is_swept = false;
  double stray = 0.0; ///< swept: what a way between two poses in a row bows out by at most, near the model

private:
  struct Bow { ///< between two poses in a row: strays by at most `drift` + `turn` * (distance from the pivot's way)
    double drift = 0.0, turn = 0.0;
    Point3 from = {0, 0, 0}, to = {0, 0, 0}; ///< the pivot's way
  };

  void add(const Eigen::Isometry3d& scan_pose, const Eigen::Isometry3d& pose, const Point3& center, std::uint32_t given,
           double fraction);
  std::uint32_t divide(std::uint32_t first, std::uint32_t last);
  void bound(PathInterval& interval) const;

  std::vector<Bow> bows_;
};

/// T p, as if computed exactly and rounded once or twice.
Point3 carried(const Eigen::Isometry3d& pose, const Point3& p);

} // namespace pcl_bsh

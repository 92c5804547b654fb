// SPDX-License-Identifier: BSD-3-Clause
// The poses of a trajectory, and a binary tree over them. It bounds how far from straight the scan's points move, seen
// by the model.
#pragma once

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/geometry/polar_decomposition.h>
#include <pcl_bsh/geometry/rigid_motion.h>
#include <pcl_bsh/query/progress.h>

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <vector>

namespace pcl_bsh {

/// Shares of a query's progress, in [0, 1]: at the end of making the path, and at the end of the broad phase. The walks
/// do the rest.
inline constexpr double kPathDone = 0.05, kBroadPhaseDone = 0.1;

/// Bounds the error of the C library's sine and cosine of an angle up to a turn: four units in the last place of 1. The
/// library is held against an enclosure in rational numbers (test/trajectory/sine_test.cpp).
inline constexpr double kSineError = 0x1p-51;

/// Bounds the rounding of bounds of motion, and of turns between the ends of a motion: a few dozen operations in
/// double, and the errors of sine and cosine (test/proof/turns.g).
inline constexpr double kMotionRounding = 0x1p-45;

/// Seen by the model at this pose, point x of the world is at R' (x - center), from the model's centre. On a swept
/// path, R is the rotation nearest to the pose's linear part.
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

/// Poses first..last of the path. Take the straight line between the places where the model sees a point of the world
/// at the first and at the last pose. At pose k, the point is seen at most drift + turn * (its distance from the pivot)
/// away from the line's point at (k - first) / (last - first).
struct PathInterval {
  std::uint32_t first = 0, last = 0;
  std::uint32_t left = 0, right = 0; ///< its halves, as indices of intervals; 0: not divided further
  double drift = 0.0, turn = 0.0;
  double bend_drift = 0.0, bend_turn = 0.0; ///< such bounds of the distance from the parabola through the places at the
                                            ///< first, the middle and the last pose
  Point3 pivot = {0, 0, 0};

  bool divided() const { return left != 0; }
  std::uint32_t middle() const { return first + (last - first) / 2; }
};

class PosePath {
public:
  /// A path of exactly the given poses. @param center a point in the model's frame, near its middle. @throws what
  /// progress throws
  PosePath(const Eigen::Isometry3d& scan_pose, const std::vector<Eigen::Isometry3d>& model_poses, const Point3& center,
           Progress& progress);

  /// The model, and the bounds for cutting the motion between poses. Between two poses of the path, no point of the
  /// model, nor a point within `reach` of it, strays farther than `stray` from a straight line.
  struct Sweep {
    Point3 pivot;  ///< of the motion, in the model's frame
    double radius; ///< of the model around it
    double size;   ///< of the model around `center`
    double reach;
    double stray;
    double rounding; ///< how far the rounding of a reported instant may move a point of the model, at most
  };

  /// A swept path has no more poses than this; it takes some 260 bytes for each.
  static constexpr double kMostPoses = 0x1p22;

  /// A swept path: the motion from each given pose to the next. It passes each given pose exactly.
  /// @throws std::invalid_argument naming the poses, before any memory is taken: where that takes too many poses, or
  ///   where the model turns by half a turn, and both directions are as short
  PosePath(const Eigen::Isometry3d& scan_pose, const std::vector<Eigen::Isometry3d>& model_poses, const Point3& center,
           const Sweep& sweep, Progress& progress);

  /// Throws what the constructor of a swept path throws, without making it.
  static void check(const std::vector<Eigen::Isometry3d>& model_poses, const Sweep& sweep, Progress& progress);

  std::vector<PathPose> poses;
  std::vector<PathInterval> intervals; ///< intervals[0] is the whole path; empty when that has no pose
  double skew = 0.0; ///< how far the rotations are from rigid: bounds |R'R - I|, of pose and scan summed
  double far = 0.0;  ///< the largest coordinate of a centre, in the world
  bool is_swept = false;
  double stray = 0.0; ///< swept: how far a point's motion between two consecutive poses strays from straight at most,
                      ///< near the model

  /// Returns the place of a model's point at pose k of a swept path, seen by the model, from its centre. A pose that is
  /// not quite rigid stretches the model.
  Point3 stretched(std::uint32_t k, const Point3& p) const
  {
    if (stretches_.empty()) return p;
    const std::array<double, 9>& s = stretches_[k];
    return {s[0] * p[0] + s[1] * p[1] + s[2] * p[2], s[3] * p[0] + s[4] * p[1] + s[5] * p[2],
            s[6] * p[0] + s[7] * p[1] + s[8] * p[2]};
  }

private:
  PosePath() = default;

  /// A given pose and the motion from there to the next.
  struct Step {
    double cuts = 0.0;                              ///< parts that it is cut into
    Bow bow = {0.0, 0.0};                           ///< of each of them
    Eigen::Vector3d turn = Eigen::Vector3d::Zero(); ///< of the whole: axis times angle
    Point3 begin = {0, 0, 0}, end = {0, 0, 0};      ///< of the pivot's motion

    Point3 pivotAt(double fraction) const
    {
      return {begin[0] + (end[0] - begin[0]) * fraction, begin[1] + (end[1] - begin[1]) * fraction,
              begin[2] + (end[2] - begin[2]) * fraction};
    }
  };

  /// @return how many poses it takes
  double plan(const std::vector<Eigen::Isometry3d>& model_poses, const std::vector<PolarDecomposition>& parts,
              const Sweep& sweep, Progress& progress);
  void add(const Eigen::Isometry3d& scan_pose, const Eigen::Isometry3d& pose, const Eigen::Matrix3d& rotation,
           const Point3& center, std::uint32_t given, double fraction);
  void divideAll(Progress& progress);
  std::uint32_t divide(std::uint32_t first, std::uint32_t last, Progress& progress);
  void bound(PathInterval& interval) const;
  double stretchStray(std::uint32_t first, std::uint32_t last) const;

  std::vector<Step> steps_;                      // swept: per given pose
  std::vector<std::array<double, 9>> stretches_; // swept: per pose of the path; empty where all poses are rigid
  double size_ = 0.0;                            // swept: of the model around its centre
};

/// T p, as if computed exactly and rounded once or twice.
Point3 carried(const Eigen::Isometry3d& pose, const Point3& p);

} // namespace pcl_bsh

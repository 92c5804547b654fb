// SPDX-License-Identifier: BSD-3-Clause
// From one local frame to another under two poses, and the bounds that make float arithmetic there provable.
#pragma once

#include <pcl_bsh/geometry/distance_band.h>
#include <pcl_bsh/geometry/local_frame.h>

#include <Eigen/Geometry>

#include <array>

namespace pcl_bsh {

/// The rotation that all frames of two poses share.
struct RelativeRotation {
  RelativeRotation(const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b);

  Eigen::Matrix3d matrix;                 ///< R_b' R_a
  std::array<double, 12> columns = {};    ///< `matrix` by columns, each followed by a 0
  std::array<double, 12> back_turns = {}; ///< R_b' in the same order
  double stretch = 1.0;                   ///< at least the spectral norm of `matrix`
  double skew = 0.0;                      ///< at least ||R_b'R_b - I||
};

/// Carries points of frame a into frame b: y = M x + g, so that |y - x_b| times b's unit is the distance of the points.
///
/// Let z = T_a p - T_b q be the true vector, w = R_b' z / unit_b. Let E = R_b'R_b - I, zero for a perfect pose. Then w
/// = g + M (x_a + e_a) - (I + E)(x_b + e_b). g = R_b' (T_a origin_a - T_b origin_b) / unit_b has compensated products;
/// M = R_b' R_a unit_a / unit_b. `error` bounds |w - (y - x_b)| over all stored points, float evaluation of y included
/// (kCarriedProductError, kCarriedShiftError); |z| and |w| differ by at most ||E|| |w|.
class RelativeFrame {
public:
  RelativeFrame() = default;
  RelativeFrame(const LocalFrame& a, const Eigen::Isometry3d& pose_a, const LocalFrame& b,
                const Eigen::Isometry3d& pose_b)
  : RelativeFrame(a, pose_a, b, pose_b, RelativeRotation(pose_a, pose_b))
  {
  }

  /// @param rotation of the same poses
  RelativeFrame(const LocalFrame& a, const Eigen::Isometry3d& pose_a, const LocalFrame& b,
                const Eigen::Isometry3d& pose_b, const RelativeRotation& rotation);

  std::array<float, 9> m = {}; ///< row-major, float
  std::array<float, 3> g = {}; ///< float
  float stretch_a = 1.0f;      ///< a radius in a's unit, times this, bounds it in b's frame (spectral norm, rounded up)
  float stretch_b = 1.0f;      ///< factor for a radius of b: 1 + ||E||, rounded up
  std::array<double, 3> g_exact = {}; ///< g in double
  double error = 0.0;                 ///< in b's units

  /// The band for a clearance >= 0 given in the clouds' unit. @pre finite or infinite, not NaN.
  DistanceBand band(double clearance) const noexcept;

  /// The band for records that err by more than stored points: by more_error, and by more_share of their distance. A
  /// triangle of b that was laid flat has flat.error and kFlatShare.
  DistanceBand band(double clearance, double more_error, double more_share) const noexcept;

  /// At least (clearance + error) in b's units: two nodes whose centres' float distance exceeds the sum of their
  /// stretched radii and this, by more than rounding, hold no colliding pair.
  float pruneReach(double clearance) const noexcept;

  /// At most (clearance - error) in b's units; the counterpart for "every pair collides". Negative when no such length
  /// exists.
  float acceptReach(double clearance) const noexcept;

  /// Spheres of this radius or less are of the size of the error: float tests say little about where their points are.
  float bluntRadius() const noexcept;

  /// Whether two blunt spheres that the float test calls near may be apart: the error may have changed the test.
  /// @param squared distance of their centres. @param reach the sum of their stretched radii and pruneReach().
  bool isUndecided(float squared, float reach) const noexcept
  {
    const float surely_near = reach - bluntRadius() / 4;
    return !(surely_near > 0.0f && squared < surely_near * surely_near);
  }

  double unit() const noexcept { return unit_b_; } ///< b's, in the clouds' unit

  /// Bounds | |z| - |w| | / |w|, how far the poses are from rigid.
  double skew() const noexcept { return skew_; }

  /// Whether no stored points of the two frames are within the clearance, whatever they are. Judged in double, so that
  /// distances whose squares leave the range of float are answered here.
  bool separates(double clearance) const noexcept;

private:
  double span_ = 0.0;        // of both frames' points around their origins, in b's units
  double float_error_ = 0.0; // as `error`, but finite for values out of float's range: good in double arithmetic
  double prune_error_ = 0.0; // the error for spheres, not for points: infinite where carried points may overflow
  double unit_b_ = 1.0;
  double skew_ = 0.0; ///< bounds ||E||
};

} // namespace pcl_bsh

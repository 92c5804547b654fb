// SPDX-License-Identifier: BSD-3-Clause
// Labels of single points of a cloud in a solid, at one pose of both.
#pragma once

#include <pcl_bsh/base/pulse.h>
#include <pcl_bsh/geometry/triangle/winding.h>
#include <pcl_bsh/solid/columns.h>
#include <pcl_bsh/solid/solid.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh {

/// Double arithmetic decides crossings where its error bound allows, and Winding decides all others exactly. Both use
/// the same ray, so each may decide some crossings of one point.
///
/// Error bound. A place is R (p - o) + g, where o is near it in the cloud. Here g = Rb^-1 s and s = Ra o + ta - tb - Rb
/// ob. Entries are at most 1 + 1e-6 and v = 2^-53. Cofactors and determinant of Rb err by 4 v and 20 v, its inverse by
/// less than 32 v an entry, R by less than 128 v. A is the largest |p - o|, S the largest |s|, and e the error of s,
/// which is summed in numbers that know it. R (p - o) errs by less than 400 v A per axis, g by less than 120 v S + 4 e.
/// The last sums add 8 v (A + S). kFrameError = 1024 v of A + S has room for twice that, and for bounds of boxes that
/// are compared with it.
class PointLabels {
public:
  PointLabels(const Eigen::Isometry3d& pose_a, const PlacedSolid& b);

  /// The rigid map from the cloud's frame, near one origin, to where the solid's columns see its places.
  struct Frame {
    Point3 origin; ///< in the cloud's own frame
    Point3 shift;  ///< where the origin is seen
    double error;  ///< of seen(), per axis, in both the place and the solid's corners; infinite where nothing is known
  };

  /// @param reach at least |p - origin| per axis, of all points that are seen from this frame
  Frame frameAt(const Point3& origin, double reach) const;

  /// Returns where a place of the cloud is seen. @param from_origin the place less the frame's origin
  Point3 seen(const Frame& frame, const Point3& from_origin) const noexcept
  {
    Point3 at;
    for (std::size_t k = 0; k < 3; ++k)
      at[k] = (rotation_[k][0] * from_origin[0] + rotation_[k][1] * from_origin[1] + rotation_[k][2] * from_origin[2]) +
              frame.shift[k];
    return at;
  }

  const Columns& columns() const noexcept { return columns_; }

  /// @param p finite, of the cloud. @param exact_decisions crossings that Winding decided are added
  Label label(const Frame& frame, const Point3& p, std::uint64_t& exact_decisions);

  /// The label of all places within `error` of `at`, per axis, as seen; nothing where double arithmetic cannot tell.
  std::optional<Label> labelAround(const Point3& at, double error);

  /// Copies the gaps that another PointLabels has found. @pre both have the same poses
  void takeGaps(const PointLabels& other) { gaps_ = other.gaps_; }

private:
  /// A box that no triangle meets: all in it have one label.
  struct Gap {
    Point3 low, high;
    Label label;

    bool holds(const Point3& at, double error) const noexcept
    {
      for (std::size_t k = 0; k < 3; ++k)
        if (!(at[k] - error > low[k] && at[k] + error < high[k])) return false;
      return true;
    }
    bool touches(const Point3& at, double error) const noexcept
    {
      for (std::size_t k = 0; k < 3; ++k)
        if (at[k] + error < low[k] || at[k] - error > high[k]) return false;
      return true;
    }
  };

  const Gap* gapAt(const Point3& at, double error);
  void addGap(const Point3& at, double error, Label label);
  template <class Decide>
  std::optional<int> turnsAt(const Point3& at, double error, const Decide& decide);

  const Columns& columns_;
  const TrianglesView& triangles_;
  Winding winding_;
  Eigen::Isometry3d pose_a_, pose_b_;
  std::array<Point3, 3> rotation_, inverse_; ///< rows, in the order of the columns' axes
  std::vector<std::uint32_t> several_;
  std::vector<Gap> gaps_;
  std::size_t gaps_met_ = 0, gaps_made_ = 0;
  Pulse pulse_; ///< of triangles above a place
};

} // namespace pcl_bsh

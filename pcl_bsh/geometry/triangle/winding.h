// SPDX-License-Identifier: BSD-3-Clause
// Tells exactly if closed triangles enclose a point: crossings of a ray from it, and the winding number of them all.
//
//   Winding winding(T_world_a, T_world_b);
//   int turns = 0;
//   for (triangle) { ... winding.crossing(p, triangle) ... turns += crossing.turns; }
#pragma once

#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

namespace pcl_bsh {

/// Rays from points of a along an axis of b, through triangles of b. The ray begins beside the point, by an
/// infinitesimal step along the next axis and an infinitely smaller one along the last. So it meets no edge and no
/// corner, and each of its crossings counts once. Where the point is not on the surface, the winding number is that of
/// the point.
class PCL_BSH_EXPORT_INTERNAL Winding {
public:
  struct Crossing {
    int turns = 0;           ///< 1 where the ray leaves through the triangle's front (seen counterclockwise), -1 back
    bool on_surface = false; ///< the point is on the closed triangle; turns then say nothing
  };

  /// How many crossings were decided by double arithmetic, by sums of doubles that know their error, and by integers.
  struct Stages {
    std::uint64_t doubles = 0, long_numbers = 0, integers = 0;
  };

  /// @param axis 0, 1 or 2: of b's own frame, towards which the rays go
  Winding(const Eigen::Isometry3d& pose_a, const Eigen::Isometry3d& pose_b, int axis = 0);

  /// @param p, triangle finite
  Crossing crossing(const Point3& p, const Triangle3& triangle, Stages* stages = nullptr) const;

  /// How often `count` triangles wind round the point, positive where fronts look outward; nothing where the point is
  /// on one of them. Triangles that are not finite count for nothing. Asks one triangle after another.
  /// @param triangle called with 0 .. count - 1
  std::optional<int> number(const Point3& p, std::size_t count,
                            const std::function<Triangle3(std::size_t)>& triangle) const;

private:
  template <class Number>
  using Corners = std::array<std::array<Number, 3>, 3>;

  template <class Number>
  std::array<Number, 3> seen(const Point3& p, const Point3& q) const;
  template <class Number>
  Corners<Number> turnedBack(const Corners<Number>& corners) const;

  ExactDistance points_;
  std::array<std::array<double, 4>, 3> a_, b_; ///< rows of the poses
  bool turned_;                                ///< b's axes are not those of the world
  std::size_t axis_;
};

} // namespace pcl_bsh

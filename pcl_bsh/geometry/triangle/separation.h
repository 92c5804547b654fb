// SPDX-License-Identifier: BSD-3-Clause
// How far apart two points, or triangles, are in double arithmetic, and along which direction. Bounds of motion follow
// from it; answers at poses are those of RecordDistance.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/triangle/triangle3.h>

#include <cstdint>

namespace pcl_bsh {

/// Error of a distance of two places, or of a span along a direction, relative to the largest coordinate. Proved in
/// test/proof/separation.g. Squares of lengths below 2^-500 vanish: as much is added.
inline constexpr double kSeparationError = 48 * kDoubleUnit;

/// A point, or a closed triangle: all that lies between its corners.
struct Corners {
  Triangle3 at;
  std::uint32_t count; ///< 1 or 3

  static Corners of(const Point3& p) { return {{p, p, p}, 1}; }
  static Corners of(const Triangle3& t) { return {t, 3}; }
};

struct Separation {
  Point3 place_a, place_b;      ///< about nearest to each other; where both meet, about the same
  Point3 direction = {0, 0, 0}; ///< of length 1, from b to a; 0 where they meet
  double low = 0.0, high = 0.0; ///< the distance is between these, whatever rounding takes
};

/// The separation of corners in one frame, finite and below 2^300. `low` and `high` are as near to each other as
/// rounding lets them, except for triangles so thin that their sides lie closer together than that.
PCL_BSH_EXPORT_INTERNAL Separation separationOf(const Corners& a, const Corners& b);

/// The normal of a face of one of them, of length 1 and from b to a, along which both are apart by no less than
/// `least`. Among several, it is the one along which they are farthest apart; 0 where no face has such a normal.
PCL_BSH_EXPORT_INTERNAL Point3 faceBetween(const Corners& a, const Corners& b, double least);

/// Corners that move, each on a parabola: at s in [0, 1] at from + s way + 4 s (1 - s) bow.
struct MovingCorners {
  Triangle3 from, way, bow;
  std::uint32_t count;

  Corners at(double s) const;
};

/// Two MovingCorners in one frame, which share s. Refers to both, and owns neither.
class PCL_BSH_EXPORT_INTERNAL MovingPair {
public:
  MovingPair(const MovingCorners& a, const MovingCorners& b);

  /// A lower bound of the gap from b to a along a direction of length 1, between two instants; may be negative.
  double leastApart(const Point3& direction, double begin, double end) const;

  const MovingCorners &a, &b;

private:
  bool b_rests_;
  double error_;
};

/// When two MovingCorners come near each other.
struct Approach {
  bool contact = false;                         ///< whether they come near enough; the next three are set only then
  double distance = 0.0, at = 0.0, enter = 0.0; ///< the smallest one, its instant, and the first instant near enough
  bool meets = false;                           ///< whether they meet at an instant looked at, up to rounding
  std::uint32_t looks = 0;                      ///< instants that were looked at
};

/// There is no contact where both stay beyond `near_enough`, and there is one where they come nearer than that by more
/// than `resolution`. `distance` is the smallest one within `resolution`. Before `enter`, they are never nearer than
/// `near_enough` by more than that.
/// @param resolution above what rounding takes; bounds the work. @param nearest whether the smallest distance counts;
/// if not, only the first instant does @param early_enough contacts from this instant on count as equally early
PCL_BSH_EXPORT_INTERNAL Approach approachOf(const MovingCorners& a, const MovingCorners& b, double near_enough,
                                            double resolution, bool nearest, double early_enough = 1.0);

} // namespace pcl_bsh

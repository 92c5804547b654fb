// SPDX-License-Identifier: BSD-3-Clause
// Directions in cells: the faces of a cube about the scanner, each cut into squares whose edges are great circles.
#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pcl_bsh {

inline constexpr std::size_t kCubeFaces = 6;

/// Where a direction meets the cube [-1, 1]^3.
struct FacePlace {
  std::size_t face; ///< twice the axis, plus 1 where it is negative
  double u, w;      ///< along the two axes after it
};

/// @param direction not 0
inline FacePlace facePlaceOf(const Eigen::Vector3d& direction)
{
  Eigen::Index axis = 0;
  const double size = direction.cwiseAbs().maxCoeff(&axis);
  return {2 * static_cast<std::size_t>(axis) + (direction[axis] < 0.0 ? 1 : 0), direction[(axis + 1) % 3] / size,
          direction[(axis + 2) % 3] / size};
}

/// The direction of a place of a face, of length 1 to 1.8.
inline Eigen::Vector3d directionOf(const FacePlace& place)
{
  const auto axis = static_cast<Eigen::Index>(place.face / 2);
  Eigen::Vector3d direction;
  direction[axis] = place.face % 2 == 0 ? 1.0 : -1.0;
  direction[(axis + 1) % 3] = place.u;
  direction[(axis + 2) % 3] = place.w;
  return direction;
}

/// A square of a face that is cut into 2^level squares an edge.
struct DirectionCell {
  std::size_t face;
  unsigned level;
  std::uint32_t u, w; ///< < 2^level

  DirectionCell quarter(std::uint32_t q) const { return {face, level + 1, 2 * u + (q & 1), 2 * w + (q >> 1)}; }

  double halfEdge() const { return 1.0 / static_cast<double>(std::uint64_t{1} << level); } ///< exact; ldexp() is slow

  Eigen::Vector3d middle() const
  {
    const double half = halfEdge();
    return directionOf({face, -1.0 + half * (2 * u + 1), -1.0 + half * (2 * w + 1)});
  }

  /// Returns the corners, in order around the cell.
  std::array<Eigen::Vector3d, 4> corners() const
  {
    const double edge = 2.0 * halfEdge();
    const double u0 = -1.0 + edge * u, w0 = -1.0 + edge * w;
    return {directionOf({face, u0, w0}), directionOf({face, u0 + edge, w0}), directionOf({face, u0 + edge, w0 + edge}),
            directionOf({face, u0, w0 + edge})};
  }
};

/// A sphere about a unit vector that holds all directions of a cell.
struct CellSphere {
  CellSphere() = default;
  explicit CellSphere(const DirectionCell& cell)
  {
    center = cell.middle();
    const double length = center.norm();
    const double farthest = 1.4142135623730952 * cell.halfEdge(); // of the face's places from its middle
    center /= length;
    // |x / |x| - y / |y|| <= 2 |x - y| / (|x| + |y|), and no place of a face is nearer than 1 (Dunkl, Williams, 1964).
    chord = 2.0 * farthest / (length + std::max(1.0, length - farthest)) * (1.0 + 0x1p-40);
  }
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double chord = 0.0;
};

/// The directions about a unit vector up to an angle of less than half a turn.
struct Cone {
  Cone(const Eigen::Vector3d& axis, double half_angle)
  : direction(axis),
    sine(half_angle < 0.5 * static_cast<double>(EIGEN_PI) ? std::sin(half_angle) : 1.0),
    cosine(std::cos(half_angle)),
    chord(2.0 * std::sin(0.5 * half_angle))
  {
  }
  Eigen::Vector3d direction;
  double sine; ///< the greatest sine of its angles
  double cosine, chord;

  bool isApartFrom(const CellSphere& cell) const
  {
    const double both = chord + cell.chord;
    return (direction - cell.center).squaredNorm() > both * both + 0x1p-40;
  }

  /// Whether they share a direction; rounded towards true.
  bool meets(const DirectionCell& cell) const;
};

/// A cell lies between beams if on each of its eight sides is a beam within the angle of its middle. A side is a sector
/// of 135 degrees on the cell's face: side i goes from i to i + 3 eighths of a turn, from u towards w. A beam is in it
/// if each place of the cell sees it there. Each half-plane about a place of the cell holds one of the sectors, so that
/// the place is in a triangle of such beams, and great circles are straight lines there.
inline constexpr std::size_t kBeamSides = 8;

/// A beam counts for a sector if it is within it by this length, on the cube, and by twice as much along u + w and u -
/// w. This is more than the error of stored directions, at up to 70 degrees from the middle of a face.
inline constexpr double kBesideCell = 0x1p-19;

/// Levels of the cells in which beams of an angle are judged: an edge of a cell is at most a quarter of the angle.
unsigned cellLevels(double angle);

/// Returns the angle up to which a beam counts as near a cell's middle: the given one, less rounding and the error of
/// stored directions.
inline double cellAngle(double angle)
{
  return angle * (1.0 - 0x1p-10) - 0x1p-22;
}

} // namespace pcl_bsh

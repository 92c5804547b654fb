// SPDX-License-Identifier: BSD-3-Clause
// Places and headings as people write a way, and the poses between them. readPoses() reads it where poses are read.
//
//   waypoints 0.05 2
//   0 0 0 0
//   4 0 0 0
//   6 2 0 90 arc
//   6 2 0 180 turn
#pragma once

#include <Eigen/Geometry>

#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// The pose at a place, turned about z by a heading in degrees, counter-clockwise as seen from above: from x towards y.
/// Multiples of 90 are exact.
Eigen::Isometry3d placeAt(const Eigen::Vector3d& place, double heading);

/// A pose of a way, and how a body gets there from the one before. Headings change the short way round.
struct Waypoint {
  enum class Way : unsigned char {
    straight, ///< along a line; the heading changes evenly meanwhile
    turn,     ///< turns in place first, then goes along the line
    arc,      ///< about the one vertical axis whose turn takes the one pose to the other, rising evenly
  };

  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  double heading = 0.0; ///< in degrees, as placeAt() has it
  Way way = Way::straight;
};

/// How far two neighbouring poses may be apart at most: both > 0 and finite.
struct LargestStep {
  double length = 0.0;  ///< of the body's origin, along its way
  double degrees = 0.0; ///< of its heading
};

/// Whether the first line of a text, comments left out, begins with `waypoints`.
bool areWaypoints(std::string_view text);

/// A way as text has it.
struct WaypointPath {
  LargestStep step;
  std::vector<Waypoint> way;
};

/// A first line `waypoints LENGTH DEGREES`, which are the largest step. Then a waypoint a line: x y z heading, and
/// `turn` or `arc` where its way is no line; values are separated by blanks, tabs, commas or semicolons. A '#' begins a
/// comment. @throws FormatError naming the line
WaypointPath parseWaypoints(std::string_view text);

/// The poses of a way: all waypoints, and as few evenly spaced poses between them as the step allows. A waypoint that
/// is where the one before is adds none.
/// @throws FormatError for a step that is not > 0, a heading of half a turn from the one before, which is as short
///   either way round, and for more than ten million poses
std::vector<Eigen::Isometry3d> posesAlong(const WaypointPath& path);

} // namespace pcl_bsh::io

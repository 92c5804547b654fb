// SPDX-License-Identifier: BSD-3-Clause
// Made rooms of boxes, and what scanners in them measure.
#pragma once

#include <pcl_bsh/seen/seen_space.h>

#include "random.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace pcl_bsh::test {

inline constexpr double kPi = 3.14159265358979323846;

/// Solid boxes in a hollow one.
struct MadeRoom {
  Eigen::AlignedBox3d hollow;
  std::vector<Eigen::AlignedBox3d> boxes;

  /// Along a unit vector to the first surface. @pre the origin is in the hollow and in no box
  double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const
  {
    double nearest = spanIn(hollow, origin, direction).second;
    for (const Eigen::AlignedBox3d& box : boxes) {
      const auto [enter, leave] = spanIn(box, origin, direction);
      if (enter <= leave && enter > 0.0) nearest = std::min(nearest, enter);
    }
    return nearest;
  }

  /// From a place to the nearest surface; negative in a box or outside of the hollow.
  double distance(const Eigen::Vector3d& place) const
  {
    double nearest = std::min((place - hollow.min()).minCoeff(), (hollow.max() - place).minCoeff());
    for (const Eigen::AlignedBox3d& box : boxes)
      nearest = std::min(nearest, box.contains(place) ? -1.0 : box.exteriorDistance(place));
    return nearest;
  }

private:
  static std::pair<double, double> spanIn(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin,
                                          const Eigen::Vector3d& direction)
  {
    const Eigen::Array3d inverse = direction.array().inverse();
    const Eigen::Array3d a = (box.min() - origin).array() * inverse, b = (box.max() - origin).array() * inverse;
    return {a.min(b).maxCoeff(), a.max(b).minCoeff()};
  }
};

/// Whether beams in all directions of the ball's cone leave the ball before they meet a surface: of as many as are
/// asked for, the outermost and others.
/// @param inside whether the scanner turns to a direction
template <class Room, class Inside>
bool shows(const Room& room, const Eigen::Vector3d& origin, const Eigen::Vector3d& center, double radius,
           int directions, const Inside& inside)
{
  const Eigen::Vector3d way = center - origin;
  const double distance = way.norm();
  if (distance <= radius) return false;
  const Eigen::Vector3d axis = way / distance, side = axis.unitOrthogonal(), up = axis.cross(side);
  for (int i = 0; i <= directions; ++i) {
    const double turn = 2.399963 * i, share = i % 2 == 0 ? 1.0 : std::sqrt(static_cast<double>(i) / directions);
    const double angle = share * std::asin(radius / distance);
    const Eigen::Vector3d d = std::cos(angle) * axis + std::sin(angle) * (std::cos(turn) * side + std::sin(turn) * up);
    const double off = distance * std::sin(angle);
    const double leaves = distance * std::cos(angle) + std::sqrt(std::max(0.0, radius * radius - off * off));
    if (!inside(d) || room.cast(origin, d) <= leaves) return false;
  }
  return true;
}

/// Whether a scanner that turns all round shows it.
template <class Room>
bool shows(const Room& room, const Eigen::Vector3d& origin, const Eigen::Vector3d& center, double radius,
           int directions)
{
  return shows(room, origin, center, radius, directions, [](const Eigen::Vector3d&) { return true; });
}

/// A hall of so many metres with pillars between a scanner's places, and a machine's length of free way.
inline MadeRoom hallOfPillars(double length = 20.0, double width = 12.0, double height = 5.0, double step = 4.0)
{
  MadeRoom room{{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(length, width, height)}, {}};
  for (double x = step; x < length; x += step)
    for (double y = step; y < width; y += step)
      room.boxes.emplace_back(Eigen::Vector3d(x - 0.25, y - 0.25, 0), Eigen::Vector3d(x + 0.25, y + 0.25, height));
  return room;
}

/// How a scanner turns. Angles in radians.
struct MadeScanner {
  Eigen::Vector3d origin;
  double step = 0.01;                                     ///< between beams of a row, and between rows
  double lowest = -1.0, highest = 1.3;                    ///< elevation
  double first = 0.0, last = 2.0 * kPi;                   ///< azimuth
  double noise = 0.0;                                     ///< sigma of ranges, cut off at three
  double range = std::numeric_limits<double>::infinity(); ///< from farther away nothing returns

  /// Whether a direction is no farther out than its outermost beams. @pre last - first <= 2 pi
  bool turnsTo(const Eigen::Vector3d& direction) const
  {
    const double up = std::asin(std::clamp(direction.z() / direction.norm(), -1.0, 1.0));
    double around = std::atan2(direction.y(), direction.x());
    while (around < first) around += 2.0 * kPi;
    return lowest <= up && up <= highest && around <= last;
  }
};

/// Coordinates of returns, in a row, and of the ends of beams without a return.
struct MadeScan {
  std::vector<double> returns, misses;
  ScanBeams scan(const Eigen::Vector3d& origin) const
  {
    ScanBeams scan;
    scan.origin = {origin.x(), origin.y(), origin.z()};
    scan.returns = viewOf(returns.data(), returns.size() / 3);
    scan.misses = viewOf(misses.data(), misses.size() / 3);
    return scan;
  }
};

template <class Room>
MadeScan makeScan(const Room& room, const MadeScanner& scanner, Random& random)
{
  MadeScan made;
  const auto rows = static_cast<int>((scanner.highest - scanner.lowest) / scanner.step);
  for (int row = 0; row <= rows; ++row) {
    const double elevation = scanner.lowest + scanner.step * row;
    const double turn = scanner.last - scanner.first;
    const auto columns = static_cast<int>(std::ceil(turn / scanner.step));
    for (int column = 0; column < columns; ++column) {
      const double azimuth = scanner.first + turn * column / columns;
      const Eigen::Vector3d d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                              std::sin(elevation));
      double range = room.cast(scanner.origin, d);
      const bool returns = range <= scanner.range;
      if (scanner.noise > 0.0) range += scanner.noise * std::clamp(random.uniform(-3, 3), -3.0, 3.0);
      const Eigen::Vector3d end = scanner.origin + (returns ? range : 1.0) * d;
      std::vector<double>& list = returns ? made.returns : made.misses;
      list.insert(list.end(), {end.x(), end.y(), end.z()});
    }
  }
  return made;
}

} // namespace pcl_bsh::test

// SPDX-License-Identifier: BSD-3-Clause
// A railway wagon on its way through a scanned tunnel, made up: does it keep 5 cm from the wall everywhere?
//
// At scale 1 the size is that of Schauer & Nuechter, Collision detection between point clouds using an efficient k-d
// tree implementation (2015). The tunnel has 18.92 M points and is 1144 m long, the wagon has 2.5 M points, and there
// are 19,392 positions. The wagon stands on two bogies, so in a bend its middle leaves the track to the inside and its
// ends to the outside. There it touches walls that its cross-section, carried along the track, would clear. Some lamps
// reach in too far anywhere.
//
// The tight tunnel is one long bend of 180 m radius in which the vault grazes the wagon's upper edges: their gap falls
// to about the clearance, and stays there for 600 m. Its points come in random order, with noise of 4 mm.
//
// Metres; z up, x forward, the origin of wagon and track at the rails' level in the middle of the track.
#pragma once

#include <Eigen/Geometry>

#include <cstddef>
#include <functional>
#include <vector>

namespace pcl_bsh::tunnel {

inline constexpr double track_length = 1144.0;
inline constexpr double clearance = 0.05;
inline constexpr double wagon_length = 26.4;
inline constexpr double pivot_distance = 19.0; ///< between the wagon's two bogies

enum class Course { winding, tight };

/// A curve in space, by the distance travelled: straights, bends, and clothoids between them; a gentle rise and fall.
class Track {
public:
  explicit Track(Course course = Course::winding);

  /// Where a narrow trolley would stand at this station, 0 .. track_length: x along the track, y left, z up.
  Eigen::Isometry3d at(double station) const;

  /// The wagon with its middle at this station: both bogies on the track, the body straight between them.
  Eigen::Isometry3d wagonAt(double station) const;

  /// In 1/m, positive to the left; 0 on a straight.
  static double curvature(double station, Course course = Course::winding);

private:
  struct Sample {
    double x, y, heading;
  };
  std::vector<Sample> samples_;
};

struct Size {
  std::size_t scan = 0;
  std::size_t wagon = 0;
  std::size_t poses = 0;

  /// Counts in proportion, lengths as they are; above scale 1 only the scan grows.
  /// @throws std::invalid_argument unless 0 < scale <= 100
  static Size atScale(double scale);
};

/// All that a question along a path needs. Points are float x, y, z in a row.
struct Passage {
  std::vector<Eigen::Vector3f>
      scan; ///< in the world, in the order of a scanner that turns as it travels; tight: random
  std::vector<Eigen::Vector3f> wagon;   ///< in the wagon's frame
  std::vector<Eigen::Isometry3d> poses; ///< of the wagon in the world, evenly spaced over the whole tunnel
};

/// Every call makes an equal passage.
Passage makePassage(const Size& size, Course course = Course::winding);

/// The scan of makePassage() on the winding course point by point, for scans that are larger than memory.
/// @param count of its points
void forEachScanPoint(std::size_t count, const std::function<void(const Eigen::Vector3f&)>& take);

/// Distance from a place in the cross-section (y to the left, z up) to the wagon's outline there; 0 inside.
double distanceToWagonOutline(double y, double z);

} // namespace pcl_bsh::tunnel

// SPDX-License-Identifier: BSD-3-Clause
// The data of each scan in a SeenSpace.
#pragma once

#include <pcl_bsh/seen/beam_tree.h>
#include <pcl_bsh/seen/hole_map.h>
#include <pcl_bsh/seen/seen_space.h>

#include <vector>

namespace pcl_bsh {

/// One scan of a SeenSpace. Its beams count for directions within kReachOfAngle times its angle of their own.
class SeenScan {
public:
  /// @param angle 0: measured
  SeenScan(const ScanBeams& scan, double angle, unsigned threads);

  const Point3& origin() const { return beams_.scan().origin; }
  double angle() const { return angle_; }
  std::size_t size() const { return beams_.beams().size(); }

  /// Whether the scan sees the whole ball: nothing in it is left open.
  bool sees(const BallView& ball, std::uint64_t& tested) const;

  /// Whether it surely sees none of the balls about the places in a ball. @param least radius of the balls about them
  bool seesNoneIn(const BallView& ball, double least, std::uint64_t& tested) const;

  /// Whether no beam passed a place: it is in a hole, or all beams that count for its direction ended before it.
  /// @param place a ball of radius 0
  bool isDark(const BallView& place, std::uint64_t& tested) const;

private:
  BeamTree beams_;
  double angle_;
  BeamAngle speaks_; ///< for what is seen
  BeamAngle passes_; ///< for what is in shadow
  HoleMap holes_;
};

class SeenSpace::Storage {
public:
  std::vector<SeenScan> scans;
};

/// Checks of a SeenSpace's input. @throws InvalidInput
void checkScan(const ScanBeams& scan, std::size_t index);
void checkBeamAngle(double angle);

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// What scanners saw to be empty: the space that their beams passed through. Is a ball in it, or did nobody look there?
//
//   SeenSpace seen({{origin_1, viewOf(scan_1, n)}, {origin_2, viewOf(scan_2, m)}});
//   std::vector<Verdict> verdicts = collisionFlags({scans}, {robot, T_scans_robot}, {0.05, Side::b}).b;
//   UnseenResult found = markUnseen(seen, {robot, T_scans_robot}, {0.05}, verdicts); // what is free, but was not seen
//
// A beam speaks for the directions within an angle of its own: it says that they are empty up to its return, less the
// return's uncertainty and radius, and less the angle's share of that (0.002 of it at 0.002 radians), for edges of
// right angles and blunter ones come nearer than that between beams. A ball is seen by a scanner if for each direction
// in which it can be looked at (the directions of its cone; all, where the scanner is in the ball) there is such a
// beam, and each such beam is empty up to where this direction leaves the ball. One scanner that sees the whole ball
// suffices.
//
// So beams beside the cone count, and a share of each range does not. Of beams in the cone alone, and of their whole
// ranges, balls would be seen into which an edge comes between two beams.
//
// Seen is certain: what rounding leaves open is not seen. Not seen has tolerances: directions are judged in cells of a
// grid over the sphere, each of which one beam must speak for as a whole, so that a cell is a hole for certain where
// the angle to the nearest beam exceeds the given one, perhaps where it exceeds 0.6 of that, and else never; and a
// length of 2^-40 times the coordinates may decide either way.
//
// What the beams do not tell: things thinner than the angle leaves between beams, edges sharper than right angles,
// glass, and mixed pixels at edges, whose returns lie behind what was there.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The beams of one scanner from one place, in the frame and the unit that all scans share.
struct ScanBeams {
  Point3 origin = {0, 0, 0}; ///< where the beams began
  PointsView returns;        ///< where they ended; a record that is not finite, or at the origin, is no beam

  /// Beams without a return: a place on each, at any distance. They count only with a range.
  PointsView misses = {};
  double misses_beyond = 0.0; ///< no return means that there is nothing up to here; 0: it says nothing
};

/// How scans are read.
struct SeenOptions {
  /// For which directions beside its own a beam speaks, in radians, in [1e-4, 0.25]. None: measured of each scan, one
  /// and a half times the median, over its beams, of how far the nearest beams above, below and beside are.
  std::optional<double> angle = {};
  unsigned threads = 1; ///< 0: all of the machine's
};

/// Holds the scans' views, and 20 bytes a beam.
class SeenSpace {
public:
  /// @throws std::invalid_argument naming the value: an origin, an angle or a range that is not what its declaration
  ///   asks for; a view that a SphereHierarchy would refuse; no scan
  explicit SeenSpace(const std::vector<ScanBeams>& scans, const SeenOptions& options = {});
  ~SeenSpace();
  SeenSpace(SeenSpace&&) noexcept;
  SeenSpace& operator=(SeenSpace&&) noexcept;

  std::size_t size() const noexcept;             ///< scans
  double angle(std::size_t scan) const noexcept; ///< in use; radians. 0: it has less than two beams, and sees nothing
  std::size_t beams(std::size_t scan) const noexcept; ///< that say something

  class Storage; ///< for the queries
  const Storage& storage() const noexcept { return *storage_; }

private:
  std::unique_ptr<Storage> storage_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

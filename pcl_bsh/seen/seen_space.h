// SPDX-License-Identifier: BSD-3-Clause
// The space that scanners saw to be empty: their beams passed through it. Is a ball in it, or did nobody look there?
//
//   SeenSpace seen({{origin_1, viewOf(scan_1, n)}, {origin_2, viewOf(scan_2, m)}});
//   std::vector<Verdict> verdicts = collisionFlags({scans}, {robot, T_scans_robot}, {0.05, Flagged::b}).b;
//   UnseenResult found = markUnseen(seen, {robot, T_scans_robot}, {0.05}, verdicts); // what is free, but was not seen
//
// A direction lies between beams if beams lie on all sides of it: it is in a triangle of three beams within 1.2 angles.
// Nothing is known of other directions: beyond the outermost beams, in gaps, beside a single beam or row. A beam counts
// for the directions within 1.5 angles of its own. They are empty up to its return, less the return's uncertainty and
// radius, and less the angle's share of that (0.002 of it at 0.002 radians). A scanner looks at a ball in the
// directions of its cone, or in all where it is in the ball. It sees the ball if each of these directions, and each one
// within a third of the angle (0.334) of them, lies between beams. Also, each beam that counts for a direction of the
// cone has to be empty up to where the direction leaves the ball. One scanner that sees the whole ball suffices.
//
// This holds for the following worlds. In a direction between beams a plane that they met, at any slant, is no nearer
// than the nearest place where they met it, less 1 - cos(1.2 angles). A surface that bulges towards the scanner comes
// nearer by less than the angle's share under these conditions. A sphere: the beams round the direction are within the
// angle of it. An edge of a right angle or blunter: within 0.87 angles. A corner of three right angles: within two
// thirds. Beams of an even grid are so near, at the measured angle. Beams have to meet things. A scanner sees a thing
// at least two angles wide, also at its corners: then a beam of an even grid meets it beside each of its places. Single
// beams of the grid may be lost: a right angle then holds another beam within 1.5 angles. A corner that hangs over the
// last row, or into a gap, by more than half a step meets a beam of that row; by less, it is within the third of the
// angle.
//
// Seen is certain: what rounding leaves open is not seen. Not seen has tolerances: directions are judged in cells of a
// grid over the sphere, with edges of a quarter of the angle at most. A cell lies between beams if each of eight
// sectors of 135 degrees, which all of its places see, has a beam within the angle of the cell's middle. A length of
// 2^-40 times the coordinates may decide either way.
//
// The beams do not tell of things thinner than that, of edges and corners sharper than right angles, of things that
// throw nothing back between neighbouring beams, or of glass. Nor do they tell of mixed pixels at edges, whose returns
// lie behind the surface.
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
  /// How far a direction may be from the beams that it lies between, in radians, in [1e-4, 0.25]. None: measured of
  /// each scan, one and a half times the median, over its beams, of how far the nearest beams above, below and beside
  /// are.
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
  std::size_t beams(std::size_t scan) const noexcept; ///< how many beams count

  class Storage; ///< for the queries
  const Storage& storage() const noexcept { return *storage_; }

private:
  std::unique_ptr<Storage> storage_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

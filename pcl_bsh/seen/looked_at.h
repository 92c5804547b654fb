// SPDX-License-Identifier: BSD-3-Clause
// The beams of a scan that say something of a model at its poses: those in directions near the model. A SeenSpace of
// these beams gives the answers that one of all beams gives. It must have two beams if the scan has two.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/placed.h>

#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The directions in which models are looked for from one scanner, so that only beams that matter need to be kept.
class LookedAt {
public:
  /// @param angle that beams speak for. @throws std::invalid_argument as SeenSpace does
  LookedAt(const Point3& origin, double angle);

  /// Adds the directions near a model at a pose: those of balls about its points, of their radii and uncertainties and
  /// the clearance. A ball that holds the origin needs all beams.
  void add(const Placed& model, double clearance);

  bool holds(const Point3& end) const;                       ///< whether a beam that ended there counts
  bool holdsSome(const Point3& center, double radius) const; ///< whether a beam may that ended in it

private:
  class Walk;

  Point3 origin_;
  double angle_;
  bool all_ = false;
  std::vector<bool> cells_; ///< of directions
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

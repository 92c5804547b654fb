// SPDX-License-Identifier: BSD-3-Clause
// The beams of a scan that say something of a model at its poses: those in directions near the model. A SeenSpace of
// these gives the answers of one of all beams, if it holds two beams of the scan, where there are two.
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

  /// The model is asked about at this pose, too, with balls of its points' radii and uncertainties and the clearance. A
  /// ball about the origin needs all beams.
  void add(const Placed& model, double clearance);

  bool holds(const Point3& end) const;                       ///< whether a beam that ended there counts
  bool holdsSome(const Point3& center, double radius) const; ///< whether one may that ended in this ball

private:
  class Walk;

  Point3 origin_;
  double angle_;
  bool all_ = false;
  std::vector<bool> cells_; ///< of directions
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

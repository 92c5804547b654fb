// SPDX-License-Identifier: BSD-3-Clause
// Boxes about a cloud's points, wherever the cloud stands: what of a site may be near it is told by them in no time.
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/site/site.h>

#include <Eigen/Geometry>

#include <optional>
#include <vector>

namespace pcl_bsh::sites {

/// The box about a box that is moved, and larger by `reach` on all sides. Its rounding is paid for. All of space where
/// numbers overflow.
Bounds moved(const Bounds& box, const Eigen::Isometry3d& pose, double reach);

/// Whether they have a point in common.
bool overlap(const Bounds& a, const Bounds& b);

/// At most the distance of any points of both; 0 where the boxes overlap.
double leastDistance(const Bounds& a, const Bounds& b);

/// The smallest box about both.
Bounds joined(const Bounds& a, const Bounds& b);

/// Boxes, in the cloud's frame, about its finite points with their radii and uncertainties: about all of them, and
/// about those of each cell of a coarse grid.
class CloudBoxes {
public:
  explicit CloudBoxes(const PointsView& points);

  bool empty() const noexcept { return parts_.empty(); }
  const Bounds& whole() const { return *whole_; } ///< @pre not empty
  const std::vector<Bounds>& parts() const noexcept { return parts_; }
  double largestRadius() const noexcept { return largest_radius_; } ///< of a point

private:
  std::optional<Bounds> whole_;
  std::vector<Bounds> parts_;
  double largest_radius_ = 0.0;
};

} // namespace pcl_bsh::sites

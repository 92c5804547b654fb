// SPDX-License-Identifier: BSD-3-Clause
// Boxes about a cloud's points, wherever the cloud stands. They tell cheaply which tiles of a site may be near it.
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/site/site.h>

#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <vector>

namespace pcl_bsh::site {

/// Returns a box that holds the moved box, grown by `reach` on all sides and by a bound of the rounding. It has no
/// limit on an axis on which numbers overflow.
Bounds moved(const Bounds& box, const Eigen::Isometry3d& pose, double reach);

/// Whether they have a point in common.
bool overlap(const Bounds& a, const Bounds& b);

/// At most the distance of any points of both; 0 where the boxes overlap.
double leastDistance(const Bounds& a, const Bounds& b);

/// The smallest box about both.
Bounds joined(const Bounds& a, const Bounds& b);

/// Tells whether a point, moved by a pose, may be within a distance of a box. It is for many points, all of which lie
/// in the box `points`.
class PointsNear {
public:
  PointsNear(const Bounds& box, double distance, const Bounds& points, const Eigen::Isometry3d& pose);

  /// False: it is farther away, or not finite.
  bool operator()(const Point3& p) const
  {
    bool is_near = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const double place = rows_[k][0] * p[0] + rows_[k][1] * p[1] + rows_[k][2] * p[2] + rows_[k][3];
      is_near = is_near && place >= grown_.low[k] && place <= grown_.high[k];
    }
    return is_near;
  }

private:
  Bounds grown_; ///< the box, grown by the distance and a bound of the places' rounding
  std::array<std::array<double, 4>, 3> rows_;
};

/// Boxes, in the cloud's frame, about its finite points with their radii and uncertainties: one about all points, and
/// one about the points of each cell of a coarse grid.
class CloudBoxes {
public:
  explicit CloudBoxes(const PointsView& points);

  /// One box about points that are not in memory.
  explicit CloudBoxes(const Bounds& box) : whole_(box), parts_{box} {}

  bool empty() const noexcept { return parts_.empty(); }
  const Bounds& whole() const { return *whole_; } ///< @pre not empty
  const std::vector<Bounds>& parts() const noexcept { return parts_; }
  double largestRadius() const noexcept { return largest_radius_; } ///< of a point

private:
  std::optional<Bounds> whole_;
  std::vector<Bounds> parts_;
  double largest_radius_ = 0.0;
};

/// Returns the boxes about a cloud's points. @param whole return one box: the space between the parts counts, too
inline CloudBoxes boxesOf(const PointsView& points, bool whole)
{
  CloudBoxes boxes(points);
  return whole && !boxes.empty() ? CloudBoxes(boxes.whole()) : boxes;
}

} // namespace pcl_bsh::site

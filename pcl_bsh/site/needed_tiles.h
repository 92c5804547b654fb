// SPDX-License-Identifier: BSD-3-Clause
// The boxes of a site's tiles as balls that hold them, so that hierarchies answer for them.
#pragma once

#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/site/site.h>

#include <cstdint>
#include <vector>

namespace pcl_bsh::sites {

/// Some balls for each tile that has finite points: each point of the tile lies in one of them.
class TileBalls {
public:
  explicit TileBalls(const Site& site);

  /// The balls as points with radii.
  PointsView view() const;

  /// The tile of a ball.
  std::uint32_t tile(std::size_t ball) const { return tiles_[ball]; }
  std::size_t size() const { return tiles_.size(); }

private:
  void cover(const Bounds& bounds, std::uint32_t tile);

  std::vector<Point3> centers_;
  std::vector<float> radii_;
  std::vector<std::uint32_t> tiles_;
};

} // namespace pcl_bsh::sites

// SPDX-License-Identifier: BSD-3-Clause
// The tiles of a site that another is compared with, read when they are needed, and cut to the points that are near.
#pragma once

#include <pcl_bsh/site/answers/question_part.h>

#include <cstdint>
#include <list>
#include <set>
#include <utility>
#include <vector>

namespace pcl_bsh::site {

class ObstacleTiles {
public:
  /// @param memory bytes for the tiles that are kept, as the next question may need them, and for the hierarchy of one
  ///   tile
  /// @throws std::invalid_argument when the largest tile needs more, or its points cannot be so uncertain
  ObstacleTiles(const PlacedSite& site, std::uint64_t memory);

  /// Returns a lower bound of the distance from a box in the common frame to the points, wherever these truly are.
  /// None: it is greater than `distance`.
  std::optional<double> lowerBound(const Bounds& box, double distance) const;

  /// Calls compare(tile, its points that may be near, where they stand), the nearest tiles first, while tiles are
  /// within reach() of the box. Before each tile, reach() is called again: it may fall.
  template <typename Reach, typename Compare>
  void compare(const Bounds& box, const Reach& reach, const HierarchyOptions& building, const Compare& compare)
  {
    for (const auto& [lower, tile] : near(box, reach())) {
      if (lower > reach()) break;
      const PointsView points = cut(tile, box, reach());
      if (points.size() > 0) compare(last(), Placed(SphereHierarchy(points, building), site_.pose));
    }
  }

  /// All points of a tile. The view is valid until another tile is asked for.
  PointsView points(std::uint32_t tile);

  /// The tile that was asked for last.
  const pcl::PCLPointCloud2& last() const { return kept_.front().second; }

  /// Over all ranks: tiles, those that were needed, and how often one was read.
  TilesRead read() const;

private:
  const Tile& tile(std::uint32_t i) const { return site_.site.tiles[i]; }
  std::vector<std::pair<double, std::uint32_t>> near(const Bounds& box, double distance) const;
  PointsView cut(std::uint32_t tile, const Bounds& box, double distance);
  const pcl::PCLPointCloud2& load(std::uint32_t tile);

  PlacedSite site_;
  /// The tiles that were used last, the very last first. DIY's keeper of blocks is not used: it would write tiles to
  /// disk that are there already.
  std::list<std::pair<std::uint32_t, pcl::PCLPointCloud2>> kept_;
  std::uint64_t kept_points_ = 0, most_kept_points_ = 0;
  std::vector<std::pair<Bounds, std::uint32_t>> boxes_; ///< of tiles with points, wherever these truly are
  std::vector<std::int32_t> indices_;                   ///< of the points that are near, of the last tile
  std::set<std::uint32_t> needed_;
  std::uint64_t read_ = 0;
};

} // namespace pcl_bsh::site

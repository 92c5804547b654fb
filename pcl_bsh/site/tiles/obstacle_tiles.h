// SPDX-License-Identifier: BSD-3-Clause
// The tiles of a site that another is compared with: read when they are needed, and cut to what is near.
#pragma once

#include <pcl_bsh/site/collide_sites.h>

#include <cstdint>
#include <list>
#include <set>
#include <utility>
#include <vector>

namespace pcl_bsh::site {

class ObstacleTiles {
public:
  /// @param memory bytes for tiles that are kept, as the next question may need them, and the hierarchy of one
  /// @throws std::invalid_argument when the largest tile needs more, or its points cannot be so uncertain
  ObstacleTiles(const PlacedSite& site, std::uint64_t memory);

  /// The tiles that may have a point within the distance of a box in the common frame, wherever points truly are: those
  /// first that may be nearest, each with a lower bound of its distance.
  std::vector<std::pair<double, std::uint32_t>> near(const Bounds& box, double distance) const;

  /// The points of a tile that may be within the distance of the box, wherever they truly are. The view, whose records
  /// are the tile's, is good until `indices` or this changes.
  PointsView cut(std::uint32_t tile, const Bounds& box, double distance, std::vector<std::int32_t>& indices);

  /// All points of a tile, likewise.
  PointsView points(std::uint32_t tile);

  /// The tile that was asked for last.
  const pcl::PCLPointCloud2& last() const { return kept_.front().second; }

  const PlacedSite& site() const noexcept { return site_; }
  const Tile& tile(std::uint32_t i) const { return site_.site.tiles[i]; }

  /// Over all ranks: tiles, those that were needed, and how often one was read.
  TilesRead read() const;

private:
  const pcl::PCLPointCloud2& load(std::uint32_t tile);

  PlacedSite site_;
  /// Those that were used last, the very last first. DIY's keeper of blocks would write them to a disk of its own; they
  /// are on one.
  std::list<std::pair<std::uint32_t, pcl::PCLPointCloud2>> kept_;
  std::uint64_t kept_points_ = 0, most_kept_points_ = 0;
  std::vector<std::pair<Bounds, std::uint32_t>> boxes_; ///< of tiles with points, wherever these truly are
  std::set<std::uint32_t> needed_;
  std::uint64_t read_ = 0;
};

} // namespace pcl_bsh::site

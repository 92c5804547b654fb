// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/answers/tile_query.h>
#include <pcl_bsh/site/tiles/cloud_boxes.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>
#include <pcl_bsh/site/tiles/obstacle_tiles.h>
#include <pcl_bsh/site/tiles/tile_visitor.h>

#include <algorithm>

namespace pcl_bsh::site {

ObstacleTiles::ObstacleTiles(const PlacedSite& site, std::uint64_t memory) : site_(site)
{
  const TileVisitor largest(site.site, memory);
  most_kept_points_ = (memory - largest.bytesForLargest()) / std::max<std::size_t>(1, recordBytes(site.site));
  requireUncertainty(site.site, site.uncertainty);
  for (std::uint32_t i = 0; i < site.site.tiles.size(); ++i)
    if (tile(i).bounds) boxes_.emplace_back(moved(trueBounds(tile(i), site.uncertainty), site.pose, 0.0), i);
}

std::vector<std::pair<double, std::uint32_t>> ObstacleTiles::near(const Bounds& box, double distance) const
{
  std::vector<std::pair<double, std::uint32_t>> tiles;
  for (const auto& [other, i] : boxes_) {
    const double least = leastDistance(box, other);
    if (least <= distance) tiles.emplace_back(least, i);
  }
  std::sort(tiles.begin(), tiles.end());
  return tiles;
}

std::optional<double> ObstacleTiles::lowerBound(const Bounds& box, double distance) const
{
  const auto tiles = near(box, distance);
  return tiles.empty() ? std::nullopt : std::optional(tiles.front().first);
}

const pcl::PCLPointCloud2& ObstacleTiles::load(std::uint32_t i)
{
  const auto kept = std::find_if(kept_.begin(), kept_.end(), [&](const auto& entry) { return entry.first == i; });
  if (kept != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, kept);
    return kept_.front().second;
  }
  pcl::PCLPointCloud2 reused;
  while (!kept_.empty() && kept_points_ + tile(i).points > most_kept_points_) {
    kept_points_ -= kept_.back().second.width;
    reused = std::move(kept_.back().second);
    kept_.pop_back();
  }
  kept_.emplace_front(i, readTile(site_.site, tile(i), std::move(reused)));
  kept_points_ += tile(i).points;
  ++read_;
  return kept_.front().second;
}

PointsView ObstacleTiles::points(std::uint32_t i)
{
  needed_.insert(i);
  return TileQuery::pointsOf(load(i), site_.site, tile(i), site_.uncertainty);
}

PointsView ObstacleTiles::cut(std::uint32_t i, const Bounds& box, double distance)
{
  PointsView points = this->points(i);
  const PointsNear is_near(box, distance + straying(tile(i), site_.uncertainty), *tile(i).bounds, site_.pose);
  indices_.clear();
  indices_.reserve(points.count);
  for (std::uint32_t record = 0; record < points.count; ++record)
    if (is_near(points.point(record))) indices_.push_back(static_cast<std::int32_t>(record));
  if (indices_.size() == points.count) return points;
  points.restrictTo(indices_.data(), indices_.size());
  return points;
}

TilesRead ObstacleTiles::read() const
{
  TilesRead read;
  read.tiles = site_.site.tiles.size();
  const std::vector<double> own(needed_.begin(), needed_.end()); // numbers of 32 bits are exact as doubles
  const std::vector<double> all = gatheredFromAllRanks(own);
  read.needed = std::set<double>(all.begin(), all.end()).size();
  read.read = sumOfAllRanks(read_);
  return read;
}

} // namespace pcl_bsh::site

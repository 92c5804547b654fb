// SPDX-License-Identifier: BSD-3-Clause
// Compares a site, tile by tile, with a cloud in memory or with another site.
#pragma once

#include <pcl_bsh/site/answers/tile_query.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>
#include <pcl_bsh/site/tiles/obstacle_tiles.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace pcl_bsh::site {

/// A cloud that a site is compared with, always as a whole.
class ObstacleCloud {
public:
  /// @param solid its inside counts, too; then one box about the whole cloud is compared, as the inside may be far from
  ///   the boxes of its parts
  ObstacleCloud(const Placed& standing, bool solid)
  : cloud(standing),
    boxes_(boxesOf(cloud.hierarchy().view(), solid)),
    parts_(placedParts(boxes_, cloud.pose))
  {
  }

  std::optional<double> lowerBound(const Bounds& box, double distance) const
  {
    if (parts_.empty()) return std::nullopt;
    double least = infinity;
    for (const Bounds& part : parts_) least = std::min(least, leastDistance(box, part));
    if (least > distance) return std::nullopt;
    return least > 0.0 ? least : -boxes_.largestRadius(); // where boxes overlap, a point may be inside a ball
  }

  const Placed cloud;

private:
  CloudBoxes boxes_;
  std::vector<Bounds> parts_;
};

/// Compares each tile of a site with the parts of the other cloud or site that come near it.
class Comparison {
public:
  /// @param visited whose tiles are visited, with its uncertainty. @param other none: the obstacle in memory
  Comparison(const QuestionPart& part, const PlacedSite& visited, const std::optional<PlacedSite>& other)
  : visited_(visited),
    tile_query_(part, visited)
  {
    if (other)
      tiles_.emplace(*other, tile_query_.bytesLeft());
    else
      cloud_.emplace(Placed(part.model(), part.question.pose), part.question.solid);
    if (other) pose_of_other_ = other->pose;
  }

  bool isOfSites() const { return tiles_.has_value(); }

  /// Returns these points of the other site where they stand; or the whole cloud in memory, whatever `some` is.
  Placed standing(const SphereHierarchy& some) const { return cloud_ ? cloud_->cloud : Placed(some, pose_of_other_); }

  /// Calls query(a, b) with empty clouds in place of sites, so that it refuses wrong arguments where no tile is asked
  /// about.
  template <typename Query>
  void refuse(const Query& query) const
  {
    const SphereHierarchy nothing(PointsView{});
    query(Placed(nothing, visited_.pose), standing(nothing));
  }

  /// Calls ask(tile, cloud, its points where they stand) for tiles by ascending lower bounds, while these are at most
  /// least(). All ranks call least() whenever each has had a tile more.
  template <typename Ask, typename Least>
  TilesRead visit(double distance, const Ask& ask, const Least& least)
  {
    const auto tiles = tilesNear(distance);
    return tile_query_.visit(numbersOf(tiles), placed(ask), [&](std::size_t visited) {
      const double most = least();
      return visited < tiles.size() && tiles[visited].first <= most;
    });
  }

  /// As TileQuery::visitAndAdd(), with points where they stand, in the order of the site's tiles.
  template <typename Find, typename Add>
  TilesRead visitAndAdd(double distance, const Find& find, const Add& add)
  {
    std::vector<std::uint32_t> numbers = numbersOf(tilesNear(distance));
    std::sort(numbers.begin(), numbers.end());
    return tile_query_.visitAndAdd(numbers, placed(find), add, isOfSites());
  }

  /// Calls compare(tile, near points where they stand) for tiles of the other site, the nearest first, while they are
  /// within reach() of the given tile. Before each tile, reach() is called again: it may fall.
  template <typename Reach, typename Compare>
  void compareWithOther(const Tile& tile, const Reach& reach, const Compare& compare)
  {
    if (tiles_)
      tiles_->compare(boxOf(tile), reach, tile_query_.building(), compare);
    else
      compare(pcl::PCLPointCloud2(), cloud_->cloud);
  }

  TilesRead readOfOther() const { return tiles_ ? tiles_->read() : TilesRead(); }

private:
  using Tiles = std::vector<std::pair<double, std::uint32_t>>;

  /// Returns the box of the places where the points of a tile may truly be, in the common frame.
  Bounds boxOf(const Tile& tile) const
  {
    const Bounds box = trueBounds(tile, visited_.uncertainty);
    return visited_.pose.matrix().isIdentity(0.0) ? box : moved(box, visited_.pose, 0.0);
  }

  /// Returns the tiles within a distance of the other, by ascending lower bounds, each with its bound.
  Tiles tilesNear(double distance) const
  {
    Tiles tiles;
    for (std::uint32_t i = 0; i < visited_.site.tiles.size(); ++i) {
      if (!visited_.site.tiles[i].bounds) continue;
      const Bounds box = boxOf(visited_.site.tiles[i]);
      const auto lower = tiles_ ? tiles_->lowerBound(box, distance) : cloud_->lowerBound(box, distance);
      if (lower) tiles.emplace_back(*lower, i);
    }
    std::sort(tiles.begin(), tiles.end());
    return tiles;
  }

  static std::vector<std::uint32_t> numbersOf(const Tiles& tiles)
  {
    std::vector<std::uint32_t> numbers;
    for (const auto& [lower, tile] : tiles) numbers.push_back(tile);
    return numbers;
  }

  template <typename Ask>
  auto placed(const Ask& ask) const
  {
    return [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const SphereHierarchy& hierarchy) {
      return ask(tile, cloud, Placed(hierarchy, visited_.pose));
    };
  }

  const PlacedSite visited_;
  TileQuery tile_query_;
  std::optional<ObstacleCloud> cloud_; ///< in memory, or:
  std::optional<ObstacleTiles> tiles_;
  Eigen::Isometry3d pose_of_other_ = Eigen::Isometry3d::Identity();
};

} // namespace pcl_bsh::site

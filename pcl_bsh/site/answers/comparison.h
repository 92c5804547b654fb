// SPDX-License-Identifier: BSD-3-Clause
// A site and what it is compared with, tile by tile: a cloud in memory, or another site.
#pragma once

#include <pcl_bsh/site/answers/inquiry.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>
#include <pcl_bsh/site/tiles/obstacle_tiles.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace pcl_bsh::site {

/// A cloud that a site is compared with: all of it is near, where any is.
class ObstacleCloud {
public:
  /// @param solid it counts with what it encloses, far from all of its parts, perhaps
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

/// Each tile of a site, and what of the other cloud or site comes near it.
class Comparison {
public:
  /// @param visited whose tiles are visited, with its uncertainty. @param other none: the obstacle in memory
  Comparison(const Asked& asked, const PlacedSite& visited, const std::optional<PlacedSite>& other)
  : visited_(visited),
    inquiry_(asked, visited)
  {
    if (other)
      tiles_.emplace(*other, inquiry_.bytesLeft());
    else
      cloud_.emplace(Placed(asked.model(), asked.question.pose), asked.question.solid);
    if (other) pose_of_other_ = other->pose;
  }

  bool isOfSites() const { return tiles_.has_value(); }

  /// Some points of the other site where they stand, or the cloud, of which there is one.
  Placed standing(const SphereHierarchy& some) const { return cloud_ ? cloud_->cloud : Placed(some, pose_of_other_); }

  /// Calls query(a, b) with nothing in place of sites: what it refuses is refused although no tile may be asked about.
  template <typename Query>
  void refuse(const Query& query) const
  {
    const SphereHierarchy nothing(PointsView{});
    query(Placed(nothing, visited_.pose), standing(nothing));
  }

  /// Calls ask(tile, cloud, its points where they stand), those first that may be nearest, while their lower bounds are
  /// at most what least() says, which is asked whenever all ranks have had a tile more.
  template <typename Ask, typename Least>
  TilesRead visit(double distance, const Ask& ask, const Least& least)
  {
    const auto tiles = tilesNear(distance);
    return inquiry_.visit(numbersOf(tiles), placed(ask), [&](std::size_t visited) {
      const double most = least();
      return visited < tiles.size() && tiles[visited].first <= most;
    });
  }

  /// As Inquiry has it, with points where they stand, in the order of the site's tiles.
  template <typename Find, typename Add>
  TilesRead visitAndAdd(double distance, const Find& find, const Add& add)
  {
    std::vector<std::uint32_t> numbers = numbersOf(tilesNear(distance));
    std::sort(numbers.begin(), numbers.end());
    return inquiry_.visitAndAdd(numbers, placed(find), add, isOfSites());
  }

  /// Calls compare(a tile of the other site, those of its points that are near where they stand), nearest tiles first,
  /// while there are some within the reach of the tile, which is asked for before each: it may fall.
  template <typename Reach, typename Compare>
  void compareWithOther(const Tile& tile, const Reach& reach, const Compare& compare)
  {
    if (tiles_)
      tiles_->compare(boxOf(tile), reach, inquiry_.building(), compare);
    else
      compare(pcl::PCLPointCloud2(), cloud_->cloud);
  }

  TilesRead readOfOther() const { return tiles_ ? tiles_->read() : TilesRead(); }

private:
  using Tiles = std::vector<std::pair<double, std::uint32_t>>;

  /// Where the points of a tile may truly be, in the common frame.
  Bounds boxOf(const Tile& tile) const
  {
    const Bounds box = trueBounds(tile, visited_.uncertainty);
    return visited_.pose.matrix().isIdentity(0.0) ? box : moved(box, visited_.pose, 0.0);
  }

  /// Tiles that something of the other may come so near to: those first that may be nearest, each with a lower bound.
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
  Inquiry inquiry_;
  std::optional<ObstacleCloud> cloud_; ///< in memory, or:
  std::optional<ObstacleTiles> tiles_;
  Eigen::Isometry3d pose_of_other_ = Eigen::Isometry3d::Identity();
};

} // namespace pcl_bsh::site

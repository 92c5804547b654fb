// SPDX-License-Identifier: BSD-3-Clause
// A site and what it is compared with, tile by tile: a cloud in memory, or another site.
#pragma once

#include <pcl_bsh/site/answers/inquiry.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>
#include <pcl_bsh/site/tiles/obstacle_tiles.h>

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace pcl_bsh::site {

/// A cloud that a site is compared with: all of it is near, where any is.
class ObstacleCloud {
public:
  /// @param solid it counts with what it encloses, far from all of its parts, perhaps
  ObstacleCloud(const Placed& cloud, bool solid)
  : cloud_(cloud),
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

  template <typename Reach, typename Compare>
  void compare(const Bounds&, const Reach&, const HierarchyOptions&, const Compare& compare)
  {
    compare(pcl::PCLPointCloud2(), cloud_);
  }

  TilesRead read() const { return {}; }

private:
  const Placed& cloud_;
  CloudBoxes boxes_;
  std::vector<Bounds> parts_;
};

/// Each tile of a site, and what of the other cloud or site comes near it.
template <typename Other>
class Comparison {
public:
  /// @param asked whose tiles are visited. @param request with its uncertainty
  Comparison(const PlacedSite& asked, const Other& other, const SiteRequest& request)
  : asked_(asked),
    inquiry_(asked.site, request),
    other_(othersOf(other, request))
  {
    requireUncertainty(asked.site, asked.uncertainty);
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
    return inquiry_.visitAndAdd(numbers, placed(find), add, !std::is_same_v<Other, Placed>);
  }

  /// Calls compare(a tile of the other site, those of its points that are near where they stand), nearest tiles first,
  /// while there are some within the reach of the tile, which is asked for before each: it may fall.
  template <typename Reach, typename Compare>
  void compareWithOther(const Tile& tile, const Reach& reach, const Compare& compare)
  {
    other_.compare(boxOf(tile), reach, inquiry_.building(), compare);
  }

  TilesRead readOfOther() const { return other_.read(); }

private:
  auto othersOf(const Other& other, const SiteRequest& request) const
  {
    if constexpr (std::is_same_v<Other, Placed>)
      return ObstacleCloud(other, request.solid != nullptr);
    else
      return ObstacleTiles(other, request.memory - std::min(request.memory, inquiry_.bytesForLargest()));
  }

  using Tiles = std::vector<std::pair<double, std::uint32_t>>;

  /// Where the points of a tile may truly be, in the common frame.
  Bounds boxOf(const Tile& tile) const
  {
    const Bounds box = trueBounds(tile, asked_.uncertainty);
    return asked_.pose.matrix().isIdentity(0.0) ? box : moved(box, asked_.pose, 0.0);
  }

  /// Tiles that something of the other may come so near to: those first that may be nearest, each with a lower bound.
  Tiles tilesNear(double distance) const
  {
    Tiles tiles;
    for (std::uint32_t i = 0; i < asked_.site.tiles.size(); ++i) {
      if (!asked_.site.tiles[i].bounds) continue;
      if (const auto lower = other_.lowerBound(boxOf(asked_.site.tiles[i]), distance)) tiles.emplace_back(*lower, i);
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
      return ask(tile, cloud, Placed(hierarchy, asked_.pose));
    };
  }

  const PlacedSite& asked_;
  Inquiry inquiry_;
  std::conditional_t<std::is_same_v<Other, Placed>, ObstacleCloud, ObstacleTiles> other_;
};

} // namespace pcl_bsh::site

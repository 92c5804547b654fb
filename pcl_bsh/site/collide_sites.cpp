// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/site/answers/candidate.h>
#include <pcl_bsh/site/answers/inquiry.h>
#include <pcl_bsh/site/collide_sites.h>
#include <pcl_bsh/site/tiles/cloud_boxes.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>
#include <pcl_bsh/site/tiles/obstacle_tiles.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::site {

namespace {

/// Each tile of one site, and the tiles of the other that come near it.
class PairInquiry {
public:
  /// @param asked whose tiles are visited. @param request with its uncertainty
  PairInquiry(const PlacedSite& asked, const PlacedSite& other, const SiteRequest& request)
  : asked_(asked),
    inquiry_(asked.site, request),
    others_(other, request.memory - std::min(request.memory, inquiry_.bytesForLargest()))
  {
    requireUncertainty(asked.site, asked.uncertainty);
  }

  /// Where the points of a tile may truly be, in the common frame.
  Bounds boxOf(const Tile& tile) const { return moved(trueBounds(tile, asked_.uncertainty), asked_.pose, 0.0); }

  /// The tiles asked about that something of the other site may come so near to: those first that may be nearest, each
  /// with a lower bound of its distance.
  std::vector<std::pair<double, std::uint32_t>> tilesNear(double distance) const
  {
    std::vector<std::pair<double, std::uint32_t>> tiles;
    for (std::uint32_t i = 0; i < asked_.site.tiles.size(); ++i) {
      if (!asked_.site.tiles[i].bounds) continue;
      const auto near = others_.near(boxOf(asked_.site.tiles[i]), distance);
      if (!near.empty()) tiles.emplace_back(near.front().first, i);
    }
    std::sort(tiles.begin(), tiles.end());
    return tiles;
  }

  /// Calls ask(tile, cloud, its points where they stand), in this order of the tiles.
  template <typename Ask>
  TilesRead visit(const std::vector<std::pair<double, std::uint32_t>>& tiles, const Ask& ask,
                  const std::function<bool(std::size_t)>& go_on)
  {
    return inquiry_.visit(
        numbersOf(tiles),
        [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const SphereHierarchy& hierarchy) {
          ask(tile, cloud, Placed(hierarchy, asked_.pose));
        },
        go_on);
  }

  /// As Inquiry has it, with points where they stand, in the order of the site's tiles.
  template <typename Find, typename Add>
  TilesRead visitAndAdd(const std::vector<std::pair<double, std::uint32_t>>& tiles, const Find& find, const Add& add)
  {
    std::vector<std::uint32_t> numbers = numbersOf(tiles);
    std::sort(numbers.begin(), numbers.end());
    return inquiry_.visitAndAdd(
        numbers,
        [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const SphereHierarchy& hierarchy) {
          return find(tile, cloud, Placed(hierarchy, asked_.pose));
        },
        add, true);
  }

  /// Calls compare(a tile of the other site, those of its points that are near where they stand), nearest tiles first,
  /// while there are some within the distance of the tile, which is asked for before each: it may fall.
  template <typename Reach, typename Compare>
  void compareWithOthers(const Tile& tile, const Reach& reach, const Compare& compare)
  {
    const Bounds box = boxOf(tile);
    for (const auto& [lower, other] : others_.near(box, reach())) {
      if (lower > reach()) break;
      const PointsView near = others_.cut(other, box, reach(), indices_);
      if (near.size() > 0)
        compare(others_.last(), Placed(SphereHierarchy(near, inquiry_.building()), others_.site().pose));
    }
  }

  TilesRead readOfOthers() const { return others_.read(); }

private:
  static std::vector<std::uint32_t> numbersOf(const std::vector<std::pair<double, std::uint32_t>>& tiles)
  {
    std::vector<std::uint32_t> numbers;
    for (const auto& [lower, tile] : tiles) numbers.push_back(tile);
    return numbers;
  }

  const PlacedSite& asked_;
  Inquiry inquiry_;
  ObstacleTiles others_;
  std::vector<std::int32_t> indices_; ///< of points of a tile of the other site
};

/// Placed where nothing is: what is asked of it is refused as of any cloud.
struct Nothing {
  SphereHierarchy hierarchy{PointsView{}};
  Placed at(const Eigen::Isometry3d& pose) const { return {hierarchy, pose}; }
};

SiteRequest with(SiteRequest request, const Uncertainty& uncertainty)
{
  request.uncertainty = uncertainty;
  return request;
}

SitePairFlags flagsOf(const PlacedSite& asked, const PlacedSite& other, const SiteRequest& request,
                      const FlagsSink& sink)
{
  FlagsRequest wanted;
  wanted.clearance = request.clearance;
  wanted.accuracy = request.accuracy;
  wanted.threads = request.threads;
  const Nothing nothing;
  pcl_bsh::collisionFlags(nothing.at(asked.pose), nothing.at(other.pose), wanted); // refuses what no tile may be asked
  SitePairFlags result;
  PairInquiry inquiry(asked, other, request);
  const auto find = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const Placed& a) {
    FlagsResult all;
    all.a.assign(a.hierarchy().view().count, flagOf(Verdict::free));
    FlagsResult found;
    inquiry.compareWithOthers(
        tile, [&] { return request.clearance; },
        [&](const pcl::PCLPointCloud2&, const Placed& b) {
          pcl_bsh::collisionFlags(a, b, wanted, found);
          std::transform(all.a.begin(), all.a.end(), found.a.begin(), all.a.begin(), surer);
          all.work += found.work;
        });
    const auto counted = [&](Verdict verdict) {
      return static_cast<std::size_t>(std::count(all.a.begin(), all.a.end(), flagOf(verdict)));
    };
    all.colliding_a = counted(Verdict::colliding);
    all.undecided_a = counted(Verdict::undecided);
    if (sink) sink(tile, cloud, all);
    return std::vector<double>{static_cast<double>(all.colliding_a), static_cast<double>(all.undecided_a)};
  };
  const auto add = [&](const std::vector<double>& numbers) {
    result.colliding += static_cast<std::uint64_t>(numbers[0]);
    result.undecided += static_cast<std::uint64_t>(numbers[1]);
  };
  result.tiles = inquiry.visitAndAdd(inquiry.tilesNear(request.clearance), find, add);
  result.tiles_b = inquiry.readOfOthers();
  result.colliding = sumOfAllRanks(result.colliding);
  result.undecided = sumOfAllRanks(result.undecided);
  return result;
}

} // namespace

SitePairAny anyCollision(const Site& site, const PlacedSite& b, const SiteRequest& request)
{
  AnyRequest wanted;
  wanted.clearance = request.clearance;
  wanted.accuracy = request.accuracy;
  wanted.threads = request.threads;
  const Nothing nothing;
  pcl_bsh::anyCollision(nothing.at(Eigen::Isometry3d::Identity()), nothing.at(b.pose), wanted);
  const PlacedSite asked{site, Eigen::Isometry3d::Identity(), request.uncertainty};
  PairInquiry inquiry(asked, b, request);
  bool collides = false, is_undecided = false;
  const auto ask = [&](const Tile& tile, const pcl::PCLPointCloud2&, const Placed& a) {
    inquiry.compareWithOthers(
        tile, [&] { return collides ? -1.0 : request.clearance; },
        [&](const pcl::PCLPointCloud2&, const Placed& other) {
          const Verdict verdict = pcl_bsh::anyCollision(a, other, wanted).verdict;
          collides = verdict == Verdict::colliding;
          is_undecided = is_undecided || verdict == Verdict::undecided;
        });
  };
  SitePairAny result;
  result.tiles = inquiry.visit(inquiry.tilesNear(request.clearance), ask,
                               [&](std::size_t) { return !(collides = sumOfAllRanks(collides ? 1 : 0) > 0); });
  result.tiles_b = inquiry.readOfOthers();
  result.verdict = verdictOfAllRanks(collides, is_undecided);
  return result;
}

SitePairFlags collisionFlags(const Site& site, const PlacedSite& b, const SiteRequest& request, const FlagsSink& sink)
{
  return flagsOf({site, Eigen::Isometry3d::Identity(), request.uncertainty}, b, request, sink);
}

SitePairFlags collisionFlagsOfB(const Site& site, const PlacedSite& b, const SiteRequest& request,
                                const FlagsSink& sink)
{
  const PlacedSite a{site, Eigen::Isometry3d::Identity(), request.uncertainty};
  return flagsOf(b, a, with(request, b.uncertainty), sink);
}

SitePairClosest closestPair(const Site& site, const PlacedSite& placed, const SiteRequest& asked)
{
  const SiteRequest request = with(asked, {});
  const PlacedSite a{site, Eigen::Isometry3d::Identity(), {}}, b{placed.site, placed.pose, {}};
  DistanceRequest wanted;
  wanted.accuracy = request.accuracy;
  wanted.threads = request.threads;
  const Nothing nothing;
  pcl_bsh::closestPair(nothing.at(a.pose), nothing.at(b.pose), wanted);
  PairInquiry inquiry(a, b, request);
  const auto by_distance = inquiry.tilesNear(infinity);
  double least = infinity, lower = infinity;
  std::vector<Candidate> candidates_a, candidates_b;
  const auto ask = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const Placed& points) {
    inquiry.compareWithOthers(
        tile, [&] { return least; },
        [&](const pcl::PCLPointCloud2& other, const Placed& others) {
          const DistanceResult found = pcl_bsh::closestPair(points, others, wanted);
          lower = std::min(lower, found.interval.lower);
          if (!found.pair || found.distance > least) return;
          least = found.distance;
          candidates_a.push_back(
              {points.hierarchy().view().point(found.pair->a), nameOf(cloud, found.pair->a), found.distance});
          candidates_b.push_back(
              {others.hierarchy().view().point(found.pair->b), nameOf(other, found.pair->b), found.distance});
        });
  };
  const auto go_on = [&](std::size_t visited) {
    least = leastOfAllRanks(least);
    return visited < by_distance.size() && by_distance[visited].first <= least;
  };
  SitePairClosest result;
  result.tiles = inquiry.visit(by_distance, ask, go_on);
  result.tiles_b = inquiry.readOfOthers();

  // Distances that round to the same double may differ: the nearest of each two tiles are compared once more, exactly.
  const Candidates last_a(candidates_a, least), last_b(candidates_b, least);
  lower = leastOfAllRanks(lower);
  if (last_a.points.empty()) return result;
  wanted.accuracy = {};
  const DistanceResult nearest =
      pcl_bsh::closestPair({last_a.hierarchy(), a.pose}, {last_b.hierarchy(), b.pose}, wanted);
  result.interval = {std::min(lower, nearest.interval.lower), nearest.interval.upper};
  result.distance = nearest.distance;
  result.point = last_a.points[nearest.pair->a];
  result.point_b = last_b.points[nearest.pair->b];
  return result;
}

SitePairDistances pointDistances(const Site& site, const PlacedSite& placed, double max_distance,
                                 const SiteRequest& asked, const PairDistancesSink& sink)
{
  const SiteRequest request = with(asked, {});
  const PlacedSite a{site, Eigen::Isometry3d::Identity(), {}}, b{placed.site, placed.pose, {}};
  if (request.accuracy.stopsEarly())
    throw std::invalid_argument("accuracy " + request.accuracy.text() +
                                ": distances of two sites cannot stop early: give exact, float or a tolerance");
  PointDistancesRequest wanted;
  wanted.max_distance = max_distance;
  wanted.accuracy = request.accuracy;
  wanted.threads = request.threads;
  const Nothing nothing;
  pcl_bsh::pointDistances(nothing.at(a.pose), nothing.at(b.pose), wanted);
  SitePairDistances result;
  double greatest = -infinity;
  PairInquiry inquiry(a, b, request);
  const auto find = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const Placed& points) {
    const PointsView& view = points.hierarchy().view();
    std::vector<double> distance(view.count, std::numeric_limits<double>::quiet_NaN());
    double reach = max_distance; // what is farther than all points' distances changes none
    inquiry.compareWithOthers(
        tile, [&] { return reach; },
        [&](const pcl::PCLPointCloud2&, const Placed& others) {
          PointDistancesRequest nearer = wanted;
          nearer.max_distance = reach;
          const PointDistances found = pcl_bsh::pointDistances(points, others, nearer);
          double farthest = 0.0;
          for (std::uint32_t i = 0; i < view.count; ++i) {
            distance[i] = std::fmin(distance[i], found.distance[i]); // the one that is a number
            if (!isFinite(view.point(i))) continue;
            farthest = std::isnan(distance[i]) ? infinity : std::max(farthest, distance[i]);
          }
          reach = std::min(reach, farthest);
        });
    std::vector<double> numbers = {0.0, -infinity};
    for (const double d : distance) {
      if (std::isnan(d)) continue;
      ++numbers[0];
      numbers[1] = std::max(numbers[1], d);
    }
    if (sink) sink(tile, cloud, distance);
    return numbers;
  };
  const auto add = [&](const std::vector<double>& numbers) {
    result.measured += static_cast<std::uint64_t>(numbers[0]);
    greatest = std::max(greatest, numbers[1]);
  };
  result.tiles = inquiry.visitAndAdd(inquiry.tilesNear(max_distance), find, add);
  result.tiles_b = inquiry.readOfOthers();
  result.measured = sumOfAllRanks(result.measured);
  greatest = -leastOfAllRanks(-greatest);
  if (result.measured > 0) result.greatest = greatest;
  return result;
}

} // namespace pcl_bsh::site

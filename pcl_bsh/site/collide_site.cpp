// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/surface_distances.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/site/answers/candidate.h>
#include <pcl_bsh/site/answers/inquiry.h>
#include <pcl_bsh/site/answers/passage_sum.h>
#include <pcl_bsh/site/collide_site.h>
#include <pcl_bsh/site/tiles/needed_tiles.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::site {

namespace {

/// The same where only measured places count.
SiteRequest measured(SiteRequest request)
{
  request.uncertainty = {};
  return request;
}

} // namespace

SiteAny anyCollision(const Site& site, const Placed& b, const SiteRequest& request)
{
  SiteAny result;
  AnyRequest wanted;
  wanted.clearance = request.clearance;
  wanted.accuracy = request.accuracy;
  wanted.threads = request.threads;
  pcl_bsh::anyCollision({SphereHierarchy(PointsView{})}, b, wanted); // refuses what no tile may be asked about
  requireUncertainty(site, request.uncertainty);
  bool collides = false, is_undecided = false;
  Inquiry inquiry(site, request);
  const auto ask = [&](const Tile&, const pcl::PCLPointCloud2&, const SphereHierarchy& hierarchy) {
    const Verdict verdict = pcl_bsh::anyCollision({hierarchy}, b, wanted).verdict;
    collides = verdict == Verdict::colliding;
    is_undecided = is_undecided || verdict == Verdict::undecided;
  };
  result.tiles = inquiry.visit(tilesWithin(site, b, request.clearance, request.uncertainty), ask,
                               [&](std::size_t) { return !(collides = sumOfAllRanks(collides ? 1 : 0) > 0); });
  result.verdict = verdictOfAllRanks(collides, is_undecided);
  return result;
}

SiteFlags collisionFlags(const Site& site, const Placed& b, Side flagged, const SiteRequest& request,
                         const FlagsSink& sink)
{
  SiteFlags result;
  const bool of_b = flagged != Side::a;
  FlagsRequest wanted;
  wanted.clearance = request.clearance;
  wanted.accuracy = request.accuracy;
  wanted.flagged = of_b ? Side::both : Side::a;
  wanted.threads = request.threads;
  pcl_bsh::collisionFlags({SphereHierarchy(PointsView{})}, b, wanted); // refuses what no tile may be asked about
  requireUncertainty(site, request.uncertainty);
  if (of_b) result.b.assign(b.hierarchy().view().count, 0);
  Inquiry inquiry(site, request);
  const auto find = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const SphereHierarchy& hierarchy) {
    const FlagsResult flags = pcl_bsh::collisionFlags({hierarchy}, b, wanted);
    std::vector<double> numbers = {static_cast<double>(flags.colliding_a), static_cast<double>(flags.undecided_a)};
    for (std::size_t i = 0; i < flags.b.size(); ++i)
      if (flags.b[i] != 0) numbers.insert(numbers.end(), {static_cast<double>(i), static_cast<double>(flags.b[i])});
    if (sink) sink(tile, cloud, flags);
    return numbers;
  };
  const auto add_flags = [&](const std::vector<double>& numbers, std::size_t begin) {
    for (std::size_t k = begin; k < numbers.size(); k += 2) {
      std::uint8_t& flag = result.b[static_cast<std::size_t>(numbers[k])];
      flag = surer(flag, static_cast<std::uint8_t>(numbers[k + 1]));
    }
  };
  const auto add = [&](const std::vector<double>& numbers) {
    result.colliding += static_cast<std::uint64_t>(numbers[0]);
    result.undecided += static_cast<std::uint64_t>(numbers[1]);
    add_flags(numbers, 2);
  };
  result.tiles = inquiry.visitAndAdd(tilesWithin(site, b, request.clearance, request.uncertainty), find, add);
  result.colliding = sumOfAllRanks(result.colliding);
  result.undecided = sumOfAllRanks(result.undecided);
  if (ranks() > 1 && of_b) {
    std::vector<double> own;
    for (std::size_t i = 0; i < result.b.size(); ++i)
      if (result.b[i] != 0) own.insert(own.end(), {static_cast<double>(i), static_cast<double>(result.b[i])});
    add_flags(gatheredFromAllRanks(own), 0);
  }
  const auto counted = [&](Verdict verdict) {
    return static_cast<std::uint64_t>(std::count(result.b.begin(), result.b.end(), flagOf(verdict)));
  };
  result.colliding_b = counted(Verdict::colliding);
  result.undecided_b = counted(Verdict::undecided);
  return result;
}

SiteClosest closestPair(const Site& site, const Placed& b, const SiteRequest& asked)
{
  const SiteRequest request = measured(asked);
  DistanceRequest wanted;
  wanted.accuracy = request.accuracy;
  wanted.threads = request.threads;
  pcl_bsh::closestPair({SphereHierarchy(PointsView{})}, b, wanted); // refuses a pose that no tile may be asked about
  const auto by_distance = tilesByDistance(site, b);
  std::vector<std::uint32_t> tiles;
  for (const auto& [lower, tile] : by_distance) tiles.push_back(tile);
  double least = infinity, lower = infinity;
  std::vector<Candidate> candidates;
  Inquiry inquiry(site, request);
  const auto ask = [&](const Tile&, const pcl::PCLPointCloud2& cloud, const SphereHierarchy& hierarchy) {
    const DistanceResult found = pcl_bsh::closestPair({hierarchy}, b, wanted);
    lower = std::min(lower, found.interval.lower);
    if (!found.pair || found.distance > least) return;
    least = found.distance;
    candidates.push_back({hierarchy.view().point(found.pair->a), nameOf(cloud, found.pair->a), found.distance});
  };
  const auto go_on = [&](std::size_t visited) {
    least = leastOfAllRanks(least);
    return visited < tiles.size() && by_distance[visited].first <= least;
  };
  SiteClosest result;
  result.tiles = inquiry.visit(tiles, ask, go_on);

  // Distances that round to the same double may differ: the nearest of each tile are compared once more, exactly.
  const Candidates last(candidates, least);
  lower = leastOfAllRanks(lower);
  if (last.points.empty()) return result;
  wanted.accuracy = {};
  DistanceResult nearest = pcl_bsh::closestPair({last.hierarchy()}, b, wanted);
  nearest.interval.lower = std::min(lower, nearest.interval.lower);
  if (request.surface) tellOfSurface(*request.surface, nearest);
  result.interval = nearest.interval;
  result.distance = nearest.distance;
  result.point = last.points[nearest.pair->a];
  result.b = nearest.pair->b;
  return result;
}

SiteDistances pointDistances(const Site& site, const Placed& b, double max_distance, const SiteRequest& asked,
                             const DistancesSink& sink)
{
  const SiteRequest request = measured(asked);
  SiteDistances result;
  PointDistancesRequest wanted;
  wanted.max_distance = max_distance;
  wanted.accuracy = request.accuracy;
  wanted.threads = request.threads;
  pcl_bsh::pointDistances({SphereHierarchy(PointsView{})}, b, wanted); // refuses what no tile may be asked about
  double greatest = -infinity;
  Inquiry inquiry(site, request);
  const auto find = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const SphereHierarchy& hierarchy) {
    PointDistances found = pcl_bsh::pointDistances({hierarchy}, b, wanted);
    if (request.surface) tellOfSurface(*request.surface, found);
    if (sink) sink(tile, cloud, found);
    return std::vector<double>{static_cast<double>(found.measured), static_cast<double>(found.undecided),
                               found.greatest};
  };
  const auto add = [&](const std::vector<double>& numbers) {
    result.measured += static_cast<std::uint64_t>(numbers[0]);
    result.undecided += static_cast<std::uint64_t>(numbers[1]);
    if (numbers[0] > 0) greatest = std::max(greatest, numbers[2]);
  };
  std::vector<std::uint32_t> tiles;
  if (max_distance < infinity)
    tiles = tilesWithin(site, b, max_distance);
  else
    tiles = tilesWithPoints(site, b);
  result.tiles = inquiry.visitAndAdd(tiles, find, add);
  result.measured = sumOfAllRanks(result.measured);
  result.undecided = sumOfAllRanks(result.undecided);
  greatest = -leastOfAllRanks(-greatest);
  if (result.measured > 0) result.greatest = greatest;
  return result;
}

SitePassage collideAlong(const Site& site, const SphereHierarchy& model, const std::vector<Eigen::Isometry3d>& poses,
                         const SiteRequest& request, const PassageSink& sink)
{
  const TrajectoryRequest wanted = alongPath(request);
  refusePassage(site, model, poses, wanted);
  requireUncertainty(site, request.uncertainty);
  PassageSum sum(request, poses.size());
  Inquiry inquiry(site, request);
  const auto find = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const SphereHierarchy& hierarchy) {
    TrajectoryResult found = pcl_bsh::collideAlong({hierarchy}, model, poses, wanted);
    if (request.surface) tellOfSurface(found);
    if (sink) sink(tile, cloud, found);
    return sum.numbersOf(tile, cloud, found);
  };
  const std::vector<std::uint32_t> tiles = tilesAlong(site, model, poses, pathReach(request), request.uncertainty);
  const TilesRead read = inquiry.visitAndAdd(tiles, find, [&](const auto& numbers) { sum.add(numbers); });
  SitePassage result = sum.ofAllRanks();
  result.tiles = read;
  return result;
}

} // namespace pcl_bsh::site

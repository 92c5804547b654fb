// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/collision/any_collision.h>
#include <pcl_bsh/collision/closest_pair.h>
#include <pcl_bsh/site/candidate.h>
#include <pcl_bsh/site/collide_site.h>
#include <pcl_bsh/site/inquiry.h>
#include <pcl_bsh/site/needed_tiles.h>
#include <pcl_bsh/trajectory/add_summary.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcl_bsh::sites {

namespace {

/// The same where only measured places count.
SiteRequest measured(SiteRequest request)
{
  request.uncertainty = {};
  return request;
}

/// Refuses what the query would refuse of the whole site, although no tile may be asked: the site's corners are.
void refuse(const Site& site, const SphereHierarchy& model, const std::vector<Eigen::Isometry3d>& poses,
            const TrajectoryRequest& request)
{
  std::vector<Point3> corners;
  if (site.bounds) corners = {site.bounds->low, site.bounds->high};
  const SphereHierarchy scan(viewOf(corners.empty() ? nullptr : corners.front().data(), corners.size()));
  pcl_bsh::collideAlong({scan}, model, poses, request);
}

/// Its number, as those of poses, is exact as a double.
constexpr FirstContact no_contact = {std::size_t{1} << 53, 1.0};

FirstContact earlier(const FirstContact& a, const FirstContact& b)
{
  return std::pair(b.pose, b.fraction) < std::pair(a.pose, a.fraction) ? b : a;
}

/// @pre one of them is a contact
FirstContact earliestOfAllRanks(const FirstContact& own)
{
  const double pose = leastOfAllRanks(static_cast<double>(own.pose));
  const bool mine = static_cast<double>(own.pose) == pose;
  return {static_cast<std::size_t>(pose), leastOfAllRanks(mine ? own.fraction : 1.0)};
}

/// What `more` says of other points of the site, too.
void add(std::vector<PoseSummary>& poses, const std::vector<PoseSummary>& more)
{
  poses.resize(std::max(poses.size(), more.size()));
  for (std::size_t k = 0; k < more.size(); ++k) addSummary(poses[k], more[k]);
}

void append(std::vector<double>& numbers, const std::vector<PoseSummary>& poses)
{
  for (const PoseSummary& pose : poses) {
    numbers.insert(numbers.end(), {pose.colliding ? 1.0 : 0.0, static_cast<double>(pose.colliding_points),
                                   static_cast<double>(pose.undecided_points), pose.distance});
  }
}

std::vector<PoseSummary> posesOf(const std::vector<double>& numbers, std::size_t begin, std::size_t end)
{
  std::vector<PoseSummary> poses;
  for (std::size_t i = begin; i < end; i += 4) {
    poses.push_back({numbers[i] != 0.0, static_cast<std::size_t>(numbers[i + 1]),
                     static_cast<std::size_t>(numbers[i + 2]), numbers[i + 3]});
  }
  return poses;
}

std::vector<PoseSummary> summedOverAllRanks(const std::vector<PoseSummary>& own)
{
  std::vector<double> numbers;
  append(numbers, own);
  const std::vector<double> all = gatheredFromAllRanks(numbers);
  std::vector<PoseSummary> sum;
  for (std::size_t begin = 0; begin < all.size(); begin += numbers.size())
    add(sum, posesOf(all, begin, begin + numbers.size()));
  return sum;
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
  const DistanceResult nearest = pcl_bsh::closestPair({last.hierarchy()}, b, wanted);
  result.interval = {std::min(lower, nearest.interval.lower), nearest.interval.upper};
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
    const PointDistances found = pcl_bsh::pointDistances({hierarchy}, b, wanted);
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
  TrajectoryRequest wanted;
  wanted.clearance = request.clearance;
  wanted.accuracy = request.accuracy;
  wanted.threads = request.threads;
  const bool measures = !request.accuracy.stopsEarly();
  wanted.distances = wanted.first_poses = wanted.closest_poses = measures;
  wanted.swept = request.swept;
  wanted.pivot = request.pivot;
  wanted.pose_summaries = request.pose_summaries;
  refuse(site, model, poses, wanted);
  requireUncertainty(site, request.uncertainty);

  PathReach reach;
  // Colliding is what comes within clearance + tolerance.
  reach.distance = request.clearance + request.swept.value_or(0.0);
  reach.moves = request.swept.has_value();
  reach.pivot = request.pivot;
  SitePassage result;
  if (request.pose_summaries) result.poses.resize(poses.size());
  double least = infinity, first = infinity;
  FirstContact contact = no_contact, certain = no_contact;
  Inquiry inquiry(site, request);
  const auto find = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const SphereHierarchy& hierarchy) {
    const TrajectoryResult found = pcl_bsh::collideAlong({hierarchy}, model, poses, wanted);
    double nearest = infinity, earliest = infinity;
    for (std::size_t i = 0; i < found.distance.size(); ++i) {
      if (found.flags[i] == 0) continue;
      nearest = std::min(nearest, double{found.distance[i]});
      earliest = std::min(earliest, static_cast<double>(found.first_pose[i]));
    }
    std::vector<double> numbers = {static_cast<double>(found.colliding), static_cast<double>(found.undecided), nearest,
                                   earliest};
    for (const auto& met : {found.first_contact, found.certain_contact})
      numbers.insert(numbers.end(),
                     {static_cast<double>(met.value_or(no_contact).pose), met.value_or(no_contact).fraction});
    append(numbers, found.poses);
    if (sink) sink(tile, cloud, found);
    return numbers;
  };
  const auto add_tile = [&](const std::vector<double>& numbers) {
    result.colliding += static_cast<std::uint64_t>(numbers[0]);
    result.undecided += static_cast<std::uint64_t>(numbers[1]);
    least = std::min(least, numbers[2]);
    first = std::min(first, numbers[3]);
    contact = earlier(contact, {static_cast<std::size_t>(numbers[4]), numbers[5]});
    certain = earlier(certain, {static_cast<std::size_t>(numbers[6]), numbers[7]});
    add(result.poses, posesOf(numbers, 8, numbers.size()));
  };
  result.tiles = inquiry.visitAndAdd(tilesAlong(site, model, poses, reach, request.uncertainty), find, add_tile);
  result.colliding = sumOfAllRanks(result.colliding);
  result.undecided = sumOfAllRanks(result.undecided);
  if (request.pose_summaries) result.poses = summedOverAllRanks(result.poses);
  least = leastOfAllRanks(least);
  first = leastOfAllRanks(first);
  if (measures && result.colliding + result.undecided > 0) {
    result.distance = static_cast<float>(least);
    result.first_pose = static_cast<std::int32_t>(first);
    if (request.swept) result.first_contact = earliestOfAllRanks(contact);
  }
  if (sumOfAllRanks(certain.pose == no_contact.pose ? 0 : 1) > 0) result.certain_contact = earliestOfAllRanks(certain);
  return result;
}

} // namespace pcl_bsh::sites

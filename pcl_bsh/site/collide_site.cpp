// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/site/answers/comparison.h>
#include <pcl_bsh/site/answers/held.h>
#include <pcl_bsh/site/collide_site.h>
#include <pcl_bsh/site/tiles/records.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace pcl_bsh::site {

namespace {

/// Calls query(a, b) with nothing in place of sites: what it refuses is refused although no tile may be asked about.
template <typename Query>
void refuse(const Eigen::Isometry3d& pose, const Placed& b, const Query& query)
{
  query(Placed(SphereHierarchy(PointsView{}), pose), b);
}

template <typename Query>
void refuse(const Eigen::Isometry3d& pose, const PlacedSite& b, const Query& query)
{
  const SphereHierarchy nothing(PointsView{});
  query(Placed(nothing, pose), Placed(nothing, b.pose));
}

PlacedSite asFirst(const Site& site, const Uncertainty& uncertainty = {})
{
  return {site, Eigen::Isometry3d::Identity(), uncertainty};
}

SiteRequest with(SiteRequest request, const Uncertainty& uncertainty)
{
  request.uncertainty = uncertainty;
  return request;
}

/// A point of a site that may be nearest to something: the nearest of a tile.
struct Candidate {
  Point3 place;
  SitePoint point;
  double distance;
};

/// Those of all ranks that have a distance, of which exact arithmetic chooses, in the order of their names.
struct Candidates {
  Candidates(const std::vector<Candidate>& own, double distance)
  {
    std::vector<Candidate> last = gatheredFromAllRanks(own);
    std::erase_if(last, [&](const Candidate& c) { return c.distance != distance; });
    std::sort(last.begin(), last.end(), [](const Candidate& c, const Candidate& d) { return c.point < d.point; });
    for (const Candidate& c : last) {
      places.push_back(c.place);
      points.push_back(c.point);
    }
  }

  SphereHierarchy hierarchy() const
  {
    return SphereHierarchy(viewOf(places.empty() ? nullptr : places.front().data(), places.size()));
  }

  std::vector<Point3> places;
  std::vector<SitePoint> points;
};

template <typename Other>
SiteAny anyOf(const PlacedSite& asked, const Other& b, const SiteRequest& request)
{
  const auto wanted = wantedOf<AnyRequest>(request);
  const auto query = [&](const Placed& x, const Placed& y) {
    AnyResult found = pcl_bsh::anyCollision(x, y, wanted);
    addHeldOf(request, x, y, found);
    return found.verdict;
  };
  refuse(asked.pose, b, query);
  Comparison<Other> comparison(asked, b, request);
  bool collides = false, is_undecided = false;
  const auto ask = [&](const Tile& tile, const pcl::PCLPointCloud2&, const Placed& a) {
    comparison.compareWithOther(
        tile, [&] { return collides ? -infinity : request.clearance; },
        [&](const pcl::PCLPointCloud2&, const Placed& other) {
          const Verdict verdict = query(a, other);
          collides = verdict == Verdict::colliding;
          is_undecided = is_undecided || verdict == Verdict::undecided;
        });
  };
  SiteAny result;
  result.tiles = comparison.visit(request.clearance, ask, [&] {
    collides = sumOfAllRanks(collides ? 1 : 0) > 0;
    return collides ? -infinity : infinity;
  });
  result.tiles_b = comparison.readOfOther();
  result.verdict = verdictOfAllRanks(collides, is_undecided);
  return result;
}

template <typename Other>
SiteFlags flagsOf(const PlacedSite& asked, const Other& b, Side flagged, const SiteRequest& request,
                  const FlagsSink& sink)
{
  SiteFlags result;
  const bool of_b = flagged != Side::a;
  auto wanted = wantedOf<FlagsRequest>(request);
  wanted.flagged = of_b || request.solid ? Side::both : Side::a;
  refuse(asked.pose, b, [&](const Placed& x, const Placed& y) { pcl_bsh::collisionFlags(x, y, wanted); });
  if constexpr (std::is_same_v<Other, Placed>)
    if (of_b) result.b.assign(b.hierarchy().view().count, Verdict::free);
  Comparison<Other> comparison(asked, b, request);
  const auto append_b = [](const std::vector<Verdict>& flags, std::vector<double>& numbers) {
    for (std::size_t i = 0; i < flags.size(); ++i)
      if (flags[i] != Verdict::free)
        numbers.insert(numbers.end(), {static_cast<double>(i), static_cast<double>(flags[i])});
  };
  const auto find = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const Placed& a) {
    FlagsResult all, found;
    all.a.assign(a.hierarchy().view().count, Verdict::free);
    comparison.compareWithOther(
        tile, [&] { return request.clearance; },
        [&](const pcl::PCLPointCloud2&, const Placed& other) {
          pcl_bsh::collisionFlags(a, other, wanted, found);
          addHeldOf(request, a, other, found);
          join(all.a, found.a);
          all.work += found.work;
        });
    all.b = std::move(found.b); // of a cloud, of which there is one
    all.colliding_a = countOf(all.a, Verdict::colliding);
    all.undecided_a = countOf(all.a, Verdict::undecided);
    if (sink) sink(tile, cloud, all);
    std::vector<double> numbers = {static_cast<double>(all.colliding_a), static_cast<double>(all.undecided_a)};
    if (of_b) append_b(all.b, numbers);
    return numbers;
  };
  const auto add_flags = [&](const std::vector<double>& numbers, std::size_t begin) {
    for (std::size_t k = begin; k < numbers.size(); k += 2) {
      Verdict& flag = result.b[static_cast<std::size_t>(numbers[k])];
      flag = graver(flag, static_cast<Verdict>(numbers[k + 1]));
    }
  };
  const auto add = [&](const std::vector<double>& numbers) {
    result.colliding += static_cast<std::uint64_t>(numbers[0]);
    result.undecided += static_cast<std::uint64_t>(numbers[1]);
    add_flags(numbers, 2);
  };
  result.tiles = comparison.visitAndAdd(request.clearance, find, add);
  result.tiles_b = comparison.readOfOther();
  result.colliding = sumOfAllRanks(result.colliding);
  result.undecided = sumOfAllRanks(result.undecided);
  if (ranks() > 1 && of_b) {
    std::vector<double> own;
    append_b(result.b, own);
    add_flags(gatheredFromAllRanks(own), 0);
  }
  result.colliding_b = countOf(result.b, Verdict::colliding);
  result.undecided_b = countOf(result.b, Verdict::undecided);
  return result;
}

template <typename Other>
SiteClosest closestOf(const PlacedSite& asked, const Other& b, const SiteRequest& request)
{
  auto wanted = wantedOf<DistanceRequest>(request);
  const auto query = [&](const Placed& x, const Placed& y) {
    DistanceResult found = pcl_bsh::closestPair(x, y, wanted);
    addHeldOf(request, x, y, found);
    return found;
  };
  refuse(asked.pose, b, query);
  Comparison<Other> comparison(asked, b, request);
  double least = infinity, lower = infinity;
  std::vector<Candidate> candidates_a, candidates_b;
  const auto ask = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const Placed& points) {
    comparison.compareWithOther(
        tile, [&] { return least; },
        [&](const pcl::PCLPointCloud2& other, const Placed& others) {
          const DistanceResult found = query(points, others);
          lower = std::min(lower, found.interval.lower);
          if (!found.pair || found.distance > least) return;
          least = found.distance;
          const auto candidate = [&](const pcl::PCLPointCloud2& of, const Placed& in, std::uint32_t i) {
            return Candidate{in.hierarchy().view().point(i), nameOf(of, i), least};
          };
          candidates_a.push_back(candidate(cloud, points, found.pair->a));
          if (std::is_same_v<Other, PlacedSite>) candidates_b.push_back(candidate(other, others, found.pair->b));
        });
  };
  SiteClosest result;
  result.tiles = comparison.visit(infinity, ask, [&] {
    least = leastOfAllRanks(least);
    return request.solid ? std::max(least, 0.0) : least; // a tile that the box meets may hold what is deeper
  });
  result.tiles_b = comparison.readOfOther();

  // Distances that round to the same double may differ: the nearest of each tile are compared once more, exactly.
  const Candidates last_a(candidates_a, least), last_b(candidates_b, least);
  lower = leastOfAllRanks(lower);
  if (last_a.points.empty()) return result;
  wanted.accuracy = {};
  const SphereHierarchy nearest_a = last_a.hierarchy(), nearest_b = last_b.hierarchy();
  DistanceResult nearest;
  if constexpr (std::is_same_v<Other, Placed>)
    nearest = query({nearest_a, asked.pose}, b);
  else
    nearest = query({nearest_a, asked.pose}, {nearest_b, b.pose});
  nearest.interval.lower = std::min(lower, nearest.interval.lower);
  result.interval = nearest.interval;
  result.distance = nearest.distance;
  result.point = last_a.points[nearest.pair->a];
  result.b = nearest.pair->b;
  if (!last_b.points.empty()) result.point_b = last_b.points[nearest.pair->b];
  return result;
}

template <typename Other>
SiteDistances distancesOf(const PlacedSite& asked, const Other& b, double max_distance, const SiteRequest& request,
                          const DistancesSink& sink)
{
  auto wanted = wantedOf<PointDistancesRequest>(request);
  wanted.max_distance = max_distance;
  refuse(asked.pose, b, [&](const Placed& x, const Placed& y) { pcl_bsh::pointDistances(x, y, wanted); });
  SiteDistances result;
  double greatest = -infinity;
  Comparison<Other> comparison(asked, b, request);
  const auto find = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const Placed& points) {
    const PointsView& view = points.hierarchy().view();
    PointDistances all;
    all.distance.assign(view.count, std::numeric_limits<double>::quiet_NaN());
    PointDistancesRequest nearer = wanted; // what is farther than all points' distances changes none
    comparison.compareWithOther(
        tile, [&] { return nearer.max_distance; },
        [&](const pcl::PCLPointCloud2&, const Placed& others) {
          PointDistances found = pcl_bsh::pointDistances(points, others, nearer);
          addHeldOf(request, points, others, found);
          if constexpr (std::is_same_v<Other, Placed>) {
            all = std::move(found);
            return;
          }
          double farthest = 0.0;
          for (std::uint32_t i = 0; i < view.count; ++i) {
            double& distance = all.distance[i];
            distance = std::fmin(distance, found.distance[i]); // the one that is a number
            if (!isFinite(view.point(i))) continue;
            farthest = std::isnan(distance) ? infinity : std::max(farthest, distance);
          }
          nearer.max_distance = std::min(nearer.max_distance, farthest);
        });
    if (std::is_same_v<Other, PlacedSite>) {
      for (const double distance : all.distance) {
        if (std::isnan(distance)) continue;
        ++all.measured;
        all.greatest = std::fmax(all.greatest, distance);
      }
    }
    if (sink) sink(tile, cloud, all);
    return std::vector<double>{static_cast<double>(all.measured), static_cast<double>(all.undecided), all.greatest};
  };
  const auto add = [&](const std::vector<double>& numbers) {
    result.measured += static_cast<std::uint64_t>(numbers[0]);
    result.undecided += static_cast<std::uint64_t>(numbers[1]);
    if (numbers[0] > 0) greatest = std::max(greatest, numbers[2]);
  };
  result.tiles = comparison.visitAndAdd(max_distance, find, add);
  result.tiles_b = comparison.readOfOther();
  result.measured = sumOfAllRanks(result.measured);
  result.undecided = sumOfAllRanks(result.undecided);
  greatest = -leastOfAllRanks(-greatest);
  if (result.measured > 0) result.greatest = greatest;
  return result;
}

} // namespace

SiteAny anyCollision(const Site& site, const Placed& b, const SiteRequest& request)
{
  return anyOf(asFirst(site, request.uncertainty), b, request);
}

SiteAny anyCollision(const Site& site, const PlacedSite& b, const SiteRequest& request)
{
  return anyOf(asFirst(site, request.uncertainty), b, request);
}

SiteFlags collisionFlags(const Site& site, const Placed& b, Side flagged, const SiteRequest& request,
                         const FlagsSink& sink)
{
  return flagsOf(asFirst(site, request.uncertainty), b, flagged, request, sink);
}

SiteFlags collisionFlags(const Site& site, const PlacedSite& b, const SiteRequest& request, const FlagsSink& sink)
{
  return flagsOf(asFirst(site, request.uncertainty), b, Side::a, request, sink);
}

SiteFlags collisionFlagsOfB(const Site& site, const PlacedSite& b, const SiteRequest& request, const FlagsSink& sink)
{
  return flagsOf(b, asFirst(site, request.uncertainty), Side::a, with(request, b.uncertainty), sink);
}

SiteClosest closestPair(const Site& site, const Placed& b, const SiteRequest& request)
{
  return closestOf(asFirst(site), b, with(request, {}));
}

SiteClosest closestPair(const Site& site, const PlacedSite& b, const SiteRequest& request)
{
  return closestOf(asFirst(site), PlacedSite{b.site, b.pose, {}}, with(request, {}));
}

SiteDistances pointDistances(const Site& site, const Placed& b, double max_distance, const SiteRequest& request,
                             const DistancesSink& sink)
{
  return distancesOf(asFirst(site), b, max_distance, with(request, {}), sink);
}

SiteDistances pointDistances(const Site& site, const PlacedSite& b, double max_distance, const SiteRequest& request,
                             const DistancesSink& sink)
{
  if (request.accuracy.stopsEarly())
    throw std::invalid_argument("accuracy " + request.accuracy.text() +
                                ": distances of two sites cannot stop early: give exact or a tolerance");
  return distancesOf(asFirst(site), PlacedSite{b.site, b.pose, {}}, max_distance, with(request, {}), sink);
}

} // namespace pcl_bsh::site

// SPDX-License-Identifier: BSD-3-Clause
// The parts of a question about a site at one pose.
#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/site/answers/comparison.h>
#include <pcl_bsh/site/answers/enclosed_in_tile.h>
#include <pcl_bsh/site/tiles/records.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::site {

namespace {

/// The nearest point of a tile, which may be the nearest point of the site.
struct Candidate {
  Point3 place;
  SitePoint point;
  double distance;
};

/// The candidates of all ranks that have the given distance, in the order of their names. Exact arithmetic chooses
/// among them.
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

void appendVerdicts(const std::vector<Verdict>& flags, std::vector<double>& numbers)
{
  for (std::size_t i = 0; i < flags.size(); ++i)
    if (flags[i] != Verdict::free)
      numbers.insert(numbers.end(), {static_cast<double>(i), static_cast<double>(flags[i])});
}

void addVerdicts(const std::vector<double>& numbers, std::size_t begin, std::vector<Verdict>& flags)
{
  for (std::size_t k = begin; k < numbers.size(); k += 2) {
    Verdict& flag = flags[static_cast<std::size_t>(numbers[k])];
    flag = graver(flag, static_cast<Verdict>(numbers[k + 1]));
  }
}

/// How many points of a site collide, or are undecided, over all ranks.
struct Counts {
  std::uint64_t colliding = 0, undecided = 0;
};

/// Flags the points of a comparison's tiles. @param told gets the flags of each tile, and their counts
/// @param flags_of_cloud gets the flags of the cloud in memory; null: they are not asked for
template <typename Told>
Counts flags(const QuestionPart& part, Comparison& comparison, std::vector<Verdict>* flags_of_cloud, const Told& told,
             TilesRead& read)
{
  auto wanted = wantedOf<FlagsRequest>(part.question);
  wanted.flagged = flags_of_cloud || part.question.solid ? Flagged::both : Flagged::a;
  comparison.refuse([&](const Placed& x, const Placed& y) { collisionFlags(x, y, wanted); });
  if (flags_of_cloud) flags_of_cloud->assign(part.model().view().count, Verdict::free);
  const auto find = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const Placed& a) {
    FlagsResult all, found;
    all.a.assign(a.hierarchy().view().count, Verdict::free);
    comparison.compareWithOther(
        tile, [&] { return part.clearance(); },
        [&](const pcl::PCLPointCloud2&, const Placed& other) {
          collisionFlags(a, other, wanted, found);
          addEnclosedOf(part, a, found);
          join(all.a, found.a);
          all.work += found.work;
        });
    all.colliding_a = countOf(all.a, Verdict::colliding);
    all.undecided_a = countOf(all.a, Verdict::undecided);
    std::vector<double> numbers = {static_cast<double>(all.colliding_a), static_cast<double>(all.undecided_a)};
    told(tile, cloud, all);
    if (flags_of_cloud) appendVerdicts(found.b, numbers);
    return numbers;
  };
  Counts counts;
  const auto add = [&](const std::vector<double>& numbers) {
    counts.colliding += static_cast<std::uint64_t>(numbers[0]);
    counts.undecided += static_cast<std::uint64_t>(numbers[1]);
    if (flags_of_cloud) addVerdicts(numbers, 2, *flags_of_cloud);
  };
  read += comparison.visitAndAdd(part.clearance(), find, add);
  counts = {sumOfAllRanks(counts.colliding), sumOfAllRanks(counts.undecided)};
  if (ranks() > 1 && flags_of_cloud) {
    std::vector<double> own;
    appendVerdicts(*flags_of_cloud, own);
    addVerdicts(gatheredFromAllRanks(own), 0, *flags_of_cloud);
  }
  return counts;
}

} // namespace

void findAny(const QuestionPart& part, SiteAnswer& answer)
{
  const auto wanted = wantedOf<AnyRequest>(part.question);
  const auto query = [&](const Placed& x, const Placed& y) {
    AnyResult found = anyCollision(x, y, wanted);
    addEnclosedOf(part, x, found);
    return found.verdict;
  };
  Comparison comparison(part, part.input(), part.obstacle());
  comparison.refuse(query);
  bool collides = false, is_undecided = false;
  const auto ask = [&](const Tile& tile, const pcl::PCLPointCloud2&, const Placed& a) {
    comparison.compareWithOther(
        tile, [&] { return collides ? -infinity : part.clearance(); },
        [&](const pcl::PCLPointCloud2&, const Placed& other) {
          const Verdict verdict = query(a, other);
          collides = verdict == Verdict::colliding;
          is_undecided = is_undecided || verdict == Verdict::undecided;
        });
  };
  answer.tiles += comparison.visit(part.clearance(), ask, [&] {
    collides = sumOfAllRanks(collides ? 1 : 0) > 0;
    return collides ? -infinity : infinity;
  });
  answer.obstacle_tiles += comparison.readOfOther();
  answer.any.verdict = verdictOfAllRanks(collides, is_undecided);
}

void flag(const QuestionPart& part, SiteAnswer& answer)
{
  const Wanted& wanted = part.question.wanted;
  Comparison comparison(part, part.input(), part.obstacle());
  const bool of_cloud = wanted.obstacle_flags && !part.question.seen && !comparison.isOfSites(); // `seen` tells them
  const auto told = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, FlagsResult& found) {
    if (!part.means.receiver) return;
    Answer of_tile;
    of_tile.collisions.flags = std::move(found.a);
    of_tile.collisions.colliding = found.colliding_a;
    of_tile.collisions.undecided = found.undecided_a;
    of_tile.work = found.work;
    part.means.receiver(tile, cloud, of_tile);
  };
  const Counts counts = flags(part, comparison, of_cloud ? &answer.obstacle_flags : nullptr, told, answer.tiles);
  answer.obstacle_tiles += comparison.readOfOther();
  answer.collisions.colliding = counts.colliding;
  answer.collisions.undecided = counts.undecided;
}

void flagObstacle(const QuestionPart& part, SiteAnswer& answer)
{
  Comparison comparison(part, *part.obstacle(), part.input());
  const auto told = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, FlagsResult& found) {
    if (!part.means.obstacle_receiver) return;
    Answer of_tile;
    of_tile.obstacle_flags = std::move(found.a);
    of_tile.work = found.work;
    part.means.obstacle_receiver(tile, cloud, of_tile);
  };
  const Counts counts = flags(part, comparison, nullptr, told, answer.obstacle_tiles);
  answer.tiles += comparison.readOfOther();
  answer.obstacle_colliding = counts.colliding;
  answer.obstacle_undecided = counts.undecided;
}

void findClosest(const QuestionPart& part, SiteAnswer& answer)
{
  auto wanted = wantedOf<DistanceRequest>(part.question);
  const auto query = [&](const Placed& x, const Placed& y) {
    DistanceResult found = closestPair(x, y, wanted);
    addEnclosedOf(part, x, found);
    return found;
  };
  Comparison comparison(part, part.measuredInput(), part.measuredObstacle());
  comparison.refuse(query);
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
          if (comparison.isOfSites()) candidates_b.push_back(candidate(other, others, found.pair->b));
        });
  };
  answer.tiles += comparison.visit(infinity, ask, [&] {
    least = leastOfAllRanks(least);
    return part.question.solid ? std::max(least, 0.0) : least; // a tile that the box meets may have deeper points
  });
  answer.obstacle_tiles += comparison.readOfOther();

  // Distances that round to the same double may differ: the nearest of each tile are compared once more, exactly.
  const Candidates last_a(candidates_a, least), last_b(candidates_b, least);
  lower = leastOfAllRanks(lower);
  if (last_a.points.empty()) return;
  wanted.accuracy = {};
  const SphereHierarchy nearest_a = last_a.hierarchy(), nearest_b = last_b.hierarchy();
  const DistanceResult nearest = query(nearest_a, comparison.standing(nearest_b));
  answer.closest.interval = {std::min(lower, nearest.interval.lower), nearest.interval.upper};
  answer.closest.distance = nearest.distance;
  answer.pair = SitePair{last_a.points[nearest.pair->a], {0, nearest.pair->b}};
  if (comparison.isOfSites()) answer.pair->b = last_b.points[nearest.pair->b];
}

void measure(const QuestionPart& part, SiteAnswer& answer)
{
  auto wanted = wantedOf<PointDistancesRequest>(part.question);
  wanted.max_distance = part.question.max_distance.value_or(infinity);
  Comparison comparison(part, part.measuredInput(), part.measuredObstacle());
  comparison.refuse([&](const Placed& x, const Placed& y) { pointDistances(x, y, wanted); });
  double greatest = -infinity;
  const auto find = [&](const Tile& tile, const pcl::PCLPointCloud2& cloud, const Placed& points) {
    const PointsView& view = points.hierarchy().view();
    Answer of_tile;
    PointDistances& all = of_tile.distances.a;
    all.distance.assign(view.count, std::numeric_limits<double>::quiet_NaN());
    PointDistancesRequest nearer = wanted; // a point farther than all distances changes none
    comparison.compareWithOther(
        tile, [&] { return nearer.max_distance; },
        [&](const pcl::PCLPointCloud2&, const Placed& others) {
          PointDistances found = pointDistances(points, others, nearer);
          addEnclosedOf(part, points, found);
          if (!comparison.isOfSites()) {
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
    if (comparison.isOfSites()) {
      for (const double distance : all.distance) {
        if (std::isnan(distance)) continue;
        ++all.measured;
        all.greatest = std::fmax(all.greatest, distance);
      }
    }
    if (part.means.receiver) part.means.receiver(tile, cloud, of_tile);
    return std::vector<double>{static_cast<double>(all.measured), static_cast<double>(all.undecided), all.greatest};
  };
  PointDistances& sum = answer.distances.a;
  const auto add = [&](const std::vector<double>& numbers) {
    sum.measured += static_cast<std::size_t>(numbers[0]);
    sum.undecided += static_cast<std::size_t>(numbers[1]);
    if (numbers[0] > 0) greatest = std::max(greatest, numbers[2]);
  };
  answer.tiles += comparison.visitAndAdd(wanted.max_distance, find, add);
  answer.obstacle_tiles += comparison.readOfOther();
  sum.measured = sumOfAllRanks(sum.measured);
  sum.undecided = sumOfAllRanks(sum.undecided);
  greatest = -leastOfAllRanks(-greatest);
  if (sum.measured > 0) sum.greatest = greatest;
}

} // namespace pcl_bsh::site

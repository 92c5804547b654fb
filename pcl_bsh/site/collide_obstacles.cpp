// SPDX-License-Identifier: BSD-3-Clause
// A question about a site and several obstacles: each tile is asked about all that may be near it.
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/depths/queried_part.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/pairs/closest_pair.h>
#include <pcl_bsh/question/joined_answers.h>
#include <pcl_bsh/question/warnings/hollow.h>
#include <pcl_bsh/site/answers/enclosed_in_tile.h>
#include <pcl_bsh/site/answers/nearest_records.h>
#include <pcl_bsh/site/answers/passing_obstacle.h>
#include <pcl_bsh/site/answers/tile_query.h>
#include <pcl_bsh/site/tiles/records.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace pcl_bsh::site {
namespace {

/// The answer of a tile about one obstacle.
struct OfTile {
  CollidingRecords colliding;  ///< of the tile's points
  std::vector<double> numbers; ///< as asked() describes them
};

class SeveralAsking {
public:
  SeveralAsking(const Question& question, const Site& site, std::vector<PlacedShape>& obstacles, const SiteMeans& means,
                const std::vector<ClashFinder*>& clashes)
  : all_{question, means, site, nullptr, nullptr},
    nearest_(obstacles.size())
  {
    if (obstacles.empty()) throw InvalidInput(Input::points, "obstacles", "there are none", "give one at least");
    all_.means.clashes = nullptr;
    if (!clashes.empty()) all_.question.wanted.contacts = true;
    checkOfSeveral(all_.question);
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
      passing_.emplace_back();
      if (obstacles[i].path)
        throw InvalidInput(Input::trajectory, obstacles[i].shape.name(),
                           "has a path of its own, and the input is a site",
                           "give the question a path, which moves all obstacles");
      if (obstacles[i].ignores_input) continue;
      Question one = questionOf(all_.question, obstacles[i]);
      one.progress = nullptr;
      build(one, obstacles[i].shape);
      SiteMeans of_one = all_.means;
      if (!clashes.empty()) of_one.clashes = clashes[i];
      passing_.back() = std::make_unique<PassingObstacle>(one, of_one, site, obstacles[i].shape);
      refusePassage(site, passing_.back()->part.model(), passing_.back()->poses, passing_.back()->wanted);
    }
  }

  SiteObstaclesAnswer answer()
  {
    const std::vector<std::uint32_t> tiles = neededTiles();
    TileQuery tile_query(all_, all_.input());
    const TilesRead read = tile_query.visitAndAdd(
        tiles, [&](const auto&... tile) { return askedOf(tile...); }, [&](const auto& numbers) { add(numbers); }, false,
        [&](std::uint32_t tile) { return !nearTo(all_.site.tiles[tile]).empty(); });
    nearest_.gather();
    SiteAnswer sight;
    std::vector<SiteAnswer> each(passing_.size());
    if (all_.question.seen) look(each, sight);
    SiteObstaclesAnswer found = joined(each);
    found.all.tiles = read;
    found.all.tiles += sight.tiles;
    found.all.beam_tiles = std::move(sight.beam_tiles);
    found.all.beams_kept = sight.beams_kept;
    found.all.collisions.colliding = sumOfAllRanks(colliding_);
    found.all.collisions.undecided = sumOfAllRanks(undecided_);
    return found;
  }

private:
  using Kind = NearRecord::Kind;

  bool wantsClosest() const { return all_.question.wanted.closest; }

  /// Whether points that collide get distances. If so, the smallest of these is the obstacle's smallest distance.
  bool tellsContacts() const { return all_.question.wanted.contacts || all_.question.path; }

  bool isNear(std::uint32_t obstacle, const Tile& tile) const
  {
    const PassingObstacle& one = *passing_[obstacle];
    return one.mayReach(tile) || (wantsClosest() && one.lowerBound(tile) <= most(obstacle));
  }

  /// Returns an upper bound of the smallest distance of an obstacle, or 0 where it is less.
  double most(std::uint32_t obstacle) const { return std::max(nearest_.least(obstacle), 0.0); }

  std::vector<std::uint32_t> nearTo(const Tile& tile) const
  {
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = 0; i < passing_.size(); ++i)
      if (passing_[i] && isNear(i, tile)) near.push_back(i);
    return near;
  }

  /// Returns the tiles that may matter: first the tiles that are nearest to an obstacle, then the others.
  std::vector<std::uint32_t> neededTiles()
  {
    const std::vector<Tile>& tiles = all_.site.tiles;
    std::vector<bool> is_first(tiles.size());
    for (std::uint32_t i = 0; i < passing_.size(); ++i) {
      std::pair<double, double> best = {infinity, infinity};
      std::size_t nearest = tiles.size();
      for (std::size_t t = 0; t < tiles.size() && passing_[i]; ++t) {
        if (!tiles[t].bounds) continue;
        const std::pair bounds(passing_[i]->lowerBound(tiles[t]), passing_[i]->upperBound(tiles[t]));
        nearest_.limit(i, bounds.second);
        if (bounds >= best) continue;
        best = bounds;
        nearest = t;
      }
      if (nearest < tiles.size()) is_first[nearest] = true;
    }
    std::vector<std::uint32_t> needed;
    for (std::uint32_t t = 0; t < tiles.size(); ++t)
      if (tiles[t].bounds && !nearTo(tiles[t]).empty()) needed.push_back(t);
    std::stable_partition(needed.begin(), needed.end(), [&](std::uint32_t t) { return is_first[t]; });
    return needed;
  }

  /// Returns how many points collide with anything, and how many are undecided. Then follow, for each obstacle that is
  /// near, its index, the count of its numbers, and its numbers.
  std::vector<double> askedOf(const Tile& tile, const pcl::PCLPointCloud2& cloud, const SphereHierarchy& hierarchy)
  {
    const std::vector<std::uint32_t> near = nearTo(tile);
    const unsigned threads = threadCount(all_.question.threads);
    const unsigned inner = near.size() > 1 ? 1 : threads; // of each query
    const std::size_t batch = std::size_t{4} * threads;   // of answers that memory holds at once
    const Shape shape = shapeOf(hierarchy);
    JoinedAnswers joined(hierarchy.view().count, all_.question.wanted);
    std::vector<double> numbers(2);
    for (std::size_t begin = 0; begin < near.size(); begin += batch) {
      std::vector<OfTile> some(std::min(batch, near.size() - begin));
      parallelFor(some.size(), threads,
                  [&](std::size_t i) { some[i] = asked(near[begin + i], tile, cloud, shape, inner); });
      for (std::size_t i = 0; i < some.size(); ++i) {
        joined.add(near[begin + i], some[i].colliding.records, some[i].colliding.found);
        numbers.push_back(static_cast<double>(near[begin + i]));
        numbers.push_back(static_cast<double>(some[i].numbers.size()));
        numbers.insert(numbers.end(), some[i].numbers.begin(), some[i].numbers.end());
      }
    }
    if (all_.means.receiver) joined.fill(all_.question.poses().size());
    const ObstaclesAnswer found = joined.finish(all_.question.path.has_value());
    numbers[0] = static_cast<double>(found.all.collisions.colliding);
    numbers[1] = static_cast<double>(found.all.collisions.undecided);
    if (all_.means.receiver) all_.means.receiver(tile, cloud, found.all);
    return numbers;
  }

  /// Asks about one obstacle. Its numbers are the count of near records, the near records and, unless all points are
  /// free, the numbers of PassageSum.
  OfTile asked(std::uint32_t obstacle, const Tile& tile, const pcl::PCLPointCloud2& cloud, const Shape& shape,
               unsigned threads) const
  {
    const PassingObstacle& one = *passing_[obstacle];
    OfTile of_tile;
    if (one.mayReach(tile)) of_tile.colliding = collidingOf(one, tile, shape, threads);
    const CollidingRecords& found = of_tile.colliding;
    std::vector<NearRecord> records;
    if (wantsClosest()) records = recordsOf(obstacle, tile, cloud, shape, threads, found);
    of_tile.numbers.push_back(static_cast<double>(records.size()));
    for (const NearRecord& near : records) append(of_tile.numbers, near);
    if (found.records.empty()) return of_tile;
    const std::vector<double> sum = one.sum.numbersOf(tile, cloud, found);
    of_tile.numbers.insert(of_tile.numbers.end(), sum.begin(), sum.end());
    return of_tile;
  }

  static CollidingRecords collidingOf(const PassingObstacle& one, const Tile& tile, const Shape& shape,
                                      unsigned threads)
  {
    const SphereHierarchy& hierarchy = shape.hierarchy();
    if (mayAskAny(one.part.question)) { // most obstacles are free
      auto wanted = wantedOf<AnyRequest>(one.part.question);
      wanted.threads = threads;
      AnyResult any = anyCollision(hierarchy, {one.part.model(), one.poses.front()}, wanted);
      addEnclosedOf(one.part, shape, any);
      if (any.verdict == Verdict::free) return {};
    }
    TrajectoryRequest wanted = one.wanted;
    wanted.threads = threads;
    const auto ask = [&](const Shape& points) {
      TrajectoryResult found = collideAlong({points.hierarchy()}, one.part.model(), one.poses, wanted);
      addEnclosedOf(one.part, points, found);
      return CollidingRecords(found);
    };
    // A small part of the tile costs what few points cost.
    const Bounds near = one.boxOfReach(tile);
    std::vector<std::int32_t> some;
    boxSearch(hierarchy, near.low, near.high, some);
    if (2 * some.size() > hierarchy.size()) return ask(shape);
    std::sort(some.begin(), some.end());
    const QueriedPart part(hierarchy, {some.begin(), some.end()});
    CollidingRecords colliding = ask(shapeOf(part.queried().thing()));
    for (std::int32_t& record : colliding.records)
      record = static_cast<std::int32_t>(part.original(static_cast<std::uint32_t>(record)));
    return colliding;
  }

  /// Returns where the obstacle is nearest to a tile's points, and a place that its faces enclose.
  std::vector<NearRecord> recordsOf(std::uint32_t obstacle, const Tile& tile, const pcl::PCLPointCloud2& cloud,
                                    const Shape& shape, unsigned threads, const CollidingRecords& colliding) const
  {
    const PassingObstacle& one = *passing_[obstacle];
    const SphereHierarchy& hierarchy = shape.hierarchy();
    const bool collides = !colliding.records.empty();
    std::vector<NearRecord> records;
    const auto add = [&](Kind kind, const DistanceResult& closest, std::int32_t pose) {
      if (!closest.pair) return;
      const std::uint32_t a = closest.pair->a;
      records.push_back({obstacle, kind, closest.distance, closest.interval, pose, closest.pair->b, nameOf(cloud, a),
                         hierarchy.view().point(a)});
    };
    if (collides && tellsContacts()) {
      DistanceResult closest = closestOf(colliding.found);
      if (closest.pair) {
        const std::int32_t pose = colliding.found.closest_pose[closest.pair->a];
        closest.pair->a = static_cast<std::uint32_t>(colliding.records[closest.pair->a]);
        add(Kind::colliding, closest, pose);
        return records;
      }
    }
    const double most_distance = most(obstacle);
    if (one.lowerBound(tile) <= most_distance) {
      if (one.part.question.path) {
        const auto [closest, pose] = closestAlong(hierarchy, one.part.model(), one.poses, most_distance);
        add(Kind::measured, closest, pose);
      }
      else {
        DistanceRequest wanted; // exact, as along a path
        wanted.threads = threads;
        wanted.max_distance = most_distance;
        DistanceResult closest = closestPair(hierarchy, {one.part.model(), one.poses.front()}, wanted);
        if (collides) addEnclosedOf(one.part, shape, closest);
        add(Kind::measured, closest, 0);
      }
    }
    if (collides || !one.mayClose(tile)) return records;
    if (!records.empty() && records.back().distance <= pcl_bsh::nearTo(*one.part.shape)) return records;
    std::vector<Eigen::Isometry3d> poses;
    for (const Eigen::Isometry3d& pose : one.poses) poses.push_back(pose.inverse());
    if (const auto place = placeWithin(*one.part.shape, hierarchy, poses)) {
      NearRecord enclosed{obstacle, Kind::enclosed};
      enclosed.pose = static_cast<std::int32_t>(&tile - all_.site.tiles.data());
      enclosed.place = *place;
      records.push_back(enclosed);
    }
    return records;
  }

  void add(const std::vector<double>& numbers)
  {
    colliding_ += static_cast<std::uint64_t>(numbers[0]);
    undecided_ += static_cast<std::uint64_t>(numbers[1]);
    for (std::size_t k = 2; k < numbers.size();) {
      PassingObstacle& one = *passing_[static_cast<std::size_t>(numbers[k])];
      const std::size_t end = k + 2 + static_cast<std::size_t>(numbers[k + 1]);
      const auto records = static_cast<std::size_t>(numbers[k + 2]);
      for (std::size_t r = 0; r < records; ++r)
        nearest_.add(nearRecordFrom(numbers.data() + k + 3 + r * near_record_numbers));
      const std::size_t begin = k + 3 + records * near_record_numbers;
      if (begin < end)
        one.sum.add(
            {numbers.begin() + static_cast<std::ptrdiff_t>(begin), numbers.begin() + static_cast<std::ptrdiff_t>(end)});
      k = end;
    }
  }

  void look(std::vector<SiteAnswer>& each, SiteAnswer& sight)
  {
    std::vector<const QuestionPart*> parts;
    std::vector<Answer*> answers;
    for (std::size_t i = 0; i < passing_.size(); ++i) {
      if (!passing_[i]) continue;
      passing_[i]->part.means.answers = nullptr; // kept answers are of the visit before
      parts.push_back(&passing_[i]->part);
      answers.push_back(&each[i]);
    }
    lookAround(parts, answers, sight);
  }

  /// The answers about all tiles of all ranks. @param each_seen what is unseen of each obstacle
  SiteObstaclesAnswer joined(std::vector<SiteAnswer>& each_seen)
  {
    SiteObstaclesAnswer found;
    found.each.resize(passing_.size());
    JoinedAnswers joined(0, all_.question.wanted);
    const NamedCloud named = namedSite(all_.site);
    for (std::uint32_t i = 0; i < passing_.size(); ++i) {
      if (!passing_[i]) {
        joined.skip();
        continue;
      }
      SiteAnswer& one = each_seen[i];
      passing_[i]->sum.tell(one);
      one.closest = {}; // it has no pair
      SiteObstacleAnswer& each = found.each[i];
      nearest_.tell(passing_[i]->part, i, each);
      one.warnings = warningsOfOne(i, named, each.closest.distance);
      joined.add(i, one);
      joined.setClosest(each.closest, each.closest_pose);
      each.found = std::move(one.collisions);
      each.not_seen = std::move(one.unseen);
      if (one.first_pose)
        found.all.first_pose = std::min(*one.first_pose, found.all.first_pose.value_or(*one.first_pose));
    }
    ObstaclesAnswer all = joined.finish(all_.question.path.has_value());
    static_cast<Answer&>(found.all) = std::move(all.all);
    for (std::size_t i = 0; i < found.each.size(); ++i) static_cast<ObstacleAnswer&>(found.each[i]) = all.each[i];
    found.closest = all.closest;
    if (found.closest != kNothing) found.all.pair = found.each[found.closest].pair;
    return found;
  }

  std::vector<Warning> warningsOfOne(std::uint32_t obstacle, const NamedCloud& site, double nearest) const
  {
    const QuestionPart& part = passing_[obstacle]->part;
    std::vector<Warning> warnings = warningsOf(part.question, site, part.shape->facts(all_.question.wanted.spacings));
    const std::optional<Point3> place = nearest_.enclosed(obstacle);
    if (place && nearest > pcl_bsh::nearTo(*part.shape))
      warnings.push_back(pcl_bsh::warningOfHollow(part.shape->name(), "solid", site.name, *place));
    return warnings;
  }

  QuestionPart all_;
  std::vector<std::unique_ptr<PassingObstacle>> passing_; ///< null: it ignores the site
  NearestRecords nearest_;
  std::uint64_t colliding_ = 0, undecided_ = 0;
};

} // namespace

void checkOfSeveral(const Question& question)
{
  check(question, false);
  const Wanted& wanted = question.wanted;
  for (const auto& [is_wanted, name] :
       {std::pair{wanted.any, "any"}, {wanted.distances, "distances"}, {wanted.obstacle_flags, "obstacle_flags"}})
    if (is_wanted)
      throw InvalidInput(Input::result, name, "is not told of several obstacles of a site", "ask about one alone");
}

SiteObstaclesAnswer ask(const Question& question, const Site& site, std::vector<PlacedShape>& obstacles,
                        const SiteMeans& means, const std::vector<ClashFinder*>& clashes)
{
  return SeveralAsking(question, site, obstacles, means, clashes).answer();
}

} // namespace pcl_bsh::site

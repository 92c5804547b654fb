// SPDX-License-Identifier: BSD-3-Clause
#include "questions.h"
#include "support/brute_force/clusters.h"
#include "support/brute_force/neighbors.h"
#include "support/question.h"

#include "bytes.h"
#include "target.h"

#include <pcl_bsh/base/float_environment.h>
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/clashes/clashes.h>
#include <pcl_bsh/clusters/clusters.h>
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/neighbors/spacing.h>
#include <pcl_bsh/pairs/trace.h>
#include <pcl_bsh/query/brute_force_points.h>
#include <pcl_bsh/query/record_distance.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <type_traits>

namespace pcl_bsh::fuzz {
namespace {

using brute_force::FinitePoint;
using brute_force::finitePoints;
using test::Random;

/// A finite point of the view, if the first one looked at is.
std::optional<std::uint32_t> anyPoint(const PointsView& view, Random& random)
{
  if (view.size() == 0) return std::nullopt;
  const auto i = static_cast<std::size_t>(random.integer(0, static_cast<int>(view.size()) - 1));
  const std::uint32_t record = view.record(i);
  if (!isFinite(view.point(record))) return std::nullopt;
  return record;
}

double nearTie(double tie, Random& random)
{
  const int last_bit = random.integer(-1, 1);
  tie = std::max(tie, 0.0);
  if (last_bit == 0 || !std::isfinite(tie)) return std::min(tie, std::numeric_limits<double>::max());
  return std::min(std::nextafter(tie, last_bit < 0 ? 0.0 : infinity), std::numeric_limits<double>::max());
}

double anyLength(double tie, double unit, Random& random)
{
  switch (random.integer(0, 7)) {
  case 0:
    return 0.0;
  case 1:
    return unit / 8 * random.integer(0, 16);
  case 2:
    return unit * random.uniform(0, 0.5);
  case 3:
    return random.chance(0.5) ? 8 * unit : std::numeric_limits<double>::max();
  default:
    return nearTie(tie, random);
  }
}

RecordDistance distanceOf(const Placed& a, const Placed& b)
{
  return {a.hierarchy().view(), a.pose, b.hierarchy().view(), b.pose};
}

/// Flags of a query that may stop early, or tell apart what is within a tolerance at will.
void requireFlags(const std::vector<Verdict>& flags, const std::vector<Verdict>& within,
                  const std::vector<Verdict>& within_tolerance, const Accuracy& accuracy, const char* what)
{
  require(flags.size() == within.size(), what);
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] == Verdict::undecided)
      require(accuracy.stopsEarly(), what);
    else if (flags[i] == Verdict::colliding)
      require(within_tolerance[i] == Verdict::colliding, what);
    else
      require(flags[i] == Verdict::free && within[i] == Verdict::free, what);
  }
}

void requireHeld(const Interval& interval, double distance, const test::Question& request, const char* what)
{
  if (interval.lower <= distance && distance <= interval.upper) return;
  std::ostringstream text;
  text.precision(17);
  text << what << ", accuracy " << request.accuracy.text() << ": [" << interval.lower << ", " << interval.upper
       << "] lacks the distance " << distance;
  throw Finding(text.str());
}

void requireSame(const Neighbors& found, const Neighbors& expected, const std::string& what, const Point3& query)
{
  if (found.indices == expected.indices && found.squared_distances == expected.squared_distances) return;
  std::ostringstream text;
  text.precision(17);
  text << what << " at " << query[0] << ' ' << query[1] << ' ' << query[2] << ": other neighbours\n  found";
  for (std::size_t i = 0; i < found.indices.size(); ++i)
    text << ' ' << found.indices[i] << " (" << found.squared_distances[i] << ')';
  text << "\n  expected";
  for (std::size_t i = 0; i < expected.indices.size(); ++i)
    text << ' ' << expected.indices[i] << " (" << expected.squared_distances[i] << ')';
  throw Finding(text.str());
}

Accuracy anyAccuracy(double unit, Random& random)
{
  switch (random.integer(0, 9)) {
  case 0:
    return Accuracy::level(static_cast<unsigned>(random.integer(0, 3)));
  case 1:
    return Accuracy::nodePairs(static_cast<std::uint64_t>(random.integer(0, 200)));
  case 2:
    return Accuracy::tolerance(unit * random.uniform(0, 0.2));
  default:
    return Accuracy::exact();
  }
}

double withTolerance(const test::Question& request)
{
  const double more = request.accuracy.mode == Accuracy::Mode::tolerance ? request.accuracy.value : 0.0;
  return std::min(request.clearance + more, std::numeric_limits<double>::max());
}

} // namespace

std::vector<PointPair> collidingPairs(const Placed& a, const Placed& b, double clearance)
{
  const DefaultFloatEnvironment environment;
  const RecordDistance distance = distanceOf(a, b);
  std::vector<PointPair> pairs;
  const std::vector<FinitePoint> points = finitePoints(a.hierarchy().view()),
                                 others = finitePoints(b.hierarchy().view());
  for (const FinitePoint& p : points)
    for (const FinitePoint& q : others)
      if (distance.compare({p.record, q.record}, clearance) <= 0) pairs.push_back({p.record, q.record});
  std::sort(pairs.begin(), pairs.end()); // a subset may name a record twice
  return pairs;
}

void requireNearest(const Placed& a, const Placed& b, const std::vector<PointPair>& colliding, std::size_t most,
                    const std::vector<Contact>& contacts)
{
  require(contacts.size() == std::min(most, colliding.size()), "contacts: another number");
  if (contacts.empty()) return;
  const DefaultFloatEnvironment environment;
  const RecordDistance distance = distanceOf(a, b);
  const auto before = [&](const PointPair& l, const PointPair& r) {
    const int sign = distance.compareGaps(l, r);
    return sign != 0 ? sign < 0 : l < r;
  };
  std::vector<PointPair> found;
  for (const Contact& contact : contacts) {
    require(found.empty() || !before(contact.pair, found.back()), "contacts: not in order");
    require(contact.distance == distance.gap(contact.pair), "contacts: another distance");
    found.push_back(contact.pair);
  }
  const PointPair last = found.back();
  std::sort(found.begin(), found.end());
  require(std::includes(colliding.begin(), colliding.end(), found.begin(), found.end()), "contacts: other pairs");
  std::vector<PointPair> left_out;
  std::set_difference(colliding.begin(), colliding.end(), found.begin(), found.end(), std::back_inserter(left_out));
  for (const PointPair& pair : left_out) require(!before(pair, last), "contacts: a nearer pair was left out");
}

double Questions::anyClearance(const Placed& a, const Placed& b, double unit, Random& random)
{
  const auto p = anyPoint(a.hierarchy().view(), random), q = anyPoint(b.hierarchy().view(), random);
  const double tie = p && q ? distanceOf(a, b).gap(PointPair{*p, *q}) : unit;
  return anyLength(tie, unit, random);
}

void Questions::ask(const Placed& a, const Placed& b, double unit, unsigned kinds, Random& random)
{
  test::Question request;
  request.clearance = anyClearance(a, b, unit, random);
  request.flagged = static_cast<Flagged>(random.integer(1, 3));
  request.threads = static_cast<unsigned>(random.integer(1, 3));
  request.accuracy = anyAccuracy(unit, random);
  const bool of_triangles = a.hierarchy().view().triangles; // what is asked of points alone is refused of them
  if ((kinds & 1) != 0) askAny(a, b, request);
  if ((kinds & 2) != 0) askFlags(a, b, request);
  if ((kinds & 4) != 0) askClosest(a, b, request);
  if ((kinds & 8) != 0) askContacts(a, b, request, random);
  if ((kinds & 16) != 0 && !of_triangles) askNeighbors(a.hierarchy(), b.hierarchy().view(), unit, random);
  if ((kinds & 32) != 0 && !of_triangles) askBoxes(a.hierarchy(), unit, random);
  if ((kinds & 64) != 0) askClusters(a.hierarchy(), unit, random);
  if ((kinds & 128) != 0) askAlong(a, b, unit, random);
  if ((kinds & 256) != 0 && !of_triangles) askSpacing(a.hierarchy());
}

void Questions::askAny(const Placed& a, const Placed& b, const test::Question& request)
{
  const bool expected = brute_force::anyCollision(a, b, request).verdict == Verdict::colliding;
  const AnyResult any = anyCollision(a, b, request);
  require(any.pair.has_value() == (any.verdict == Verdict::colliding) || request.accuracy.stopsEarly(),
          "any: a witness belongs to a collision");
  if (any.verdict == Verdict::colliding)
    require(any.pair && distanceOf(a, b).compare(*any.pair, withTolerance(request)) <= 0,
            "any: the witness does not collide");
  if (any.verdict == Verdict::free) require(!expected, "any: free, though a pair collides");
  if (any.verdict == Verdict::undecided) require(request.accuracy.stopsEarly(), "any: undecided, though exact");
  if (request.accuracy.isExact()) require((any.verdict == Verdict::colliding) == expected, "any: differs");
  const double distance = brute_force::closestPair(a, b).distance;
  requireHeld(any.interval, distance, request, "any");
  if (request.accuracy.stopsEarly()) return;
  const CollisionTrace trace = traceCollision(a, b, request);
  require(trace.result.verdict == any.verdict && trace.result.pair == any.pair, "trace: another answer");
  test::Question of_one_thread = request; // several may count other work, as anyCollision() declares
  of_one_thread.threads = 1;
  const Work work = anyCollision(a, b, of_one_thread).work;
  require(trace.result.work.node_pairs == work.node_pairs && trace.result.work.leaf_pairs == work.leaf_pairs,
          "trace: other work");
}

void Questions::askFlags(const Placed& a, const Placed& b, const test::Question& request)
{
  collisionFlags(a, b, request, flags_);
  test::Question wider = request;
  wider.clearance = withTolerance(request);
  const FlagsResult expected = brute_force::collisionFlags(a, b, request);
  if (request.accuracy.isExact()) {
    require(flags_.a == expected.a && flags_.b == expected.b, "flags: differ");
    require(flags_.colliding_a == expected.colliding_a && flags_.colliding_b == expected.colliding_b, "flags: counts");
    require(flags_.undecided_a == 0 && flags_.undecided_b == 0, "flags: undecided, though exact");
    return;
  }
  const FlagsResult tolerated = brute_force::collisionFlags(a, b, wider);
  requireFlags(flags_.a, expected.a, tolerated.a, request.accuracy, "flags of a: not what the accuracy grants");
  requireFlags(flags_.b, expected.b, tolerated.b, request.accuracy, "flags of b: not what the accuracy grants");
  require(flags_.undecided_a == countOf(flags_.a, Verdict::undecided) &&
              flags_.undecided_b == countOf(flags_.b, Verdict::undecided),
          "flags: undecided");
}

void Questions::askClosest(const Placed& a, const Placed& b, const test::Question& request)
{
  const DistanceResult found = closestPair(a, b, request), expected = brute_force::closestPair(a, b);
  requireHeld(found.interval, expected.distance, request, "closest pair");
  if (request.accuracy.mode == Accuracy::Mode::exact) {
    require(found.distance == expected.distance, "closest pair: another distance");
    require(found.pair == expected.pair, "closest pair: another pair");
  }
  else if (found.pair) {
    require(distanceOf(a, b).gap(*found.pair) == found.distance, "closest pair: not its own");
  }
}

void Questions::askContacts(const Placed& a, const Placed& b, const test::Question& request, Random& random)
{
  const std::vector<PointPair> expected = collidingPairs(a, b, request.clearance);
  constexpr int counts[] = {0, 1, 2, 10, 1000000};
  const auto most = static_cast<std::size_t>(random.pick(counts));
  const ContactsResult contacts = nearestContacts(a, b, {request.clearance, most});
  require(contacts.complete == (expected.size() <= most), "contacts: complete or not");
  requireNearest(a, b, expected, most, contacts.contacts);
  PairsWithin within = pairsWithin(a, b, {request.clearance, most});
  require(within.complete == (expected.size() <= most), "pairs: complete or not");
  require(within.pairs.size() == std::min(most, expected.size()), "pairs: another number");
  std::sort(within.pairs.begin(), within.pairs.end());
  require(std::includes(expected.begin(), expected.end(), within.pairs.begin(), within.pairs.end()), "pairs: others");
}

void Questions::askNeighbors(const SphereHierarchy& cloud, const PointsView& queries, double unit, Random& random)
{
  const ExactDistance distance(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity());
  const auto somewhere = [&]() -> Point3 {
    const auto own = anyPoint(cloud.view(), random), other = anyPoint(queries, random);
    Point3 q = own ? cloud.view().point(*own) : Point3{0, 0, 0};
    if (other && random.chance(0.3)) q = queries.point(*other);
    if (random.chance(0.6))
      for (double& x : q) x += random.chance(0.5) ? unit / 4 * random.integer(-4, 4) : unit * random.uniform(-0.5, 0.5);
    return q;
  };
  const auto anyRadius = [&](const Point3& q) {
    const auto p = anyPoint(cloud.view(), random);
    const double tie = p && isFinite(q) ? distance.gap({cloud.view().point(*p), q}) : unit;
    return random.chance(0.05) ? infinity : anyLength(tie, unit, random);
  };
  RadiusOptions options;
  Neighbors expected;
  for (int i = 0; i < 12; ++i) {
    const Point3 q = somewhere();
    const double radius = anyRadius(q);
    options.most = random.chance(0.5) ? 0 : static_cast<std::size_t>(random.integer(0, 20));
    options.sorted = random.chance(0.8);
    radiusSearch(cloud, q, radius, neighbors_, options);
    brute_force::radiusSearch(cloud, q, radius, expected, options);
    if (!options.sorted) {
      const auto sorted = [](const Neighbors& n) {
        std::vector<std::pair<float, std::int32_t>> pairs;
        for (std::size_t k = 0; k < n.indices.size(); ++k) pairs.emplace_back(n.squared_distances[k], n.indices[k]);
        std::sort(pairs.begin(), pairs.end());
        return pairs;
      };
      require(sorted(neighbors_) == sorted(expected), "radius search, unsorted: differs");
    }
    else {
      requireSame(neighbors_, expected, "radius search of " + std::to_string(radius), q);
    }
    require(anyInRadius(cloud, q, radius) == brute_force::anyInRadius(cloud, q, radius), "any in radius: differs");
    const auto k = static_cast<std::size_t>(random.integer(0, 20));
    nearestKSearch(cloud, q, k, neighbors_);
    brute_force::nearestKSearch(cloud, q, k, expected);
    requireSame(neighbors_, expected, "nearest " + std::to_string(k), q);
  }

  // Batches: the other cloud's points are the queries.
  const auto threads = static_cast<unsigned>(random.integer(1, 3));
  options.most = random.chance(0.5) ? 0 : 3;
  options.sorted = true;
  const double radius = anyRadius(somewhere());
  const auto k = static_cast<std::size_t>(random.integer(0, 5));
  const auto requireLists = [&](const auto& twin, const char* what) {
    require(lists_.indices.size() == queries.size(), what);
    for (std::size_t i = 0; i < queries.size(); i += 7) {
      twin(queries.point(queries.record(i)));
      require(lists_.indices[i] == expected.indices, what);
      require(lists_.squared_distances[i] == expected.squared_distances, what);
    }
  };
  radiusSearch(cloud, queries, radius, lists_, options, threads);
  requireLists([&](const Point3& q) { brute_force::radiusSearch(cloud, q, radius, expected, options); },
               "radius search of many: differs");
  nearestKSearch(cloud, queries, k, lists_, threads);
  requireLists([&](const Point3& q) { brute_force::nearestKSearch(cloud, q, k, expected); },
               "k nearest of many: differs");
  const std::vector<std::uint8_t> any = flagAnyInRadius(cloud, queries, radius, threads);
  for (std::size_t i = 0; i < queries.size(); i += 5)
    require((any[i] != 0) == brute_force::anyInRadius(cloud, queries.point(queries.record(i)), radius),
            "any in radius of many: differs");
  if (!queries.radii) return;
  const std::vector<std::uint8_t> balls = anyInBalls(cloud, queries, threads);
  for (std::size_t i = 0; i < queries.size(); i += 5) {
    const std::uint32_t record = queries.record(i);
    require((balls[i] != 0) == brute_force::anyInRadius(cloud, queries.point(record), queries.radius(record)),
            "any in balls: differs");
  }
}

void Questions::askBoxes(const SphereHierarchy& cloud, double unit, Random& random)
{
  std::vector<std::int32_t> expected;
  for (int i = 0; i < 4; ++i) {
    Point3 low, high;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto p = anyPoint(cloud.view(), random);
      const double from = p && random.chance(0.7) ? cloud.view().point(*p)[k] : unit * random.uniform(-2, 2);
      const double to = random.chance(0.3) ? from : from + unit / 8 * random.integer(-1, 16);
      low[k] = random.chance(0.05) ? -infinity : from;
      high[k] = random.chance(0.05) ? infinity : to;
    }
    boxSearch(cloud, low, high, indices_);
    brute_force::boxSearch(cloud, low, high, expected);
    require(indices_ == expected, "box search: differs");
  }
}

void Questions::askClusters(const SphereHierarchy& cloud, double unit, Random& random)
{
  const double distance = anyClearance({cloud}, {cloud}, unit, random);
  const Clusters found = euclideanClusters(cloud, distance), expected = brute_force::euclideanClusters(cloud, distance);
  require(found.of == expected.of && found.sizes == expected.sizes, "clusters: differ");
}

void Questions::askAlong(const Placed& a, const Placed& b, double unit, Random& random)
{
  std::vector<Eigen::Isometry3d> poses;
  Eigen::Isometry3d pose = b.pose;
  for (int k = random.integer(0, 5); k > 0; --k) {
    poses.push_back(pose);
    pose.pretranslate(Eigen::Vector3d{unit / 8 * random.integer(-2, 2), unit / 8 * random.integer(-2, 2), 0});
    if (random.chance(0.2)) pose.linear() = random.rotation().toRotationMatrix();
  }
  TrajectoryRequest request;
  request.clearance = anyClearance(a, b, unit, random);
  request.threads = static_cast<unsigned>(random.integer(1, 3));
  request.flags = random.chance(0.7);
  request.distances = random.chance(0.5);
  request.first_poses = random.chance(0.5);
  request.closest_poses = random.chance(0.5);
  request.pose_summaries = random.chance(0.5);
  TrajectoryRequest all = request;
  all.flags = all.distances = all.first_poses = all.closest_poses = all.pose_summaries = true;
  const TrajectoryResult expected = brute_force::collideAlong(a, b.hierarchy(), poses, all);
  const TrajectoryResult found = collideAlong(a, b.hierarchy(), poses, request);
  const auto same = [&](const auto& x, const auto& y, bool asked, const char* what) {
    if (asked ? x == y : x.empty()) return;
    std::ostringstream text;
    text.precision(17);
    text << what << ", clearance " << request.clearance << ", " << poses.size() << " poses, asked for"
         << (request.flags ? " flags" : "") << (request.distances ? " distances" : "")
         << (request.first_poses ? " first_poses" : "") << (request.closest_poses ? " closest_poses" : "")
         << (request.pose_summaries ? " pose_summaries" : "") << ", " << request.threads << " threads";
    const auto shown = [](auto value) {
      if constexpr (std::is_enum_v<decltype(value)>)
        return static_cast<int>(value);
      else
        return value;
    };
    for (std::size_t i = 0; asked && i < std::min(x.size(), y.size()); ++i)
      if (x[i] != y[i]) text << "; point " << i << ": " << shown(x[i]) << " instead of " << shown(y[i]);
    throw Finding(text.str());
  };
  same(found.flags, expected.flags, request.flags, "along: flags differ");
  const auto bits = [](const std::vector<float>& lengths) { // NaN equals NaN
    std::vector<std::uint32_t> words(lengths.size());
    if (!lengths.empty()) std::memcpy(words.data(), lengths.data(), 4 * lengths.size());
    return words;
  };
  same(bits(found.distance), bits(expected.distance), request.distances, "along: distances differ");
  same(found.first_pose, expected.first_pose, request.first_poses, "along: first poses differ");
  same(found.closest_pose, expected.closest_pose, request.closest_poses, "along: closest poses differ");
  same(found.closest_point, expected.closest_point, request.distances || request.closest_poses,
       "along: closest points differ");
  require(found.poses.size() == (request.pose_summaries ? poses.size() : 0), "along: number of summaries");
  for (std::size_t k = 0; k < found.poses.size(); ++k)
    require(found.poses[k].colliding == expected.poses[k].colliding &&
                found.poses[k].colliding_points == expected.poses[k].colliding_points &&
                found.poses[k].distance == expected.poses[k].distance,
            "along: summaries differ");

  if (random.chance(0.3)) {
    TrajectoryRequest early = request;
    early.distances = early.first_poses = early.closest_poses = early.pose_summaries = false;
    early.flags = true;
    early.accuracy = random.chance(0.5) ? Accuracy::level(static_cast<unsigned>(random.integer(0, 2)))
                                        : Accuracy::nodePairs(static_cast<std::uint64_t>(random.integer(0, 300)));
    requireFlags(collideAlong(a, b.hierarchy(), poses, early).flags, expected.flags, expected.flags, early.accuracy,
                 "along: not what the accuracy grants");
  }
  if (random.chance(0.3)) {
    TrajectoryRequest swept = request;
    swept.pose_summaries = false;
    swept.flags = true;
    swept.swept = unit / 64;
    std::vector<Verdict> flags;
    try {
      flags = collideAlong(a, b.hierarchy(), poses, swept).flags;
    }
    catch (const std::invalid_argument&) { // coordinates too large for the tolerance
      return;
    }
    for (std::size_t i = 0; i < flags.size(); ++i)
      require(flags[i] >= expected.flags[i], "swept: free, though colliding at a pose");
  }
  if (!std::isfinite(request.clearance) || request.clearance > 1e100) return;
  const double step = unit / 4;
  std::vector<std::uint32_t> clashing;
  const std::vector<Clash> clashes = findClashes(a.hierarchy().view(), expected, step);
  for (const Clash& clash : clashes) clashing.insert(clashing.end(), clash.records.begin(), clash.records.end());
  std::sort(clashing.begin(), clashing.end());
  std::vector<std::uint32_t> colliding;
  for (std::uint32_t i = 0; i < expected.flags.size(); ++i)
    if (expected.flags[i] == Verdict::colliding) colliding.push_back(i);
  require(clashing == colliding, "clashes: do not hold the colliding points once each");
  std::vector<std::int32_t> subset(colliding.begin(), colliding.end());
  subset.push_back(0); // so that there is an address
  PointsView those = a.hierarchy().view();
  those.indices = subset.data();
  those.index_count = colliding.size();
  const Clusters clusters = brute_force::euclideanClusters(SphereHierarchy(those), step);
  require(clusters.sizes.size() == clashes.size(), "clashes: not the clusters");
  for (const Clash& clash : clashes)
    for (const std::uint32_t record : clash.records)
      require(clusters.of[record] == clusters.of[clash.records.front()], "clashes: not the clusters");
}

void Questions::askSpacing(const SphereHierarchy& cloud)
{
  const std::vector<FinitePoint> points = finitePoints(cloud.view());
  if (points.size() > 1024) return;
  std::vector<double> gaps;
  for (const FinitePoint& p : points) {
    double nearest = infinity;
    for (const FinitePoint& q : points)
      if (p.point != q.point)
        nearest =
            std::min(nearest, std::hypot(p.point[0] - q.point[0], p.point[1] - q.point[1], p.point[2] - q.point[2]));
    if (std::isfinite(nearest)) gaps.push_back(nearest);
  }
  const Spacing found = spacingOf(cloud);
  require(found.samples == points.size(), "spacing: another number of samples");
  if (gaps.empty()) return require(found.median == 0.0 && found.wide == 0.0, "spacing: of one place");
  std::sort(gaps.begin(), gaps.end());
  const auto near = [](double x, double y) { return std::abs(x - y) <= 1e-6 * y; };
  require(near(found.median, gaps[gaps.size() / 2]), "spacing: another median");
  require(near(found.wide, gaps[gaps.size() * 9 / 10]), "spacing: another wide one");
}

} // namespace pcl_bsh::fuzz

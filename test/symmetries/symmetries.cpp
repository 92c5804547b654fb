// SPDX-License-Identifier: BSD-3-Clause
#include "symmetries.h"

#include "answers.h"
#include "fuzz/target.h"
#include "signed_axes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numeric>

namespace pcl_bsh::symmetries {
namespace {

using test::Random;
using Poses = std::vector<Eigen::Isometry3d>;

/// An instance made of another, and what is asked of it to be answered.
struct Image {
  Instance instance;
  Answers expected;
  Kept kept = {};
};

void turnPoints(Body& body, const SignedAxes& axes)
{
  for (Point3& p : body.points) p = axes(p);
}

void turnOwn(Instance& instance, const SignedAxes& axes)
{
  for (Point3& query : instance.queries) query = axes(query);
  const Point3 low = axes(instance.low), high = axes(instance.high);
  for (std::size_t k = 0; k < 3; ++k) {
    instance.low[k] = std::min(low[k], high[k]);
    instance.high[k] = std::max(low[k], high[k]);
  }
}

// Frames ----------------------------------------------------------------------------------------------------------

/// Also mirrored.
void exchangeAxes(Image& image, Random& random)
{
  const SignedAxes axes = SignedAxes::any(random);
  Instance& made = image.instance;
  turnPoints(made.a, axes);
  turnPoints(made.b, axes);
  turnOwn(made, axes);
  for (Eigen::Isometry3d* pose : {&made.a.pose, &made.b.pose}) *pose = axes.conjugated(*pose);
  for (Poses* poses : {&made.path, &made.relative})
    for (Eigen::Isometry3d& pose : *poses) pose = axes.conjugated(pose);
}

void turnWorld(Image& image, Random& random)
{
  const SignedAxes turn = SignedAxes::anyTurn(random);
  Instance& made = image.instance;
  made.a.pose = turn.before(made.a.pose);
  made.b.pose = turn.before(made.b.pose);
  for (Eigen::Isometry3d& pose : made.path) pose = turn.before(pose);
}

/// Where no sum rounds.
bool shiftWorld(Image& image, Random& random)
{
  Instance& made = image.instance;
  const double reach = std::max(made.clearance, made.tolerance);
  if (!(reach > 0.0) || !std::isfinite(reach)) return false;
  bool exact = true;
  const Point3 shift = random.point([&] { return std::exp2(std::ilogb(reach)) * random.integer(-64, 64); });
  const auto move = [&](Eigen::Isometry3d& pose) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double before = pose.translation()[k], by = shift[static_cast<std::size_t>(k)], after = before + by;
      exact = exact && after - by == before && after - before == by;
      pose.translation()[k] = after;
    }
  };
  move(made.a.pose);
  move(made.b.pose);
  std::for_each(made.path.begin(), made.path.end(), move);
  return exact;
}

void turnFrameOfA(Image& image, Random& random)
{
  const SignedAxes turn = SignedAxes::anyTurn(random);
  Instance& made = image.instance;
  turnPoints(made.a, turn);
  turnOwn(made, turn);
  made.a.pose = turn.undoneBy(made.a.pose);
  for (Eigen::Isometry3d& pose : made.relative) pose = turn.before(pose);
}

void turnFrameOfB(Image& image, Random& random)
{
  const SignedAxes turn = SignedAxes::anyTurn(random);
  Instance& made = image.instance;
  turnPoints(made.b, turn);
  made.b.pose = turn.undoneBy(made.b.pose);
  for (Poses* poses : {&made.path, &made.relative})
    for (Eigen::Isometry3d& pose : *poses) pose = turn.undoneBy(pose);
}

// Lengths ---------------------------------------------------------------------------------------------------------

/// Multiplies by powers of two, and remembers whether anything was lost to the ends of the numbers.
struct Scale {
  int power;
  bool exact = true;

  template <class Number>
  void operator()(Number& x, int times = 1)
  {
    const Number scaled = std::ldexp(x, times * power);
    const auto whole = [](Number y) { return y == 0 || std::isnormal(y) || !std::isfinite(y); };
    exact =
        exact && whole(x) && whole(scaled) && std::isfinite(x) == std::isfinite(scaled) && (x == 0) == (scaled == 0);
    x = scaled;
  }
  void operator()(Point3& p)
  {
    for (double& x : p) (*this)(x);
  }
  void operator()(Eigen::Isometry3d& pose)
  {
    for (Eigen::Index k = 0; k < 3; ++k) (*this)(pose.translation()[k]);
  }
  template <class Value>
  void operator()(std::vector<Value>& values)
  {
    for (Value& value : values) (*this)(value);
  }
  void operator()(Body& body)
  {
    (*this)(body.points);
    (*this)(body.radii);
    (*this)(body.uncertainties);
    (*this)(body.pose);
    if (body.scalar == Scalar::float32) // of coordinates, too
      for (Point3 p : body.points)
        for (double& x : p) {
          const double back = std::ldexp(x, -power);
          for (const double y : {x, back})
            exact = exact && (y == 0 || std::isnormal(static_cast<float>(y)) || !std::isfinite(y)) &&
                    std::isfinite(static_cast<float>(y)) == std::isfinite(y);
        }
  }
};

/// Whether floats hold all squared distances from the queries.
bool squaresAreNormal(const Instance& instance)
{
  for (const Point3& q : instance.queries)
    for (const Point3& p : instance.a.points) {
      const double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
      const auto squared = static_cast<float>(x * x + y * y + z * z);
      if (isFinite(p) && !std::isnormal(squared) && (x != 0 || y != 0 || z != 0)) return false;
    }
  return true;
}

double largestCoordinate(const Instance& instance)
{
  double most = 0.0;
  for (const Body* body : {&instance.a, &instance.b}) {
    most = std::max(most, body->pose.translation().cwiseAbs().maxCoeff());
    for (const Point3& p : body->points)
      for (const double x : p)
        if (std::isfinite(x)) most = std::max(most, std::abs(x));
  }
  return most;
}

bool scale(Image& image, Random& random)
{
  constexpr int powers[] = {-40, -7, -1, 1, 2, 10, 60};
  Scale by{random.pick(powers)};
  const Instance original = image.instance;
  Instance& made = image.instance;
  by(made.a);
  by(made.b);
  by(made.path);
  by(made.relative);
  by(made.queries);
  for (Point3* corner : {&made.low, &made.high}) by(*corner);
  by(made.clearance);
  by(made.tolerance);
  Answers& told = image.expected;
  by(told.closest);
  for (auto& contact : told.contacts) by(contact.second);
  for (auto* distances : {&told.distances_a, &told.distances_b, &told.limited_a, &told.distance_at, &told.closest_at,
                          &told.asked_both_ways})
    by(*distances);
  by(told.hausdorff);
  by(told.asked_closest);
  by(told.path_distances);
  by(told.asked_distances);
  for (Answers::Surface* surface : {&told.surface, &told.shell}) {
    by(surface->distances);
    by(surface->face_distances);
    by(surface->closest);
  }
  for (Answers::Near& near : told.near) {
    for (auto& neighbor : near.within) neighbor.second = std::ldexp(neighbor.second, 2 * by.power);
    for (float& nearest : near.nearest) nearest = std::ldexp(nearest, 2 * by.power);
  }
  image.kept.own = squaresAreNormal(image.instance) && squaresAreNormal(original);
  const double most = std::max(largestCoordinate(original), largestCoordinate(made));
  if (most > 0x1p90) made.tolerance = 0.0; // swept motion ends at 2^100
  by.exact = by.exact && most < 0x1p1000;  // distances that are no number are those of no point
  return by.exact;
}

// Records ---------------------------------------------------------------------------------------------------------

/// Where the records of an image come from: [new] = old.
using Sources = std::vector<std::size_t>;

template <class Value>
void take(std::vector<Value>& values, const Sources& sources)
{
  if (values.empty()) return;
  std::vector<Value> taken;
  for (const std::size_t source : sources) taken.push_back(values[source]);
  values = std::move(taken);
}

void take(Body& body, const Sources& sources)
{
  take(body.points, sources);
  take(body.radii, sources);
  take(body.uncertainties, sources);
}

std::vector<std::int32_t> recordsOf(const std::vector<std::int32_t>& old, const Sources& sources)
{
  std::vector<std::int32_t> records;
  for (std::size_t i = 0; i < sources.size(); ++i)
    if (std::binary_search(old.begin(), old.end(), static_cast<std::int32_t>(sources[i])))
      records.push_back(static_cast<std::int32_t>(i));
  return records;
}

/// Answers about clouds that consist of records of the old ones, each at least once.
void takeRecords(Image& image, const Sources& from_a, const Sources& from_b)
{
  take(image.instance.a, from_a);
  take(image.instance.b, from_b);
  Answers& told = image.expected;
  for (auto* flags : {&told.flags_a, &told.path_flags, &told.swept.free, &told.swept.hit, &told.swept.free_farther,
                      &told.asked_flags, &told.asked_within, &told.asked_path_flags})
    take(*flags, from_a);
  for (auto* flags : {&told.flags_b, &told.asked_obstacle_flags}) take(*flags, from_b);
  told.indices_a = recordsOf(told.indices_a, from_a);
  told.indices_b = recordsOf(told.indices_b, from_b);
  for (auto* distances : {&told.distances_a, &told.limited_a}) take(*distances, from_a);
  for (auto* distances : {&told.distances_b, &told.asked_both_ways}) take(*distances, from_b);
  for (auto* distances : {&told.path_distances, &told.asked_distances}) take(*distances, from_a);
  for (auto* poses : {&told.first_poses, &told.closest_poses}) take(*poses, from_a);
  for (auto* nearest : {&told.names.nearest_a, &told.names.closest_point}) take(*nearest, from_a);
  take(told.names.nearest_b, from_b);
  for (Answers::Surface* surface : {&told.surface, &told.shell}) {
    for (auto* flags : {&surface->flags, &surface->path_flags}) take(*flags, from_a);
    take(surface->distances, from_a);
  }
  std::vector<std::uint32_t> new_of_b(from_b.size());
  for (std::size_t i = from_b.size(); i-- > 0;) new_of_b[from_b[i]] = static_cast<std::uint32_t>(i);
  for (auto* faces : {&image.instance.faces, &image.instance.shell})
    for (Triangle& face : *faces)
      for (std::uint32_t& corner : face) corner = new_of_b[corner];

  const auto old = std::move(told.contacts);
  told.contacts.clear();
  for (std::uint32_t i = 0; i < from_a.size(); ++i)
    for (std::uint32_t j = 0; j < from_b.size(); ++j) {
      const PointPair source{static_cast<std::uint32_t>(from_a[i]), static_cast<std::uint32_t>(from_b[j])};
      const auto contact = std::lower_bound(old.begin(), old.end(), source,
                                            [](const auto& l, const PointPair& r) { return l.first < r; });
      if (contact != old.end() && contact->first == source)
        told.contacts.emplace_back(PointPair{i, j}, contact->second);
    }

  for (Answers::Near& near : told.near) {
    const auto before = std::move(near.within);
    near.within.clear();
    for (std::size_t i = 0; i < from_a.size(); ++i)
      for (const auto& [record, squared] : before)
        if (static_cast<std::size_t>(record) == from_a[i])
          near.within.emplace_back(static_cast<std::int32_t>(i), squared);
  }
  told.box = recordsOf(told.box, from_a);
  std::vector<std::int32_t> smallest(told.clusters.size(), -1);
  take(told.clusters, from_a);
  for (std::size_t i = 0; i < told.clusters.size(); ++i)
    if (told.clusters[i] >= 0) {
      std::int32_t& first = smallest[static_cast<std::size_t>(told.clusters[i])];
      if (first < 0) first = static_cast<std::int32_t>(i);
      told.clusters[i] = first;
    }
}

Sources inOrder(std::size_t count)
{
  Sources sources(count);
  std::iota(sources.begin(), sources.end(), std::size_t{0});
  return sources;
}

void shuffle(Image& image, Random& random)
{
  const auto shuffled = [&](std::size_t count) {
    Sources sources = inOrder(count);
    for (std::size_t i = count; i > 1; --i)
      std::swap(sources[i - 1], sources[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
    return sources;
  };
  takeRecords(image, shuffled(image.instance.a.points.size()), shuffled(image.instance.b.points.size()));
  image.kept.names = false;
}

/// The copies come last, so that the smallest records stay.
void doublePoints(Image& image, Random&)
{
  const auto twice = [](std::size_t count) {
    Sources sources = inOrder(count);
    sources.insert(sources.end(), sources.begin(), sources.begin() + static_cast<std::ptrdiff_t>(count));
    return sources;
  };
  takeRecords(image, twice(image.instance.a.points.size()), twice(image.instance.b.points.size()));
  for (std::size_t& count : image.expected.colliding_at) count *= 2;
  image.kept.nearest = false;
}

void exchangeClouds(Image& image, Random&)
{
  std::swap(image.instance.a, image.instance.b);
  Answers& told = image.expected;
  std::swap(told.flags_a, told.flags_b);
  std::swap(told.indices_a, told.indices_b);
  std::swap(told.distances_a, told.distances_b);
  for (auto& contact : told.contacts) std::swap(contact.first.a, contact.first.b);
  std::sort(told.contacts.begin(), told.contacts.end());
  told.limited_a = told.distances_a; // nothing less rounded than distances says which are within the clearance
  for (std::size_t i = 0; i < told.limited_a.size(); ++i) {
    const auto record = static_cast<std::uint32_t>(i);
    const bool within = std::any_of(told.contacts.begin(), told.contacts.end(),
                                    [&](const auto& contact) { return contact.first.a == record; });
    if (!within) told.limited_a[i] = std::numeric_limits<double>::quiet_NaN();
  }
  image.instance.tolerance = 0.0;
  image.instance.faces.clear();
  image.instance.shell.clear();
  image.kept = {false, false, false, false, false, false};
}

// Paths -----------------------------------------------------------------------------------------------------------

template <class Value>
void reverseGroups(std::vector<Value>& values, std::size_t group)
{
  std::reverse(values.begin(), values.end());
  for (std::size_t i = 0; i + group <= values.size(); i += group)
    std::reverse(values.begin() + static_cast<std::ptrdiff_t>(i),
                 values.begin() + static_cast<std::ptrdiff_t>(i + group));
}

/// Which of several poses is the first is another matter.
void reversePath(Image& image, Random&)
{
  std::reverse(image.instance.path.begin(), image.instance.path.end());
  Answers& told = image.expected;
  reverseGroups(told.colliding_at, 2);
  for (auto* distances : {&told.distance_at, &told.closest_at}) reverseGroups(*distances, 1);
  for (auto* flags : {&told.any_at, &told.motions.free, &told.motions.hit, &told.motions.free_farther})
    reverseGroups(*flags, 1);
  told.first_poses.clear();
  told.closest_poses.clear();
  image.kept.names = false;
  image.kept.motions = true; // a motion has the same verdict in both directions
}

template <class Value>
void repeatGroups(std::vector<Value>& values, std::size_t group)
{
  std::vector<Value> repeated;
  for (std::size_t i = 0; i + group <= values.size(); i += group)
    for (int time = 0; time < 2; ++time)
      repeated.insert(repeated.end(), values.begin() + static_cast<std::ptrdiff_t>(i),
                      values.begin() + static_cast<std::ptrdiff_t>(i + group));
  values = std::move(repeated);
}

void repeatPoses(Image& image, Random&)
{
  repeatGroups(image.instance.path, 1);
  repeatGroups(image.instance.relative, 1);
  Answers& told = image.expected;
  repeatGroups(told.colliding_at, 2);
  for (auto* distances : {&told.distance_at, &told.closest_at}) repeatGroups(*distances, 1);
  repeatGroups(told.any_at, 1);
  for (auto* poses : {&told.first_poses, &told.closest_poses})
    for (std::int32_t& pose : *poses) pose = pose < 0 ? pose : 2 * pose;
  told.motions = {}; // there are others between
}

// Halves ----------------------------------------------------------------------------------------------------------

std::uint8_t worse(std::uint8_t l, std::uint8_t r)
{
  constexpr auto hit = static_cast<std::uint8_t>(Verdict::colliding);
  return l == hit || r == hit ? hit : std::max(l, r);
}

constexpr auto smaller = [](auto l, auto r) { return std::fmin(l, r); }; // NaN: none

template <class Value>
std::vector<Value> interleaved(const std::vector<Value>& even, const std::vector<Value>& odd)
{
  std::vector<Value> all;
  for (std::size_t i = 0; i < even.size() + odd.size(); ++i) all.push_back(i % 2 == 0 ? even[i / 2] : odd[i / 2]);
  return all;
}

template <class Value, class Join>
std::vector<Value> joined(std::vector<Value> l, const std::vector<Value>& r, Join join)
{
  for (std::size_t i = 0; i < l.size(); ++i) l[i] = join(l[i], r[i]);
  return l;
}

std::vector<std::int32_t> bothRecords(const std::vector<std::int32_t>& even, const std::vector<std::int32_t>& odd)
{
  std::vector<std::int32_t> all;
  for (const std::int32_t record : even) all.push_back(2 * record);
  for (const std::int32_t record : odd) all.push_back(2 * record + 1);
  std::sort(all.begin(), all.end());
  return all;
}

/// The even records of a, or the odd ones.
Instance halfOf(const Instance& whole, std::size_t first)
{
  Instance half = whole;
  Sources sources;
  for (std::size_t i = first; i < whole.a.points.size(); i += 2) sources.push_back(i);
  take(half.a, sources);
  if (sources.empty()) half.a = {{}, {}, {}, whole.a.scalar, whole.a.pose};
  half.tolerance = 0.0;
  return half;
}

/// The answers about the whole cloud, from those of its two halves.
Answers joinedHalves(const Answers& even, const Answers& odd)
{
  Answers all;
  all.any = worse(even.any, odd.any);
  all.flags_a = interleaved(even.flags_a, odd.flags_a);
  all.flags_b = joined(even.flags_b, odd.flags_b, worse);
  all.indices_a = bothRecords(even.indices_a, odd.indices_a);
  std::set_union(even.indices_b.begin(), even.indices_b.end(), odd.indices_b.begin(), odd.indices_b.end(),
                 std::back_inserter(all.indices_b));
  all.closest = smaller(even.closest, odd.closest);
  for (const Answers* half : {&even, &odd})
    for (const auto& [pair, distance] : half->contacts)
      all.contacts.emplace_back(PointPair{2 * pair.a + (half == &odd), pair.b}, distance);
  std::sort(all.contacts.begin(), all.contacts.end());
  all.distances_a = interleaved(even.distances_a, odd.distances_a);
  all.distances_b = joined(even.distances_b, odd.distances_b, smaller);
  all.limited_a = interleaved(even.limited_a, odd.limited_a);
  for (std::size_t i = 0; i < even.near.size(); ++i) {
    Answers::Near near;
    for (const Answers* half : {&even, &odd})
      for (const auto& [record, squared] : half->near[i].within)
        near.within.emplace_back(2 * record + (half == &odd), squared);
    std::sort(near.within.begin(), near.within.end());
    near.any = even.near[i].any || odd.near[i].any;
    all.near.push_back(near);
  }
  all.box = bothRecords(even.box, odd.box);
  all.path_flags = interleaved(even.path_flags, odd.path_flags);
  all.path_distances = interleaved(even.path_distances, odd.path_distances);
  all.first_poses = interleaved(even.first_poses, odd.first_poses);
  all.closest_poses = interleaved(even.closest_poses, odd.closest_poses);
  all.colliding_at = joined(even.colliding_at, odd.colliding_at, std::plus<>());
  all.distance_at = joined(even.distance_at, odd.distance_at, smaller);
  all.any_at = joined(even.any_at, odd.any_at, worse);
  all.closest_at = joined(even.closest_at, odd.closest_at, smaller);
  all.asked_flags = interleaved(even.asked_flags, odd.asked_flags);
  all.asked_obstacle_flags = joined(even.asked_obstacle_flags, odd.asked_obstacle_flags, worse);
  all.asked_within = interleaved(even.asked_within, odd.asked_within);
  all.asked_path_flags = interleaved(even.asked_path_flags, odd.asked_path_flags);
  all.asked_distances = interleaved(even.asked_distances, odd.asked_distances);
  all.asked_both_ways = joined(even.asked_both_ways, odd.asked_both_ways, smaller);
  all.asked_closest = smaller(even.asked_closest, odd.asked_closest);
  const auto join_surfaces = [](const Answers::Surface& l, const Answers::Surface& r) {
    return Answers::Surface{interleaved(l.flags, r.flags),
                            interleaved(l.path_flags, r.path_flags),
                            interleaved(l.distances, r.distances),
                            joined(l.face_flags, r.face_flags, worse),
                            joined(l.face_distances, r.face_distances, smaller),
                            smaller(l.closest, r.closest)};
  };
  all.surface = join_surfaces(even.surface, odd.surface);
  all.shell = join_surfaces(even.shell, odd.shell);
  return all;
}

// All -------------------------------------------------------------------------------------------------------------

void require(const Instance& instance, const std::string& symmetry, const std::string& difference)
{
  if (!difference.empty()) throw fuzz::Finding(instance.name + ", " + symmetry + ": " + difference);
}

/// No motion that collides is free where the clearance is larger by the tolerance.
std::string contradiction(const Answers::Motion& l, const Answers::Motion& r)
{
  for (std::size_t i = 0; i < std::min(l.hit.size(), r.free_farther.size()); ++i)
    if ((l.hit[i] == 1 && r.free_farther[i] == 1) || (r.hit[i] == 1 && l.free_farther[i] == 1))
      return "motion " + std::to_string(i) + ": collides, and is free";
  return {};
}

void compare(const Instance& instance, const std::string& symmetry, const Image& image, const Ask& ask)
{
  Answers found = ask(image.instance);
  const Answers& expected = image.expected;
  if (expected.first_poses.empty()) { // not known
    found.first_poses.clear();
    found.closest_poses.clear();
  }
  require(instance, symmetry, firstDifference(expected, found, image.kept));
  require(instance, symmetry, contradiction(expected.swept, found.swept));
  require(instance, symmetry, contradiction(expected.motions, found.motions));
}

} // namespace

std::size_t requireSymmetric(const Instance& instance, Random& random, const Ask& ask)
{
  const auto always = [](void (*change)(Image&, Random&)) {
    return [change](Image& image, Random& numbers) {
      change(image, numbers);
      return true;
    };
  };
  const std::pair<const char*, std::function<bool(Image&, Random&)>> symmetries[] = {
      {"axes exchanged", always(exchangeAxes)},
      {"world turned", always(turnWorld)},
      {"world shifted", shiftWorld},
      {"frame of a turned", always(turnFrameOfA)},
      {"frame of b turned", always(turnFrameOfB)},
      {"lengths scaled", scale},
      {"records in another order", always(shuffle)},
      {"points doubled", always(doublePoints)},
      {"clouds exchanged", always(exchangeClouds)},
      {"path reversed", always(reversePath)},
      {"poses repeated", always(repeatPoses)},
  };
  const Answers original = ask(instance);
  require(instance, "clearance raised", contradiction(original.swept, original.swept));
  require(instance, "clearance raised", contradiction(original.motions, original.motions));
  std::size_t compared = 0;
  for (const auto& [name, change] : symmetries) {
    Image image{instance, original};
    image.instance.threads = static_cast<unsigned>(random.integer(1, 3));
    if (!change(image, random)) continue;
    compare(instance, name, image, ask);
    ++compared;
  }
  Answers halves = joinedHalves(ask(halfOf(instance, 0)), ask(halfOf(instance, 1)));
  halves.hausdorff = original.hausdorff; // the greatest of smallest distances is not that of a half
  require(instance, "a split in two", firstDifference(halves, original, {false, true, false, true, true}));
  return compared + 1;
}

} // namespace pcl_bsh::symmetries

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/seen/unseen_points.h>

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/query/result.h>

#include "support/brute_force/unseen.h"
#include "support/made_scans.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::hallOfPillars;
using test::kPi;
using test::MadeRoom;
using test::MadeScan;
using test::MadeScanner;
using test::makeScan;
using test::Random;
using Verdicts = std::vector<Verdict>;

constexpr Verdict kUnseen = Verdict::unseen;

UnseenRequest within(double clearance, unsigned threads = 1)
{
  UnseenRequest request;
  request.clearance = clearance;
  request.threads = threads;
  return request;
}

/// Verdicts of a model at a pose, all free before.
Verdicts verdictsOf(const SeenSpace& seen, const Placed& model, double clearance, unsigned threads = 1)
{
  Verdicts verdicts(model.hierarchy().view().count, Verdict::free);
  const UnseenResult found = markUnseen(seen, model, within(clearance, threads), verdicts);
  EXPECT_EQ(found.unseen, static_cast<std::size_t>(std::count(verdicts.begin(), verdicts.end(), kUnseen)));
  return verdicts;
}

Verdicts bruteForce(const std::vector<ScanBeams>& scans, double angle, const Placed& model, double clearance)
{
  Verdicts verdicts(model.hierarchy().view().count, Verdict::free);
  brute_force::markUnseen(scans, angle, model, within(clearance), verdicts);
  return verdicts;
}

SeenSpace spaceOf(const std::vector<ScanBeams>& scans, double angle, unsigned threads = 1)
{
  SeenOptions options;
  options.angle = angle;
  options.threads = threads;
  return SeenSpace(scans, options);
}

/// One place, as a model.
bool isSeen(const std::vector<ScanBeams>& scans, double angle, const Point3& place, double clearance)
{
  const SphereHierarchy model(viewOf(place.data(), 1));
  const Verdicts verdicts = verdictsOf(spaceOf(scans, angle), {model}, clearance);
  EXPECT_EQ(verdicts, bruteForce(scans, angle, {model}, clearance));
  return verdicts[0] != kUnseen;
}

/// Beams from the origin all around, each of them so long: at an angle of 0.2, sure of 0.8 of that.
std::vector<double> allAround(double step, double range)
{
  MadeRoom ball{{Eigen::Vector3d::Constant(-1e6), Eigen::Vector3d::Constant(1e6)}, {}};
  Random random(1);
  MadeScanner scanner{Eigen::Vector3d::Zero(), step, -kPi / 2, kPi / 2};
  MadeScan made = makeScan(ball, scanner, random);
  for (std::size_t i = 0; i < made.returns.size(); i += 3) {
    Eigen::Map<Eigen::Vector3d> end(made.returns.data() + i);
    end *= range / end.norm();
  }
  return made.returns;
}

ScanBeams scanOf(const std::vector<double>& xyz)
{
  ScanBeams scan;
  scan.returns = viewOf(xyz.data(), xyz.size() / 3);
  return scan;
}

TEST(MarkUnseen, AgreesWithBruteForce)
{
  std::size_t seen_points = 0, unseen_points = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Random random(seed);
    const MadeRoom room = hallOfPillars();
    std::vector<MadeScan> made;
    std::vector<Eigen::Vector3d> origins;
    for (int s = 0; s <= static_cast<int>(seed % 3); ++s) {
      MadeScanner scanner{{random.uniform(1, 3) + 8 * s, random.uniform(1, 3), random.uniform(1, 2)},
                          random.uniform(0.06, 0.12),
                          random.uniform(-1.5, -0.5),
                          random.uniform(0.3, 1.5),
                          seed % 2 == 0 ? 0.0 : 0.02,
                          seed % 4 == 3 ? 6.0 : 1e9};
      made.push_back(makeScan(room, scanner, random));
      origins.push_back(scanner.origin);
    }
    std::vector<ScanBeams> scans;
    for (std::size_t s = 0; s < made.size(); ++s) {
      scans.push_back(made[s].scan(origins[s]));
      if (seed % 4 == 3 && s == 0) scans.back().misses_beyond = 5.0;
      if (seed % 5 == 1) scans.back().returns.uncertainty = 0.05;
    }
    const double angle = random.uniform(0.16, 0.25);
    test::Cloud cloud = test::anyCloud(400, seed % 2 == 0 ? 1.0 : 4.0, {0, 0, 0}, random);
    if (seed % 3 == 0) test::makeUncertain(cloud, 0.05, random);
    const SphereHierarchy model(cloud.view());
    Eigen::Isometry3d pose(Eigen::Quaterniond::UnitRandom());
    pose.translation() = Eigen::Vector3d{random.uniform(2, 18), random.uniform(2, 10), random.uniform(1, 3)};
    const double clearance = seed % 6 == 5 ? 0.0 : random.uniform(0.01, 0.3);
    const Verdicts truth = bruteForce(scans, angle, {model, pose}, clearance);
    const SeenSpace space = spaceOf(scans, angle);
    EXPECT_EQ(verdictsOf(space, {model, pose}, clearance), truth) << seed;
    EXPECT_EQ(verdictsOf(spaceOf(scans, angle, 2), {model, pose}, clearance, 2), truth) << seed;
    const auto unseen = static_cast<std::size_t>(std::count(truth.begin(), truth.end(), kUnseen));
    unseen_points += unseen;
    seen_points += truth.size() - unseen;
  }
  EXPECT_GT(seen_points, 400u);
  EXPECT_GT(unseen_points, 400u);
}

/// The contract of a ball that is seen, tried in directions of its cone.
void expectSeenByOne(const std::vector<ScanBeams>& scans, double angle, const Eigen::Vector3d& center, double radius)
{
  bool seen_by_one = false;
  for (const ScanBeams& scan : scans) {
    const Eigen::Vector3d origin(scan.origin.data()), way = center - origin, axis = way.normalized();
    const double distance = way.norm();
    bool seen = distance > radius;
    for (int i = 0; i <= 40 && seen; ++i) {
      const double off = std::asin(radius / distance) * std::sqrt(i / 40.0);
      const Eigen::Vector3d side = axis.unitOrthogonal(), up = axis.cross(side);
      const Eigen::Vector3d d =
          std::cos(off) * axis + std::sin(off) * (std::cos(2.4 * i) * side + std::sin(2.4 * i) * up);
      const double chord = radius * radius - std::pow(distance * std::sin(off), 2);
      const double leaves = distance * std::cos(off) + std::sqrt(std::max(0.0, chord));
      std::vector<double> turns; // of the beams round it
      for (std::size_t k = 0; k < scan.returns.count; ++k) {
        const Point3 end = scan.returns.point(static_cast<std::uint32_t>(k));
        const Eigen::Vector3d beam = Eigen::Vector3d(end.data()) - origin;
        const auto is_within = [&](double reach) {
          return beam.dot(d) >= beam.norm() * std::cos(reach * angle) * (1 + 1e-14);
        };
        if (is_within(1.2))
          turns.push_back(std::atan2(beam.dot(d.cross(d.unitOrthogonal())), beam.dot(d.unitOrthogonal())));
        if (!is_within(1.5)) continue;
        seen = seen && beam.norm() - scan.returns.uncertainty > leaves * (1 - 1e-12);
      }
      std::sort(turns.begin(), turns.end());
      seen = seen && turns.size() > 2 && turns.back() - turns.front() >= kPi - 1e-9;
      for (std::size_t k = 1; seen && k < turns.size(); ++k) seen = turns[k] - turns[k - 1] <= kPi + 1e-9;
    }
    seen_by_one = seen_by_one || seen;
  }
  EXPECT_TRUE(seen_by_one) << center.transpose() << ", radius " << radius;
}

/// Beams so near each other that what they leave out is told in cells of cells of tiles.
TEST(MarkUnseen, BeamsOfAFineScanLeaveOutAHole)
{
  constexpr double kStep = 0.001, kAngle = 0.002;
  std::vector<double> ends;
  for (int i = -40; i <= 40; ++i)
    for (int j = -40; j <= 40; ++j)
      if (std::hypot(i - 5, j) > 10)
        for (const double x : {10.0, 10 * kStep * i, 10 * kStep * j}) ends.push_back(x);
  const SeenSpace space = spaceOf({scanOf(ends)}, kAngle);
  Random random(31);
  int seen = 0, unseen = 0;
  for (int k = 0; k < 2000; ++k) {
    const double i = random.uniform(-36, 36), j = random.uniform(-36, 36), from_hole = std::hypot(i - 5, j) - 10,
                 range = random.uniform(2, 9);
    if (std::abs(from_hole) < 4) continue;
    const Point3 place = {range, range * kStep * i, range * kStep * j};
    const SphereHierarchy model(viewOf(place.data(), 1));
    const bool is_seen = verdictsOf(space, {model}, 1e-4)[0] != kUnseen;
    ASSERT_EQ(is_seen, from_hole > 0) << i << ' ' << j << ' ' << range;
    ++(is_seen ? seen : unseen);
  }
  EXPECT_GT(seen, 500);
  EXPECT_GT(unseen, 20);
}

TEST(MarkUnseen, KeepsItsPromiseInARoomOfPillars)
{
  const MadeRoom room = hallOfPillars();
  const double step = 0.03, clearance = 0.1;
  std::vector<MadeScan> made;
  std::vector<ScanBeams> scans;
  const Eigen::Vector3d origins[] = {{2, 2, 1.5}, {18, 10, 1.5}};
  Random random(7);
  for (const Eigen::Vector3d& origin : origins) made.push_back(makeScan(room, {origin, step, -1.57, 1.57}, random));
  for (std::size_t s = 0; s < made.size(); ++s) scans.push_back(made[s].scan(origins[s]));
  std::vector<double> places;
  for (int i = 0; i < 1500; ++i)
    for (const double most : {20.0, 12.0, 5.0}) places.push_back(random.uniform(0, most));
  const SphereHierarchy model(viewOf(places.data(), places.size() / 3));
  const SeenSpace space(scans);
  const Verdicts verdicts = verdictsOf(space, {model}, clearance);
  std::size_t visible = 0, recognised = 0;
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    const Eigen::Vector3d place(places[3 * i], places[3 * i + 1], places[3 * i + 2]);
    const bool seen = verdicts[i] != kUnseen;
    if (seen) {
      EXPECT_GT(room.distance(place), clearance) << place.transpose();
    }
    if (seen && i % 64 == 0) expectSeenByOne(scans, space.angle(0), place, clearance);
    if (!shows(room, origins[0], place, clearance, 40) && !shows(room, origins[1], place, clearance, 40)) continue;
    ++visible;
    recognised += seen;
  }
  EXPECT_GT(visible, 700u);
  EXPECT_GT(recognised, visible / 2); // beams of 30 mrad, half a metre apart at the far wall
}

/// A pillar hides the middle of a room from one scanner, and another sees it from behind.
class UnseenTriangles : public testing::Test {
protected:
  UnseenTriangles()
  {
    room.boxes.emplace_back(Eigen::Vector3d(3, 2.5, 0), Eigen::Vector3d(3.5, 3.5, 3));
    Random random(1);
    for (const double x : {1.0, 7.0}) {
      origins.emplace_back(x, 3.0, 1.5);
      made.push_back(makeScan(room, {origins.back(), 0.08, -1.57, 1.57}, random));
    }
    for (std::size_t s = 0; s < made.size(); ++s) scans.push_back(made[s].scan(origins[s]));
  }

  Verdicts found(const std::vector<float>& corners, std::size_t scanners, double clearance) const
  {
    std::vector<std::uint32_t> faces(corners.size() / 3);
    for (std::uint32_t i = 0; i < faces.size(); ++i) faces[i] = i;
    TrianglesView triangles;
    triangles.vertices = viewOf(corners.data(), faces.size());
    triangles.corners = faces.data();
    triangles.count = faces.size() / 3;
    const SphereHierarchy model(viewOf(triangles));
    const std::vector<ScanBeams> used(scans.begin(), scans.begin() + static_cast<std::ptrdiff_t>(scanners));
    const Verdicts verdicts = verdictsOf(spaceOf(used, 0.13), {model}, clearance);
    EXPECT_EQ(verdicts, bruteForce(used, 0.13, {model}, clearance));
    return verdicts;
  }

  MadeRoom room{{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(8, 6, 3)}, {}};
  std::vector<Eigen::Vector3d> origins;
  std::vector<MadeScan> made;
  std::vector<ScanBeams> scans;
};

TEST_F(UnseenTriangles, AreSeenInParts)
{
  // Long and thin, beside the pillar: the ball about it holds the pillar and the walls.
  const std::vector<float> beside = {1.0f, 1.0f, 1.5f, 3.5f, 1.0f, 1.5f, 3.5f, 1.05f, 1.6f};
  EXPECT_EQ(found(beside, 1, 0.05), (Verdicts{Verdict::free}));
  // Its far end is too near to the pillar's edge, as each of both scanners sees it.
  const std::vector<float> around = {1.0f, 1.0f, 1.5f, 7.0f, 1.0f, 1.5f, 7.0f, 1.05f, 1.6f};
  EXPECT_EQ(found(around, 1, 0.05), (Verdicts{Verdict::unseen}));
  EXPECT_EQ(found(around, 2, 0.05), (Verdicts{Verdict::free}));
}

TEST_F(UnseenTriangles, AreUnseenWhereOneOfTheirPlacesIs)
{
  Random random(2);
  std::size_t seen = 0, unseen = 0;
  std::vector<float> corners;
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d at{random.uniform(0.5, 7.5), random.uniform(0.5, 5.5), random.uniform(0.5, 2.5)};
    for (int c = 0; c < 3; ++c)
      for (Eigen::Index k = 0; k < 3; ++k) corners.push_back(static_cast<float>(at[k] + random.uniform(-0.5, 0.5)));
  }
  const double clearance = 0.05;
  const Verdicts verdicts = found(corners, 1, clearance);
  const SeenSpace space = spaceOf({scans[0]}, 0.13);
  for (std::size_t t = 0; t < verdicts.size(); ++t) {
    std::vector<double> places;
    for (int sample = 0; sample < 50; ++sample) {
      double u = random.uniform(0, 1), w = random.uniform(0, 1);
      if (u + w > 1) u = 1 - u, w = 1 - w;
      for (std::size_t k = 0; k < 3; ++k) {
        const double a = corners[9 * t + k], b = corners[9 * t + 3 + k], c = corners[9 * t + 6 + k];
        places.push_back(a + u * (b - a) + w * (c - a));
      }
    }
    const SphereHierarchy points(viewOf(places.data(), 50));
    const Verdicts of_places = verdictsOf(space, {points}, clearance * (1.0 - 1e-6));
    const auto missed = std::count(of_places.begin(), of_places.end(), kUnseen);
    if (verdicts[t] == Verdict::free) {
      EXPECT_EQ(missed, 0) << t;
    }
    (verdicts[t] == Verdict::free ? seen : unseen) += 1;
  }
  EXPECT_GT(seen, 5u);
  EXPECT_GT(unseen, 5u);
}

TEST(MarkUnseen, SettlesWholeSpheres)
{
  std::vector<double> ends = allAround(0.1, 12.5);
  Random random(3);
  std::vector<float> places(3 * 20000);
  for (float& x : places) x = static_cast<float>(random.uniform(-1, 1));
  const SphereHierarchy model(viewOf(places.data(), places.size() / 3));
  const SeenSpace space = spaceOf({scanOf(ends)}, 0.2);
  for (const double far : {5.0, 20.0}) {
    Verdicts verdicts(20000, Verdict::free);
    const Eigen::Isometry3d pose(Eigen::Translation3d(far, 0, 0));
    const UnseenResult found = markUnseen(space, {model, pose}, within(0.05), verdicts);
    EXPECT_EQ(found.unseen, far > 10.0 ? 20000u : 0u);
    EXPECT_LT(found.work.node_pairs, 5000u); // a test for each point would be more
  }
}

TEST(MarkUnseen, LeavesOtherVerdictsAlone)
{
  const std::vector<double> ends = allAround(0.1, 1.0);
  const float places[] = {5, 0, 0, 5, 1, 0, 5, 2, 0, 5, 3, 0, std::nanf(""), 0, 0};
  const SphereHierarchy model(viewOf(places, 5));
  const Verdicts before = test::verdictsOf({0, 1, 2, 3, 0});
  Verdicts verdicts = before, by_brute_force = before;
  EXPECT_EQ(markUnseen(spaceOf({scanOf(ends)}, 0.2), {model}, within(0.1), verdicts).unseen, 1u);
  EXPECT_EQ(brute_force::markUnseen({scanOf(ends)}, 0.2, {model}, within(0.1), by_brute_force).unseen, 1u);
  EXPECT_EQ(verdicts, test::verdictsOf({4, 1, 2, 3, 0}));
  EXPECT_EQ(by_brute_force, verdicts);
}

TEST(MarkUnseenHardCases, BeamThatGrazes)
{
  std::vector<double> ends = allAround(0.1, 12.5);
  const double angle = 0.2, off = 0.4; // a short beam, off the ball's direction
  ends.insert(ends.end(), {std::cos(off), std::sin(off), 0.0});
  const double touching = 5.0 * std::sin(off - 1.5 * angle);
  EXPECT_TRUE(isSeen({scanOf(ends)}, angle, {5, 0, 0}, touching * (1 - 1e-9)));
  EXPECT_FALSE(isSeen({scanOf(ends)}, angle, {5, 0, 0}, touching * (1 + 1e-9)));
  for (const double less : {0.0, 1e-15, 1e-14}) // what rounding leaves open is not seen
    EXPECT_FALSE(isSeen({scanOf(ends)}, angle, {5, 0, 0}, touching * (1 - less))) << less;
}

TEST(MarkUnseenHardCases, BeamThatEndsAtTheBall)
{
  const std::vector<double> ends = allAround(0.1, 12.5);
  EXPECT_TRUE(isSeen({scanOf(ends)}, 0.2, {5, 0, 0}, 5 - 1e-9));
  EXPECT_FALSE(isSeen({scanOf(ends)}, 0.2, {5, 0, 0}, 5 + 1e-9));
  EXPECT_TRUE(isSeen({scanOf(ends)}, 0.2, {9, 0, 0}, 1 - 1e-9));
  EXPECT_FALSE(isSeen({scanOf(ends)}, 0.2, {9, 0, 0}, 1 + 1e-9));
}

TEST(MarkUnseenHardCases, BallAboutTheScanner)
{
  const std::vector<double> ends = allAround(0.1, 12.5);
  for (const Point3& place : {Point3{0, 0, 0}, Point3{0.5, 0, 0}, Point3{0, 0, -1}}) {
    EXPECT_TRUE(isSeen({scanOf(ends)}, 0.2, place, 1.0));
    EXPECT_FALSE(isSeen({scanOf(ends)}, 0.2, place, 10.5));
  }
  std::vector<double> without_below;
  for (std::size_t i = 0; i < ends.size(); i += 3)
    if (ends[i + 2] > -11.0) without_below.insert(without_below.end(), &ends[i], &ends[i] + 3);
  EXPECT_FALSE(isSeen({scanOf(without_below)}, 0.2, {0, 0, 0}, 0.1)); // where the scanner itself stands
  EXPECT_FALSE(isSeen({scanOf(without_below)}, 0.2, {0, 0, -2}, 0.1));
  EXPECT_TRUE(isSeen({scanOf(without_below)}, 0.2, {0, 0, 2}, 0.1));
}

TEST(MarkUnseenHardCases, TwoScannersThatSeeHalfEach)
{
  std::vector<double> left, right;
  const std::vector<double> ends = allAround(0.1, 12.5);
  for (std::size_t i = 0; i < ends.size(); i += 3) {
    std::vector<double>& side = ends[i + 1] < 0.0 ? left : right;
    side.insert(side.end(), &ends[i], &ends[i] + 3);
  }
  const Point3 middle{5, 0, 0}, aside{5, 2, 0};
  EXPECT_FALSE(isSeen({scanOf(left), scanOf(right)}, 0.2, middle, 2.0));
  EXPECT_FALSE(isSeen({scanOf(left)}, 0.2, aside, 0.6));
  EXPECT_TRUE(isSeen({scanOf(left), scanOf(right)}, 0.2, aside, 0.6));
  EXPECT_TRUE(isSeen({scanOf(left), scanOf(ends)}, 0.2, middle, 2.0));
}

TEST(MarkUnseenHardCases, AllBeamsWithoutReturn)
{
  const std::vector<double> ends = allAround(0.1, 1.0);
  ScanBeams scan;
  scan.misses = viewOf(ends.data(), ends.size() / 3);
  EXPECT_EQ(SeenSpace({scan}).beams(0), 0u);
  EXPECT_EQ(SeenSpace({scan}).angle(0), 0.0);
  EXPECT_FALSE(isSeen({scan}, 0.2, {2, 0, 0}, 0.5)); // they say nothing
  scan.misses_beyond = 3.75;
  EXPECT_TRUE(isSeen({scan}, 0.2, {2, 0, 0}, 0.5));
  EXPECT_FALSE(isSeen({scan}, 0.2, {2, 0, 0}, 1.1));
}

/// It went nowhere: it says nothing, also where other beams do.
TEST(MarkUnseenHardCases, ABeamWithoutLengthSaysNothing)
{
  for (const bool returned : {true, false}) {
    ScanBeams scan;
    const std::vector<double> nowhere = {0, 0, 0},
                              others = {5, 0.62, 0.62, 5, -0.62, 0.62, 5, -0.62, -0.62, 5, 0.62, -0.62, 0, 0, 0};
    (returned ? scan.returns : scan.misses) = viewOf(nowhere.data(), 1);
    scan.misses_beyond = 100.0;
    EXPECT_FALSE(isSeen({scan}, 0.2, {2, 0, 0}, 0.25));
    EXPECT_FALSE(isSeen({scan}, 0.2, {0, 0, 0}, 0.25));
    EXPECT_EQ(SeenSpace({scan}).beams(0), 0u);
    (returned ? scan.returns : scan.misses) = viewOf(others.data(), 5);
    EXPECT_TRUE(isSeen({scan}, 0.25, {2, 0, 0}, 0.005));
    EXPECT_EQ(SeenSpace({scan}).beams(0), 4u);
  }
}

TEST(MarkUnseenHardCases, SomeBeamsWithoutReturn)
{
  std::vector<double> returns, misses;
  const std::vector<double> ends = allAround(0.1, 12.5);
  for (std::size_t i = 0; i < ends.size(); i += 3) {
    std::vector<double>& side = ends[i] > 10.0 ? misses : returns;
    side.insert(side.end(), &ends[i], &ends[i] + 3);
  }
  ScanBeams scan = scanOf(returns);
  scan.misses = viewOf(misses.data(), misses.size() / 3);
  EXPECT_FALSE(isSeen({scan}, 0.2, {4, 0, 0}, 0.5)); // no beam says anything there
  scan.misses_beyond = 6.25;
  EXPECT_TRUE(isSeen({scan}, 0.2, {4, 0, 0}, 0.5));
  EXPECT_FALSE(isSeen({scan}, 0.2, {6, 0, 0}, 0.5));
  EXPECT_TRUE(isSeen({scan}, 0.2, {0, 6, 0}, 0.5));
}

TEST(MarkUnseenHardCases, AFewBeamsSeeWhatLiesBetweenThem)
{
  const std::vector<double> square = {5, 0.62, 0.62, 5, -0.62, 0.62, 5, -0.62, -0.62, 5, 0.62, -0.62};
  for (std::size_t beams = 1; beams < 4; ++beams)
    EXPECT_FALSE(isSeen({scanOf({square.begin(), square.begin() + static_cast<std::ptrdiff_t>(3 * beams)})}, 0.25,
                        {2, 0, 0}, 0.05))
        << beams;
  EXPECT_TRUE(isSeen({scanOf(square)}, 0.25, {2, 0, 0}, 0.005));
  EXPECT_FALSE(isSeen({scanOf(square)}, 0.25, {2, 0, 0}, 0.1)) << "its margin reaches out";
  EXPECT_FALSE(isSeen({scanOf(square)}, 0.25, {2, 0.15, 0}, 0.05)) << "it reaches out";
  EXPECT_FALSE(isSeen({scanOf(square)}, 0.1, {2, 0, 0}, 0.05)) << "they are too far apart";
}

/// No angle tells them apart: they speak for no direction.
TEST(MarkUnseenHardCases, BeamsOfOneDirectionSeeNothing)
{
  const std::vector<double> ends = {5, 0, 0, 6, 0, 0, 7, 0, 0}, place = {2, 0, 0};
  const SeenSpace space({scanOf(ends)});
  EXPECT_EQ(space.angle(0), 0.0);
  EXPECT_EQ(space.beams(0), 3u);
  EXPECT_EQ(verdictsOf(space, {SphereHierarchy(viewOf(place.data(), 1))}, 0.1)[0], kUnseen);
}

/// A grid of many levels, whose cells are covered as a whole beside some that are not.
TEST(MarkUnseen, APatchOfBeamsSeesWhatIsWellWithinIt)
{
  constexpr double kStep = 0.004, kEdge = 0.3;
  std::vector<double> ends;
  for (int i = -75; i <= 75; ++i)
    for (int j = -75; j <= 75; ++j)
      for (const double x : {10.0, 10 * kStep * i, 10 * kStep * j}) ends.push_back(x);
  const SeenSpace space = spaceOf({scanOf(ends)}, 0.01);
  Random random(32);
  int seen = 0, unseen = 0;
  for (int k = 0; k < 2000; ++k) {
    const double u = random.uniform(-0.4, 0.4), w = random.uniform(-0.4, 0.4), range = random.uniform(2, 9);
    const double inside = kEdge - std::max(std::abs(u), std::abs(w));
    if (std::abs(inside) < 0.015) continue;
    const Point3 place = {range, range * u, range * w};
    const SphereHierarchy model(viewOf(place.data(), 1));
    const bool is_seen = verdictsOf(space, {model}, 1e-3)[0] != kUnseen;
    ASSERT_EQ(is_seen, inside > 0) << u << ' ' << w << ' ' << range;
    ++(is_seen ? seen : unseen);
  }
  EXPECT_GT(seen, 500);
  EXPECT_GT(unseen, 500);
}

TEST(MarkUnseenHardCases, Antipode)
{
  std::vector<double> ends = allAround(0.1, 12.5);
  ends.insert(ends.end(), {-1e-3, 0.0, 0.0});
  EXPECT_TRUE(isSeen({scanOf(ends)}, 0.2, {5, 0, 0}, 4.5));
  EXPECT_FALSE(isSeen({scanOf(ends)}, 0.2, {-5, 0, 0}, 0.1));
  EXPECT_FALSE(isSeen({scanOf({5, 0, 0, 6, 0, 0})}, 0.2, {-2, 0, 0}, 0.1)); // no beam there
}

TEST(MarkUnseenHardCases, BeamBetweenPlacesOfNoSize)
{
  std::vector<double> ends;
  for (int i = -8; i <= 8; ++i)
    for (int j = -8; j <= 8; ++j) ends.insert(ends.end(), {1.0, 0.1 * i, 0.1 * j});
  EXPECT_FALSE(isSeen({scanOf(ends)}, 0.15, {2, 0.1, 0.1}, 0.0)); // between the beams, behind what they met
  EXPECT_TRUE(isSeen({scanOf(ends)}, 0.15, {0.8, 0.04, 0.04}, 0.0));
}

TEST(MarkUnseenHardCases, FarFromTheWorldsOrigin)
{
  const std::vector<double> ends = allAround(0.1, 12.5);
  std::vector<double> moved = ends;
  const double shift[3] = {431234.5, 5412345.25, 300.125};
  for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += shift[i % 3];
  ScanBeams scan = scanOf(moved);
  scan.origin = {shift[0], shift[1], shift[2]};
  EXPECT_TRUE(isSeen({scan}, 0.2, {shift[0] + 5, shift[1], shift[2]}, 4.999));
  EXPECT_FALSE(isSeen({scan}, 0.2, {shift[0] + 5, shift[1], shift[2]}, 5.001));
}

TEST(MarkUnseenHardCases, CoordinatesWhoseProductsOverflow)
{
  ScanBeams scan;
  const std::vector<double> ends = {0,      0, 0,     1,      0, 0,      2e147, 0, 2e147,
                                    -2e147, 0, 2e147, -2e147, 0, -2e147, 2e147, 0, -2e147};
  scan.returns = viewOf(ends.data(), 6);
  scan.origin = {0, -1.5e148, 0};
  EXPECT_FALSE(isSeen({scan}, 0.25, {0, 0, -1.8e138}, 1.8e138)); // two beams end in it
  EXPECT_TRUE(isSeen({scan}, 0.25, {0, -1e148, -1.8e138}, 1.8e138));
}

TEST(MarkUnseen, TellsItsProgressAndCanBeCancelled)
{
  const std::vector<double> ends = allAround(0.1, 12.5);
  Random random(4);
  std::vector<float> places(3 * 2000);
  for (float& x : places) x = static_cast<float>(random.uniform(-15, 15));
  HierarchyOptions options;
  options.voxel_edge = 5.0;
  const SphereHierarchy model(viewOf(places.data(), 2000), options), nothing{PointsView()};
  const SeenSpace space = spaceOf({scanOf(ends)}, 0.2);
  const Verdicts expected = verdictsOf(space, {model}, 0.1);
  for (const unsigned threads : {1u, 2u}) {
    UnseenRequest request = within(0.1, threads);
    double last = 0.0;
    std::size_t reports = 0;
    request.progress = [&](double done) {
      EXPECT_GE(done, last);
      last = done;
      ++reports;
      return true;
    };
    Verdicts verdicts(2000, Verdict::free);
    const UnseenResult found = markUnseen(space, {model}, request, verdicts);
    EXPECT_EQ(verdicts, expected);
    EXPECT_EQ(found.unseen, static_cast<std::size_t>(std::count(expected.begin(), expected.end(), kUnseen)));
    EXPECT_EQ(last, 1.0);
    EXPECT_GT(reports, threads == 1 ? 3u : 0u) << "of two threads, the other may take all voxels";
    request.progress = [](double) { return false; };
    EXPECT_THROW(markUnseen(space, {model}, request, verdicts), Cancelled);
    Verdicts none;
    EXPECT_EQ(markUnseen(space, {nothing}, request, none).unseen, 0u) << "of no voxel there is none to be cancelled";
  }
  Verdicts none;
  EXPECT_EQ(markUnseen(space, {nothing}, within(0.1), none).unseen, 0u);
}

TEST(MarkUnseen, RefusesVerdictsOfAnotherModel)
{
  const std::vector<double> ends = allAround(0.1, 12.5), places = {1, 0, 0, 2, 0, 0};
  const SphereHierarchy model(viewOf(places.data(), 2));
  Verdicts one(1, Verdict::free);
  const auto refusal = [](const auto& mark) -> std::string {
    try {
      mark();
    }
    catch (const InvalidInput& error) {
      return error.what();
    }
    return {};
  };
  const std::string expected = "verdicts: are 1 of 2 points: give one per record of the model";
  EXPECT_EQ(refusal([&] { markUnseen(spaceOf({scanOf(ends)}, 0.2), {model}, within(0.1), one); }), expected);
  EXPECT_EQ(refusal([&] { brute_force::markUnseen({scanOf(ends)}, 0.2, {model}, within(0.1), one); }), expected);
}

TEST(MarkUnseen, ShortensBeamsByTheirUncertainty)
{
  const std::vector<double> ends = allAround(0.1, 12.5);
  ScanBeams scan = scanOf(ends);
  EXPECT_TRUE(isSeen({scan}, 0.2, {8, 0, 0}, 1.9));
  scan.returns.uncertainty = 0.2;
  EXPECT_FALSE(isSeen({scan}, 0.2, {8, 0, 0}, 1.9));
  EXPECT_TRUE(isSeen({scan}, 0.2, {8, 0, 0}, 1.7));
}

TEST(MarkUnseen, TakesUncertainPlacesAsTheyAre)
{
  const std::vector<double> ends = allAround(0.1, 12.5);
  const SeenSpace space = spaceOf({scanOf(ends)}, 0.2);
  const double place[] = {8, 0, 0};
  PointsView view = viewOf(place, 1);
  EXPECT_EQ(verdictsOf(space, {SphereHierarchy(view)}, 1.9)[0], Verdict::free);
  view.uncertainty = 0.2;
  EXPECT_EQ(verdictsOf(space, {SphereHierarchy(view)}, 1.9)[0], kUnseen);
  view.uncertainty = 0.0;
  const float own = 0.2f;
  view.uncertainties = &own;
  EXPECT_EQ(verdictsOf(space, {SphereHierarchy(view)}, 1.9)[0], kUnseen);
  EXPECT_EQ(verdictsOf(space, {SphereHierarchy(view)}, 1.7)[0], Verdict::free);
  view.uncertainties = nullptr;
  view.radii = &own;
  EXPECT_EQ(verdictsOf(space, {SphereHierarchy(view)}, 1.9)[0], kUnseen);
}

std::string refusalOf(const std::vector<ScanBeams>& scans, const SeenOptions& options = {})
{
  try {
    const SeenSpace space(scans, options);
  }
  catch (const InvalidInput& error) {
    return error.what();
  }
  return "taken";
}

TEST(SeenSpace, RefusesWhatHasNoMeaning)
{
  ScanBeams scan;
  EXPECT_EQ(refusalOf({scan}), "taken");
  EXPECT_EQ(refusalOf({}), "scans: there are none: give one at least, with its origin");
  for (const double angle : {0.0, 3.14159, std::nan(""), 1e-5}) { // half a turn, too
    SeenOptions options;
    options.angle = angle;
    EXPECT_NE(refusalOf({scan}, options).find("give one in [0.0001, 0.25]"), std::string::npos) << angle;
    Verdicts none;
    EXPECT_THROW(brute_force::markUnseen({scan}, angle, {SphereHierarchy(PointsView())}, within(1.0), none),
                 InvalidInput);
  }
  scan.misses.count = 3;
  EXPECT_NE(refusalOf({scan}).find("data is null"), std::string::npos) << refusalOf({scan});
  scan.misses.count = 0;
  scan.origin = {0, std::nan(""), 0};
  EXPECT_EQ(refusalOf({scan}), "scan 0: origin: 0 nan 0: give finite coordinates");
  scan.origin = {0, 0, 0};
  scan.misses_beyond = -1;
  EXPECT_EQ(refusalOf({scan}), "scan 0: range of no return: -1: give a finite length >= 0");
}

TEST(SeenSpace, MeasuresTheAngleOfBeams)
{
  const MadeRoom room = hallOfPillars();
  Random random(5);
  const Eigen::Vector3d origin(2, 2, 1.5);
  const MadeScan made = makeScan(room, {origin, 0.03, -0.8, 0.8}, random);
  const SeenSpace space({made.scan(origin)});
  EXPECT_NEAR(space.angle(0), 1.5 * 0.03, 0.003);
  EXPECT_EQ(space.beams(0), made.returns.size() / 3);
  std::vector<double> rows; // far apart, but each of them dense
  for (int row = -10; row <= 10; ++row)
    for (int i = 0; i < 1000; ++i) {
      const double azimuth = 0.00628 * i, elevation = 0.04 * row;
      rows.insert(rows.end(), {std::cos(azimuth), std::sin(azimuth), std::tan(elevation)});
    }
  EXPECT_NEAR(SeenSpace({scanOf(rows)}).angle(0), 1.5 * 0.04, 0.006);
}

} // namespace
} // namespace pcl_bsh

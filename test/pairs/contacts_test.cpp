// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/collide.h>
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/pairs/contacts.h>

#include "support/meshes.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Scene;

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

ContactsRequest within(double clearance, std::size_t most)
{
  return {clearance, most};
}

std::vector<std::uint32_t> finiteRecords(const PointsView& view)
{
  std::vector<std::uint32_t> records;
  for (std::size_t i = 0; i < view.size(); ++i) {
    const Point3 p = view.point(view.record(i));
    if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) records.push_back(view.record(i));
  }
  return records;
}

/// All colliding pairs, nearest first, by comparing all.
std::vector<PointPair> oracle(const Scene& scene)
{
  const PointsView a = scene.a.view(), b = scene.b.view();
  const RecordDistance distance(a, scene.pose_a, b, scene.pose_b);
  std::vector<PointPair> pairs;
  for (const std::uint32_t i : finiteRecords(a))
    for (const std::uint32_t j : finiteRecords(b))
      if (distance.compare({i, j}, scene.clearance) <= 0) pairs.push_back({i, j});
  std::sort(pairs.begin(), pairs.end(), [&](PointPair l, PointPair r) {
    const int sign = distance.compareGaps(l, r);
    return sign != 0 ? sign < 0 : l < r;
  });
  return pairs;
}

void expectSameAsOracle(const Scene& scene)
{
  SCOPED_TRACE(scene.name);
  const std::vector<PointPair> expected = oracle(scene);
  const SphereHierarchy a(scene.a.view()), b(scene.b.view());
  const Placed placed_a{a, scene.pose_a}, placed_b{b, scene.pose_b};
  const RecordDistance distance(a.view(), scene.pose_a, b.view(), scene.pose_b);
  for (const std::size_t most : {std::size_t{0}, std::size_t{1}, std::size_t{7}, expected.size(), ~std::size_t{0}}) {
    const ContactsResult result = nearestContacts(placed_a, placed_b, within(scene.clearance, most));
    ASSERT_EQ(result.contacts.size(), std::min(most, expected.size()));
    ASSERT_EQ(result.complete, expected.size() <= most);
    for (std::size_t i = 0; i < result.contacts.size(); ++i) {
      const Contact& contact = result.contacts[i];
      ASSERT_EQ(contact.pair, expected[i]) << i << " of " << most;
      ASSERT_EQ(contact.distance, distance.gap(contact.pair));
      const double norm = contact.normal.norm();
      ASSERT_TRUE(norm == 0.0 || std::abs(norm - 1.0) < 1e-9) << norm;
    }
  }
  PairsWithin all = pairsWithin(placed_a, placed_b, within(scene.clearance, ~std::size_t{0}));
  std::sort(all.pairs.begin(), all.pairs.end());
  std::vector<PointPair> sorted = expected;
  std::sort(sorted.begin(), sorted.end());
  ASSERT_TRUE(all.complete);
  ASSERT_EQ(all.pairs, sorted);
  if (expected.empty()) return;
  const PairsWithin some = pairsWithin(placed_a, placed_b, within(scene.clearance, expected.size() - 1));
  ASSERT_FALSE(some.complete);
  ASSERT_TRUE(pairsWithin(placed_a, placed_b, within(scene.clearance, expected.size())).complete);
}

TEST(Contacts, SameAsComparingAllPairs)
{
  for (std::uint64_t seed = 0; seed < 300; ++seed) expectSameAsOracle(test::anyScene(seed, 60));
  for (std::uint64_t seed = 1000; seed < 1010; ++seed) expectSameAsOracle(test::anyScene(seed, 300));
}

TEST(Contacts, SameAsComparingAllPairsOfTriangles)
{
  for (std::uint64_t seed = 0; seed < 200; ++seed) expectSameAsOracle(test::anyMeshScene(seed, 50));
  for (std::uint64_t seed = 1000; seed < 1003; ++seed) expectSameAsOracle(test::anyMeshScene(seed, 200));
}

TEST(Contacts, CrowdedPlacesCountEveryPoint)
{
  const Cloud crowd(std::vector<Point3>(40, Point3{1, 2, 3})), other(std::vector<Point3>(30, Point3{1, 2, 3.5}));
  expectSameAsOracle({crowd, other, identity, identity, 0.5, "two crowded places"});
}

TEST(Contacts, CrowdedPlacesOfBallsOfSeveralSizes)
{
  Random random(8);
  for (int i = 0; i < 40; ++i) {
    Cloud crowd(std::vector<Point3>(40, Point3{1, 2, 3})), other(std::vector<Point3>(30, Point3{1, 2, 3.5}));
    const auto radii = [&](std::size_t count) {
      std::vector<float> all(count);
      for (float& radius : all) radius = 0.0625f * static_cast<float>(random.integer(0, i % 4));
      return all;
    };
    crowd.setRadii(radii(40));
    other.setRadii(radii(30));
    expectSameAsOracle({crowd, other, identity, identity, 0.375, "two crowded places of balls"});
  }
}

/// Larger records of pairs at one distance are not asked for, once enough pairs are known.
TEST(Contacts, CrowdedPlacesAreComparedAsFarAsTheyAreAskedFor)
{
  const Cloud crowd(std::vector<Point3>(400, Point3{1, 2, 3})), other(std::vector<Point3>(300, Point3{1, 2, 3.5}));
  const SphereHierarchy a(crowd.view()), b(other.view());
  const ContactsResult found = nearestContacts({a}, {b}, within(0.5, 20));
  EXPECT_EQ(found.contacts.size(), 20u);
  EXPECT_LT(found.work.exact_decisions, 40u);
}

TEST(Contacts, NormalsPointFromTheOtherToTheFirst)
{
  const Cloud low({{0, 0, 0}}), high({{0, 0, 0.5}});
  const SphereHierarchy a(high.view()), b(low.view());
  const ContactsResult result = nearestContacts({a}, {b}, within(0.5, 3));
  ASSERT_EQ(result.contacts.size(), 1u);
  EXPECT_EQ(result.contacts[0].distance, 0.5);
  EXPECT_EQ(result.contacts[0].normal, Eigen::Vector3d(0, 0, 1));
}

TEST(Contacts, NormalsAreInTheFrameOfThePoses)
{
  const Cloud high({{0, 0, 0.5}}), low({{0.25, 0, 0}});
  const SphereHierarchy a(high.view()), b(low.view());
  const Eigen::Isometry3d moved(Eigen::Translation3d(3, 0, 0));
  const Eigen::Isometry3d turned = moved * Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitY()); // x to -z
  const ContactsResult result = nearestContacts({a, moved}, {b, turned}, within(1.0, 3));
  ASSERT_EQ(result.contacts.size(), 1u);
  EXPECT_NEAR(result.contacts[0].distance, 0.75, 1e-15);
  EXPECT_TRUE(result.contacts[0].normal.isApprox(Eigen::Vector3d(0, 0, 1), 1e-12));
}

TEST(Contacts, NormalsOfTheLeastNumbersAreOfLengthOne)
{
  const double root = std::sqrt(0.5);
  for (const double unit : {0x1p-1074, 3 * 0x1p-1074, 1e-322, 1e-320, 1e-310})
    for (const auto& [place, normal] : {std::pair(Point3{-unit, -unit, 0}, Eigen::Vector3d(-root, -root, 0)),
                                        {Point3{unit, -unit, 0}, Eigen::Vector3d(0, -1, 0)},
                                        {Point3{0, 0, unit}, Eigen::Vector3d(0, 0, 1)}}) {
      const std::vector<Point3> corners = {{0, 0, 0}, {4 * unit, 0, 0}, {0, 4 * unit, 0}}, places = {place};
      const std::vector<std::uint32_t> triangle = {0, 1, 2};
      const SphereHierarchy a(viewOf(places[0].data(), 1)),
          b(viewOf(TrianglesView{viewOf(corners[0].data(), 3), triangle.data(), 1}));
      const ContactsResult found = nearestContacts({a}, {b}, within(5 * unit, 3));
      ASSERT_EQ(found.contacts.size(), 1u) << unit;
      EXPECT_TRUE(found.contacts[0].normal.isApprox(normal, 1e-12))
          << unit << ": " << found.contacts[0].normal.transpose() << ", not " << normal.transpose();
    }
}

/// Surfaces of any size: triangles below 1e-80 have squares of normals that are not in the range of double.
TEST(Contacts, NormalsOfTrianglesOfAnySizeAreOfLengthOne)
{
  struct Case {
    const char* name;
    Triangle3 a, b;
    Eigen::Vector3d normal;
  };
  const double root = std::sqrt(0.5);
  const Case cases[] = {
      {"a corner above a face", {{{1, 1, 1}, {2, 2, 3}, {0, 2, 3}}}, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {0, 0, 1}},
      {"a face above a corner", {{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}}, {{{1, 1, 0}, {2, 2, -3}, {0, 2, -3}}}, {0, 0, 1}},
      {"edges that cross", {{{-1, 0, 1}, {1, 0, 1}, {0, 0, 3}}}, {{{0, -1, 0}, {0, 1, 0}, {0, 0, -3}}}, {0, 0, 1}},
      {"a corner beside an edge",
       {{{2, 0, 2}, {5, 1, 5}, {5, -1, 5}}},
       {{{1, -9, 1}, {1, 9, 1}, {-8, 0, -9}}},
       {root, 0, root}},
      {"an edge beside a corner",
       {{{1, -9, 1}, {1, 9, 1}, {8, 0, 9}}},
       {{{0, 0, 0}, {-5, 1, -5}, {-5, -1, -5}}},
       {root, 0, root}},
      {"corners", {{{1, 0, 1}, {5, 1, 6}, {5, -1, 6}}}, {{{0, 0, 0}, {-5, 1, -6}, {-5, -1, -6}}}, {root, 0, root}},
      {"a needle's face",
       {{{1, 0x1p-42, 1}, {2, 0, 3}, {0, 0, 3}}},
       {{{0, 0, 0}, {4, 0, 0}, {2, 0x1p-40, 0}}},
       {0, 0, 1}}};
  for (const double unit : {1.0, 1e-40, 1e-70, 1e-80, 1e-81, 1e-90, 1e-100, 1e-130, 1e-160, 1e-200, 1e-290, 1e20, 1e37})
    for (const Case& one : cases) {
      SCOPED_TRACE(std::string(one.name) + " of " + std::to_string(std::log10(unit)));
      test::Mesh of_a, of_b;
      const auto sized = [unit](Point3 p) { return Point3{unit * p[0], unit * p[1], unit * p[2]}; };
      of_a.add(sized(one.a[0]), sized(one.a[1]), sized(one.a[2]));
      of_b.add(sized(one.b[0]), sized(one.b[1]), sized(one.b[2]));
      const auto viewOfMesh = [](const test::Mesh& mesh) {
        return viewOf(TrianglesView{viewOf(mesh.vertices[0].data(), 3), mesh.corners.data(), 1});
      };
      const SphereHierarchy a(viewOfMesh(of_a)), b(viewOfMesh(of_b));
      for (const bool swap : {false, true}) {
        const ContactsResult found =
            swap ? nearestContacts({b}, {a}, within(2 * unit, 3)) : nearestContacts({a}, {b}, within(2 * unit, 3));
        ASSERT_EQ(found.contacts.size(), 1u);
        const Eigen::Vector3d normal = found.contacts[0].normal;
        EXPECT_TRUE(normal.isApprox(swap ? -one.normal : one.normal, 1e-9)) << normal.transpose();
      }
    }
}

/// Where points have radii, too, float arithmetic decides all but those at the very reach.
TEST(Contacts, BallsNeedHardlyAnExactDecision)
{
  Random random(7);
  const auto sheet = [&](double height) {
    std::vector<Point3> points;
    std::vector<float> radii;
    for (int i = 0; i < 40; ++i)
      for (int j = 0; j < 40; ++j) {
        points.push_back({0.1 * i + random.uniform(0, 0.05), 0.1 * j + random.uniform(0, 0.05), height});
        radii.push_back(static_cast<float>(random.uniform(0.001, 0.05)));
      }
    Cloud cloud(points);
    cloud.setRadii(radii);
    return cloud;
  };
  const Cloud low = sheet(0), high = sheet(0.31);
  const SphereHierarchy a(low.view()), b(high.view());
  const PairsWithin all = pairsWithin({a}, {b}, within(0.4, ~std::size_t{0}));
  EXPECT_GT(all.pairs.size(), 20000u);
  EXPECT_LT(all.work.exact_decisions, 10u);
  EXPECT_LT(anyCollision({a}, {b}, {0.4, {}}).work.exact_decisions, 10u);
  FlagsRequest request;
  request.clearance = 0.4;
  request.flagged = Flagged::both;
  EXPECT_LT(collisionFlags({a}, {b}, request).work.exact_decisions, 10u);
  expectSameAsOracle({low, high, identity, identity, 0.27, "sheets of balls"});
}

/// The least double clearance that joins two balls, and the next below it: at places that floats hardly hold, turned.
TEST(Contacts, BallsAtTheirVeryReach)
{
  Random random(8);
  for (int i = 0; i < 300; ++i) {
    const double far = random.chance(0.5) ? 4e5 : 0.0;
    const auto any_place = [&] {
      return Point3{far + random.uniform(-1, 1), 10 * far + random.uniform(-1, 1), random.uniform(-1, 1)};
    };
    Cloud one({any_place(), any_place()}), other({any_place()});
    one.setRadii({static_cast<float>(random.uniform(0, 0.2)), 0.0f});
    other.setRadii({static_cast<float>(random.uniform(0, 0.2))});
    Eigen::Isometry3d pose = identity;
    pose.linear() = Eigen::AngleAxisd(random.uniform(0, 0.1) / (1 + far), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const ExactDistance distance(pose, identity);
    const double gap =
        distance.gap({one.view().point(0), other.view().point(0), one.view().radius(0), other.view().radius(0)});
    if (!(gap > 0.0)) continue;
    for (const double clearance : {std::nextafter(gap, 0.0), gap, std::nextafter(gap, 9.0)})
      expectSameAsOracle({one, other, pose, identity, clearance, "two balls"});
  }
}

TEST(Contacts, RefusesWhatTheOthersRefuse)
{
  const Cloud point({{0, 0, 0}});
  const SphereHierarchy a(point.view());
  EXPECT_THROW(nearestContacts({a}, {a}, within(-1, 1)), std::invalid_argument);
  EXPECT_THROW(pairsWithin({a}, {a}, within(-1, 1)), std::invalid_argument);
}

} // namespace
} // namespace pcl_bsh

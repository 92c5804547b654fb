// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/collision/contacts.h>
#include <pcl_bsh/geometry/exact_distance.h>

#include "../query/random_clouds.h"

#include <gtest/gtest.h>

#include <stdexcept>

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
  const ExactDistance distance(scene.pose_a, scene.pose_b);
  std::vector<PointPair> pairs;
  for (const std::uint32_t i : finiteRecords(a))
    for (const std::uint32_t j : finiteRecords(b))
      if (distance.compare(a.point(i), b.point(j), scene.clearance, a.radius(i), b.radius(j)) <= 0)
        pairs.push_back({i, j});
  const auto posed = [&](PointPair pair) {
    return ExactDistance::Pair{a.point(pair.a), b.point(pair.b), a.radius(pair.a), b.radius(pair.b)};
  };
  std::sort(pairs.begin(), pairs.end(), [&](PointPair l, PointPair r) {
    const int sign = distance.compareGaps(posed(l), posed(r));
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
  const ExactDistance distance(scene.pose_a, scene.pose_b);
  for (const std::size_t most : {std::size_t{0}, std::size_t{1}, std::size_t{7}, expected.size(), ~std::size_t{0}}) {
    const ContactsResult result = nearestContacts(placed_a, placed_b, within(scene.clearance, most));
    ASSERT_EQ(result.contacts.size(), std::min(most, expected.size()));
    ASSERT_EQ(result.complete, expected.size() <= most);
    for (std::size_t i = 0; i < result.contacts.size(); ++i) {
      const Contact& contact = result.contacts[i];
      ASSERT_EQ(contact.pair, expected[i]) << i << " of " << most;
      const Point3 p = a.view().point(contact.pair.a), q = b.view().point(contact.pair.b);
      ASSERT_EQ(contact.distance,
                distance.gap({p, q, a.view().radius(contact.pair.a), b.view().radius(contact.pair.b)}));
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

TEST(Contacts, CrowdedPlacesCountEveryPoint)
{
  const Cloud crowd(std::vector<Point3>(40, Point3{1, 2, 3})), other(std::vector<Point3>(30, Point3{1, 2, 3.5}));
  expectSameAsOracle({crowd, other, identity, identity, 0.5, "two crowded places"});
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

TEST(Contacts, RefusesWhatTheOthersRefuse)
{
  const Cloud point({{0, 0, 0}});
  const SphereHierarchy a(point.view());
  EXPECT_THROW(nearestContacts({a}, {a}, within(-1, 1)), std::invalid_argument);
  EXPECT_THROW(pairsWithin({a}, {a}, within(-1, 1)), std::invalid_argument);
}

} // namespace
} // namespace pcl_bsh

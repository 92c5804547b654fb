// SPDX-License-Identifier: BSD-3-Clause
// What queries about two clouds cost where many pairs are at nearly the same distance, as the clouds grow.
#include <pcl_bsh/collision/collide.h>
#include <pcl_bsh/collision/contacts.h>

#include "../query/adversarial_clouds.h"
#include "../query/random_clouds.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace pcl_bsh {
namespace {

using test::HardPair;
using namespace test::adversarial;

double stepsOf(const Work& work)
{
  return static_cast<double>(work.node_pairs + 16 * work.leaf_pairs + work.exact_decisions);
}

/// Steps of a query on a pair of clouds.
template <class Query>
double stepsOf(const HardPair& hard, const Query& query)
{
  const test::Cloud a(hard.a), b(hard.b);
  const SphereHierarchy of_a(a.view()), of_b(b.view());
  return stepsOf(query(Placed(of_a), Placed(of_b, hard.pose_b), hard.clearance).work);
}

/// Holds a query's steps at n, 4 n and 16 n.
template <class Query>
void expectLinear(const char* name, const std::function<HardPair(std::size_t)>& make, std::size_t n, const Query& query)
{
  const double few = stepsOf(make(n), query), some = stepsOf(make(4 * n), query), many = stepsOf(make(16 * n), query);
  EXPECT_LE(some, 5 * few + 1000) << name;
  EXPECT_LE(many, 5 * some + 1000) << name;
}

constexpr auto kOneContact = [](const Placed& a, const Placed& b, double clearance) {
  return nearestContacts(a, b, {clearance, 1});
};

TEST(PairWork, OneContactCostsWhatTheClosestPairDoes)
{
  // The clearance joins most pairs, of which one is asked for.
  const auto cubes = [](std::size_t n) { return HardPair{cube(n, 1), cube(n, 2), 0.5}; };
  expectLinear("one contact", cubes, 1000, kOneContact);
  const double closest =
      stepsOf(cubes(8000), [](const Placed& a, const Placed& b, double) { return closestPair(a, b, {}); });
  EXPECT_LT(stepsOf(cubes(8000), kOneContact), 1.1 * closest);
}

TEST(PairWork, OneContactOfBallsThatAllOverlap)
{
  // Gaps below 0 bound the search as well.
  const auto steps = [](std::size_t n) {
    test::Cloud a(cube(n, 1)), b(cube(n, 2));
    a.setRadii(std::vector<float>(n, 1.0f));
    b.setRadii(std::vector<float>(n, 1.0f));
    const SphereHierarchy of_a(a.view()), of_b(b.view());
    return stepsOf(nearestContacts(Placed(of_a), Placed(of_b), {0.5, 1}).work);
  };
  const double few = steps(1000), some = steps(4000), many = steps(16000);
  EXPECT_LE(some, 5 * few);
  EXPECT_LE(many, 5 * some);
}

} // namespace
} // namespace pcl_bsh

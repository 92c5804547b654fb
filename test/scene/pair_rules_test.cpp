// SPDX-License-Identifier: BSD-3-Clause
// Whether rules leave any pair of objects: against all pairs, one by one.
#include <pcl_bsh/scene/pairs/pair_rules.h>

#include "support/random.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

bool testsAny(const PairRules& rules, std::uint32_t objects)
{
  for (ObjectId a = 0; a < objects; ++a)
    for (ObjectId b = a + 1; b < objects; ++b)
      if (rules.clearanceOf(a, b)) return true;
  return false;
}

TEST(PairRules, TellWhetherAnyPairIsTested)
{
  test::Random random(14);
  int tested = 0;
  constexpr int cases = 4000;
  for (int i = 0; i < cases; ++i) {
    PairRules rules(0.1, random.chance(0.7));
    const auto objects = static_cast<std::uint32_t>(random.integer(0, 5));
    const double fixed = random.pick({0.0, 0.5, 1.0});
    for (std::uint32_t k = 0; k < objects; ++k)
      rules.addObject(std::string(1, static_cast<char>('a' + random.integer(0, 2))), random.chance(fixed));
    for (int k = random.integer(0, 3); k > 0; --k)
      rules.setGroups(std::string(1, static_cast<char>('a' + random.integer(0, 3))),
                      std::string(1, static_cast<char>('a' + random.integer(0, 2))), {random.chance(0.3), {}});
    for (ObjectId a = 0; a < objects; ++a)
      for (ObjectId b = a + 1; b < objects; ++b)
        if (random.chance(0.4)) rules.set(b, a, {random.chance(0.2), {}});
    EXPECT_EQ(rules.testsAny(), testsAny(rules, objects)) << i;
    tested += rules.testsAny() ? 1 : 0;
  }
  EXPECT_GT(tested, cases / 4);
  EXPECT_LT(tested, 3 * cases / 4);
}

TEST(PairRules, AreAskedQuicklyOfManyObjects)
{
  PairRules rules(0.1, true);
  for (int i = 0; i < 100000; ++i) rules.addObject(std::to_string(i), true);
  EXPECT_FALSE(rules.testsAny());
  rules.set(7, 9, {true, {}});
  EXPECT_TRUE(rules.testsAny());
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/pair_reach.h>

#include "support/random_clouds.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;

std::vector<float> lengths(Random& random, double unit = 1.0)
{
  std::vector<float> found;
  for (int i = 0; i < 8; ++i) found.push_back(static_cast<float>(unit * random.uniform(0, 0.1)));
  return found;
}

TEST(PairReach, IsAroundItsSum)
{
  using Rational = boost::multiprecision::cpp_rational;
  Random random(5);
  Cloud a(std::vector<Point3>(8)), b(std::vector<Point3>(8));
  for (int trial = 0; trial < 90; ++trial) {
    const double unit = std::array{1.0, 0x1p30, 0x1p-30}[static_cast<std::size_t>(trial % 3)];
    a.setRadii(lengths(random, unit));
    a.setUncertainties(unit * random.uniform(0, 0.1), lengths(random, unit));
    b.setUncertainties(unit * random.uniform(0, 0.1), lengths(random, unit));
    const PointsView view_a = a.view(), view_b = b.view();
    const std::vector<float> spacings = lengths(random, unit);
    for (const MeantPlaces places :
         {MeantPlaces::measured, MeantPlaces::certain, MeantPlaces::possible, MeantPlaces::covered}) {
      const PatchSpacings patches =
          places == MeantPlaces::covered ? PatchSpacings(spacings.data(), 8) : PatchSpacings();
      const PairReach reach(view_a, view_b, unit * random.uniform(0, 1), places, patches);
      const Reach of_all(reach.of({0, 0})[0], UncertaintyRange(view_a), UncertaintyRange(view_b), places, patches);
      for (std::uint32_t i = 0; i < 8; ++i) {
        const PointPair pair{i, 7 - i};
        Rational sum = 0;
        for (const double term : reach.of(pair)) sum += Rational(term);
        const auto [least, most] = reach.around(pair);
        EXPECT_LE(Rational(least), sum);
        EXPECT_GE(Rational(most), sum);
        EXPECT_LT(most - least, 1e-11 * unit);
        sum -= Rational(view_a.radius(i)); // which reaches of all pairs do not have
        EXPECT_LE(Rational(of_all.least), sum);
        EXPECT_GE(Rational(of_all.most), sum);
      }
    }
  }
}

TEST(PairReach, IsOneWhereNoRecordHasItsOwn)
{
  Random random(6);
  Cloud plain(std::vector<Point3>(8)), own(std::vector<Point3>(8));
  plain.setUncertainties(0.25, {});
  own.setUncertainties(0.0, lengths(random));
  const PointsView none = plain.view(), some = own.view();
  const std::vector<float> spacings(8, 0.5f);
  EXPECT_TRUE(PairReach(none, none, 1.0, MeantPlaces::possible).isOne());
  EXPECT_FALSE(PairReach(some, none, 1.0, MeantPlaces::possible).isOne());
  EXPECT_FALSE(PairReach(none, some, 1.0, MeantPlaces::certain).isOne());
  EXPECT_FALSE(PairReach(none, none, 1.0, MeantPlaces::covered, PatchSpacings(spacings.data(), 8)).isOne());
  EXPECT_TRUE(PairReach(some, some, 1.0, MeantPlaces::measured).isOne());
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/collide.h>
#include <pcl_bsh/query/result.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "support/verdicts.h"

#include <gmock/gmock.h>

#include <type_traits>

namespace pcl_bsh {
namespace {

using testing::ElementsAre;

static_assert(!std::is_convertible_v<Verdict, int> && !std::is_convertible_v<Verdict, bool>, "2 and 3 are not true");
static_assert(sizeof(Verdict) == 1, "as files and other libraries have them");
static_assert(std::is_same_v<decltype(FlagsResult::a), std::vector<Verdict>>);
static_assert(std::is_same_v<decltype(TrajectoryResult::flags), std::vector<Verdict>>);

TEST(Verdict, IsCountedByKind)
{
  const std::vector<Verdict> verdicts = test::verdictsOf({0, 1, 2, 2, 3, 3, 3});
  EXPECT_EQ(countOf(verdicts, Verdict::free), 1U);
  EXPECT_EQ(countOf(verdicts, Verdict::undecided), 2U);
  EXPECT_EQ(countOf(verdicts, Verdict::sparse), 3U);
}

TEST(Verdict, OfTwoTheGraverHolds)
{
  const Verdict by_gravity[] = {Verdict::free, Verdict::sparse, Verdict::undecided, Verdict::colliding};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_EQ(graver(by_gravity[i], by_gravity[j]), by_gravity[std::max(i, j)]);
}

TEST(Verdict, IsAByteOfItsArray)
{
  const std::vector<Verdict> verdicts = test::verdictsOf({3, 0, 2, 1});
  EXPECT_THAT(numbersOf(verdicts), ElementsAre(3, 0, 2, 1));
  EXPECT_EQ(static_cast<const void*>(bytesOf(verdicts)), verdicts.data());
  EXPECT_THAT(maskOf(verdicts, true), ElementsAre(0, 1, 0, 0));
  EXPECT_THAT(maskOf(verdicts, false), ElementsAre(1, 0, 1, 1)) << "what is undecided is not free";
}

TEST(Nothing, IsOneWordForAllNumbers)
{
  const std::vector<std::int32_t> poses = {0, kNothing};
  const std::vector<std::uint32_t> records = {kNothing, 0};
  EXPECT_THAT(poses, ElementsAre(0, -1));
  EXPECT_THAT(records, ElementsAre(0xffffffffu, 0u));
  EXPECT_TRUE(poses[1] == kNothing && records[0] == kNothing);
  EXPECT_TRUE(poses[0] != kNothing && records[1] != kNothing);
  static_assert(!std::is_convertible_v<Nothing, bool> && !std::is_convertible_v<Nothing, double>);
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/tools/viewer/content/tile_choice.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

namespace pcl_bsh::viewer {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Tiles of ten points in a row along x: the box of the k-th goes from k to k + 0.5.
site::Site row(std::size_t count)
{
  site::Site site;
  for (std::size_t k = 0; k < count; ++k) {
    site::Tile tile;
    tile.points = 10;
    const auto x = static_cast<double>(k);
    tile.bounds = site::Bounds{{x, 0, 0}, {x + 0.5, 1, 1}};
    site.tiles.push_back(tile);
  }
  return site;
}

/// Holds all that is wanted, in the order in which it is.
std::vector<std::size_t> settle(TileChoice& choice, const Eye& eye)
{
  std::vector<std::size_t> held;
  choice.look(eye);
  for (const std::size_t tile : choice.superfluous()) choice.drop(tile);
  while (const std::optional<std::size_t> tile = choice.next()) {
    choice.hold(*tile);
    held.push_back(*tile);
  }
  return held;
}

TEST(TileChoice, TakesTheNearestFirstWithinTheBudget)
{
  TileChoice choice(row(10), 45);
  EXPECT_THAT(settle(choice, {{6.2, 0.5, 0.5}, {}}), ElementsAre(6, 5, 7, 4));
  EXPECT_EQ(choice.heldPoints(), 40u);
  EXPECT_EQ(choice.held(), 4u);
  EXPECT_EQ(choice.wanted(), 4u);
}

TEST(TileChoice, DoesNotSeeWhatTouchesTheEyeFromBehind)
{
  site::Site site = row(2);
  site.tiles[0].bounds = site::Bounds{{-1, 0, 0}, {0, 1, 1}};
  TileChoice choice(site, 10);
  const Eye along_x = {{0, 0, 0}, {{1, 2, 0, 0}, {1, -2, 0, 0}, {1, 0, 2, 0}, {1, 0, -2, 0}}};
  EXPECT_THAT(settle(choice, along_x), ElementsAre(1));
}

TEST(TileChoice, DropsWhatLeavesTheBudgetBeforeItLoads)
{
  TileChoice choice(row(10), 30);
  settle(choice, {{0, 0, 0}, {}});
  choice.look({{9, 0, 0}, {}});
  EXPECT_THAT(choice.superfluous(), ElementsAre(0, 1, 2));
  EXPECT_THAT(settle(choice, {{9, 0, 0}, {}}), ElementsAre(9, 8, 7));
  EXPECT_EQ(choice.heldPoints(), 30u);
}

TEST(TileChoice, SmallMovesOfTheEyeChangeNothing)
{
  TileChoice choice(row(10), 20);
  settle(choice, {{4.25, 0.5, 0.5}, {}}); // in tile 4, and as far from 3 as from 5
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-0.05, 0.05);
  for (int i = 0; i < 200; ++i)
    EXPECT_THAT(settle(choice, {{4.25 + off(random), 0.5 + off(random), 0.5 + off(random)}, {}}), IsEmpty()) << i;
}

TEST(TileChoice, TakesOnlyWhatIsSeenAndKeepsTheRestWhileThereIsRoom)
{
  const std::array<double, 4> right_of_5 = {1, 0, 0, -5}, left_of_5 = {-1, 0, 0, 5};
  TileChoice choice(row(10), 60);
  EXPECT_THAT(settle(choice, {{5, 0, 0}, {right_of_5}}), ElementsAre(5, 6, 7, 8, 9));
  // Turned round, there is room for one of these beside the five on the left and the one that the plane touches.
  EXPECT_THAT(settle(choice, {{5, 0, 0}, {left_of_5}}), ElementsAre(4, 3, 2, 1, 0));
  EXPECT_EQ(choice.heldPoints(), 60u);
  EXPECT_THAT(settle(choice, {{5, 0, 0}, {right_of_5, left_of_5}}), IsEmpty());
  EXPECT_EQ(choice.heldPoints(), 60u) << "nothing else is needed";
}

TEST(TileChoice, NeverWantsWhatIsTooLargeLostOrNowhere)
{
  site::Site site = row(4);
  site.tiles[0].points = 1000;
  site.tiles[1].bounds.reset(); // its points are not finite
  TileChoice choice(site, 100);
  choice.giveUp(2);
  EXPECT_THAT(settle(choice, {{0, 0, 0}, {}}), ElementsAre(3));
  TileChoice nothing(site::Site{}, 100);
  EXPECT_THAT(settle(nothing, {{0, 0, 0}, {}}), IsEmpty());
}

TEST(TileChoice, HoldsItsPromisesOnRandomWalks)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 20; ++round) {
    site::Site site;
    for (int k = 0; k < 60; ++k) {
      const Point3 low = {10 * unit(random), 10 * unit(random), unit(random)};
      site::Tile tile;
      tile.points = 1 + random() % 1000;
      tile.bounds = site::Bounds{low, {low[0] + unit(random), low[1] + unit(random), low[2] + unit(random)}};
      site.tiles.push_back(tile);
    }
    const std::uint64_t budget = 500 + random() % 8000;
    TileChoice choice(site, budget);
    for (int move = 0; move < 20; ++move) {
      const Eye eye = {{10 * unit(random), 10 * unit(random), 3 * unit(random)},
                       {{unit(random) - 0.5, unit(random) - 0.5, 0, unit(random)}}};
      choice.look(eye);
      for (const std::size_t tile : choice.superfluous()) choice.drop(tile);
      while (const std::optional<std::size_t> tile = choice.next()) {
        choice.hold(*tile);
        ASSERT_LE(choice.heldPoints(), budget);
      }
      ASSERT_EQ(choice.held(), choice.wanted());
      // A choice without a past takes these, except for tiles that were held: this eye alone decides.
      TileChoice fresh(site, budget);
      const std::vector<std::size_t> first = settle(fresh, eye);
      const auto distance = [&](std::size_t tile) {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const double at = std::clamp(eye.place[k], site.tiles[tile].bounds->low[k], site.tiles[tile].bounds->high[k]);
          sum += (at - eye.place[k]) * (at - eye.place[k]);
        }
        return sum;
      };
      ASSERT_TRUE(std::is_sorted(first.begin(), first.end(),
                                 [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); }));
    }
  }
}

} // namespace
} // namespace pcl_bsh::viewer

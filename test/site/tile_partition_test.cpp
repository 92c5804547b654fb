// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/making/density_tree.h>
#include <pcl_bsh/site/making/tile_partition.h>
#include <pcl_bsh/site/site.h>

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace pcl_bsh::site {
namespace {

/// Whatever voxels and voxels above them hold, each tile has room for all points that may be its own.
TEST(TilePartition, LeavesRoomForWhatLiesAbove)
{
  std::mt19937 random(4);
  for (int scene = 0; scene < 50; ++scene) {
    SCOPED_TRACE(scene);
    constexpr std::uint64_t most = 1000;
    std::vector<DividedVoxel> above;
    for (std::uint32_t i = 0; i < 30; ++i)
      above.push_back({random() % 60, i == 0 ? DividedVoxel::none : static_cast<std::uint32_t>(random() % i)});
    std::vector<CountedVoxel> voxels;
    for (int i = 0; i < 200; ++i) {
      CountedVoxel voxel;
      for (double& c : voxel.middle) c = static_cast<double>(random() % 100);
      voxel.points = random() % 3 == 0 ? 0 : random() % 100;
      voxel.above = static_cast<std::uint32_t>(random() % above.size());
      for (std::uint32_t k = voxel.above; k != DividedVoxel::none; k = above[k].above)
        voxel.most_above += above[k].points;
      voxels.push_back(voxel);
    }
    const std::vector<std::uint32_t> tiles = tilesOf(voxels, above, most);
    std::map<std::uint32_t, std::pair<std::uint64_t, std::set<std::uint32_t>>> held;
    for (std::size_t i = 0; i < voxels.size(); ++i) {
      auto& [points, holding] = held[tiles[i]];
      points += voxels[i].points;
      for (std::uint32_t k = voxels[i].above; k != DividedVoxel::none; k = above[k].above) holding.insert(k);
    }
    EXPECT_EQ(held.rbegin()->first + 1, held.size()) << "numbers without gaps";
    EXPECT_GT(held.size(), 5u);
    for (const auto& [tile, content] : held) {
      std::uint64_t points = content.first;
      for (const std::uint32_t k : content.second) points += above[k].points;
      EXPECT_LE(points, most) << tile;
    }
  }
  EXPECT_TRUE(tilesOf({}, {}, 10).empty());
  const std::vector<CountedVoxel> full = {{{0, 0, 0}, 500, DividedVoxel::none, 0},
                                          {{0, 0, 0}, 2, DividedVoxel::none, 0}};
  const std::vector<CountedVoxel> empty = {{{5, 0, 0}, 0, 0, 500}, {{3, 0, 0}, 0, 0, 500}};
  const std::vector<std::uint32_t> apart = tilesOf(empty, {{500, DividedVoxel::none}}, 10);
  EXPECT_NE(apart[0], apart[1]) << "each may get all that was counted above";
  EXPECT_EQ(tilesOf(full, {}, 10), (std::vector<std::uint32_t>{0, 1})) << "a voxel of one place may have more";
}

/// A corridor on both sides of two planes of coordinates: its tiles follow each other.
TEST(TilePartition, TilesOfACorridorAreCompact)
{
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> way(-300, 700);
  std::vector<Point3> points;
  for (int i = 0; i < 40000; ++i) points.push_back({way(random), normal(random), normal(random)});
  DensityTree tree(1500);
  for (const Point3& point : points) tree.add(point);
  const std::uint32_t tiles = tree.plan();
  EXPECT_LE(tiles, 54u) << "at least half full";
  std::vector<std::optional<Bounds>> boxes(tiles);
  for (const Point3& point : points) extend(boxes[tree.tileOf(point)], point);
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size(); ++j)
      if (boxes[i] && boxes[j] && boxes[i]->low[0] < boxes[j]->high[0] + 1 && boxes[j]->low[0] < boxes[i]->high[0] + 1)
        ++pairs;
  EXPECT_LE(pairs, 2 * tiles);
}

} // namespace
} // namespace pcl_bsh::site

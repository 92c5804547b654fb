// SPDX-License-Identifier: BSD-3-Clause
// Points in the order of a scan are listed, and copied when their voxel is first visited; whatever happens before.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/update.h>

#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace pcl_bsh {
namespace {

using test::Random;

constexpr std::size_t kRow = 200, kPoints = kRow * kRow;

/// Rows over hills, one point after another.
std::vector<double> scan(double lift)
{
  std::vector<double> xyz;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const auto x = static_cast<double>(i % kRow), y = static_cast<double>(i / kRow);
    xyz.insert(xyz.end(), {x, y, lift + std::sin(x / 9) * std::cos(y / 7)});
  }
  return xyz;
}

HierarchyOptions coarse()
{
  HierarchyOptions options;
  options.voxel_edge = 32.0;
  return options;
}

std::size_t countListed(const SphereHierarchy& hierarchy)
{
  const SphereHierarchy::Storage& storage = hierarchy.storage();
  std::size_t listed = 0;
  for (std::size_t v = 0; v < storage.voxel_count; ++v) listed += storage.voxels[v].isListed();
  return listed;
}

void expectAnswers(const SphereHierarchy& hierarchy)
{
  const std::vector<double> few = {100.2, 100.1, 0.3, 20.5, 20.5, 1.2, 21.0, 20.0, 3.0};
  const SphereHierarchy other(viewOf(few.data(), 3));
  FlagsRequest request;
  request.clearance = 1.5;
  request.flagged = Flagged::both;
  const FlagsResult found = collisionFlags({hierarchy}, {other}, request);
  const FlagsResult right = brute_force::collisionFlags({hierarchy}, {other}, request);
  EXPECT_EQ(found.a, right.a);
  EXPECT_EQ(found.b, right.b);
  const HierarchyDefects defects = hierarchy.validate();
  EXPECT_TRUE(defects.none()) << testing::PrintToString(defects.lines);
}

TEST(ListedPoints, AreCopiedOnlyWhereAQueryGoes)
{
  const std::vector<double> xyz = scan(0);
  const SphereHierarchy hierarchy(viewOf(xyz.data(), kPoints), coarse());
  const std::size_t voxels = hierarchy.statistics().voxels;
  EXPECT_EQ(countListed(hierarchy), voxels);
  // Bytes that construction writes of the points: one each.
  EXPECT_LE(hierarchy.storage().list_words * sizeof(std::uint32_t), kPoints);

  const double one[3] = {100, 100, 0};
  const SphereHierarchy other(viewOf(one, 1));
  FlagsRequest request;
  request.clearance = 1.5;
  const FlagsResult found = collisionFlags({hierarchy}, {other}, request);
  EXPECT_EQ(countListed(hierarchy), voxels - hierarchy.statistics().voxels_built);
  EXPECT_LE(hierarchy.statistics().voxels_built, 2u);
  EXPECT_EQ(found.a, brute_force::collisionFlags({hierarchy}, {other}, request).a);
  expectAnswers(hierarchy);
  EXPECT_EQ(countListed(hierarchy), 0u);
}

TEST(ListedPoints, InNoOrderAreCopiedAtOnce)
{
  std::vector<double> xyz = scan(0);
  Random random(3);
  for (std::size_t i = kPoints; i-- > 1;) {
    const auto j = static_cast<std::size_t>(random.integer(0, static_cast<int>(i)));
    for (std::size_t k = 0; k < 3; ++k) std::swap(xyz[3 * i + k], xyz[3 * j + k]);
  }
  const SphereHierarchy hierarchy(viewOf(xyz.data(), kPoints), coarse());
  EXPECT_EQ(countListed(hierarchy), 0u);
  expectAnswers(hierarchy);
}

TEST(ListedPoints, OfASubset)
{
  const std::vector<double> xyz = scan(0);
  std::vector<std::int32_t> records(kPoints);
  std::iota(records.begin(), records.end(), 0);
  std::reverse(records.begin() + 5000, records.begin() + 5400);
  records.erase(records.begin() + 12345);
  PointsView view = viewOf(xyz.data(), kPoints);
  view.indices = records.data();
  view.index_count = records.size();
  const SphereHierarchy hierarchy(view, coarse());
  EXPECT_EQ(countListed(hierarchy), hierarchy.statistics().voxels);
  expectAnswers(hierarchy);
}

TEST(ListedPoints, ThatMove)
{
  for (const bool visited : {false, true}) {
    const std::vector<double> before = scan(0), after = scan(0.7);
    SphereHierarchy hierarchy(viewOf(before.data(), kPoints), coarse());
    if (visited) expectAnswers(hierarchy);
    const RefitReport report = hierarchy.refit(viewOf(after.data(), kPoints));
    EXPECT_FALSE(report.sorted_anew);
    EXPECT_EQ(countListed(hierarchy), visited ? 0 : hierarchy.statistics().voxels);
    expectAnswers(hierarchy);
  }
}

TEST(ListedPoints, OfWhichSomeChange)
{
  std::vector<double> xyz = scan(0);
  SphereHierarchy hierarchy(viewOf(xyz.data(), kPoints), coarse());
  std::vector<std::int32_t> changed;
  for (std::int32_t i = 0; i < 500; ++i) changed.push_back(40 * static_cast<std::int32_t>(kRow) + i);
  for (int round = 0; round < 12; ++round) { // enough to compact
    HierarchyUpdate update(hierarchy, changed.data(), changed.size());
    for (const std::int32_t i : changed) xyz[3 * static_cast<std::size_t>(i) + 2] += 0.05;
    EXPECT_FALSE(update.commit(viewOf(xyz.data(), kPoints)).sorted_anew);
    EXPECT_GT(countListed(hierarchy), 0u);
  }
  EXPECT_LT(hierarchy.storage().buffers.size(), 12u);
  expectAnswers(hierarchy);
}

} // namespace
} // namespace pcl_bsh

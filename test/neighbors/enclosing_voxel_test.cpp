// SPDX-License-Identifier: BSD-3-Clause
// A neighbour query that stays in its own voxel asks no other. Which voxel that is, keys tell: of the places where
// points were when they were sorted. Here are the states in which points are elsewhere.
#include <pcl_bsh/hierarchy/storage.h>
#include <pcl_bsh/hierarchy/update.h>
#include <pcl_bsh/neighbors/neighbors.h>
#include <pcl_bsh/scene/scene.h>

#include "support/brute_force/neighbors.h"
#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace pcl_bsh {
namespace {

using test::Random;

/// Points of two voxels along each axis, with their hierarchy.
template <class T>
class EnclosingVoxelCloud {
public:
  explicit EnclosingVoxelCloud(double edge = 1.0, double middle = 0.0, std::size_t count = 400) : edge_(edge)
  {
    Random random(7);
    for (std::size_t i = 0; i < 3 * count; ++i) xyz.push_back(static_cast<T>(middle + edge * random.uniform(0, 2)));
    HierarchyOptions options;
    options.voxel_edge = edge;
    hierarchy = std::make_shared<SphereHierarchy>(view(), options);
    hierarchy->buildAll();
  }

  PointsView view() const { return viewOf(xyz.data(), xyz.size() / 3); }

  void shift(double by, std::size_t axis = 0)
  {
    for (std::size_t i = axis; i < xyz.size(); i += 3) xyz[i] = static_cast<T>(static_cast<double>(xyz[i]) + by);
  }

  double strayed() const { return hierarchy->storage().strayed; }

  /// At points, near them, and on faces of voxels: radius, k nearest and any, as brute force answers.
  void expectRight(const char* state)
  {
    SCOPED_TRACE(state);
    EXPECT_TRUE(hierarchy->validate().none()) << hierarchy->validate().lines.front();
    Random random(8);
    Neighbors found, expected;
    for (int i = 0; i < 150 && !testing::Test::HasFailure(); ++i) {
      Point3 q = view().point(static_cast<std::uint32_t>(random.integer(0, static_cast<int>(view().count) - 1)));
      if (!isFinite(q)) continue;
      for (double& x : q) {
        if (random.chance(0.5)) x += 0.1 * edge_ * random.uniform(-1, 1);
        if (random.chance(0.1)) x = edge_ * std::round(x / edge_);
      }
      const double radius = edge_ * random.uniform(0, 0.2);
      radiusSearch(*hierarchy, q, radius, found);
      brute_force::radiusSearch(*hierarchy, q, radius, expected);
      EXPECT_EQ(found.indices, expected.indices);
      EXPECT_EQ(anyInRadius(*hierarchy, q, radius / 4), brute_force::anyInRadius(*hierarchy, q, radius / 4));
      if (i % 8 != 0) continue; // brute force sorts all points
      nearestKSearch(*hierarchy, q, 5, found);
      brute_force::nearestKSearch(*hierarchy, q, 5, expected);
      EXPECT_EQ(found.indices, expected.indices);
    }
  }

  /// Some of the points, moved by an update.
  void update(double by, bool keeps_voxels)
  {
    std::vector<std::int32_t> records;
    for (std::size_t i = 0; i < xyz.size() / 3; ++i)
      if (xyz[3 * i + 1] < static_cast<T>(0.3 * edge_)) records.push_back(static_cast<std::int32_t>(i));
    HierarchyUpdate change(*hierarchy, records.data(), records.size());
    for (const std::int32_t i : records) {
      T& x = xyz[3 * static_cast<std::size_t>(i)];
      x = static_cast<T>(static_cast<double>(x) + by);
    }
    const UpdateReport report = change.commit(view());
    EXPECT_EQ(report.sorted_anew, !keeps_voxels);
  }

  std::vector<T> xyz;
  std::shared_ptr<SphereHierarchy> hierarchy;

private:
  double edge_;
};

TEST(EnclosingVoxel, AsSorted)
{
  EnclosingVoxelCloud<float> cloud;
  cloud.expectRight("as sorted");
  EXPECT_EQ(cloud.strayed(), 0.0);
}

TEST(EnclosingVoxel, AfterARefit)
{
  for (const double by : {1.0, -1.0, 0.5, 17.0}) {
    EnclosingVoxelCloud<float> cloud;
    cloud.shift(by);
    ASSERT_FALSE(cloud.hierarchy->refit(cloud.view()).sorted_anew);
    cloud.expectRight("refitted");
    EXPECT_GT(cloud.strayed(), 0.4);
  }
}

TEST(EnclosingVoxel, AfterARefitBackToWhereTheyWere)
{
  EnclosingVoxelCloud<float> cloud;
  const std::vector<float> before = cloud.xyz;
  cloud.shift(1.0, 2);
  ASSERT_FALSE(cloud.hierarchy->refit(cloud.view()).sorted_anew);
  cloud.xyz = before;
  ASSERT_FALSE(cloud.hierarchy->refit(cloud.view()).sorted_anew);
  cloud.expectRight("refitted twice");
  EXPECT_LT(cloud.strayed(), 1e-3); // cells are counted in float
}

TEST(EnclosingVoxel, AfterSmallMotionsTheOwnVoxelIsStillEnough)
{
  EnclosingVoxelCloud<float> cloud;
  const auto above = [&] { // spheres above the voxels that are tested for a ball in the middle of one
    Work work;
    Neighbors found;
    radiusSearch(*cloud.hierarchy, {0.5, 0.5, 0.5}, 0.05, found, {}, &work);
    return work.node_pairs;
  };
  const std::uint64_t before = above();
  cloud.shift(0.01);
  ASSERT_FALSE(cloud.hierarchy->refit(cloud.view()).sorted_anew);
  cloud.expectRight("moved by a hundredth of a voxel");
  EXPECT_LT(above(), before + 8);
}

TEST(EnclosingVoxel, AfterVoxelsWereDroppedAndBuiltAgain)
{
  EnclosingVoxelCloud<float> cloud;
  Random random(9);
  const int last = static_cast<int>(cloud.view().count) - 1;
  for (int i = 0; i < 20000; ++i) { // points of one voxel change places: its leaves grow, it does not
    float* const p = &cloud.xyz[static_cast<std::size_t>(3 * random.integer(0, last))];
    float* const q = &cloud.xyz[static_cast<std::size_t>(3 * random.integer(0, last))];
    if (std::equal(p, p + 3, q, [](float x, float y) { return std::floor(x) == std::floor(y); }))
      std::swap_ranges(p, p + 3, q);
  }
  const RefitReport report = cloud.hierarchy->refit(cloud.view(), 1.1);
  EXPECT_FALSE(report.sorted_anew);
  EXPECT_GT(report.voxels_dropped, 0u);
  cloud.expectRight("dropped");
  for (float& x : cloud.xyz) x += static_cast<float>(random.uniform(-0.05, 0.05));
  const RefitReport kept = cloud.hierarchy->refit(cloud.view(), 100.0);
  EXPECT_FALSE(kept.sorted_anew);
  cloud.expectRight("built again, and kept");
}

TEST(EnclosingVoxel, AfterAnUpdate)
{
  EnclosingVoxelCloud<float> cloud;
  cloud.update(0.25, true);
  cloud.expectRight("updated");
  EXPECT_EQ(cloud.strayed(), 0.0);
}

TEST(EnclosingVoxel, AfterAnUpdateOfRefittedPoints)
{
  EnclosingVoxelCloud<float> cloud;
  cloud.shift(0.05);
  ASSERT_FALSE(cloud.hierarchy->refit(cloud.view()).sorted_anew);
  // Points that changed voxels by the refit: the update sees that, and sorts anew.
  cloud.update(0.25, false);
  cloud.expectRight("refitted, updated");
  EXPECT_EQ(cloud.strayed(), 0.0);
}

TEST(EnclosingVoxel, AfterAnUpdateOfPointsThatDidNotStray)
{
  // A refit moves the upper half over a face; the update is of some in the lower half, and leaves the others be.
  EnclosingVoxelCloud<float> cloud;
  for (std::size_t i = 0; i < cloud.xyz.size(); i += 3)
    if (cloud.xyz[i + 1] > 1.0f) cloud.xyz[i] += 1.0f;
  ASSERT_FALSE(cloud.hierarchy->refit(cloud.view()).sorted_anew);
  cloud.update(0.25, true);
  EXPECT_GT(cloud.strayed(), 0.0);
  cloud.expectRight("a half refitted, some of the other updated");
}

TEST(EnclosingVoxel, AfterARefitOfUpdatedPoints)
{
  EnclosingVoxelCloud<float> cloud;
  cloud.update(0.25, true);
  cloud.shift(1.0);
  ASSERT_FALSE(cloud.hierarchy->refit(cloud.view()).sorted_anew);
  cloud.expectRight("updated, refitted");
}

TEST(EnclosingVoxel, AfterASceneDeformedThem)
{
  EnclosingVoxelCloud<float> cloud;
  SceneOptions options;
  options.effects.deform = 1.5;
  Scene scene(options);
  const ObjectId object_id = scene.add(object("cloud", cloud.hierarchy));
  cloud.shift(1.0, 1);
  ASSERT_FALSE(scene.deform(object_id, 0, cloud.view()).sorted_anew);
  cloud.expectRight("deformed");
}

TEST(EnclosingVoxel, AtNegativeAndGreatCoordinates)
{
  for (const double middle : {-5.0, -1e4, 1e4}) {
    EnclosingVoxelCloud<float> cloud(1.0, middle);
    cloud.expectRight("sorted");
    cloud.shift(-1.0);
    ASSERT_FALSE(cloud.hierarchy->refit(cloud.view()).sorted_anew);
    cloud.expectRight("refitted");
  }
  for (const double unit : {0x1p100, 0x1p-100, 0x1p900, 0x1p-900}) {
    EnclosingVoxelCloud<double> cloud(unit, -unit, 200);
    cloud.expectRight("sorted");
    cloud.shift(unit);
    ASSERT_FALSE(cloud.hierarchy->refit(cloud.view()).sorted_anew);
    cloud.expectRight("refitted");
  }
  EnclosingVoxelCloud<double> far(0.25, 5400000.003);
  far.expectRight("georeferenced");
  far.shift(0.25);
  ASSERT_FALSE(far.hierarchy->refit(far.view()).sorted_anew);
  far.expectRight("georeferenced, refitted");
}

/// Numbers of cells are rounded to the cloud's float32: at 2^19 cells from the base to a sixteenth of a cell.
TEST(EnclosingVoxel, WherePointsLieOnFacesAndCellNumbersAreRounded)
{
  std::vector<float> xyz;
  for (int i = 0; i < 400; ++i) {
    const float x = 524288.0f + static_cast<float>(i % 20) / 16;
    xyz.insert(xyz.end(), {i < 4 ? 0.0f : x, static_cast<float>(i / 20) / 16, 0.0f});
  }
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  SphereHierarchy hierarchy(viewOf(xyz.data(), xyz.size() / 3), options);
  Neighbors found, expected;
  const auto expectRight = [&] {
    EXPECT_TRUE(hierarchy.validate().none());
    for (int i = 4; i < 400; i += 3)
      for (const double radius : {0x1p-5, 0x1p-4, 0x1p-3}) {
        const auto at = static_cast<std::size_t>(3 * i);
        const Point3 q = {static_cast<double>(xyz[at]) + 0x1p-5, xyz[at + 1], xyz[at + 2]};
        radiusSearch(hierarchy, q, radius, found);
        brute_force::radiusSearch(hierarchy, q, radius, expected);
        ASSERT_EQ(found.indices, expected.indices);
      }
  };
  expectRight();
  for (std::size_t i = 0; i < xyz.size(); i += 3) xyz[i] += 0.0625f;
  ASSERT_FALSE(hierarchy.refit(viewOf(xyz.data(), xyz.size() / 3)).sorted_anew);
  expectRight();
}

} // namespace
} // namespace pcl_bsh

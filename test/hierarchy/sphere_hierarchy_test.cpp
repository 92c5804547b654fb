// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/hierarchy/storage.h>

#include "support/random_clouds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Shape;
using testing::HasSubstr;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

void expectSound(const SphereHierarchy& hierarchy)
{
  const HierarchyDefects defects = hierarchy.validate();
  EXPECT_TRUE(defects.none()) << testing::PrintToString(defects.lines);
}

void expectSound(const Cloud& cloud, const HierarchyOptions& options = {})
{
  expectSound(SphereHierarchy(cloud.view(), options));
}

void expectEqual(const HierarchyStatistics& x, const HierarchyStatistics& y)
{
  EXPECT_EQ(x.points, y.points);
  EXPECT_EQ(x.voxels, y.voxels);
  EXPECT_EQ(x.voxels_built, y.voxels_built);
  EXPECT_EQ(x.nodes, y.nodes);
  EXPECT_EQ(x.leaves, y.leaves);
  EXPECT_EQ(x.depth, y.depth);
  EXPECT_EQ(x.bytes, y.bytes);
  EXPECT_EQ(x.voxel_edge, y.voxel_edge);
  EXPECT_EQ(x.mean_leaf_points, y.mean_leaf_points);
  EXPECT_EQ(x.mean_leaf_radius, y.mean_leaf_radius);
}

template <class Make>
Cloud cloudOf(std::size_t count, Scalar scalar, Make make)
{
  std::vector<Point3> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = make(static_cast<double>(i));
  return Cloud(points, {scalar});
}

/// The constructor's complaint; empty when it accepts.
std::string complaint(const PointsView& view, const HierarchyOptions& options = {})
{
  try {
    SphereHierarchy hierarchy(view, options);
    return {};
  }
  catch (const std::invalid_argument& error) {
    return error.what();
  }
}

// Soundness -------------------------------------------------------------------------------------------------------

TEST(SphereHierarchy, SoundAtEverySize)
{
  Random random(1);
  for (std::size_t count = 0; count <= 100; ++count) {
    for (const Shape shape : test::all_shapes) {
      SCOPED_TRACE(std::to_string(count) + " points of shape " + std::to_string(static_cast<int>(shape)));
      const Scalar scalar = count % 2 == 0 ? Scalar::float32 : Scalar::float64;
      const Cloud cloud(test::makePoints(shape, count, 1, random), {scalar});
      const SphereHierarchy hierarchy(cloud.view());
      EXPECT_EQ(hierarchy.size(), count);
      EXPECT_EQ(hierarchy.empty(), count == 0);
      expectSound(hierarchy);
    }
  }
}

TEST(SphereHierarchy, SoundInEveryShapeFitAndLayout)
{
  Random random(2);
  for (const SphereFit fit : {SphereFit::box_center, SphereFit::ritter, SphereFit::minimal}) {
    for (int i = 0; i < 40; ++i) {
      SCOPED_TRACE(std::to_string(static_cast<int>(fit)) + ", cloud " + std::to_string(i));
      constexpr double scales[] = {0x1p-10, 1.0, 0x1p10};
      const double scale = random.pick(scales);
      const Point3 center = i % 4 == 0 ? Point3{500000 * scale, 5400000 * scale, 100 * scale} : Point3{0, 0, 0};
      HierarchyOptions options;
      options.fit = fit;
      expectSound(test::anyCloud(static_cast<std::size_t>(random.integer(100, 3000)), scale, center, random), options);
    }
  }
}

TEST(SphereHierarchy, SoundForAnyVoxelEdge)
{
  Random random(3);
  const Cloud cloud(test::makePoints(Shape::uniform, 2000, 1, random));
  for (const double edge : {0x1p-12, 0.01, 0.3, 1.0, 1000.0, 1e30}) {
    SCOPED_TRACE(edge);
    HierarchyOptions options;
    options.voxel_edge = edge;
    const SphereHierarchy hierarchy(cloud.view(), options);
    expectSound(hierarchy);
    const double used = hierarchy.statistics().voxel_edge;
    EXPECT_EQ(std::exp2(std::round(std::log2(used))), used); // a power of two
  }
}

TEST(SphereHierarchy, SoundAtExtremeMagnitudes) // H9, H15, H17, H18
{
  const auto both = [](auto make) {
    for (const Scalar scalar : {Scalar::float32, Scalar::float64}) expectSound(cloudOf(1000, scalar, make));
  };
  both([](double i) { return Point3{1e30 * i / 1000, 1e30, -1e30}; });
  both([](double i) { return Point3{std::fmod(i, 2) == 0 ? 3e38 : 2e38, 0, 0}; });
  both([](double i) { return Point3{std::exp2(-std::fmod(i, 149)), 0, 0}; });
  both([](double i) { return Point3{std::exp2(-std::fmod(i, 149)), std::exp2(-std::fmod(7 * i, 149)), 0}; });
  both([](double i) { return Point3{1e-40 * i, 3e-45 * i, 0}; });
  both([](double i) { return i == 0 ? Point3{1e30, 0, 0} : Point3{1e-7 * i, 0, 0}; });
  both([](double i) { return i == 0 ? Point3{1e6, 0, 0} : Point3{1e-6 * i, 1e-6 * std::fmod(37 * i, 1000), 0}; });
  both([](double i) { return i < 2 ? Point3{430 * i, 0, 0} : Point3{0, 0, 0}; });
  const auto wide = [](auto make) { expectSound(cloudOf(1000, Scalar::float64, make)); };
  wide([](double i) { return Point3{std::ldexp(1 + i, -1074), std::ldexp(3 * i, -1074), 0}; });
  wide([](double i) { return Point3{std::ldexp(i, 1010), -std::ldexp(i, 1010), 0}; });
  wide([](double i) { return Point3{std::ldexp(1, static_cast<int>(i * 2 - 1000)), 0, 0}; });
  wide([](double i) { return Point3{std::fmod(i, 2) == 0 ? 1.7e308 : -1.7e308, i, 0}; });
  wide([](double i) { return Point3{1 + std::ldexp(std::fmod(i, 8), -52), 1 + std::ldexp(std::fmod(i, 9), -52), 1}; });
}

TEST(SphereHierarchy, SoundWhereATinyVoxelLiesFarOut) // found by fuzzing: its origin, in its own unit, overflowed
{
  for (const double far : {1e30, 1e200, 1.7e308}) {
    const auto make = [far](double i) { return Point3{3e-45 * i, 1e-23 * i, i < 2 ? far : i < 4 ? -far : 0.5 * far}; };
    expectSound(cloudOf(20, Scalar::float64, make));
  }
}

TEST(SphereHierarchy, LeavesBadPointsOut) // H12
{
  Random random(5);
  for (const double bad : {nan, infinity, -infinity}) {
    for (const std::size_t step : {std::size_t{1}, std::size_t{3}, std::size_t{7}, std::size_t{5000}}) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<Point3> points = test::makePoints(Shape::uniform, 1000, 1, random);
        std::size_t good = points.size();
        for (std::size_t i = 0; i < points.size(); i += step, --good) points[i][axis] = bad;
        const Cloud cloud(points);
        const SphereHierarchy hierarchy(cloud.view());
        EXPECT_EQ(hierarchy.size(), good);
        EXPECT_EQ(hierarchy.statistics().points, good);
        expectSound(hierarchy);
      }
    }
  }
}

TEST(SphereHierarchy, OutliersAnywhere) // also where no sample of the cloud sees them
{
  Random random(13);
  for (int i = 0; i < 60; ++i) {
    std::vector<Point3> points = test::makePoints(random.pick(test::all_shapes), 20000, 1, random);
    const int outliers = random.integer(1, 3);
    for (int k = 0; k < outliers; ++k) {
      Point3& p = points[static_cast<std::size_t>(random.integer(0, 19999))];
      p[static_cast<std::size_t>(random.integer(0, 2))] = (k % 2 ? 1 : -1) * std::exp2(random.integer(0, 40));
    }
    if (i % 3 == 0) std::fill(points.begin(), points.begin() + 5000, Point3{nan, nan, nan});
    const Cloud cloud(points, {i % 2 == 0 ? Scalar::float32 : Scalar::float64});
    const SphereHierarchy hierarchy(cloud.view());
    EXPECT_EQ(hierarchy.size(), i % 3 == 0 ? 15000u : 20000u);
    expectSound(hierarchy);
    HierarchyOptions options;
    options.threads = 4;
    const SphereHierarchy parallel(cloud.view(), options);
    parallel.buildAll(4);
    expectEqual(parallel.statistics(), hierarchy.statistics());
  }
}

TEST(SphereHierarchy, RunsOfAnyLength) // points are sorted by runs that stay in one voxel, or are not finite
{
  Random random(31);
  constexpr std::size_t count = 150000;
  for (const Scalar scalar : {Scalar::float32, Scalar::float64}) {
    for (const int longest : {1, 2, 9, 3000}) {
      std::vector<Point3> points;
      std::size_t good = 0;
      while (points.size() < count) {
        const double place = random.integer(-1, 40);
        for (int run = random.integer(1, longest); run > 0 && points.size() < count; --run) {
          points.push_back({place < 0 ? nan : 100 * place + random.uniform(0, 1), random.uniform(0, 1), 0});
          good += place >= 0;
        }
      }
      const Cloud cloud(points, {scalar});
      HierarchyOptions options;
      const SphereHierarchy hierarchy(cloud.view(), options);
      EXPECT_EQ(hierarchy.size(), good);
      expectSound(hierarchy);
      options.threads = 2;
      const SphereHierarchy parallel(cloud.view(), options);
      parallel.buildAll(2);
      expectEqual(parallel.statistics(), hierarchy.statistics());
    }
  }
}

TEST(SphereHierarchy, EmptyViews)
{
  Cloud one({{1, 2, 3}});
  one.restrictTo({});
  const Cloud bad({{nan, 0, 0}});
  for (const PointsView& view : {PointsView{}, Cloud({}).view(), one.view(), bad.view()}) {
    const SphereHierarchy hierarchy(view);
    EXPECT_TRUE(hierarchy.empty());
    hierarchy.buildAll();
    expectSound(hierarchy);
    const HierarchyStatistics statistics = hierarchy.statistics();
    EXPECT_EQ(statistics.points, 0u);
    EXPECT_EQ(statistics.voxels, 0u);
    EXPECT_EQ(statistics.leaves, 0u);
    EXPECT_FALSE(std::isnan(statistics.mean_leaf_points));
    EXPECT_FALSE(std::isnan(statistics.mean_leaf_radius));
  }
}

TEST(SphereHierarchy, IndexesTheSubsetOnly)
{
  Random random(6);
  Cloud cloud(test::makePoints(Shape::uniform, 1000, 1, random));
  std::vector<std::int32_t> indices;
  for (std::int32_t i = 999; i >= 0; i -= 3) indices.push_back(i);
  const std::size_t count = indices.size();
  cloud.restrictTo(indices);
  const SphereHierarchy hierarchy(cloud.view());
  EXPECT_EQ(hierarchy.size(), count);
  expectSound(hierarchy);
}

// Size ------------------------------------------------------------------------------------------------------------

TEST(SphereHierarchy, MillionPointsInOnePlace) // H16
{
  const Cloud cloud(std::vector<Point3>(1000000, Point3{1.25, 2.5, 3.75}));
  const SphereHierarchy hierarchy(cloud.view());
  hierarchy.buildAll();
  EXPECT_EQ(hierarchy.size(), 1000000u);
  EXPECT_EQ(hierarchy.statistics().voxels, 1u);
  EXPECT_LT(hierarchy.statistics().mean_leaf_radius, 1e-6);
  expectSound(hierarchy);
}

TEST(SphereHierarchy, MillionPointsInALine) // H17
{
  const Cloud cloud = cloudOf(1000000, Scalar::float32, [](double i) { return Point3{1e-3 * i, 0, 0}; });
  const SphereHierarchy hierarchy(cloud.view());
  hierarchy.buildAll(2);
  EXPECT_EQ(hierarchy.size(), 1000000u);
  EXPECT_LT(hierarchy.statistics().depth, 32u);
}

TEST(SphereHierarchy, HoldsWhatItPromisesPerPoint)
{
  Random random(7);
  const Cloud cloud(test::makePoints(Shape::uniform, 300000, 1, random));
  const SphereHierarchy hierarchy(cloud.view());
  hierarchy.buildAll();
  const HierarchyStatistics statistics = hierarchy.statistics();
  EXPECT_LT(static_cast<double>(statistics.bytes), 40.0 * 300000);
  EXPECT_GE(static_cast<double>(statistics.bytes), 16.0 * 300000);
}

/// Containment alone would be satisfied by any large sphere: these must be near the smallest.
TEST(SphereHierarchy, CountsWhatQueriesMadeOfIt)
{
  Random random(4);
  Cloud cloud(test::makePoints(Shape::uniform, 3000, 1.0, random));
  cloud.setUncertainties(0.0, std::vector<float>(3000, 0.01f));
  const SphereHierarchy hierarchy(cloud.view());
  const std::size_t sorted = hierarchy.statistics().bytes;
  hierarchy.buildAll(1);
  const SphereHierarchy::Storage& storage = hierarchy.storage();
  const std::size_t before = hierarchy.statistics().bytes;
  const std::size_t nodes = hierarchy.statistics().nodes - storage.top.size();
  EXPECT_GE(before, sorted + nodes * sizeof(Node));
  for (std::size_t v = 0; v < storage.voxel_count; ++v)
    storage.voxels[v].own_uncertainties.of(storage.voxels[v], storage.view);
  const std::size_t own = storage.voxel_count * (sizeof(OwnUncertainties) + kMaxLeafPoints * sizeof(float)) +
                          nodes * sizeof(UncertaintyLanes) + 3000 * sizeof(float);
  EXPECT_EQ(hierarchy.statistics().bytes, before + own);
  BuildWork unasked;
  for (std::size_t v = 0; v < storage.voxel_count; ++v) {
    storage.voxels[v].slabs.of(storage.voxels[v], storage.view, unasked);
    storage.voxels[v].cross_slabs.of(storage.voxels[v], storage.view, unasked);
  }
  EXPECT_EQ(hierarchy.statistics().bytes, before + own + 2 * nodes * sizeof(Slabs));
}

TEST(SphereHierarchy, TellsLengthsInTheUnitOfTheCloud)
{
  Random random(5);
  const std::vector<Point3> points = test::makePoints(Shape::uniform, 1000, 1.0, random);
  const auto radiusAt = [&](double scale) {
    std::vector<Point3> scaled = points;
    for (Point3& p : scaled)
      for (double& x : p) x = static_cast<double>(static_cast<float>(x)) * scale;
    const Cloud cloud(scaled, {Scalar::float64, 0, 0});
    const SphereHierarchy hierarchy(cloud.view());
    hierarchy.buildAll(1);
    return hierarchy.statistics().mean_leaf_radius / scale;
  };
  EXPECT_NEAR(radiusAt(0x1p70) / radiusAt(1.0), 1.0, 1e-3);
  EXPECT_NEAR(radiusAt(0x1p-70) / radiusAt(1.0), 1.0, 1e-3);
}

TEST(SphereHierarchy, SpheresAreTight)
{
  Random random(8);
  const Cloud plane(test::makePoints(Shape::plane, 100000, 1, random));
  double radius_of_fit[3] = {};
  for (const SphereFit fit : {SphereFit::box_center, SphereFit::ritter, SphereFit::minimal}) {
    HierarchyOptions options;
    options.fit = fit;
    const SphereHierarchy hierarchy(plane.view(), options);
    hierarchy.buildAll();
    const HierarchyStatistics statistics = hierarchy.statistics();
    EXPECT_GE(statistics.mean_leaf_points, 6.0);
    EXPECT_LE(statistics.mean_leaf_points, 16.0);
    // A square patch of that many points, at the cloud's density, has this circumscribed radius.
    const double area = 4 * std::sqrt(1 + 0.25 * 0.25 + 0.5 * 0.5);
    const double ideal = std::sqrt(area * statistics.mean_leaf_points / 100000 / 2);
    EXPECT_LT(statistics.mean_leaf_radius, 1.5 * ideal);
    radius_of_fit[static_cast<std::size_t>(fit)] = statistics.mean_leaf_radius;
  }
  const auto [box_center, ritter, minimal] = radius_of_fit;
  EXPECT_LT(minimal, box_center);
  EXPECT_LT(minimal, ritter);
  EXPECT_LT(box_center, 1.1 * minimal);
  EXPECT_LT(ritter, 1.1 * minimal);
}

// Building --------------------------------------------------------------------------------------------------------

TEST(SphereHierarchy, BuildsNothingUntilAsked)
{
  Random random(9);
  const Cloud cloud(test::makePoints(Shape::uniform, 100000, 1, random));
  const SphereHierarchy hierarchy(cloud.view());
  EXPECT_EQ(hierarchy.statistics().voxels_built, 0u);
  EXPECT_GT(hierarchy.statistics().voxels, 4u);
  hierarchy.buildAll();
  EXPECT_EQ(hierarchy.statistics().voxels_built, hierarchy.statistics().voxels);
}

TEST(SphereHierarchy, SameForAnyNumberOfThreads)
{
  Random random(10);
  for (const Shape shape : {Shape::uniform, Shape::clusters, Shape::outlier}) {
    const Cloud cloud(test::makePoints(shape, 200000, 1, random));
    const SphereHierarchy reference(cloud.view());
    reference.buildAll(1);
    for (const unsigned threads : {2u, 4u, 0u}) {
      HierarchyOptions options;
      options.threads = threads;
      const SphereHierarchy hierarchy(cloud.view(), options);
      hierarchy.buildAll(threads);
      expectEqual(hierarchy.statistics(), reference.statistics());
    }
  }
}

TEST(SphereHierarchy, BuiltOnceByManyThreads)
{
  Random random(11);
  const Cloud cloud(test::makePoints(Shape::uniform, 100000, 1, random));
  const SphereHierarchy reference(cloud.view());
  reference.buildAll();
  const SphereHierarchy hierarchy(cloud.view());
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < 4; ++i) threads.emplace_back([&, i] { hierarchy.buildAll(1 + i % 2); });
  for (std::thread& thread : threads) thread.join();
  expectEqual(hierarchy.statistics(), reference.statistics());
  expectSound(hierarchy);
}

TEST(SphereHierarchy, MovesWithItsPoints)
{
  Random random(12);
  const Cloud cloud(test::makePoints(Shape::uniform, 1000, 1, random));
  SphereHierarchy first(cloud.view());
  first.buildAll();
  const HierarchyStatistics before = first.statistics();
  SphereHierarchy second(std::move(first));
  expectEqual(second.statistics(), before);
  SphereHierarchy third{PointsView{}};
  third = std::move(second);
  EXPECT_EQ(third.size(), 1000u);
  EXPECT_EQ(third.view().data, cloud.view().data);
  expectSound(third);
}

// Arguments -------------------------------------------------------------------------------------------------------

TEST(SphereHierarchy, RefusesBadViews)
{
  const float xyz[6] = {1, 2, 3, 4, 5, 6};
  PointsView null = viewOf(xyz, 2);
  null.data = nullptr;
  EXPECT_THAT(complaint(null), HasSubstr("null"));
  EXPECT_THAT(complaint(viewOf(xyz, std::size_t{1} << 31)), HasSubstr("2147483648"));
  EXPECT_THAT(complaint(viewOf(xyz, std::numeric_limits<std::size_t>::max())), HasSubstr("18446744073709551615"));
  for (const std::int32_t outside : {-1, 2, std::numeric_limits<std::int32_t>::max()}) {
    const std::int32_t indices[] = {0, outside};
    PointsView subset = viewOf(xyz, 2);
    subset.indices = indices;
    subset.index_count = 2;
    EXPECT_THAT(complaint(subset), HasSubstr("index " + std::to_string(outside)));
  }
  for (const float radius : {-1.0f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    const float radii[] = {0, radius};
    PointsView balls = viewOf(xyz, 2);
    balls.radii = radii;
    EXPECT_THAT(complaint(balls), HasSubstr("radius"));
  }
  EXPECT_EQ(complaint(viewOf(xyz, 2)), "");
}

TEST(SphereHierarchy, RefusesBadVoxelEdges)
{
  const float xyz[3] = {1, 2, 3};
  for (const double edge : {-1.0, nan, infinity, -infinity}) {
    HierarchyOptions options;
    options.voxel_edge = edge;
    EXPECT_THAT(complaint(viewOf(xyz, 1), options), HasSubstr("voxel edge")) << edge;
  }
}

} // namespace
} // namespace pcl_bsh

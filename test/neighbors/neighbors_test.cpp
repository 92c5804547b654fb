// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/neighbors/neighbors.h>

#include "support/brute_force/neighbors.h"
#include "support/random_clouds.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <numeric>
#include <thread>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A cloud, and questions about it: some at its points, some near them, some far away.
struct Questions {
  explicit Questions(std::uint64_t seed, int max_points) : random(seed)
  {
    constexpr double scales[] = {0x1p-10, 1.0, 0x1p10};
    constexpr double distances[] = {0, 0, 0x1p7, 1e6};
    constexpr int small_counts[] = {0, 1, 2, 3, 7, 8, 9, 15, 16, 17, 33, 64, 100};
    scale = random.pick(scales);
    const double far = scale * random.pick(distances);
    const int count = random.chance(0.3) ? random.pick(small_counts) : random.integer(0, max_points);
    cloud = std::make_unique<test::Cloud>(
        test::anyCloud(static_cast<std::size_t>(count), scale, {far, -0.5 * far, 0.25 * far}, random));
  }

  PointsView view() const { return cloud->view(); }

  /// Half of the clouds are cut into many voxels, grids at places where points lie.
  HierarchyOptions options()
  {
    constexpr double edges[] = {0, 0, 0.25, 0.5};
    HierarchyOptions options;
    options.voxel_edge = scale * random.pick(edges);
    return options;
  }

  Point3 query()
  {
    Point3 q = random.point([&] { return 2 * scale * random.uniform(-1, 1); });
    if (view().size() == 0) return q;
    const Point3 p =
        view().point(view().record(static_cast<std::size_t>(random.integer(0, static_cast<int>(view().size()) - 1))));
    if (!isFinite(p) || random.chance(0.1)) return q;
    if (random.chance(0.4)) return p;
    for (std::size_t k = 0; k < 3; ++k) q[k] = p[k] + 0.2 * q[k];
    return q;
  }

  /// Half of them are exactly, or within the last bit, the distance of some point.
  double radius(const Point3& q)
  {
    if (view().size() == 0 || random.chance(0.5)) return random.chance(0.1) ? 0.0 : scale * random.uniform(0, 0.8);
    const Point3 p =
        view().point(view().record(static_cast<std::size_t>(random.integer(0, static_cast<int>(view().size()) - 1))));
    if (!isFinite(p)) return scale;
    const double distance = ExactDistance(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity()).gap({p, q});
    const int last_bit = random.integer(-1, 1);
    return last_bit == 0 ? distance : std::nextafter(distance, last_bit < 0 ? 0.0 : 2 * distance);
  }

  test::Random random;
  double scale = 1.0;
  std::unique_ptr<test::Cloud> cloud;
};

void expectEqual(const Neighbors& found, const Neighbors& expected)
{
  EXPECT_EQ(found.indices, expected.indices);
  EXPECT_EQ(found.squared_distances, expected.squared_distances);
}

void expectEqual(const NeighborLists& found, std::size_t i, const Neighbors& expected)
{
  expectEqual({found.indices[i], found.squared_distances[i]}, expected);
}

Neighbors sortedByIndex(const Neighbors& found)
{
  std::vector<std::pair<std::int32_t, float>> pairs;
  for (std::size_t i = 0; i < found.indices.size(); ++i)
    pairs.emplace_back(found.indices[i], found.squared_distances[i]);
  std::sort(pairs.begin(), pairs.end());
  Neighbors sorted;
  for (const auto& [index, squared] : pairs) {
    sorted.indices.push_back(index);
    sorted.squared_distances.push_back(squared);
  }
  return sorted;
}

void expectLikeBruteForce(std::uint64_t seed, int max_points, int queries)
{
  SCOPED_TRACE("seed " + std::to_string(seed));
  Questions ask(seed, max_points);
  const SphereHierarchy cloud(ask.view(), ask.options());
  Neighbors found, expected;
  for (int i = 0; i < queries; ++i) {
    const Point3 q = ask.query();
    const double radius = ask.radius(q);

    const std::size_t count = radiusSearch(cloud, q, radius, found);
    EXPECT_EQ(count, brute_force::radiusSearch(cloud, q, radius, expected));
    expectEqual(found, expected);
    EXPECT_EQ(anyInRadius(cloud, q, radius), count > 0);

    Neighbors unsorted;
    radiusSearch(cloud, q, radius, unsorted, {0, false});
    expectEqual(sortedByIndex(unsorted), sortedByIndex(expected));

    const auto most = static_cast<std::size_t>(ask.random.integer(1, 40));
    radiusSearch(cloud, q, radius, found, {most, true});
    brute_force::radiusSearch(cloud, q, radius, expected, {most, true});
    expectEqual(found, expected);

    EXPECT_EQ(nearestKSearch(cloud, q, most, found), std::min(most, cloud.size()));
    brute_force::nearestKSearch(cloud, q, most, expected);
    expectEqual(found, expected);

    Point3 low = ask.query(), high = ask.query();
    for (std::size_t k = 0; k < 3; ++k)
      if (low[k] > high[k]) std::swap(low[k], high[k]);
    std::vector<std::int32_t> inside, expected_inside;
    EXPECT_EQ(boxSearch(cloud, low, high, inside), brute_force::boxSearch(cloud, low, high, expected_inside));
    EXPECT_EQ(inside, expected_inside);
    if (testing::Test::HasFailure()) FAIL() << "query " << i;
  }
}

TEST(Neighbors, LikeBruteForceOnSmallClouds)
{
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    expectLikeBruteForce(seed, 200, 6);
    if (HasFailure()) return;
  }
}

TEST(Neighbors, LikeBruteForceOnLargerClouds)
{
  for (std::uint64_t seed = 1000; seed < 1024; ++seed) {
    expectLikeBruteForce(seed, 6000, 5);
    if (HasFailure()) return;
  }
}

/// Points and queries at the faces of voxels, and one float beside. They are so far from the first voxel that counting
/// cells in float32 rounds: points lie in the voxel beside theirs, or the nearest one is across a face.
TEST(Neighbors, AcrossTheFacesOfVoxels)
{
  test::Random random(5);
  std::vector<float> xyz = {0, 0, 0};
  for (int i = 0; i < 3000; ++i) {
    for (int k = 0; k < 3; ++k) {
      const auto face = static_cast<float>(random.integer(16000, 16004));
      const int side = random.integer(-2, 2);
      xyz.push_back(side == -2 ? face + static_cast<float>(random.uniform(0, 1))
                               : std::nextafter(face, side < 0 ? 0.0f : face * static_cast<float>(1 + side)));
    }
  }
  HierarchyOptions options;
  options.voxel_edge = 1.0;
  const SphereHierarchy cloud(viewOf(xyz.data(), xyz.size() / 3), options);
  Neighbors found, expected;
  for (int i = 0; i < 400; ++i) {
    const auto record = static_cast<std::size_t>(3 * random.integer(1, 3000));
    Point3 q = {xyz[record], xyz[record + 1], xyz[record + 2]};
    if (random.chance(0.5)) q[0] += random.uniform(-0.01, 0.01);
    const double radius = random.pick({0.0, 0x1p-9, 0.01, 0.1});
    EXPECT_EQ(radiusSearch(cloud, q, radius, found), brute_force::radiusSearch(cloud, q, radius, expected));
    expectEqual(found, expected);
    EXPECT_EQ(anyInRadius(cloud, q, radius), !expected.indices.empty());
    for (const std::size_t k : {1u, 3u, 20u}) {
      nearestKSearch(cloud, q, k, found);
      brute_force::nearestKSearch(cloud, q, k, expected);
      expectEqual(found, expected);
    }
    if (HasFailure()) FAIL() << "query " << i;
  }
}

/// Mean cost of a query, on the surface of a scan with stray points above it. A first guess that leads to a stray, or a
/// bound that does not shrink, would cost a sweep over much of the cloud.
TEST(Neighbors, LookAtFewPoints)
{
  test::Random random(9);
  std::vector<float> xyz;
  for (int i = 0; i < 100000; ++i) {
    const auto x = static_cast<float>(random.uniform(0, 316)), y = static_cast<float>(random.uniform(0, 316));
    const float height = i % 50 == 0 ? static_cast<float>(random.uniform(0, 60)) : 0.0f;
    xyz.insert(xyz.end(), {x, y, 3.0f * std::sin(0.05f * x) + height});
  }
  const SphereHierarchy cloud(viewOf(xyz.data(), xyz.size() / 3));
  constexpr std::size_t queries = 2000;
  Neighbors found;
  const auto cost = [&](const auto& search) {
    Work work;
    for (std::size_t i = 0; i < queries; ++i) {
      const float* p = xyz.data() + 3 * 25 * i; // every other one is a stray
      search(Point3{p[0], p[1], p[2]}, work);
    }
    return std::array<double, 2>{static_cast<double>(work.node_pairs) / queries,
                                 static_cast<double>(work.leaf_pairs) / queries};
  };
  const auto nearest = [&](std::size_t k) {
    return cost([&, k](const Point3& q, Work& work) { nearestKSearch(cloud, q, k, found, &work); });
  };
  const auto within = [&](double radius, std::size_t most) {
    return cost(
        [&, radius, most](const Point3& q, Work& work) { radiusSearch(cloud, q, radius, found, {most}, &work); });
  };
  const auto atMost = [](double nodes, double leaves) {
    return testing::ElementsAre(testing::Le(nodes), testing::Le(leaves));
  };
  EXPECT_THAT(nearest(1), atMost(28, 6));
  EXPECT_THAT(nearest(8), atMost(96, 15));
  EXPECT_THAT(nearest(30), atMost(165, 30));
  EXPECT_THAT(within(3.0, 1), atMost(27, 6));
  EXPECT_THAT(within(3.0, 0), atMost(72, 6));
}

/// A grid of doubles where float32 would see nothing but rounding.
std::vector<double> georeferencedGrid()
{
  std::vector<double> xyz;
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) xyz.insert(xyz.end(), {500000.003 + 0.01 * i, 5400000.26 + 0.01 * j, 100.0});
  return xyz;
}

TEST(Neighbors, Float64Georeferenced)
{
  const std::vector<double> xyz = georeferencedGrid();
  const SphereHierarchy cloud(viewOf(xyz.data(), xyz.size() / 3));
  Neighbors found, expected;
  for (std::size_t i = 0; i < xyz.size(); i += 21) {
    const Point3 q = {xyz[i], xyz[i + 1], xyz[i + 2]};
    for (const double radius : {0.01, 0.03, 0.05}) {
      radiusSearch(cloud, q, radius, found);
      brute_force::radiusSearch(cloud, q, radius, expected);
      expectEqual(found, expected);
    }
    nearestKSearch(cloud, q, 9, found);
    brute_force::nearestKSearch(cloud, q, 9, expected);
    expectEqual(found, expected);
  }
}

/// Clouds so small, so large or so far away that squares leave float, or even double.
TEST(Neighbors, ExtremeCoordinates)
{
  for (const double scale : {1e-200, 1e-40, 1e-23, 1e15, 1e30, 1e100}) {
    std::vector<double> xyz;
    for (int i = 0; i < 300; ++i)
      for (const int k : {7, 11, 13}) xyz.push_back(scale * ((i * k) % 17));
    const SphereHierarchy cloud(viewOf(xyz.data(), xyz.size() / 3));
    Neighbors found, expected;
    for (const Point3& q :
         {Point3{scale, 2 * scale, 3 * scale}, Point3{0, 0, 0}, Point3{1e3, 0, 0}, Point3{-1e90, 0, 0}}) {
      for (const double radius : {0.0, 5 * scale, 1e3, kInfinity}) {
        EXPECT_EQ(radiusSearch(cloud, q, radius, found), brute_force::radiusSearch(cloud, q, radius, expected));
        expectEqual(found, expected);
        EXPECT_EQ(anyInRadius(cloud, q, radius), !expected.indices.empty());
      }
      nearestKSearch(cloud, q, 20, found);
      brute_force::nearestKSearch(cloud, q, 20, expected);
      expectEqual(found, expected);
      if (HasFailure()) FAIL() << "scale " << scale;
    }
  }
}

/// A voxel's unit follows its size: from far off, distances in it leave the range of float.
TEST(Neighbors, TinyVoxelsInALargeCloud)
{
  for (const double tiny : {1e-12, 1e-25, 1e-100})
    for (const double place : {0.0, 0x1p-3}) {
      std::vector<Point3> points;
      for (int i = 0; i < 20; ++i) points.push_back({tiny * i, 0.0, tiny * (i % 3)});
      for (int i = 0; i < 20; ++i) points.push_back({1.0 + i, 0.5, 0.0});
      const test::Cloud cloud(points, {Scalar::float64, 0, 0});
      HierarchyOptions options;
      options.voxel_edge = 0.25;
      const SphereHierarchy hierarchy(cloud.view(), options);
      Neighbors found, expected;
      for (const std::size_t k : {1u, 5u, 19u, 21u, 40u}) {
        nearestKSearch(hierarchy, {0.25, place, 0}, k, found);
        brute_force::nearestKSearch(hierarchy, {0.25, place, 0}, k, expected);
        EXPECT_EQ(found.indices, expected.indices) << k << " nearest, " << tiny;
        radiusSearch(hierarchy, {0.25, place, 0}, 3.0, found, {k, true});
        brute_force::radiusSearch(hierarchy, {0.25, place, 0}, 3.0, expected, {k, true});
        EXPECT_EQ(found.indices, expected.indices) << k << " in a radius, " << tiny;
      }
    }
}

/// A voxel of one place has unit 1, whatever the cloud's.
TEST(Neighbors, VoxelsOfOnePlaceInAHugeCloud)
{
  for (const double unit : {0x1p100, 0x1p125, 0x1p1000, 0x1p-100, 0x1p-1000}) {
    std::vector<Point3> points;
    for (int i = 0; i < 40; ++i) points.push_back({unit * (i / 4), unit * (i % 3), 0.0});
    for (int i = 0; i < 40; ++i) points.push_back({unit * (i % 7) / 16, unit * (i % 5) / 16, unit * (i % 3) / 16});
    const test::Cloud cloud(points, {Scalar::float64, 0, 0});
    HierarchyOptions options;
    options.voxel_edge = unit / 2;
    const SphereHierarchy hierarchy(cloud.view(), options);
    Neighbors found, expected;
    for (const Point3& q : {Point3{0, 0, 0}, Point3{unit / 3, unit, unit}, Point3{4 * unit, 0, -unit}})
      for (const std::size_t k : {1u, 5u, 20u, 50u, 70u}) {
        nearestKSearch(hierarchy, q, k, found);
        brute_force::nearestKSearch(hierarchy, q, k, expected);
        EXPECT_EQ(found.indices, expected.indices) << k << " nearest, unit " << unit;
      }
  }
}

TEST(Neighbors, ManyPointsInOnePlace)
{
  const std::vector<float> xyz(3 * 100000, 1.25f);
  const SphereHierarchy cloud(viewOf(xyz.data(), xyz.size() / 3));
  Neighbors found;
  Work work;
  EXPECT_EQ(radiusSearch(cloud, {1.25, 1.25, 1.25}, 0.0, found, {}, &work), 100000u);
  EXPECT_TRUE(std::is_sorted(found.indices.begin(), found.indices.end()));
  EXPECT_EQ(nearestKSearch(cloud, {0, 0, 0}, 3, found, &work), 3u);
  EXPECT_EQ(found.indices, (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_LE(work.leaf_pairs, 2u);
}

TEST(Neighbors, QueriesThatAreNotFinite)
{
  const float xyz[] = {0, 0, 0};
  const SphereHierarchy cloud(viewOf(xyz, 1)), empty(viewOf(xyz, 0));
  Neighbors found;
  for (const Point3& q : {Point3{kNan, 0, 0}, Point3{0, kInfinity, 0}}) {
    EXPECT_EQ(radiusSearch(cloud, q, kInfinity, found), 0u);
    EXPECT_EQ(nearestKSearch(cloud, q, 1, found), 0u);
    EXPECT_FALSE(anyInRadius(cloud, q, kInfinity));
    EXPECT_EQ(brute_force::radiusSearch(cloud, q, kInfinity, found), 0u);
    EXPECT_EQ(brute_force::nearestKSearch(cloud, q, 1, found), 0u);
    EXPECT_FALSE(brute_force::anyInRadius(cloud, q, kInfinity));
  }
  found.indices = {1};
  EXPECT_EQ(nearestKSearch(empty, {0, 0, 0}, 1, found), 0u);
  EXPECT_TRUE(found.indices.empty());
}

TEST(Neighbors, SaysWhatIsWrong)
{
  const float xyz[] = {0, 0, 0};
  const SphereHierarchy cloud(viewOf(xyz, 1));
  Neighbors found;
  NeighborLists many;
  std::vector<std::int32_t> indices;
  const auto refused = [](const char* text) { return ThrowsMessage<std::invalid_argument>(HasSubstr(text)); };
  EXPECT_THAT([&] { radiusSearch(cloud, {0, 0, 0}, -1.0, found); }, refused("radius: -1"));
  EXPECT_THAT([&] { anyInRadius(cloud, {0, 0, 0}, kNan); }, refused("radius: "));
  for (std::size_t k = 0; k < 3; ++k) {
    Point3 low{0, 0, 0}, high{1, 1, 1}, odd{0, 0, 0};
    odd[k] = kNan;
    EXPECT_THAT([&] { boxSearch(cloud, odd, high, indices); }, refused("a bound is NaN"));
    EXPECT_THAT([&] { boxSearch(cloud, low, odd, indices); }, refused("a bound is NaN"));
  }
  EXPECT_THAT([&] { anyInBalls(cloud, viewOf(xyz, 1)); }, refused("no radii"));
  const PointsView none = viewOf(static_cast<const float*>(nullptr), 2);
  std::vector<std::uint8_t> flags;
  EXPECT_THAT([&] { nearestKSearch(cloud, none, 1, many); }, refused("data is null"));
  EXPECT_THAT([&] { radiusSearch(cloud, none, 1.0, many); }, refused("data is null"));
  EXPECT_THAT([&] { flagAnyInRadius(cloud, none, 1.0, flags); }, refused("data is null"));
}

TEST(Neighbors, VoxelsAreBuiltWhereQueriesGo)
{
  std::vector<float> xyz;
  for (int i = 0; i < 100000; ++i) xyz.insert(xyz.end(), {0.001f * static_cast<float>(i), 0.0f, 0.0f});
  const SphereHierarchy cloud(viewOf(xyz.data(), xyz.size() / 3));
  Neighbors found;
  radiusSearch(cloud, {0, 0, 0}, 0.01, found);
  nearestKSearch(cloud, {0, 0, 0}, 5, found);
  EXPECT_FALSE(anyInRadius(cloud, {0, 1e3, 0}, 1.0));
  const HierarchyStatistics statistics = cloud.statistics();
  EXPECT_GE(statistics.voxels, 10u);
  EXPECT_LE(statistics.voxels_built, 2u);
}

/// Many points near the query, and one at the edge of the radius that is found first, second, ... or last.
TEST(Neighbors, AreSortedWhereverTheFarthestIsFound)
{
  test::Random random(9);
  std::vector<Point3> near;
  for (int i = 0; i < 300; ++i) near.push_back(random.point([&] { return 0.01 * random.uniform(-1, 1); }));
  for (const Point3 far :
       {Point3{0.99, 0, 0}, {-0.99, 0, 0}, {0, 0.99, 0}, {0, -0.99, 0}, {0, 0, 0.99}, {0, 0, -0.99}}) {
    std::vector<Point3> points = near;
    points.insert(points.begin() + 7, far);
    const test::Cloud cloud(points, {Scalar::float64, 0, 0});
    const SphereHierarchy hierarchy(cloud.view());
    Neighbors found, expected;
    EXPECT_EQ(radiusSearch(hierarchy, {0, 0, 0}, 1.0, found), 301u);
    brute_force::radiusSearch(hierarchy, {0, 0, 0}, 1.0, expected);
    expectEqual(found, expected);
    EXPECT_EQ(found.indices.back(), 7);
  }
}

TEST(Neighbors, OfTrianglesAreRefused)
{
  test::Cloud mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  mesh.setTriangles({0, 1, 2});
  const SphereHierarchy cloud(mesh.view());
  const test::Cloud points({{0, 0, 0}});
  const PointsView queries = points.view();
  Neighbors one;
  NeighborLists lists;
  std::vector<std::uint8_t> flags;
  const Point3 at{0, 0, 0};
  EXPECT_THROW(radiusSearch(cloud, at, 1.0, one), std::invalid_argument);
  EXPECT_THROW(nearestKSearch(cloud, at, 1, one), std::invalid_argument);
  EXPECT_THROW(anyInRadius(cloud, at, 1.0), std::invalid_argument);
  EXPECT_THROW(radiusSearch(cloud, queries, 1.0, lists), std::invalid_argument);
  EXPECT_THROW(nearestKSearch(cloud, queries, 1, lists), std::invalid_argument);
  EXPECT_THROW(flagAnyInRadius(cloud, queries, 1.0, flags), std::invalid_argument);
  EXPECT_THROW(anyInBalls(cloud, queries, flags), std::invalid_argument);
}

TEST(Neighbors, BatchAsOneByOneForAnyThreads)
{
  for (const std::uint64_t seed : {3u, 17u, 2000u}) {
    Questions ask(seed, 3000);
    const SphereHierarchy cloud(ask.view());
    std::vector<double> queries;
    std::vector<float> radii;
    for (int i = 0; i < 1000; ++i) {
      const Point3 q = i == 500 ? Point3{kNan, 0, 0} : ask.query();
      queries.insert(queries.end(), q.begin(), q.end());
      radii.push_back(static_cast<float>(ask.scale * ask.random.uniform(0, 0.5)));
    }
    PointsView view = viewOf(queries.data(), 1000);
    view.radii = radii.data();
    const double radius = 0.2 * ask.scale;
    NeighborLists within, nearest; // used again
    for (const unsigned threads : {1u, 2u}) {
      radiusSearch(cloud, view, radius, within, {5, true}, threads);
      nearestKSearch(cloud, view, 7, nearest, threads);
      const auto any = flagAnyInRadius(cloud, view, radius, threads), balls = anyInBalls(cloud, view, threads);
      Neighbors single;
      for (std::uint32_t i = 0; i < 1000; ++i) {
        radiusSearch(cloud, view.point(i), radius, single, {5, true});
        expectEqual(within, i, single);
        nearestKSearch(cloud, view.point(i), 7, single);
        expectEqual(nearest, i, single);
        EXPECT_EQ(any[i] != 0, anyInRadius(cloud, view.point(i), radius));
        EXPECT_EQ(balls[i] != 0, anyInRadius(cloud, view.point(i), radii[i]));
      }
    }
  }
}

TEST(NeighborsThreads, OneFreshHierarchyForAll)
{
  Questions ask(42, 4000);
  const SphereHierarchy cloud(ask.view());
  std::vector<Point3> queries;
  for (int i = 0; i < 300; ++i) queries.push_back(ask.query());
  std::vector<std::vector<std::int32_t>> answers(4);
  std::vector<std::thread> threads;
  for (auto& answer : answers)
    threads.emplace_back([&] {
      Neighbors found;
      for (const Point3& q : queries) {
        nearestKSearch(cloud, q, 3, found);
        answer.insert(answer.end(), found.indices.begin(), found.indices.end());
        radiusSearch(cloud, q, 0.1 * ask.scale, found);
        answer.insert(answer.end(), found.indices.begin(), found.indices.end());
      }
    });
  for (auto& thread : threads) thread.join();
  for (const auto& answer : answers) EXPECT_EQ(answer, answers.front());
}

TEST(NeighborsTargets, AnswerAlike)
{
  const auto on = [](std::int64_t target, std::uint64_t seed) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    Questions ask(seed, 1500);
    const SphereHierarchy cloud(ask.view());
    Neighbors found, all;
    for (int i = 0; i < 20; ++i) {
      const Point3 q = ask.query();
      radiusSearch(cloud, q, ask.radius(q), found, {0, i % 2 == 0});
      all.indices.insert(all.indices.end(), found.indices.begin(), found.indices.end());
      nearestKSearch(cloud, q, 12, found);
      all.indices.insert(all.indices.end(), found.indices.begin(), found.indices.end());
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return all.indices;
  };
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    for (const std::int64_t target : targets) EXPECT_EQ(on(target, seed), on(targets.front(), seed));
}

} // namespace
} // namespace pcl_bsh

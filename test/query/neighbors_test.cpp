// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/query/brute_force_neighbors.h>
#include <pcl_bsh/query/neighbors.h>

#include "random_clouds.h"

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

bool isFinite(const Point3& p)
{
  return std::isfinite(p[0] + p[1] + p[2]);
}

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

  /// Half of them are exactly, or but for the last bit, the distance of some point.
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
  const SphereHierarchy cloud(ask.view());
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

} // namespace
} // namespace pcl_bsh

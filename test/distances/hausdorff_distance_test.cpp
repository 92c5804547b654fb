// SPDX-License-Identifier: BSD-3-Clause
// The symmetric Hausdorff distance alone against that of all distances by brute force. The clouds are random, or make
// leaving points out easily wrong: ties of the greatest, balls, poses that are not quite rigid, great lengths.
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/distances/reached_distance.h>

#include "expect_distances.h"
#include "support/adversarial_clouds.h"
#include "support/random_clouds.h"

#include <Eigen/LU>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Scene;
using namespace test::adversarial;

/// For records: the distance and pair that brute force finds in both directions.
HausdorffDistance truthOf(const Placed& a, const Placed& b)
{
  const PointDistances of_a = brute_force::pointDistances(a, b), of_b = brute_force::pointDistances(b, a);
  HausdorffDistance truth;
  if (!of_a.greatest_pair || !of_b.greatest_pair) return truth;
  truth.distance = std::max(of_a.greatest, of_b.greatest);
  const auto take = [&](double distance, const PointPair& pair) {
    if (distance == truth.distance && !(truth.pair && *truth.pair < pair)) truth.pair = pair;
  };
  for (std::uint32_t i = 0; i < of_a.distance.size(); ++i) take(of_a.distance[i], {i, of_a.closest_point[i]});
  for (std::uint32_t i = 0; i < of_b.distance.size(); ++i) take(of_b.distance[i], {of_b.closest_point[i], i});
  return truth;
}

void expectTruth(const Placed& a, const Placed& b, bool ties_are_exact = true)
{
  const HausdorffDistance truth = truthOf(a, b);
  const SymmetricDistances both = symmetricDistances(a, b);
  for (const unsigned threads : {1u, 3u}) {
    HausdorffRequest request;
    request.threads = threads;
    const HausdorffDistance found = hausdorffDistance(a, b, request);
    EXPECT_TRUE(found.distance == truth.distance || (std::isnan(found.distance) && std::isnan(truth.distance)))
        << found.distance << ", not " << truth.distance;
    EXPECT_EQ(found.pair, both.hausdorff_pair);
    if (ties_are_exact) {
      EXPECT_EQ(found.pair, truth.pair);
    }
  }
}

TEST(HausdorffDistance, OfRandomClouds)
{
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Scene scene = test::anyScene(seed, 200);
    SCOPED_TRACE(scene.name);
    HierarchyOptions options;
    if (seed % 2 == 0) options.voxel_edge = std::max(1e-3, 4 * scene.clearance);
    const SphereHierarchy a(scene.a.view(), options), b(scene.b.view(), options);
    expectTruth({a, scene.pose_a}, {b, scene.pose_b}, false); // of equal doubles one may be the greater
    if (testing::Test::HasFailure()) return;
  }
}

/// The greatest distance is b's, and several of its points have it: of (a, b) the smallest is not that of the smallest
/// b.
TEST(HausdorffDistance, OfEqualOnesOfTheOtherCloudIsTheSmallestPair)
{
  const Cloud one({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}}, {Scalar::float64, 0, 0});
  const Cloud other({{20, 3, 0}, {0, 1, 0}, {10, 3, 0}, {10, -3, 0}, {10, 0.5, 0}, {20, 0.5, 0}},
                    {Scalar::float64, 0, 0});
  const SphereHierarchy a(one.view()), b(other.view());
  EXPECT_EQ(hausdorffDistance(a, b).pair, (PointPair{1, 2}));
  EXPECT_EQ(symmetricDistances(a, b).hausdorff_pair, (PointPair{1, 2}));
  EXPECT_EQ(symmetricDistances(a, b).b.greatest_pair, (PointPair{0, 2})) << "of (b, a)";
  EXPECT_EQ(hausdorffDistance(b, a).pair, (PointPair{0, 2}));
  EXPECT_EQ(hausdorffDistance(a, b).distance, 3.0);
}

/// Both clouds have the greatest distance: the smaller pair (a, b) names it, whichever cloud it is of.
TEST(HausdorffDistance, OfEqualOnesOfBothCloudsIsTheSmallestPair)
{
  const Cloud other({{0, 0, 0}, {10, 0, 0}, {-10, 0, 0}}, {Scalar::float64, 0, 0});
  const SphereHierarchy b(other.view());
  const Cloud late({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}}, {Scalar::float64, 0, 0});  // of a (2, 1), of b (0, 2)
  const Cloud early({{20, 0, 0}, {0, 0, 0}, {10, 0, 0}}, {Scalar::float64, 0, 0}); // of a (0, 1), of b (1, 2)
  for (const auto& [cloud, pair] : {std::pair(&late, PointPair{0, 2}), std::pair(&early, PointPair{0, 1})}) {
    const SphereHierarchy a(cloud->view());
    const SymmetricDistances both = symmetricDistances(a, b);
    EXPECT_EQ(both.a.greatest, both.b.greatest);
    EXPECT_EQ(both.hausdorff_pair, pair);
    EXPECT_EQ(hausdorffDistance(a, b).pair, pair);
  }
}

/// A lattice beside itself: all distances are equal, or differ by less than a float tells.
TEST(HausdorffDistance, OfManyEqualOnesIsTheSmallestPair)
{
  for (const double shift : {0.5, 0.25, 0.0, 0.5 + 0x1p-30, 2.0, 1000.0}) {
    SCOPED_TRACE(shift);
    std::vector<Point3> one, other;
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j < 12; ++j)
        one.push_back({double(i), double(j), 0}), other.push_back({double(i), double(j), shift});
    std::reverse(other.begin(), other.end());
    one[77][2] -= 0x1p-29; // the greatest by a little, of where the greatest is from
    for (const int variant : {0, 1, 2}) {
      if (variant == 1) one[77][2] = 0; // all equal
      if (variant == 2) other[123][2] += 0x1p-31;
      const Cloud cloud_a(one, {Scalar::float64, 0, 0}), cloud_b(other, {Scalar::float64, 0, 0});
      HierarchyOptions fine;
      fine.voxel_edge = 3.0;
      for (const HierarchyOptions& options : {HierarchyOptions(), fine}) {
        const SphereHierarchy a(cloud_a.view(), options), b(cloud_b.view(), options);
        expectTruth(a, b);
        expectTruth(b, a);
      }
    }
  }
}

TEST(HausdorffDistance, OfSubsetsThatNameAPointTwice)
{
  Cloud twice({{0, 0, 0}, {4, 0, 0}, {NAN, 0, 0}});
  twice.restrictTo({1, 2, 1, 0});
  const Cloud other({{1, 0, 0}});
  const SphereHierarchy ha(twice.view()), hb(other.view());
  EXPECT_EQ(symmetricDistances({ha}, {hb}).hausdorff, 3.0);
  EXPECT_EQ(symmetricDistances({hb}, {ha}).hausdorff, 3.0);
  expectTruth({ha}, {hb});
}

TEST(HausdorffDistance, OfBallsThatOverlap)
{
  Random random(22);
  for (int round = 0; round < 40; ++round) {
    Cloud one(test::makePoints(test::Shape::plane, 150, 1, random));
    Cloud other(test::makePoints(round % 2 ? test::Shape::sphere : test::Shape::plane, 150, 1, random));
    const auto radii = [&](double least) {
      std::vector<float> values(150);
      for (float& value : values) value = static_cast<float>(least + random.uniform(0, 0.1));
      return values;
    };
    if (round % 3 != 0) one.setRadii(radii(round % 4 >= 2 ? 3 : 0)); // all distances below zero
    if (round % 3 != 1) other.setRadii(radii(0));
    HierarchyOptions options;
    if (round % 2 == 0) options.voxel_edge = 0.3;
    const SphereHierarchy a(one.view(), options), b(other.view(), options);
    expectTruth(a, b);
  }
}

TEST(HausdorffDistance, OfHardClouds)
{
  constexpr double far = std::numeric_limits<float>::max();
  std::vector<Point3> strayed = cube(60, 1), small = cube(50, 2);
  strayed.back() = {far, far, far};
  for (Point3& p : small) p = scaled(p, 1e-30);
  const std::vector<std::vector<Point3>> clouds = {
      {{0, 0, 0}},        shells(70, 1, 0),    std::vector<Point3>(40, {1, 2, 3}), strayed, small,
      sheet(60, 0.25, 0), sheet(60, 0.25, 0.5)};
  Eigen::Isometry3d nearly(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
  nearly.translation() = Eigen::Vector3d(0.1, 0.2, 1e6);
  nearly.linear() *= 1.0 + 2e-7;
  for (const auto& one : clouds)
    for (const auto& other : clouds) {
      const Cloud cloud_a(one), cloud_b(other);
      const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
      expectTruth(a, b, false);
      expectTruth(a, {b, nearly}, false);
    }
}

TEST(HausdorffDistance, IsUnknownOfAnEmptyCloudAndRefusesWhatIsNoPose)
{
  const Cloud none(std::vector<Point3>{}), some({{1, 2, 3}, {std::nan(""), 0, 0}});
  const SphereHierarchy empty(none.view()), full(some.view());
  for (const HausdorffDistance& found : {hausdorffDistance(full, empty), hausdorffDistance(empty, full)}) {
    EXPECT_TRUE(std::isnan(found.distance));
    EXPECT_FALSE(found.pair);
  }
  EXPECT_EQ(hausdorffDistance(full, full).pair, (PointPair{0, 0}));
  Eigen::Isometry3d scaled_pose = Eigen::Isometry3d::Identity();
  scaled_pose.linear() *= 2.0;
  EXPECT_THROW(hausdorffDistance(full, {full, scaled_pose}), InvalidInput);
  HausdorffRequest request;
  request.progress = [](double) { return false; };
  EXPECT_THROW(hausdorffDistance(full, full, request), Cancelled);
}

TEST(HausdorffDistance, LooksAtFewOfThePoints)
{
  Random random(23);
  std::vector<Point3> one = sheet(20'000, 0.5, 0), other = sheet(20'000, 0.5, 0);
  for (Point3& p : other) p = {p[0] + random.uniform(-0.2, 0.2), p[1] + random.uniform(-0.2, 0.2), p[2]};
  for (const double height : {1.5, 15.0}) {
    SCOPED_TRACE(height);
    other[4321][2] = height;
    const Cloud cloud_a(one), cloud_b(other);
    const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
    const HausdorffDistance found = hausdorffDistance(a, b);
    const SymmetricDistances both = symmetricDistances(a, b);
    EXPECT_EQ(found.distance, both.hausdorff);
    EXPECT_EQ(found.pair, both.hausdorff_pair);
    // Some of the 2,592 leaves are gone through before the far point is known: all that are wider than the greatest
    // distance, and few others.
    EXPECT_LT(found.work.leaf_pairs, height > 2 ? 1900u : 2900u);
    const Work all = Work(both.a.work) += both.b.work;
    EXPECT_LT(found.work.node_pairs, all.node_pairs + 1000); // those that order the voxels
  }
}

TEST(ReachedDistance, ExceedsOnlyWhatIsSmallerForCertain)
{
  for (const double d : {1.0, 0.0, -1.0, 0x1p-126, 3.0, 0x1p100}) {
    SCOPED_TRACE(d);
    ReachedDistance reached;
    EXPECT_FALSE(reached.exceeds(-std::numeric_limits<float>::max(), 1.0)) << "nothing is known";
    reached.raise(d);
    reached.raise(d - 1.0); // no less than it was
    const auto same = static_cast<float>(d);
    EXPECT_FALSE(reached.exceeds(same, 1.0));
    EXPECT_FALSE(reached.exceeds(std::nextafter(same, std::numeric_limits<float>::max()), 1.0));
    EXPECT_TRUE(reached.exceeds(std::nextafter(same, -std::numeric_limits<float>::max()), 1.0) || d == 0.0);
    EXPECT_TRUE(reached.exceeds(-std::numeric_limits<float>::max(), 1.0));
    EXPECT_FALSE(reached.exceeds(std::numeric_limits<float>::infinity(), 1.0));
    EXPECT_FALSE(reached.exceeds(std::nanf(""), 1.0));
  }
  // Bounds in units whose product rounds to the double before the distance, or to it.
  ReachedDistance reached;
  reached.raise(1.0);
  EXPECT_FALSE(reached.exceeds(1.0f, 1.0 - 0x1p-53));
  EXPECT_FALSE(reached.exceeds(1.0f, 1.0 - 0x1p-52));
  EXPECT_TRUE(reached.exceeds(1.0f, 1.0 - 0x1p-51));
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// Distances of points against brute force: random clouds of every shape and layout, poses, radii, limits, threads, both
// directions.
#include <pcl_bsh/base/invalid_input.h>

#include "expect_distances.h"
#include "support/adversarial_clouds.h"
#include "support/meshes.h"
#include "support/random_clouds.h"
#include "support/work_counts.h"

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Scene;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

PointDistancesRequest within(double max_distance, unsigned threads = 1)
{
  PointDistancesRequest request;
  request.max_distance = max_distance;
  request.threads = threads;
  return request;
}

HierarchyOptions optionsFor(const Scene& scene, std::uint64_t seed)
{
  HierarchyOptions options;
  constexpr SphereFit fits[] = {SphereFit::box_center, SphereFit::ritter, SphereFit::minimal};
  options.fit = fits[seed % 3];
  if (seed % 2 == 0) options.voxel_edge = std::max(1e-3, 4 * scene.clearance);
  return options;
}

TEST(PointDistances, AreCountedAnewInAResultThatIsUsedAgain)
{
  const Cloud one({{0, 0, 0}, {1, 0, 0}, {9, 0, 0}}), other({{2, 0, 0}});
  const SphereHierarchy a(one.view()), b(other.view());
  PointDistances found;
  for (int again = 0; again < 3; ++again) {
    pointDistances({a}, {b}, within(3.0), found);
    EXPECT_EQ(found.measured, 2u);
  }
  const HausdorffDistance both = hausdorffDistance({a}, {b}), turned = hausdorffDistance({b}, {a});
  EXPECT_EQ(both.distance, 7.0);
  EXPECT_EQ(test::countsOf(both.work).at("node_pairs"), test::countsOf(turned.work).at("node_pairs"));
  EXPECT_GT(both.work.node_pairs, pointDistances({a}, {b}).work.node_pairs / 2);
}

TEST(PointDistances, IntervalsAreAboutAsWideAsTheTolerance)
{
  for (std::uint64_t seed = 0; seed < 20; ++seed) { // some with radii, some without
    const Scene scene = test::anyScene(seed, 300);
    const SphereHierarchy a(scene.a.view()), b(scene.b.view());
    PointDistancesRequest request = within(kInfinity);
    const double tolerance = 0.01 * (scene.clearance + 1e-3);
    request.accuracy = Accuracy::tolerance(tolerance);
    const PointDistances found = pointDistances({a, scene.pose_a}, {b, scene.pose_b}, request);
    for (std::size_t i = 0; i < found.distance.size(); ++i) {
      if (found.closest_point[i] == kNothing) continue;
      const double rounding = 1e-12 * std::abs(found.distance[i]);
      EXPECT_GE(found.interval[i].lower, found.distance[i] - tolerance * (1 + 1e-9) - rounding) << scene.name;
      EXPECT_LE(found.interval[i].upper, found.distance[i] + rounding + 1e-300) << scene.name;
    }
  }
}

TEST(PointDistances, OfRandomClouds)
{
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Scene scene = test::anyScene(seed, 250);
    SCOPED_TRACE(scene.name);
    const HierarchyOptions options = optionsFor(scene, seed);
    const SphereHierarchy ha(scene.a.view(), options), hb(scene.b.view(), options);
    const Placed a(ha, scene.pose_a), b(hb, scene.pose_b);
    for (const double max : {kInfinity, scene.clearance}) {
      test::expectSame(pointDistances(a, b, within(max)), brute_force::pointDistances(a, b, within(max)));
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(PointDistances, OfTriangles)
{
  for (std::uint64_t seed = 0; seed < 240; ++seed) {
    const Scene scene = test::anyMeshScene(seed, 60);
    SCOPED_TRACE(scene.name);
    const HierarchyOptions options = optionsFor(scene, seed);
    const SphereHierarchy ha(scene.a.view(), options), hb(scene.b.view(), options);
    const Placed a(ha, scene.pose_a), b(hb, scene.pose_b);
    for (const double max : {kInfinity, scene.clearance}) {
      test::expectSame(pointDistances(a, b, within(max, 1 + seed % 2)), brute_force::pointDistances(a, b, within(max)));
      if (testing::Test::HasFailure()) return;
    }
  }
}

/// Leaves with points within the limit and beyond it, where floats know of each but one triangle.
TEST(PointDistances, OfOneTriangleWithinALimit)
{
  Random random(8);
  Cloud floor({{0, 0, 0}, {100, 0, 0}, {0, 100, 0}});
  floor.setTriangles({0, 1, 2});
  const SphereHierarchy b(floor.view());
  HierarchyOptions options;
  options.voxel_edge = 100; // many leaves in each, one after another
  std::size_t measured = 0;
  for (int round = 0; round < 12; ++round) {
    std::vector<Point3> points(100);
    for (Point3& p : points) {
      const double z = random.chance(0.5) ? random.uniform(0, 0.9) : random.uniform(1.1, 2);
      p = {random.uniform(1, 40), random.uniform(1, 40), z};
    }
    const Cloud cloud(points);
    const SphereHierarchy a(cloud.view(), options);
    const PointDistances found = pointDistances({a}, {b}, within(1.0));
    test::expectSame(found, brute_force::pointDistances({a}, {b}, within(1.0)));
    measured += found.measured;
  }
  EXPECT_GT(measured, 400u);
  EXPECT_LT(measured, 800u);
}

TEST(PointDistances, OfOnePointNeedNoExactDecision)
{
  Random random(9);
  const Cloud one({{0.1, 0.2, 0.3}}), cloud(test::makePoints(test::Shape::uniform, 300, 1, random));
  const SphereHierarchy a(cloud.view()), b(one.view());
  for (const double max : {1.0, kInfinity}) {
    const PointDistances found = pointDistances({a}, {b}, within(max));
    EXPECT_GT(found.measured, 100u);
    EXPECT_EQ(found.work.exact_decisions, 0u);
  }
}

/// Points that a translation brings so near to each other that what it rounds off is about as long as what it leaves.
TEST(PointDistances, OfTranslationsThatRound)
{
  const double third = 1.0 / 3.0, far = 1e9;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<Point3> points(40, Point3{});
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i][axis] = far + static_cast<double>(i) * 0x1p-21;
      points[i][(axis + 1) % 3] = static_cast<double>(i % 3) * 0x1p-23;
    }
    const Cloud one({{0, 0, 0}}, {Scalar::float64}), other(points, {Scalar::float64});
    Eigen::Isometry3d pose_a = Eigen::Isometry3d::Identity(), pose_b = pose_a;
    pose_a.translation()[static_cast<Eigen::Index>(axis)] = far + third;
    pose_b.translation()[static_cast<Eigen::Index>(axis)] = third;
    const SphereHierarchy a(one.view()), b(other.view());
    for (const auto& [from, to] :
         {std::pair(Placed(a, pose_a), Placed(b, pose_b)), {Placed(b, pose_b), Placed(a, pose_a)}})
      test::expectSame(pointDistances(from, to), brute_force::pointDistances(from, to));
  }
}

/// Leaves with points of two crowds, where what is between these is near to both: no point is farther from it than the
/// cut, which is less than the tolerance. A point far from the leaf that was compared first has found nothing yet.
TEST(PointDistances, WithinToleranceOfCrowdsThatAreApart)
{
  HierarchyOptions one_voxel;
  one_voxel.voxel_edge = 64.0;
  for (std::uint64_t seed = 0; seed < 800; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::vector<Point3> crowds(static_cast<std::size_t>(random.integer(2, 12))), of_a, of_b;
    const int axes = random.integer(1, 3);
    for (Point3& p : crowds)
      for (int k = 0; k < 3; ++k) p[static_cast<std::size_t>(k)] = k < axes ? random.integer(0, 8) : 0;
    const auto crowd = [&](std::vector<Point3>& points, const Point3& center, int most) {
      const double spread = std::exp2(-random.integer(1, 20));
      for (int count = random.integer(1, most); count > 0; --count) {
        const Point3 off = random.point([&] { return spread * random.uniform(-1, 1); });
        points.push_back({center[0] + off[0], center[1] + off[1], center[2] + off[2]});
      }
    };
    const auto any = [&] {
      return crowds[static_cast<std::size_t>(random.integer(1, static_cast<int>(crowds.size()))) - 1];
    };
    for (const Point3& center : crowds) {
      crowd(of_a, center, 60);
      if (random.chance(0.6)) crowd(of_b, center, 40);
    }
    for (int count = random.integer(1, 40); count > 0; --count) {
      const Point3 p = any(), q = any();
      crowd(of_b, {(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2}, 30);
    }
    const Cloud one(of_a), other(of_b);
    const SphereHierarchy a(one.view(), one_voxel), b(other.view(), one_voxel);
    const PointDistances truth = pointDistances({a}, {b});
    for (const double tolerance : {0.5, 2.0, 10.0}) {
      PointDistancesRequest request;
      request.accuracy = Accuracy::tolerance(tolerance);
      const PointDistances near = pointDistances({a}, {b}, request);
      ASSERT_EQ(near.measured, of_a.size());
      for (std::size_t i = 0; i < of_a.size(); ++i) {
        ASSERT_GE(near.distance[i], truth.distance[i]);
        ASSERT_LE(near.distance[i], truth.distance[i] + tolerance * (1 + 1e-9));
      }
    }
  }
}

/// Leaves of nodes below nodes go through the other cloud's nodes by themselves. Places of a lattice are as far from
/// several others; balls of a shift all distances of their point, those of b let nearer points be farther. One cloud is
/// near the other, one is among it, one is far for its size.
TEST(PointDistances, OfTreesThatAreDeep)
{
  Random random(41);
  const auto cloud = [&](std::size_t count, double apart, double raised) {
    std::vector<Point3> points(count);
    for (Point3& p : points) {
      for (double& x : p) x = apart > 0.0 ? apart * random.integer(0, 9) : random.uniform(0, 9);
      p[2] += raised;
    }
    return points;
  };
  const auto radii = [&](std::size_t count) {
    std::vector<float> values(count);
    for (float& radius : values) radius = 0.5f * static_cast<float>(random.integer(0, 6));
    return values;
  };
  HierarchyOptions one_voxel;
  one_voxel.voxel_edge = 64.0;
  for (int kind = 0; kind < 24; ++kind) {
    SCOPED_TRACE(kind);
    const double apart = kind % 2 == 0 ? 1.0 : 0.0, heights[] = {0.0, 8.0, 40.0};
    Cloud one(cloud(300, apart, heights[kind / 8])), other(cloud(1200, apart, 0.0));
    if ((kind & 2) != 0) one.setRadii(radii(300));
    if ((kind & 4) != 0) other.setRadii(radii(1200));
    const SphereHierarchy ha(one.view(), one_voxel), hb(other.view(), one_voxel);
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(0.5, 0, 0);
    const Placed a(ha, pose), b(hb);
    for (const double max : {kInfinity, 0.5 + heights[kind / 8]}) {
      const PointDistances truth = brute_force::pointDistances(a, b, within(max));
      test::expectSame(pointDistances(a, b, within(max)), truth);
      PointDistancesRequest request = within(max);
      request.accuracy = Accuracy::tolerance(0.25);
      const PointDistances near = pointDistances(a, b, request);
      EXPECT_EQ(near.measured, truth.measured);
      for (std::size_t i = 0; i < truth.distance.size(); ++i) {
        if (std::isnan(truth.distance[i])) continue;
        EXPECT_GE(near.distance[i], truth.distance[i]);
        EXPECT_LE(near.distance[i], truth.distance[i] + 0.25 * (1 + 1e-9));
      }
    }
  }
}

TEST(PointDistances, OfBallsWithinALimit)
{
  Random random(7);
  for (int i = 0; i < 60; ++i) { // of a alone, of b alone, of both
    Cloud one(test::makePoints(test::Shape::plane, 150, 1, random));
    Cloud other(test::makePoints(test::Shape::sphere, 150, 1, random));
    const auto radii = [&] {
      std::vector<float> values(150);
      for (float& value : values) value = random.chance(0.1) ? 0.5f : static_cast<float>(random.uniform(0, 0.05));
      return values;
    };
    if (i % 3 != 0) one.setRadii(radii());
    if (i % 3 != 1) other.setRadii(radii());
    const SphereHierarchy a(one.view()), b(other.view());
    const double max = random.uniform(0, 0.3);
    test::expectSame(pointDistances(a, b, within(max)), brute_force::pointDistances(a, b, within(max)));
  }
}

TEST(PointDistances, ThreadsGiveTheSameAnswerForTheSameWork)
{
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene scene = test::anyScene(seed, 2000);
    HierarchyOptions options = optionsFor(scene, seed);
    options.voxel_edge = 0.25;
    const auto ask = [&](unsigned threads) {
      const SphereHierarchy ha(scene.a.view(), options), hb(scene.b.view(), options);
      return pointDistances({ha, scene.pose_a}, {hb, scene.pose_b}, within(kInfinity, threads));
    };
    const PointDistances one = ask(1), four = ask(4);
    test::expectSame(four, one);
    EXPECT_EQ(test::countsOf(four.work), test::countsOf(one.work));
  }
}

TEST(PointDistances, OfBothDirectionsGiveTheSymmetricHausdorffDistance)
{
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const Scene scene = test::anyScene(seed, 120);
    SCOPED_TRACE(scene.name);
    const SphereHierarchy ha(scene.a.view()), hb(scene.b.view());
    const Placed a(ha, scene.pose_a), b(hb, scene.pose_b);
    for (const double max : {kInfinity, scene.clearance}) {
      const SymmetricDistances found = symmetricDistances(a, b, within(max));
      const PointDistances of_a = brute_force::pointDistances(a, b, within(max));
      const PointDistances of_b = brute_force::pointDistances(b, a, within(max));
      test::expectSame(found.a, of_a);
      test::expectSame(found.b, of_b);
      const bool known = of_a.measured == ha.size() && of_b.measured == hb.size() && ha.size() > 0 && hb.size() > 0;
      EXPECT_EQ(found.hausdorff_pair.has_value(), known);
      EXPECT_EQ(std::isnan(found.hausdorff), !known);
      if (!known) continue;
      EXPECT_EQ(found.hausdorff, std::max(of_a.greatest, of_b.greatest));
      const PointPair p = *of_a.greatest_pair, q = {of_b.greatest_pair->b, of_b.greatest_pair->a};
      if (of_a.greatest != of_b.greatest) {
        EXPECT_EQ(*found.hausdorff_pair, of_a.greatest > of_b.greatest ? p : q);
      }
      EXPECT_TRUE(*found.hausdorff_pair == p || *found.hausdorff_pair == q);
    }
  }
}

TEST(PointDistances, AreNoneWhereACloudIsEmpty)
{
  const Cloud none(std::vector<Point3>{}), some({{1, 2, 3}, {std::nan(""), 0, 0}});
  const SphereHierarchy empty(none.view()), full(some.view());
  PointDistancesRequest request;
  EXPECT_TRUE(pointDistances(empty, full, request).distance.empty());
  request.accuracy = Accuracy::level(1);
  const PointDistances found = pointDistances(full, empty, request);
  EXPECT_EQ(found.measured + found.undecided, 0u);
  EXPECT_EQ(found.closest_point, (std::vector<std::uint32_t>{kNothing, kNothing}));
  EXPECT_EQ(found.interval[0].lower, kInfinity);
  EXPECT_TRUE(std::isnan(found.interval[1].lower));
  EXPECT_TRUE(std::isnan(symmetricDistances(full, empty).hausdorff));
}

TEST(PointDistances, AreRefusedWithoutMeaning)
{
  const Cloud one({{1, 2, 3}});
  const SphereHierarchy point(one.view());
  for (const double bad : {-1.0, std::nan("")}) {
    try {
      pointDistances(point, point, within(bad));
      ADD_FAILURE();
    }
    catch (const InvalidInput& error) {
      EXPECT_EQ(error.input(), Input::max_distance);
    }
  }
  Eigen::Isometry3d scaled = Eigen::Isometry3d::Identity();
  scaled.linear() *= 2.0;
  EXPECT_THROW(pointDistances({point, scaled}, point), InvalidInput);
  EXPECT_THROW(symmetricDistances(point, {point, scaled}), InvalidInput);
  PointDistancesRequest request;
  request.accuracy = Accuracy::tolerance(-1);
  EXPECT_THROW(brute_force::pointDistances(point, point, request), InvalidInput);
}

TEST(PointDistances, ReportProgressAndStop)
{
  Random random(3);
  const Cloud cloud(test::makePoints(test::Shape::uniform, 5000, 1, random));
  HierarchyOptions fine;
  fine.voxel_edge = 0.25;
  const SphereHierarchy a(cloud.view(), fine);
  std::vector<double> told;
  PointDistancesRequest request;
  request.progress = [&](double done) {
    told.push_back(done);
    return true;
  };
  const PointDistances truth = pointDistances(a, a, request);
  ASSERT_GT(told.size(), 10u);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1.0);
  for (const unsigned threads : {1u, 3u}) {
    int calls = 0;
    request.threads = threads;
    request.progress = [&](double) { return ++calls < 5; };
    PointDistances result = truth;
    EXPECT_THROW(pointDistances(a, a, request, result), Cancelled);
    EXPECT_TRUE(result.distance.empty() && result.closest_point.empty() && !result.greatest_pair);
    request.progress = [](double) -> bool { throw std::runtime_error("of the caller"); };
    EXPECT_THROW(symmetricDistances(a, a, request), std::runtime_error);
  }
  request.progress = nullptr;
  test::expectSame(pointDistances(a, a, request), truth);
}

/// Work per point of the larger cloud, which must not grow with it.
TEST(PointDistances, TakeLinearWorkOfHardClouds)
{
  using namespace test::adversarial;
  const auto perPoint = [](const std::vector<Point3>& one, const std::vector<Point3>& other) {
    const Cloud cloud_a(one), cloud_b(other);
    const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
    const Work work = pointDistances(a, b).work;
    return static_cast<double>(work.node_pairs + 16 * work.leaf_pairs + work.exact_decisions) /
           static_cast<double>(std::max(one.size(), other.size()));
  };
  const std::vector<Point3> center = {{0, 0, 0}};
  EXPECT_LT(perPoint(center, shells(20'000, 1, 0)), 12.0); // all at the same distance
  EXPECT_LT(perPoint(shells(20'000, 1, 0), center), 12.0);
  const std::vector<Point3> place(20'000, {1, 2, 3});
  EXPECT_LT(perPoint(place, place), 1.0);
  EXPECT_LT(perPoint(place, shells(20'000, 1, 0)), 12.0);
  EXPECT_LT(perPoint(sheet(20'000, 0, 0), sheet(20'000, 0.5, 0)), 250.0); // four at the same distance from each
}

TEST(PointDistances, OfCloudsBelowFloatResolution)
{
  Random random(5);
  for (const double grain : {0x1p-24, 0x1p-40, 0x1p-60}) {
    std::vector<Point3> points(1500);
    for (Point3& p : points) p = random.point([&] { return 0.25 + grain * random.integer(0, 64); });
    points[0] = {1, 1, 1};
    std::vector<Point3> shifted = points;
    for (Point3& p : shifted) p[0] += 32 * grain;
    const Cloud cloud_a(points, {Scalar::float64, 0, 0}), cloud_b(shifted, {Scalar::float64, 0, 0});
    const SphereHierarchy a(cloud_a.view()), b(cloud_b.view());
    test::expectSame(pointDistances(a, b), brute_force::pointDistances(a, b));
  }
}

/// The frame of one place measures in the clouds' unit, that of a tiny cloud in one of its own: the factor between them
/// is no float.
TEST(PointDistances, BetweenOnePlaceAndATinyCloud)
{
  for (const double scale : {1e-30, 1e-36, 1e-38, 1e-39, 1e-41, 1e-44, 1e-60, 1e-170, 1e-300})
    for (const Scalar scalar : {Scalar::float32, Scalar::float64}) {
      if (scalar == Scalar::float32 && scale < 1e-44) continue;
      SCOPED_TRACE(scale);
      const Cloud place(std::vector<Point3>(30, {3 * scale, 0, scale}), {scalar, 0, 0});
      std::vector<Point3> points;
      for (int i = 0; i < 40; ++i) points.push_back({i % 5 * scale, i / 5 * scale, 0});
      const Cloud tiny(points, {scalar, 0, 0});
      const SphereHierarchy a(place.view()), b(tiny.view());
      for (const auto& [from, to] : {std::pair(&a, &b), std::pair(&b, &a)}) {
        const PointDistances truth = brute_force::pointDistances(*from, *to);
        test::expectSame(pointDistances(*from, *to), truth);
        for (const Accuracy& accuracy : {Accuracy::level(0), Accuracy::level(4), Accuracy::tolerance(0.0)}) {
          PointDistancesRequest request;
          request.accuracy = accuracy;
          const PointDistances found = pointDistances(*from, *to, request);
          for (std::size_t i = 0; i < truth.distance.size(); ++i) {
            EXPECT_LE(found.interval[i].lower, truth.distance[i]) << accuracy.text();
            EXPECT_GE(found.interval[i].upper, truth.distance[i]) << accuracy.text();
          }
        }
      }
      EXPECT_EQ(hausdorffDistance(a, b).distance, symmetricDistances(a, b).hausdorff);
    }
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>

#include "support/facing_sheets.h"
#include "support/kd_tree.h"
#include "support/meshes.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"
#include "support/work_counts.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace pcl_bsh {
namespace {

using Flags = std::vector<Verdict>;
using test::Cloud;
using test::FacingSheets;
using test::Random;
using test::Scene;
using test::Shape;

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

FlagsRequest within(double clearance, Flagged flagged = Flagged::a, unsigned threads = 1)
{
  FlagsRequest request;
  request.clearance = clearance;
  request.flagged = flagged;
  request.threads = threads;
  return request;
}

TEST(CollisionFlags, OfNothingLookedAtAreUndecidedButOfWhatCollidesWithNothing)
{
  // With a budget of nothing; one point is not finite, or is not named.
  const Cloud other({{0, 0, 0}});
  Cloud with_nan({{0, 0, 0}, {nan, 0, 0}, {0.5, 0, 0}}), subset({{0, 0, 0}, {0.25, 0, 0}, {0.5, 0, 0}});
  subset.restrictTo({0, 2});
  const SphereHierarchy b(other.view());
  FlagsRequest request = within(1.0);
  request.accuracy = Accuracy::nodePairs(0);
  for (const Cloud* cloud : {&with_nan, &subset}) {
    const SphereHierarchy a(cloud->view());
    const FlagsResult found = collisionFlags({a}, {b}, request);
    EXPECT_EQ(found.a, (Flags{Verdict::undecided, Verdict::free, Verdict::undecided}));
    EXPECT_EQ(found.undecided_a, 2u);
  }
}

std::size_t ones(const Flags& flags)
{
  std::size_t count = 0;
  for (const Verdict flag : flags) count += flag == Verdict::colliding;
  return count;
}

/// Both sides, one side at a time, and any number of threads.
void expectSameAsBruteForce(const Scene& scene)
{
  SCOPED_TRACE(scene.name);
  const SphereHierarchy a(scene.a.view()), b(scene.b.view());
  const Placed placed_a{a, scene.pose_a}, placed_b{b, scene.pose_b};
  const FlagsResult expected = brute_force::collisionFlags(placed_a, placed_b, within(scene.clearance, Flagged::both));
  for (const unsigned threads : {1u, 2u, 4u}) {
    SCOPED_TRACE(std::to_string(threads) + " threads");
    const FlagsResult both = collisionFlags(placed_a, placed_b, within(scene.clearance, Flagged::both, threads));
    ASSERT_EQ(both.a, expected.a);
    ASSERT_EQ(both.b, expected.b);
    EXPECT_EQ(both.colliding_a, expected.colliding_a);
    EXPECT_EQ(both.colliding_b, expected.colliding_b);
  }
  const FlagsResult of_a = collisionFlags(placed_a, placed_b, within(scene.clearance, Flagged::a));
  EXPECT_EQ(of_a.a, expected.a);
  EXPECT_TRUE(of_a.b.empty());
  EXPECT_EQ(of_a.colliding_b, 0u);
  const FlagsResult of_b = collisionFlags(placed_a, placed_b, within(scene.clearance, Flagged::b));
  EXPECT_EQ(of_b.b, expected.b);
  EXPECT_TRUE(of_b.a.empty());
  EXPECT_EQ(of_b.colliding_a, 0u);
}

Flags flagsOf(const Cloud& a, const Cloud& b, double clearance)
{
  const SphereHierarchy hierarchy_a(a.view()), hierarchy_b(b.view());
  return collisionFlags({hierarchy_a}, {hierarchy_b}, within(clearance)).a;
}

std::vector<Point3> gridOf(int side, double start, double step)
{
  std::vector<Point3> points;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      for (int k = 0; k < side; ++k) points.push_back({start + step * i, start + step * j, start + step * k});
    }
  }
  return points;
}

TEST(CollisionFlags, SameAsBruteForceOnSmallClouds)
{
  for (std::uint64_t seed = 0; seed < 400; ++seed) expectSameAsBruteForce(test::anyScene(seed, 100));
}

TEST(CollisionFlags, SameAsBruteForceOnLargerClouds)
{
  for (std::uint64_t seed = 1000; seed < 1030; ++seed) expectSameAsBruteForce(test::anyScene(seed, 1000));
  for (std::uint64_t seed = 2000; seed < 2004; ++seed) expectSameAsBruteForce(test::anyScene(seed, 3000));
}

TEST(CollisionFlags, SameAsBruteForceOfTriangles)
{
  for (std::uint64_t seed = 0; seed < 300; ++seed) expectSameAsBruteForce(test::anyMeshScene(seed, 60));
  for (std::uint64_t seed = 300; seed < 306; ++seed) expectSameAsBruteForce(test::anyMeshScene(seed, 400));
}

/// Floats know less of such triangles than of points about their middles.
TEST(CollisionFlags, PointsAtTheClearanceOfFarLargerTriangles)
{
  Random random(62);
  std::size_t hits = 0, all = 0;
  for (int i = 0; i < 200; ++i) {
    const double clearance = std::pow(10.0, random.uniform(-3, 0)), size = 1000.0;
    test::Mesh mesh;
    mesh.add({-size, -0.3 * size, 0.1 * size}, {size, 0.3 * size, -0.1 * size}, {0.2 * size, 0.7 * size, 0.5 * size});
    const Eigen::Vector3d along = Eigen::Vector3d(1, 0.3, -0.1).normalized();
    const Eigen::Vector3d normal = along.cross(Eigen::Vector3d(0.2, 0.7, 0.5)).normalized();
    std::vector<Point3> near;
    for (int k = 0; k < 100; ++k) {
      const Eigen::Vector3d p = clearance * random.uniform(0, 2) * along.cross(normal) * (k % 2 == 0 ? -1 : 0) +
                                clearance * random.uniform(-2, 2) * along +
                                (clearance + 1e-4 * random.uniform(-1, 1)) * normal;
      near.push_back({p.x(), p.y(), p.z()});
    }
    Cloud triangles(mesh.vertices), points(near, {Scalar::float64});
    triangles.setTriangles(mesh.corners);
    const SphereHierarchy a(points.view()), b(triangles.view());
    const FlagsResult expected = brute_force::collisionFlags({a}, {b}, within(clearance));
    ASSERT_EQ(collisionFlags({a}, {b}, within(clearance)).a, expected.a) << i;
    hits += ones(expected.a), all += expected.a.size();
  }
  EXPECT_GT(hits, all / 5);
  EXPECT_LT(hits, all - all / 5);
}

/// Floats decide next to the clearance: of points, and of nodes as small as they are, beside triangles much larger.
TEST(CollisionFlags, PointsAtTheClearanceOfLargeTriangles)
{
  Random random(61);
  std::size_t hits = 0, all = 0;
  for (int i = 0; i < 60; ++i) {
    const double size = std::pow(10.0, random.uniform(-1, 3)), clearance = size * std::pow(10.0, random.uniform(-3, 0));
    const double far = random.chance(0.5) ? 0.0 : 1e5;
    test::Mesh mesh;
    std::vector<Point3> near;
    for (int t = 0; t < 3; ++t) {
      const auto corner = [&] {
        const Point3 p = random.point([&] { return size * random.uniform(-1, 1); });
        return Point3{p[0] + far, p[1], p[2] - far};
      };
      const Point3 a = corner(), b = corner();
      Point3 c = corner();
      if (t == 1)
        for (std::size_t k = 0; k < 3; ++k) c[k] = a[k] + 1e-4 * (c[k] - a[k]);
      mesh.add(a, b, c);
      const auto vector = [](const Point3& p) { return Eigen::Vector3d(p[0], p[1], p[2]); };
      const Eigen::Vector3d normal = (vector(b) - vector(a)).cross(vector(c) - vector(a)).normalized();
      for (int k = 0; k < 100; ++k) {
        const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
        const Eigen::Vector3d p = vector(a) + u * (vector(b) - vector(a)) + v * (vector(c) - vector(a)) +
                                  clearance * (1.0 + 1e-7 * random.integer(-9, 9)) * normal;
        near.push_back({p[0], p[1], p[2]});
      }
    }
    const test::Layout layout{random.chance(0.5) ? Scalar::float32 : Scalar::float64};
    Cloud triangles(mesh.vertices, layout), points(near, layout);
    triangles.setTriangles(mesh.corners);
    const SphereHierarchy a(points.view()), b(triangles.view());
    const Eigen::Isometry3d pose = random.chance(0.5) ? identity : random.pose(far);
    const FlagsResult expected = brute_force::collisionFlags({a, pose}, {b, pose}, within(clearance, Flagged::both));
    const FlagsResult found = collisionFlags({a, pose}, {b, pose}, within(clearance, Flagged::both));
    ASSERT_EQ(found.a, expected.a) << i;
    ASSERT_EQ(found.b, expected.b) << i;
    hits += ones(found.a), all += found.a.size();
  }
  EXPECT_GT(hits, all / 5);
  EXPECT_LT(hits, all - all / 5);
}

/// Flags of points between two heights above a floor of small triangles, whose balls have a radius of 0.028.
FlagsResult flagsAboveFloor(double low, double high, double clearance)
{
  Random random(52);
  constexpr std::uint32_t side = 100;
  constexpr double edge = 4.0 / side;
  test::Mesh mesh;
  for (std::uint32_t i = 0; i < side; ++i)
    for (std::uint32_t j = 0; j < side; ++j) {
      const double x = edge * i, y = edge * j;
      mesh.add({x, y, 0}, {x + edge, y, 0}, {x, y + edge, 0});
    }
  std::vector<Point3> points(300);
  for (Point3& p : points) p = {random.uniform(0.1, 3.9), random.uniform(0.1, 3.9), random.uniform(low, high)};
  Cloud floor(mesh.vertices);
  floor.setTriangles(mesh.corners);
  const Cloud cloud(points);
  const SphereHierarchy a(cloud.view()), b(floor.view());
  return collisionFlags({a}, {b}, within(clearance));
}

/// The middle of some triangle is near each point: no triangle is compared.
TEST(CollisionFlags, MiddlesOfTrianglesSettleThePointsOfLeaves)
{
  const FlagsResult found = flagsAboveFloor(0.05, 0.05, 0.1);
  EXPECT_EQ(found.colliding_a, 300u);
  EXPECT_EQ(found.work.leaf_pairs, 0u);
}

/// Leaves reach down to the floor, but the middle of no triangle is as near to a point as its ball might matter.
TEST(CollisionFlags, MiddlesOfTrianglesSparePointsThatNoBallReaches)
{
  const FlagsResult found = flagsAboveFloor(0.14, 0.6, 0.1);
  EXPECT_EQ(found.colliding_a, 0u);
  EXPECT_EQ(found.work.leaf_pairs, 0u);
}

TEST(CollisionFlags, SameAsBruteForceOnGridsWithTies) // H5, H5b, H5c
{
  struct Grid {
    double start, step;
    std::vector<double> clearances;
  };
  for (const Grid& grid : {Grid{0, 1.0 / 16, {0, 1.0 / 16, 3.0 / 16, 5.0 / 16}}, Grid{0, .01, {.01, .02, .03}},
                           Grid{1000, .01, {.01, .03}}}) {
    const std::vector<Point3> points = gridOf(12, grid.start, grid.step);
    // Every fourth layer only, so that not every point has a neighbour.
    std::vector<Point3> layers;
    for (const Point3& p : points) {
      if (std::lround((p[0] - grid.start) / grid.step) % 8 == 0) layers.push_back(p);
    }
    for (const double clearance : grid.clearances) {
      expectSameAsBruteForce({Cloud(points), Cloud(layers), identity, identity, clearance, "grid"});
      Eigen::Isometry3d quarter_turn = identity;
      quarter_turn.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
      expectSameAsBruteForce({Cloud(points), Cloud(layers), quarter_turn, quarter_turn, clearance, "turned grid"});
    }
  }
}

TEST(CollisionFlags, GeoreferencedRows) // H6, H6b, H10
{
  const auto row = [](double y) {
    std::vector<Point3> points;
    for (int i = 0; i < 1000; ++i) points.push_back({500000.003 + .01 * i, y, 100});
    return Cloud(points, {Scalar::float64});
  };
  EXPECT_EQ(ones(flagsOf(row(5400000.26), row(5400000.34), .05)), 0u);
  EXPECT_EQ(ones(flagsOf(row(5400000.24), row(5400000.26), .05)), 1000u);
  std::vector<Point3> microns, every_hundredth;
  for (int i = 0; i < 1000; ++i) microns.push_back({1000 + 1e-7 * i, 0, 0});
  for (int i = 0; i < 1000; i += 100) every_hundredth.push_back(microns[static_cast<std::size_t>(i)]);
  expectSameAsBruteForce({Cloud(microns, {Scalar::float64}), Cloud(every_hundredth, {Scalar::float64}), identity,
                          identity, 1e-6, "microns"});
}

TEST(CollisionFlags, BadPointsNeitherCollideNorHideOthers) // H12, H13
{
  const auto line = [](auto is_bad) {
    std::vector<Point3> points;
    for (int i = 0; i < 1000; ++i) points.push_back({is_bad(i) ? (i % 2 ? infinity : nan) : .001 * i, 0, 0});
    return Cloud(points);
  };
  const Cloud queries = line([](int) { return false; });
  for (const Cloud& target : {line([](int i) { return i == 0; }), line([](int i) { return i % 3 == 0; }),
                              line([](int i) { return i == 500 || i == 999; }), line([](int i) { return i > 100; })}) {
    expectSameAsBruteForce({queries, target, identity, identity, .0105, "line"});
    expectSameAsBruteForce({target, queries, identity, identity, .0105, "line"});
  }
  EXPECT_EQ(flagsOf(Cloud({{nan, 0, 0}, {0, infinity, 0}, {0, 0, 0}}), queries, 1), test::verdictsOf({0, 0, 1}));
  EXPECT_EQ(ones(flagsOf(queries, line([](int) { return true; }), 1e30)), 0u);
}

TEST(CollisionFlags, EmptyClouds)
{
  const Cloud none({}), two({{0, 0, 0}, {1, 1, 1}});
  EXPECT_TRUE(flagsOf(none, two, 1).empty());
  EXPECT_EQ(flagsOf(two, none, 1), test::verdictsOf({0, 0}));
  EXPECT_TRUE(flagsOf(none, none, 1).empty());
  Cloud empty_subset = two;
  empty_subset.restrictTo({});
  EXPECT_EQ(flagsOf(empty_subset, two, 1), test::verdictsOf({0, 0}));
  EXPECT_EQ(flagsOf(two, empty_subset, 1), test::verdictsOf({0, 0}));
}

TEST(CollisionFlags, RecordNamedTwiceCountsOnce)
{
  Cloud twice({{9, 9, 9}, {0, 0, 0}, {5, 5, 5}});
  twice.restrictTo({1, 1, 2, 1});
  const Cloud origin({{0, 0, 0}});
  const SphereHierarchy a(twice.view()), b(origin.view());
  const FlagsResult result = collisionFlags({a}, {b}, within(1, Flagged::both));
  EXPECT_EQ(result.a, test::verdictsOf({0, 1, 0}));
  EXPECT_EQ(result.colliding_a, 1u);
}

TEST(CollisionFlags, BallsReachWhereTheirCentersDoNot)
{
  Cloud a({{0, 0, 0}, {-1, 0, 0}}), b({{10, 0, 0}});
  a.setRadii({1.0f, 1.5f});
  b.setRadii({8.0f});
  for (const double clearance : {std::nextafter(1.0, 0.0), 1.0, std::nextafter(1.5, 0.0), 1.5}) {
    expectSameAsBruteForce({a, b, identity, identity, clearance, "balls " + std::to_string(clearance)});
  }
  EXPECT_EQ(flagsOf(a, b, 1), test::verdictsOf({1, 0}));
  EXPECT_EQ(flagsOf(b, a, 1), test::verdictsOf({1}));
}

TEST(CollisionFlags, BallsOfDifferentSizeInOnePlace)
{
  Random random(77);
  for (int i = 0; i < 50; ++i) {
    std::vector<float> radii(static_cast<std::size_t>(random.integer(1, 100)));
    for (float& radius : radii) radius = static_cast<float>(random.integer(0, 8)) / 8;
    Cloud a(std::vector<Point3>(radii.size(), Point3{1, 2, 3})), b({{1, 2, 5}, {1, 4, 3}});
    a.setRadii(radii);
    expectSameAsBruteForce({a, b, identity, identity, random.integer(8, 16) / 8.0, "balls " + std::to_string(i)});
  }
}

TEST(CollisionFlags, ScalesOutsideTheRangeOfFloat)
{
  for (const double scale : {0x1p-1000, 0x1p-400, 0x1p-140, 0x1p-100, 0x1p100, 0x1p126, 0x1p300, 0x1p900}) {
    Random random(17);
    for (int i = 0; i < 10; ++i) {
      const Shape shape = random.pick(test::all_shapes);
      Cloud a(test::makePoints(shape, 100, scale, random), {Scalar::float64});
      Cloud b(test::makePoints(shape, 100, scale, random), {Scalar::float64});
      const Eigen::Isometry3d pose = i % 2 == 0 ? identity : random.pose(scale);
      const double clearance = test::tiedClearance(a.view(), identity, b.view(), pose, random);
      expectSameAsBruteForce({a, b, identity, pose, clearance, "scale " + std::to_string(std::log2(scale))});
    }
  }
}

TEST(CollisionFlags, MixedMagnitudesInOneCloud)
{
  Random random(99);
  const auto points = [&](std::size_t count) {
    std::vector<Point3> list(count);
    for (Point3& p : list) {
      const double size = std::ldexp(1.0, random.integer(-1070, 1000));
      p = random.point([&] { return size * random.uniform(-1, 1); });
    }
    return Cloud(list, {Scalar::float64});
  };
  for (int i = 0; i < 20; ++i) {
    const double clearance = std::ldexp(random.uniform(1, 2), random.integer(-1070, 1000));
    const Eigen::Isometry3d pose = i % 2 == 0 ? identity : random.pose(1);
    expectSameAsBruteForce({points(50), points(50), identity, pose, clearance, "mixed"});
  }
}

TEST(CollisionFlags, NearlyRigidPoses) // as far from a rotation as is allowed
{
  Random random(23);
  for (int i = 0; i < 60; ++i) {
    Scene scene = test::anyScene(static_cast<std::uint64_t>(3000 + i), 200);
    for (Eigen::Isometry3d* pose : {&scene.pose_a, &scene.pose_b}) {
      for (int k = 0; k < 9; ++k) pose->linear()(k / 3, k % 3) += 1.5e-7 * random.uniform(-1, 1);
    }
    Random tie(static_cast<std::uint64_t>(i));
    scene.clearance = test::tiedClearance(scene.a.view(), scene.pose_a, scene.b.view(), scene.pose_b, tie);
    expectSameAsBruteForce(scene);
  }
}

TEST(CollisionFlags, SameInAnyFloatingPointEnvironmentOfTheCaller) // H25
{
  for (std::uint64_t seed = 4000; seed < 4030; ++seed) {
    const Scene scene = test::anyScene(seed, 200);
    SCOPED_TRACE(scene.name);
    const auto flags = [&] { // built and asked in the environment of the moment
      const SphereHierarchy a(scene.a.view()), b(scene.b.view());
      return collisionFlags({a, scene.pose_a}, {b, scene.pose_b}, within(scene.clearance, Flagged::both, 2));
    };
    const FlagsResult expected = flags();
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
      std::fesetround(mode);
      const FlagsResult result = flags();
      EXPECT_EQ(std::fegetround(), mode);
      std::fesetround(FE_TONEAREST);
      EXPECT_EQ(result.a, expected.a);
      EXPECT_EQ(result.b, expected.b);
    }
  }
#ifdef __SSE2__
  const Cloud a({{0, 0, 0}}), b({{3e-40, 4e-40, 0}}); // H8
  constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | flush_to_zero | denormals_are_zero);
  const Flags touching = flagsOf(a, b, 5.1e-40), apart = flagsOf(a, b, 4.9e-40);
  _mm_setcsr(before);
  EXPECT_EQ(touching, test::verdictsOf({1}));
  EXPECT_EQ(apart, test::verdictsOf({0}));
#endif
}

TEST(CollisionFlags, WorkIsTheSameForAnyNumberOfThreads)
{
  Random random(8);
  const Cloud a(test::makePoints(Shape::uniform, 20000, 1, random)),
      b(test::makePoints(Shape::sphere, 20000, 1, random));
  const Eigen::Isometry3d pose = random.pose(0.1);
  Work expected;
  for (const unsigned threads : {1u, 2u, 4u, 0u}) {
    const SphereHierarchy ha(a.view()), hb(b.view());
    const Work work = collisionFlags({ha}, {hb, pose}, within(0.05, Flagged::both, threads)).work;
    if (threads == 1) expected = work;
    EXPECT_EQ(test::countsOf(work), test::countsOf(expected)) << threads;
  }
  EXPECT_GT(expected.voxels_built, 0u);
  EXPECT_GT(expected.leaf_pairs, 0u);
}

// Twice what it takes today: a prune that is lost costs far more.
TEST(CollisionFlags, PrunesMostOfTheWork)
{
  Random random(64);
  const Cloud a(test::makePoints(Shape::uniform, 20000, 1, random)),
      b(test::makePoints(Shape::sphere, 20000, 1, random));
  const SphereHierarchy ha(a.view()), hb(b.view());
  const Work near = collisionFlags({ha}, {hb}, within(0.02)).work;
  EXPECT_LT(near.node_pairs, 170000u);
  EXPECT_LT(near.leaf_pairs, 24000u);
  EXPECT_LT(near.exact_decisions, 20u);
  const Work wide = collisionFlags({ha}, {hb}, within(0.5)).work; // most nodes settle as a whole
  EXPECT_LT(wide.node_pairs, 450000u);
  EXPECT_LT(wide.leaf_pairs, 70000u);
  const Work apart = collisionFlags({ha}, {hb, Eigen::Isometry3d(Eigen::Translation3d(5, 0, 0))}, within(0.5)).work;
  EXPECT_LT(apart.node_pairs, 100u);
  EXPECT_EQ(apart.leaf_pairs, 0u);
  // Points so far apart that their leaves' balls hold much of the other cloud: they are compared one by one.
  const Cloud dense(test::makePoints(Shape::sphere, 400000, 1, random)),
      sparse(test::makePoints(Shape::sphere, 300, 1, random));
  const SphereHierarchy of_dense(dense.view()), of_sparse(sparse.view());
  EXPECT_LT(collisionFlags({of_dense}, {of_sparse}, within(0.001)).work.leaf_pairs, 11000u);
}

TEST(CollisionFlags, BuildsOnlyWhatItVisits)
{
  Random random(5);
  const Cloud hall(test::makePoints(Shape::uniform, 200000, 1, random));
  const Cloud tool(test::makePoints(Shape::clusters, 1000, 0.01, random));
  const SphereHierarchy hall_hierarchy(hall.view()), tool_hierarchy(tool.view());
  ASSERT_GT(hall_hierarchy.statistics().voxels, 50u);
  const Eigen::Isometry3d corner(Eigen::Translation3d(0.9, 0.9, 0.9));
  const Work first = collisionFlags({hall_hierarchy}, {tool_hierarchy, corner}, within(0.01)).work;
  const std::size_t hall_built = hall_hierarchy.statistics().voxels_built;
  EXPECT_GE(hall_built, 1u);
  EXPECT_LE(hall_built, 2u);
  EXPECT_EQ(hall_built + tool_hierarchy.statistics().voxels_built, first.voxels_built);
  EXPECT_EQ(collisionFlags({hall_hierarchy}, {tool_hierarchy, corner}, within(0.01)).work.voxels_built, 0u);
  const Eigen::Isometry3d away(Eigen::Translation3d(50, 0, 0));
  EXPECT_EQ(collisionFlags({hall_hierarchy}, {tool_hierarchy, away}, within(0.01)).work.voxels_built, 0u);
}

void expectSameAsKdTree(const Cloud& a, const Eigen::Isometry3d& pose_a, const Cloud& b,
                        const Eigen::Isometry3d& pose_b, double clearance)
{
  SCOPED_TRACE(clearance);
  const SphereHierarchy ha(a.view()), hb(b.view());
  const FlagsResult result = collisionFlags({ha, pose_a}, {hb, pose_b}, within(clearance, Flagged::both, 2));
  EXPECT_TRUE(result.a == test::flagsByKdTree(a.view(), pose_a, b.view(), pose_b, clearance));
  EXPECT_TRUE(result.b == test::flagsByKdTree(b.view(), pose_b, a.view(), pose_a, clearance));
  EXPECT_GT(result.colliding_a, 0u);
  EXPECT_LT(result.colliding_a, a.view().count);
}

TEST(CollisionFlags, SameAsKdTreeOnHundredThousandPoints)
{
  Random random(100000);
  const std::size_t count = 100000;
  struct Case {
    Shape a, b;
    double clearance;
  };
  for (const Case& c : {Case{Shape::uniform, Shape::sphere, 0.02}, Case{Shape::plane, Shape::plane, 0.01},
                        Case{Shape::clusters, Shape::uniform, 0.02}}) {
    const Cloud a(test::makePoints(c.a, count, 1, random)), b(test::makePoints(c.b, count, 1, random));
    const Eigen::Isometry3d pose_a = random.pose(0.2);
    expectSameAsKdTree(a, pose_a, b, random.pose(0.2), c.clearance);
  }
  std::vector<Point3> here = test::makePoints(Shape::uniform, count, 50, random), there = here;
  for (Point3& p : here) p = {p[0] + 515050, p[1] + 1981050, p[2]};
  for (Point3& p : there) p = {p[0] + 515050.4, p[1] + 1981050.1, p[2] + random.uniform(0, 1)};
  expectSameAsKdTree(Cloud(here, {Scalar::float64}), identity, Cloud(there, {Scalar::float64}), identity, 0.7);
}

TEST(CollisionFlags, ManyThreadsOnOneFreshHierarchy)
{
  Random random(44);
  const Cloud hall(test::makePoints(Shape::uniform, 50000, 1, random));
  const Cloud tool(test::makePoints(Shape::sphere, 2000, 0.3, random));
  const auto pose = [](std::size_t i) {
    return Eigen::Isometry3d(Eigen::Translation3d(0.3 * static_cast<double>(i % 3) - 0.3, 0, 0));
  };
  const SphereHierarchy hall_reference(hall.view()), tool_reference(tool.view());
  const SphereHierarchy hall_shared(hall.view()), tool_shared(tool.view());
  std::vector<FlagsResult> results(8);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < results.size(); ++i) {
    threads.emplace_back([&, i] {
      results[i] = collisionFlags({hall_shared}, {tool_shared, pose(i)}, within(0.02, Flagged::both, 1 + i % 2));
    });
  }
  for (std::thread& thread : threads) thread.join();
  std::uint64_t built = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const FlagsResult expected =
        collisionFlags({hall_reference}, {tool_reference, pose(i)}, within(0.02, Flagged::both));
    EXPECT_EQ(results[i].a, expected.a);
    EXPECT_EQ(results[i].b, expected.b);
    EXPECT_EQ(results[i].work.node_pairs, expected.work.node_pairs);
    built += results[i].work.voxels_built;
  }
  EXPECT_EQ(built, hall_shared.statistics().voxels_built + tool_shared.statistics().voxels_built); // each once
}

/// A result that comes with another answer in it, of the other side and larger, is as good as a new one.
TEST(CollisionFlags, SameIntoAResultUsedBefore)
{
  const Scene large = test::anyScene(7, 400), small = test::anyScene(8, 60);
  const SphereHierarchy a(large.a.view()), b(large.b.view()), c(small.a.view()), d(small.b.view());
  FlagsResult result;
  collisionFlags({a, large.pose_a}, {b, large.pose_b}, within(large.clearance, Flagged::both), result);
  for (const Flagged side : {Flagged::a, Flagged::both, Flagged::b}) {
    const FlagsRequest request = within(small.clearance, side);
    collisionFlags({c, small.pose_a}, {d, small.pose_b}, request, result);
    const FlagsResult expected = collisionFlags({c, small.pose_a}, {d, small.pose_b}, request);
    EXPECT_EQ(result.a, expected.a);
    EXPECT_EQ(result.b, expected.b);
    EXPECT_EQ(result.colliding_a, expected.colliding_a);
    EXPECT_EQ(result.colliding_b, expected.colliding_b);
    EXPECT_EQ(result.work.node_pairs, expected.work.node_pairs);
  }
}

TEST(CollisionFlags, LooksAtFewVoxelsOfALongCloud)
{
  Random random(32);
  std::vector<Point3> road, car;
  for (int i = 0; i < 50000; ++i) road.push_back({random.uniform(0, 1000), random.uniform(-2, 2), 0.0});
  for (int i = 0; i < 100; ++i) car.push_back({random.uniform(500, 501), random.uniform(-1, 1), 10.0});
  HierarchyOptions options;
  options.voxel_edge = 2.0;
  const SphereHierarchy a(viewOf(road[0].data(), road.size()), options), b(viewOf(car[0].data(), car.size()));
  ASSERT_GE(a.statistics().voxels, 1000u);
  const FlagsResult found = collisionFlags({a}, {b}, within(0.2));
  EXPECT_EQ(found.colliding_a, 0u);
  EXPECT_LT(found.work.node_pairs, 200u); // and not at least one for each voxel
  const FlagsResult lowered = collisionFlags({a}, {b, Eigen::Isometry3d(Eigen::Translation3d(0, 0, -10))}, within(0.2));
  EXPECT_GT(lowered.colliding_a, 10u);
  EXPECT_EQ(lowered.colliding_a, ones(lowered.a));
}

TEST(CollisionFlags, BySlabsOfFacingSheetsToTheLastBit)
{
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const FacingSheets sheets(seed, seed < 50 ? 300 : 1200);
    HierarchyOptions options;
    options.voxel_edge = seed % 3 == 0 ? 0.5 : 0.0;
    const SphereHierarchy a(sheets.a->view(), options), b(sheets.b->view(), options);
    const Placed placed_a{a, sheets.pose_a}, placed_b{b, sheets.pose_b};
    const double least = closestPair(placed_a, placed_b).distance; // fits slabs
    for (const double clearance : {std::nextafter(least, 0.0), least, 1.01 * least, 1.2 * least, 2 * least}) {
      const FlagsRequest request = within(clearance, Flagged::both);
      const FlagsResult found = collisionFlags(placed_a, placed_b, request);
      const FlagsResult expected = brute_force::collisionFlags(placed_a, placed_b, request);
      EXPECT_EQ(found.a, expected.a) << clearance;
      EXPECT_EQ(found.b, expected.b) << clearance;
    }
  }
}

TEST(CollisionFlags, SlabsOfEarlierQueriesSpareHalfTheCostOfFacingSheets)
{
  const FacingSheets sheets(6, 60000);
  const SphereHierarchy a(sheets.a->view()), b(sheets.b->view()), unasked_a(sheets.a->view()),
      unasked_b(sheets.b->view());
  const Placed placed_a{a, sheets.pose_a}, placed_b{b, sheets.pose_b};
  const double gap = closestPair(placed_a, placed_b).distance;
  a.buildAll();
  b.buildAll();
  const auto cost = [](const FlagsResult& result) { return result.work.node_pairs + 16 * result.work.leaf_pairs; };
  for (const double clearance : {0.9 * gap, 1.01 * gap}) {
    const FlagsRequest request = within(clearance, Flagged::both);
    const FlagsResult by_spheres = collisionFlags({unasked_a, sheets.pose_a}, {unasked_b, sheets.pose_b}, request);
    Work one_thread;
    for (const unsigned threads : {1u, 4u}) {
      const FlagsResult found = collisionFlags(placed_a, placed_b, within(clearance, Flagged::both, threads));
      EXPECT_EQ(found.a, by_spheres.a);
      EXPECT_EQ(found.b, by_spheres.b);
      EXPECT_LT(2 * cost(found), cost(by_spheres));
      EXPECT_EQ(found.work.volumes_built, 0u); // flags fit none
      if (threads == 1) one_thread = found.work;
      EXPECT_EQ(test::countsOf(found.work), test::countsOf(one_thread));
    }
  }
}

/// Half a floor and a wall: planes lie across other axes in each half, so that no node's slab holds what is in another.
std::vector<Point3> floorAndWall(std::size_t count, Random& random)
{
  std::vector<Point3> points(count);
  for (Point3& p : points) {
    const double along = random.uniform(2, 4);
    p = random.chance(0.5) ? Point3{random.uniform(2, 3), along, 2.1} : Point3{3.9, along, random.uniform(2, 4)};
  }
  return points;
}

TEST(CollisionFlags, BySlabsOfWhatLiesAcrossOtherAxes)
{
  Random random(45);
  HierarchyOptions options;
  options.voxel_edge = 8.0; // deep trees: nodes below the root have slabs of their own
  for (int round = 0; round < 2; ++round) {
    const Cloud one(floorAndWall(1500, random)), other(floorAndWall(1500, random));
    const SphereHierarchy a(one.view(), options), b(other.view(), options);
    ASSERT_EQ(a.statistics().voxels, 1u);
    const Placed placed_a{a}, placed_b{b, Eigen::Isometry3d(Eigen::Translation3d(0.11, 0.02, 0.13))};
    closestPair(placed_a, placed_b); // fits slabs
    for (const double clearance : {0.112, 0.135, 0.16}) {
      const FlagsRequest request = within(clearance, Flagged::both);
      const FlagsResult found = collisionFlags(placed_a, placed_b, request);
      const FlagsResult expected = brute_force::collisionFlags(placed_a, placed_b, request);
      EXPECT_EQ(found.a, expected.a) << clearance;
      EXPECT_EQ(found.b, expected.b) << clearance;
      EXPECT_GT(found.colliding_a, 10u);
    }
  }
}

/// Each voxel is asked about its own slabs: here the next one is far from all that was asked.
TEST(CollisionFlags, SlabsOfOneVoxelNeedNoneOfTheNext)
{
  Random random(46);
  const auto sheet = [&](double height) {
    std::vector<Point3> points(20000);
    for (Point3& p : points) {
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
      p = {300 + x, 300 + y, 300 + 0.2 * x * x - 0.1 * x * y + height};
    }
    return points;
  };
  std::vector<Point3> with_next = sheet(0.0);
  for (int i = 0; i < 500; ++i) with_next.push_back({900 + random.uniform(-1, 1), 900, 900});
  const Cloud one(with_next), other(sheet(0.05));
  HierarchyOptions options;
  options.voxel_edge = 600.0;
  const SphereHierarchy a(one.view(), options), b(other.view(), options), unasked_a(one.view(), options),
      unasked_b(other.view(), options);
  ASSERT_EQ(a.statistics().voxels, 2u);
  const double gap = closestPair({a}, {b}).distance;
  for (const SphereHierarchy* const built : {&a, &b, &unasked_a, &unasked_b}) built->buildAll();
  const auto cost = [](const FlagsResult& result) { return result.work.node_pairs + 16 * result.work.leaf_pairs; };
  const FlagsResult found = collisionFlags({a}, {b}, within(0.9 * gap));
  const FlagsResult by_spheres = collisionFlags({unasked_a}, {unasked_b}, within(0.9 * gap));
  EXPECT_EQ(found.a, by_spheres.a);
  EXPECT_LT(2 * cost(found), cost(by_spheres));
}

/// Slabs answer what exact arithmetic would. A coarser answer has to be the one that spheres alone give.
TEST(CollisionFlags, OtherThanExactDoNotDependOnEarlierQueries)
{
  const FacingSheets sheets(6, 5000);
  const SphereHierarchy a(sheets.a->view()), b(sheets.b->view());
  const Placed placed_a{a, sheets.pose_a}, placed_b{b, sheets.pose_b};
  a.buildAll();
  b.buildAll();
  const std::vector<Accuracy> accuracies = {Accuracy::tolerance(0.1), Accuracy::level(2), Accuracy::nodePairs(3000)};
  FlagsRequest request = within(0.1, Flagged::both);
  std::vector<FlagsResult> before;
  for (const Accuracy& accuracy : accuracies) {
    request.accuracy = accuracy;
    before.push_back(collisionFlags(placed_a, placed_b, request));
  }
  closestPair(placed_a, placed_b); // fits slabs
  for (std::size_t i = 0; i < accuracies.size(); ++i) {
    SCOPED_TRACE(accuracies[i].text());
    request.accuracy = accuracies[i];
    const FlagsResult after = collisionFlags(placed_a, placed_b, request);
    EXPECT_EQ(after.a, before[i].a);
    EXPECT_EQ(after.b, before[i].b);
    EXPECT_EQ(test::countsOf(after.work), test::countsOf(before[i].work));
  }
}

TEST(CollisionFlags, RefusesWhatItCannotAnswer)
{
  const Cloud one({{1, 2, 3}});
  const SphereHierarchy point(one.view());
  EXPECT_THROW(collisionFlags({point}, {point}, within(-1)), std::invalid_argument);
  EXPECT_THROW(collisionFlags({point}, {point}, within(nan)), std::invalid_argument);
  Eigen::Isometry3d mirror = identity;
  mirror.linear()(2, 2) = -1;
  EXPECT_THROW(collisionFlags({point}, {point, mirror}, within(1)), std::invalid_argument);
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// Inputs that other tools are known to answer wrongly, or not at all, each under its catalogue number, with the answer
// of exact arithmetic. Every query, fit and instruction set, one thread and several.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include "../distances/expect_distances.h"
#include "support/hard_cases.h"
#include "support/question.h"
#include "support/random_clouds.h"
#include "support/simd_target.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#ifdef __SSE2__
#include <immintrin.h>
#endif

namespace pcl_bsh {
namespace {

using namespace hard_cases;
using test::Cloud;
using test::Random;

test::Question within(double clearance, unsigned threads)
{
  test::Question request;
  request.clearance = clearance;
  request.flagged = Flagged::both;
  request.threads = threads;
  return request;
}

/// The answers of brute force, which agree with the catalogue.
struct Truth {
  AnyResult any;
  FlagsResult flags;
  DistanceResult closest;
  PointDistances distances;
};

Truth truthOf(const HardCase& c, const Placed& a, const Placed& b)
{
  Truth truth{brute_force::anyCollision(a, b, within(c.clearance, 1)),
              brute_force::collisionFlags(a, b, within(c.clearance, 1)), brute_force::closestPair(a, b),
              brute_force::pointDistances(a, b)};
  if (c.colliding_pairs != unknown) {
    EXPECT_EQ(countPairs(c), c.colliding_pairs);
    EXPECT_EQ(truth.any.verdict == Verdict::colliding, c.colliding_pairs > 0);
    EXPECT_EQ(truth.flags.colliding_a, c.colliding_a);
    EXPECT_EQ(truth.flags.colliding_b, c.colliding_b);
    EXPECT_EQ(truth.closest.distance, c.smallest_distance);
  }
  return truth;
}

int checks = 0; ///< answers compared so far

void expectTruth(const Truth& truth, const HardCase& c, const Placed& a, const Placed& b, unsigned threads)
{
  const test::Question request = within(c.clearance, threads);
  const AnyResult any = anyCollision(a, b, request);
  ASSERT_EQ(any.verdict, truth.any.verdict);
  if (any.pair) {
    EXPECT_LE(
        ExactDistance(a.pose, b.pose)
            .compare(a.hierarchy().view().point(any.pair->a), b.hierarchy().view().point(any.pair->b), c.clearance),
        0);
  }
  const FlagsResult flags = collisionFlags(a, b, request);
  EXPECT_EQ(flags.a, truth.flags.a);
  EXPECT_EQ(flags.b, truth.flags.b);
  const DistanceResult closest = closestPair(a, b, request);
  EXPECT_EQ(closest.distance, truth.closest.distance);
  EXPECT_EQ(closest.pair, truth.closest.pair);
  PointDistancesRequest all;
  all.threads = threads;
  test::expectSame(pointDistances(a, b, all), truth.distances);
  checks += 5;
}

constexpr SphereFit all_fits[] = {SphereFit::box_center, SphereFit::ritter, SphereFit::minimal};

void expectTruthEverywhere(const HardCase& c)
{
  SCOPED_TRACE(c.name);
  const Cloud a(c.a, {c.scalar}), b(c.b, {c.scalar});
  const SphereHierarchy plain_a(a.view()), plain_b(b.view());
  const Truth truth = truthOf(c, {plain_a, c.pose_a}, {plain_b, c.pose_b});
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const test::OnTarget on_target(target);
    for (const SphereFit fit : all_fits) {
      SCOPED_TRACE("fit " + std::to_string(static_cast<int>(fit)));
      HierarchyOptions options;
      options.fit = fit;
      const SphereHierarchy ha(a.view(), options), hb(b.view(), options);
      for (const unsigned threads : {1u, 4u}) expectTruth(truth, c, {ha, c.pose_a}, {hb, c.pose_b}, threads);
      EXPECT_TRUE(ha.validate().none());
      EXPECT_TRUE(hb.validate().none());
    }
  }
}

class HardCases : public testing::TestWithParam<HardCase> {};

TEST_P(HardCases, EqualExactArithmetic)
{
  checks = 0;
  expectTruthEverywhere(GetParam());
  RecordProperty("checks", checks);
}

/// The clouds with uncertain places, at a pose and along a path of that pose alone.
TEST_P(HardCases, UncertainPlacesEqualExactArithmetic)
{
  const HardCase& c = GetParam();
  Cloud a(c.a, {c.scalar}), b(c.b, {c.scalar});
  Random random(c.a.size() + 7);
  const double scale = c.clearance > 0.0 ? std::min(c.clearance, 0x1p100) : 0x1p-10; // of floats
  test::makeUncertain(a, scale, random);
  test::makeUncertain(b, scale, random);
  const SphereHierarchy ha(a.view()), hb(b.view());
  const Placed placed_a(ha, c.pose_a), placed_b(hb, c.pose_b);
  const FlagsResult truth = brute_force::collisionFlags(placed_a, placed_b, within(c.clearance, 1));
  TrajectoryRequest along;
  along.clearance = c.clearance;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const test::OnTarget on_target(target);
    for (const unsigned threads : {1u, 2u}) {
      const FlagsResult found = collisionFlags(placed_a, placed_b, within(c.clearance, threads));
      EXPECT_EQ(found.a, truth.a);
      EXPECT_EQ(found.b, truth.b);
      along.threads = threads;
      EXPECT_EQ(collideAlong(placed_a, hb, {c.pose_b}, along).flags, truth.a);
    }
  }
}

std::string nameOf(const testing::TestParamInfo<HardCase>& info)
{
  std::string name = info.param.name + " " + std::to_string(info.index);
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, HardCases, testing::ValuesIn(catalogue()), nameOf);

// Series ----------------------------------------------------------------------------------------------------------

TEST(HardCaseSeries, H4)
{
  int hits = 0;
  for (int k = 1; k <= 10000; ++k) {
    const double d = k / 1000.0;
    const Cloud a({{0, 0, 0}}), b({{d, 0, 0}});
    const SphereHierarchy ha(a.view()), hb(b.view());
    hits += anyCollision({ha}, {hb}, within(d, 1)).verdict == Verdict::colliding;
  }
  EXPECT_EQ(hits, 5033);
}

TEST(HardCaseSeries, H20FarMoves)
{
  Random random(20);
  for (const double reach : {1.0, 10.0, 100.0, 1000.0, 1e4}) {
    HardCase c{"H20 " + std::to_string(reach), {}, {}, .05, unknown};
    c.pose_b.rotate(Eigen::AngleAxisd(std::acos(-1.0) / 6, Eigen::Vector3d::UnitZ()));
    c.pose_b.pretranslate(Eigen::Vector3d(reach, -reach / 3, .1));
    const double band = reach < 100 ? 1e-5 : 1e-3;
    for (int i = 0; i < 200; ++i) {
      const Point3 q = random.point([&] { return random.uniform(-reach, reach); });
      const Eigen::Vector3d moved = c.pose_b * Eigen::Vector3d(f(q[0]), f(q[1]), f(q[2]));
      const Eigen::Vector3d p =
          moved + random.rotation() * Eigen::Vector3d(.05 * (1 + band * random.uniform(-1, 1)), 0, 0);
      c.b.push_back(q);
      c.a.push_back({p[0], p[1], p[2]});
    }
    expectTruthEverywhere(c);
  }
}

TEST(HardCaseSeries, H21TiesUnderRotation)
{
  Random random(21);
  for (int i = 0; i < 40; ++i) {
    HardCase c{"H21 " + std::to_string(i), {}, {}, 0, unknown, Scalar::float64};
    c.pose_b = random.pose(1000);
    for (int k = 0; k < 20; ++k) {
      c.a.push_back(random.point([&] { return random.uniform(-1000, 1000); }));
      c.b.push_back(random.point([&] { return random.uniform(-1000, 1000); }));
    }
    const ExactDistance distance(c.pose_a, c.pose_b);
    c.clearance = distance.gap({c.a[0], c.b[0]}); // the double nearest to a distance: decided by its last bit
    expectTruthEverywhere(c);
  }
}

TEST(HardCaseSeries, H22FlatLeaves)
{
  Random random(22);
  for (int i = 0; i < 3000; ++i) {
    const auto leaf = [&] { return listOf(2, [&](int) { return Point3{f(random.uniform(0, .25)), 0, 0}; }); };
    const HardCase c{"H22 " + std::to_string(i), leaf(), leaf(), 0, unknown};
    const Cloud a(c.a), b(c.b);
    const SphereHierarchy ha(a.view()), hb(b.view());
    const double gap = brute_force::closestPair({ha}, {hb}).distance;
    EXPECT_EQ(anyCollision({ha}, {hb}, within(gap, 1)).verdict, Verdict::colliding);
    EXPECT_EQ(closestPair({ha}, {hb}).distance, gap);
    if (gap == 0) continue;
    EXPECT_EQ(anyCollision({ha}, {hb}, within(std::nextafter(gap, 0.0), 1)).verdict, Verdict::free);
  }
}

TEST(HardCaseSeries, H23AffinePosesAreRefusedNearlyRigidOnesExact)
{
  Random random(23);
  const Cloud one({{1, 2, 3}});
  const SphereHierarchy point(one.view());
  for (int i = 0; i < 1000; ++i) {
    Eigen::Isometry3d affine = identity;
    for (int k = 0; k < 9; ++k) affine.linear()(k / 3, k % 3) = random.uniform(-3, 3);
    EXPECT_THROW(anyCollision({point, affine}, {point}, within(1, 1)), std::invalid_argument);
    EXPECT_THROW(collisionFlags({point}, {point, affine}, within(1, 1)), std::invalid_argument);
    EXPECT_THROW(closestPair({point, affine}, {point}), std::invalid_argument);
  }
  for (int i = 0; i < 30; ++i) { // as far from rigid as is accepted: |R'R - I| of up to 1e-6
    HardCase c{"H23 " + std::to_string(i), {}, {}, 0, unknown};
    for (Eigen::Isometry3d* pose : {&c.pose_a, &c.pose_b}) {
      *pose = random.pose(10);
      Eigen::Matrix3d spoiled = pose->linear();
      for (int k = 0; k < 9; ++k) spoiled(k / 3, k % 3) += random.uniform(-1, 1);
      const auto deviation = [&](double t) -> double {
        const Eigen::Matrix3d m = (1 - t) * pose->linear() + t * spoiled;
        return (m.transpose() * m - Eigen::Matrix3d::Identity()).norm();
      };
      double t = 1e-6;
      while (deviation(t) > 0.99e-6) t *= 0.9;
      pose->linear() = ((1 - t) * pose->linear() + t * spoiled).eval();
    }
    for (int k = 0; k < 60; ++k) {
      c.a.push_back(random.point([&] { return random.uniform(-10, 10); }));
      c.b.push_back(random.point([&] { return random.uniform(-10, 10); }));
    }
    const Cloud a(c.a), b(c.b);
    c.clearance = test::tiedClearance(a.view(), c.pose_a, b.view(), c.pose_b, random);
    expectTruthEverywhere(c);
  }
}

TEST(HardCaseSeries, H25AnyEnvironmentOfTheCaller)
{
  const auto each = [](const auto& set) {
    for (const HardCase& c : catalogue()) {
      if (c.a.size() > 400) continue;
      SCOPED_TRACE(c.name);
      const Cloud a(c.a, {c.scalar}), b(c.b, {c.scalar});
      const SphereHierarchy plain_a(a.view()), plain_b(b.view());
      const Truth truth = truthOf(c, {plain_a, c.pose_a}, {plain_b, c.pose_b});
      set(true);
      const SphereHierarchy ha(a.view()), hb(b.view());
      const AnyResult any = anyCollision({ha, c.pose_a}, {hb, c.pose_b}, within(c.clearance, 2));
      const FlagsResult flags = collisionFlags({ha, c.pose_a}, {hb, c.pose_b}, within(c.clearance, 2));
      const DistanceResult closest = closestPair({ha, c.pose_a}, {hb, c.pose_b});
      const PointDistances distances = pointDistances({ha, c.pose_a}, {hb, c.pose_b});
      set(false);
      test::expectSame(distances, truth.distances);
      EXPECT_EQ(any.verdict, truth.any.verdict);
      EXPECT_EQ(flags.a, truth.flags.a);
      EXPECT_EQ(flags.b, truth.flags.b);
      EXPECT_EQ(closest.distance, truth.closest.distance);
      EXPECT_EQ(closest.pair, truth.closest.pair);
    }
  };
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO})
    each([mode](bool on) { std::fesetround(on ? mode : FE_TONEAREST); });
#ifdef __SSE2__
  constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
  const unsigned before = _mm_getcsr();
  each([before](bool on) { _mm_setcsr(on ? before | flush_to_zero | denormals_are_zero : before); });
#endif
}

TEST(HardCaseSeries, H27FineVoxelsOverAWideCloud)
{
  HierarchyOptions fine;
  fine.voxel_edge = .01;
  const Cloud a({{0, 0, 0}, {1000, 1000, 1000}, {.5, 0, 0}}), b({{.5, 0, 0}});
  const SphereHierarchy ha(a.view(), fine), hb(b.view(), fine);
  EXPECT_EQ(collisionFlags({ha}, {hb}, within(.25, 1)).a, test::verdictsOf({0, 0, 1}));
}

} // namespace
} // namespace pcl_bsh

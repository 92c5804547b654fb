// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/certify/certify.h>

#include <pcl_bsh/hierarchy/storage.h>

#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using test::Shape;

constexpr SphereFit all_fits[] = {SphereFit::box_center, SphereFit::ritter, SphereFit::minimal};

CertifyOptions everything()
{
  CertifyOptions options;
  options.sample = CertifyOptions::all;
  return options;
}

HierarchyOptions fitted(SphereFit fit, double voxel_edge = 0.0)
{
  HierarchyOptions options;
  options.fit = fit;
  options.voxel_edge = voxel_edge;
  return options;
}

/// The test's way into a finished hierarchy, to damage it.
SphereHierarchy::Storage& open(const SphereHierarchy& hierarchy)
{
  return const_cast<SphereHierarchy::Storage&>(hierarchy.storage());
}

/// Certified: all spheres hold all points, none is smaller than the smallest; and the counts agree.
void expectHolds(const PointsView& view, const HierarchyOptions& options = {})
{
  const SphereHierarchy hierarchy(view, options);
  const Certificate certificate = certify(hierarchy, everything());
  EXPECT_TRUE(certificate.holds());
  EXPECT_TRUE(certificate.leaks.empty());
  EXPECT_EQ(certificate.missing, 0U);
  std::size_t nodes = 0;
  for (const LevelCertificate& level : certificate.levels) {
    if (level.level.kind != SphereLevel::voxel) nodes += level.spheres;
    std::size_t counted = 0;
    for (const std::size_t count : level.ratio.histogram) counted += count;
    EXPECT_EQ(counted, level.ratio.measured);
    EXPECT_TRUE(level.ratio.measured == 0 || (level.ratio.mean() >= 1.0 && level.ratio.worst >= level.ratio.mean()));
  }
  EXPECT_EQ(certificate.total.ratio.measured + certificate.total.ratio.one_place, nodes);
  EXPECT_EQ(certificate.total.spheres, nodes + hierarchy.statistics().voxels);
}

template <class Make>
Cloud cloudOf(std::size_t count, Scalar scalar, Make make)
{
  std::vector<Point3> points(count);
  for (std::size_t i = 0; i < count; ++i) points[i] = make(static_cast<double>(i));
  return Cloud(points, {scalar});
}

/// The ratio of the one leaf of a cloud: its stored radius over the smallest, and that stored radius.
struct OneLeaf {
  double ratio;
  double stored;
};

OneLeaf oneLeaf(const Cloud& cloud)
{
  const SphereHierarchy hierarchy(cloud.view(), fitted(SphereFit::minimal, 1e6));
  const Certificate certificate = certify(hierarchy, everything());
  EXPECT_TRUE(certificate.holds());
  EXPECT_EQ(certificate.levels.size(), 3U); // one sphere on each
  const Voxel& voxel = hierarchy.storage().voxels[0];
  return {certificate.levels.back().ratio.worst, voxel.nodes[0].r[0] * voxel.frame.unit};
}

// Clouds that hold ------------------------------------------------------------------------------------------------

TEST(Certify, HoldsForEveryShapeFitAndLayout)
{
  Random random(21);
  for (const SphereFit fit : all_fits) {
    for (int i = 0; i < 12; ++i) {
      SCOPED_TRACE("fit " + std::to_string(static_cast<int>(fit)) + ", cloud " + std::to_string(i));
      const Point3 center = i % 3 == 0 ? Point3{500000, 5400000, 100} : Point3{0, 0, 0};
      const Cloud cloud = test::anyCloud(static_cast<std::size_t>(random.integer(1, 400)), 1.0, center, random);
      expectHolds(cloud.view(), fitted(fit, i % 2 == 0 ? 0.0 : 0.25));
    }
  }
}

TEST(Certify, HoldsForDegenerateClouds)
{
  for (const SphereFit fit : all_fits) {
    const auto both = [&](std::size_t count, auto make) {
      for (const Scalar scalar : {Scalar::float32, Scalar::float64})
        expectHolds(cloudOf(count, scalar, make).view(), fitted(fit));
    };
    both(1, [](double) { return Point3{1, 2, 3}; });
    both(100, [](double) { return Point3{1.25, 2.5, 3.75}; });
    both(100, [](double i) { return Point3{0.1 * i, 0.2 * i, -0.3 * i}; });
    both(125, [](double i) { return Point3{std::fmod(i, 5), std::fmod(std::floor(i / 5), 5), std::floor(i / 25)}; });
    both(48, [](double i) { // on one sphere, exactly: all (+-3, +-4, +-12) in any order are 13 from the origin
      static constexpr double sides[6][3] = {{3, 4, 12}, {3, 12, 4}, {4, 3, 12}, {4, 12, 3}, {12, 3, 4}, {12, 4, 3}};
      const auto n = static_cast<unsigned>(i);
      const double* side = sides[n / 8];
      return Point3{(n & 1 ? -1 : 1) * side[0], (n & 2 ? -1 : 1) * side[1], (n & 4 ? -1 : 1) * side[2]};
    });
    both(60, [](double i) { return Point3{500000.003 + 0.01 * i, 5400000.26 + 0.01 * std::fmod(7 * i, 13), 100}; });
    both(60, [](double i) { return Point3{1e-40 * i, 3e-45 * std::fmod(i, 7), 0}; });
    both(60, [](double i) { return Point3{1e30 * i / 60, 1e30, -1e30 * std::fmod(i, 3)}; });
    both(20, [](double i) { return Point3{std::fmod(i, 2) == 0 ? 3e38 : -3e38, i, 0}; });
    expectHolds(cloudOf(20, Scalar::float64,
                        [](double i) {
                          return Point3{std::ldexp(i, -1074), 0, 0};
                        })
                    .view(),
                fitted(fit));
    expectHolds(cloudOf(20, Scalar::float64,
                        [](double i) {
                          return Point3{std::ldexp(i, 1010), -i, 0};
                        })
                    .view(),
                fitted(fit));
  }
}

TEST(Certify, LeavesBadPointsAsideAndHoldsOfNothing)
{
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Cloud cloud = cloudOf(90, Scalar::float32, [](double i) {
    const double bad[] = {i, nan, infinity};
    return Point3{i, bad[static_cast<int>(i) % 3], 1};
  });
  expectHolds(cloud.view());
  const Certificate nothing = certify(SphereHierarchy{PointsView{}});
  EXPECT_TRUE(nothing.holds());
  EXPECT_EQ(nothing.total.checks, 0U);
}

TEST(Certify, SameForAnyNumberOfThreads)
{
  Random random(22);
  const Cloud cloud(test::makePoints(Shape::clusters, 3000, 1, random));
  CertifyOptions options;
  options.sample = 20;
  const SphereHierarchy hierarchy(cloud.view(), fitted(SphereFit::ritter, 0.125));
  const Certificate one = certify(hierarchy, options);
  double last = 0.0;
  options.threads = 4;
  options.progress = [&](double share) { last = share; };
  const Certificate many = certify(hierarchy, options);
  EXPECT_EQ(last, 1.0);
  ASSERT_EQ(one.levels.size(), many.levels.size());
  EXPECT_GT(one.levels.size(), 4U);
  for (std::size_t i = 0; i < one.levels.size(); ++i) {
    EXPECT_EQ(one.levels[i].checks, many.levels[i].checks);
    EXPECT_EQ(one.levels[i].ratio.sum, many.levels[i].ratio.sum);
    EXPECT_LE(one.levels[i].ratio.measured + one.levels[i].ratio.one_place, 20U);
  }
}

// Smallest radii --------------------------------------------------------------------------------------------------

TEST(Certify, KnowsSmallestRadii)
{
  const auto expectRadius = [](const std::vector<Point3>& points, double radius) {
    for (const double far : {64.0, 524288.0}) { // not across the border of two voxels
      std::vector<Point3> moved = points;
      for (Point3& p : moved)
        for (double& x : p) x += far;
      const OneLeaf leaf = oneLeaf(Cloud(moved, {Scalar::float64}));
      EXPECT_NEAR(leaf.stored / leaf.ratio, radius, 1e-9 * radius);
      EXPECT_LT(leaf.ratio, 1.00001);
    }
  };
  expectRadius({{0, 0, 0}, {6, 8, 0}}, 5.0);
  expectRadius({{0, 0, 0}, {6, 8, 0}, {3, 4, 0}, {3, 5, 0}}, 5.0);
  expectRadius({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, std::sqrt(3.0)); // tetrahedron
  expectRadius({{2, 0, 0}, {-1, std::sqrt(3.0), 0}, {-1, -std::sqrt(3.0), 0}, {0, 0, 0.5}}, 2.0);
  expectRadius({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}},
               std::sqrt(0.75)); // cube
}

TEST(Certify, KnowsSmallestRadiiOfBalls)
{
  Cloud two({{0, 0, 0}, {10, 0, 0}});
  two.setRadii({1.0f, 2.0f});
  const OneLeaf leaf = oneLeaf(two);
  EXPECT_NEAR(leaf.stored / leaf.ratio, 6.5, 1e-9);
  Cloud inside({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  inside.setRadii({4.0f, 2.0f, 0.5f}); // the first holds the others
  const OneLeaf big = oneLeaf(inside);
  EXPECT_NEAR(big.stored / big.ratio, 4.0, 1e-9);
}

// Leaks -----------------------------------------------------------------------------------------------------------

/// Shrinks one sphere after the other, to just below what its farthest point needs, and expects that one to be found.
TEST(Certify, FindsALeakAtEveryLevel)
{
  Random random(23);
  const Cloud cloud(test::makePoints(Shape::uniform, 1500, 1, random));
  const SphereHierarchy hierarchy(cloud.view(), fitted(SphereFit::box_center, 0.25));
  hierarchy.buildAll();
  SphereHierarchy::Storage& storage = open(hierarchy);
  CertifyOptions containment;
  containment.sample = 0;

  std::set<std::pair<int, unsigned>> levels;
  std::set<std::pair<int, unsigned>> found;
  for (const LevelCertificate& level : certify(hierarchy, containment).levels)
    levels.insert({level.level.kind, level.level.depth});
  EXPECT_GE(levels.size(), 5U); // two above the voxels, the voxels', two below

  const auto shrunk = [&](float& radius, std::uint32_t node, std::uint32_t child, bool top) {
    const float sound = radius;
    radius *= 0.9f; // boxes' centres are at most 10 % off, these far less
    const Certificate certificate = certify(hierarchy, containment);
    radius = sound;
    if (certificate.holds()) return; // a sphere may have that much room to spare
    EXPECT_GE(certificate.total.leaks, 1U);
    const Leak& leak = certificate.leaks.front();
    EXPECT_EQ(leak.node, node);
    EXPECT_EQ(leak.child, child);
    EXPECT_EQ(leak.level.kind == SphereLevel::above_voxels, top);
    EXPECT_GT(leak.excess, 0.0);
    EXPECT_LE(leak.excess, 0.11 * static_cast<double>(sound));
    found.insert({leak.level.kind, leak.level.depth});
  };
  for (std::uint32_t n = 0; n < storage.top.size(); ++n)
    for (std::uint32_t i = 0; i < storage.top[n].count; ++i)
      if (random.chance(0.1) || n == 0) shrunk(storage.top[n].r[i], n, i, true);
  for (std::size_t v = 0; v < storage.voxel_count; v += 20) {
    std::vector<Node>& nodes = storage.voxels[v].nodes;
    for (std::uint32_t n = 0; n < nodes.size(); ++n)
      for (std::uint32_t i = 0; i < nodes[n].count; ++i) shrunk(nodes[n].r[i], n, i, false);
    shrunk(storage.voxels[v].radius, 0, 0, false);
  }
  EXPECT_TRUE(certify(hierarchy, containment).holds());
  for (const auto& level : levels)
    EXPECT_TRUE(found.count(level)) << "no leak found on level " << level.first << ", depth " << level.second;
}

TEST(Certify, FindsTheSmallestLeak)
{
  const Cloud cloud({{63, 0, 0}, {65, 0, 0}});
  const SphereHierarchy hierarchy(cloud.view(), fitted(SphereFit::box_center, 1e6));
  hierarchy.buildAll();
  Node& node = open(hierarchy).voxels[0].nodes[0];
  const float sound = node.r[0];
  node.r[0] = 1.0f;
  EXPECT_TRUE(certify(hierarchy, everything()).holds()) << "touching is inside";
  node.r[0] = std::nextafter(1.0f, 0.0f);
  const Certificate certificate = certify(hierarchy, everything());
  EXPECT_FALSE(certificate.holds());
  ASSERT_EQ(certificate.leaks.size(), 2U);
  EXPECT_EQ(certificate.leaks[0].excess, 0x1p-24);
  EXPECT_EQ(certificate.levels.back().ratio.measured, 0U) << "a sphere that leaks has no ratio";
  node.r[0] = std::numeric_limits<float>::quiet_NaN(); // must be found, and not reach CGAL
  EXPECT_FALSE(certify(hierarchy, everything()).holds());
  node.r[0] = sound;
  node.x[0] = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(certify(hierarchy, everything()).holds());
}

TEST(Certify, FindsABallThatSticksOut)
{
  Cloud cloud({{63, 0, 0}, {65, 0, 0}});
  cloud.setRadii({0.5f, 0.5f});
  const SphereHierarchy hierarchy(cloud.view(), fitted(SphereFit::box_center, 1e6));
  hierarchy.buildAll();
  Node& node = open(hierarchy).voxels[0].nodes[0];
  node.r[0] = 1.5f;
  EXPECT_TRUE(certify(hierarchy, everything()).holds());
  node.r[0] = 1.25f;
  const Certificate certificate = certify(hierarchy, everything());
  ASSERT_EQ(certificate.leaks.size(), 2U);
  EXPECT_EQ(certificate.leaks[0].excess, 0.25);
  node.r[0] = 0.25f; // smaller than a ball
  EXPECT_EQ(certify(hierarchy, everything()).leaks[0].excess, 1.25);
}

TEST(Certify, FindsAPointThatNoLeafHolds)
{
  Random random(24);
  const Cloud cloud(test::makePoints(Shape::uniform, 200, 1, random));
  const SphereHierarchy hierarchy(cloud.view());
  hierarchy.buildAll();
  Voxel& voxel = open(hierarchy).voxels[0];
  auto* records = const_cast<std::uint32_t*>(voxel.records());
  records[1] = records[0];
  const Certificate certificate = certify(hierarchy, everything());
  EXPECT_EQ(certificate.missing, 1U);
  EXPECT_FALSE(certificate.holds());
}

} // namespace
} // namespace pcl_bsh

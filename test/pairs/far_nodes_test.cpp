// SPDX-License-Identifier: BSD-3-Clause
// Nodes far from each other for their size, which are compared by how far they reach towards each other: clouds of
// which spheres say little, at the very distance of two of their points.
#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/collide.h>
#include <pcl_bsh/hierarchy/update.h>
#include <pcl_bsh/traversal/far_nodes.h>

#include "support/adversarial_clouds.h"
#include "support/climb.h"
#include "support/random_clouds.h"
#include "support/verdicts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Cloud;
using test::Random;
using namespace test::adversarial;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Lines, arcs, patches and clumps, one unit in size, whose points stray a little.
std::vector<Point3> shapeOf(int kind, std::size_t n, Random& random)
{
  std::vector<Point3> points = kind == 0   ? axis(n, 1)
                               : kind == 1 ? helix(n, 1, 0)
                               : kind == 2 ? sheet(n, 0, 0)
                               : kind == 3 ? shells(n, 1, 0)
                                           : cube(n, 7);
  if (kind == 2)
    for (Point3& p : points) p = scaled(p, 1.0 / std::sqrt(static_cast<double>(n)));
  const double rough = std::pow(10.0, random.uniform(-9, -2));
  for (Point3& p : points)
    for (double& x : p) x += rough * random.uniform(-1, 1);
  return points;
}

Eigen::Isometry3d poseAt(double distance, Random& random)
{
  const Point3 to = direction(random);
  Eigen::Isometry3d pose = random.pose(0.0);
  pose.translation() += distance * Eigen::Vector3d(to[0], to[1], to[2]);
  return pose;
}

/// The least distance of two nodes' points, at least and at most.
ExactDistance::Enclosure nearest(const SphereHierarchy::Storage& a, const SphereHierarchy::Storage& b, const Voxel& va,
                                 const Voxel& vb, const Node& na, const Node& nb, std::uint32_t i, std::uint32_t k,
                                 const ExactDistance& distance)
{
  ExactDistance::Enclosure least{INFINITY, INFINITY};
  for (std::uint32_t p = na.begin[i]; p < na.begin[i + 1]; ++p)
    for (std::uint32_t q = nb.begin[k]; q < nb.begin[k + 1]; ++q) {
      const auto of = distance.enclose(a.view.point(va.records()[p]), b.view.point(vb.records()[q]));
      least.low = std::min(least.low, of.low), least.high = std::min(least.high, of.high);
    }
  return least;
}

TEST(FarNodes, AreNeverApartWithinTheDistanceOfTheirPoints)
{
  Random random(61);
  double closest_claim = 0.0; // of a distance
  std::size_t claims = 0;
  std::uint64_t compared = 0;
  for (int round = 0; round < 40; ++round) {
    Cloud cloud_a(shapeOf(round % 5, 200, random), {round % 2 == 0 ? Scalar::float32 : Scalar::float64});
    Cloud cloud_b(shapeOf(random.integer(0, 4), 200, random));
    HierarchyOptions options;
    options.voxel_edge = round % 3 == 0 ? 0.5 : 8.0;
    const SphereHierarchy ha(cloud_a.view(), options), hb(cloud_b.view(), options);
    ha.buildAll();
    hb.buildAll();
    const auto &a = ha.storage(), &b = hb.storage();
    const double away = std::pow(10.0, random.uniform(-1, 4));
    Eigen::Isometry3d pose_a = poseAt(round % 4 == 0 ? 1e6 : 0.0, random), pose_b = pose_a * poseAt(away, random);
    if (round % 4 == 1) pose_b.linear() *= 1.0 + 4e-7; // within what is let pass as rigid
    const ExactDistance distance(pose_a, pose_b);
    BuildWork work;
    for (std::size_t v = 0; v < a.voxel_count; ++v)
      for (std::size_t w = 0; w < b.voxel_count; ++w)
        for (const Node& na : a.voxels[v].nodes)
          for (const Node& nb : b.voxels[w].nodes)
            for (std::uint32_t i = 0; i < na.count; ++i)
              for (std::uint32_t k = 0; k < nb.count; ++k) {
                const NodeSupport sa = nodeSupport(a.voxels[v], a.view, na, i, work),
                                  sb = nodeSupport(b.voxels[w], b.view, nb, k, work);
                const auto least = nearest(a, b, a.voxels[v], b.voxels[w], na, nb, i, k, distance);
                // A claimed gap is true: its points are no nearer.
                double claimed = 0.0, above = least.high * (1.0 + 1e-6) + 1e-300;
                EXPECT_FALSE(areFarNodesApart(distance, pose_a, sa, pose_b, sb, least.high, compared)) << round;
                for (int step = 0; step < 30; ++step) {
                  const double middle = 0.5 * (claimed + above);
                  (areFarNodesApart(distance, pose_a, sa, pose_b, sb, middle, compared) ? claimed : above) = middle;
                }
                claims += claimed > 0.0;
                closest_claim = std::max(closest_claim, claimed / least.high);
              }
  }
  EXPECT_GT(claims, 1000u);
  EXPECT_GT(closest_claim, 1.0 - 1e-9); // some of these bounds are as good as can be
}

using Real = long double; // its error is 2^-11 of double's
using Numbers = std::vector<double>;
using RealVector = Eigen::Matrix<Real, 3, 1>;

Eigen::Vector3d vectorAt(const Numbers& n, std::size_t k)
{
  return {n[k], n[k + 1], n[k + 2]};
}

Eigen::Isometry3d poseAt(const Numbers& n, std::size_t k)
{
  Eigen::Quaterniond turn(n[k], n[k + 1], n[k + 2], n[k + 3]);
  if (!(turn.norm() > 0.1 && turn.norm() < 100)) turn.setIdentity();
  Eigen::Isometry3d pose(turn.normalized());
  pose.translation() = vectorAt(n, k + 4);
  return pose;
}

/// Two poses and two middles, of 20 numbers: the error of the vector between, as a part of its bound.
double betweenFraction(const Numbers& n)
{
  const Eigen::Isometry3d pose_a = poseAt(n, 0), pose_b = poseAt(n, 7);
  const Point3 a = {n[14], n[15], n[16]}, b = {n[17], n[18], n[19]};
  const auto posed = [](const Eigen::Isometry3d& pose, const Point3& p) -> RealVector {
    const RealVector at(p[0], p[1], p[2]);
    return pose.linear().cast<Real>() * at + pose.translation().cast<Real>();
  };
  const CenterDifference difference(pose_a, a, pose_b, b);
  const Real off = (posed(pose_b, b) - posed(pose_a, a) - difference.vector.cast<Real>()).norm();
  return difference.error > 0x1p-500 && difference.error < 0x1p500 ? static_cast<double>(off / difference.error) : 0.0;
}

constexpr double kUnit = 4.0; ///< of the frame: lengths of nodes are in it, those of supports in the cloud's

/// A direction, a rotation, two normals and three lengths, of 16 numbers. The shortfall of the support against that of
/// the two slabs and the sphere, without its margin, as a part of the margin.
double supportFraction(const Numbers& n)
{
  const auto isPlain = [](double x) { return std::abs(x) < 8.0; };
  if (!std::all_of(n.begin(), n.end(), isPlain)) return 0.0;
  const Eigen::Vector3d away = vectorAt(n, 0), own = vectorAt(n, 7), cross = vectorAt(n, 10);
  if (!(away.norm() > 0.1 && own.norm() > 0.1 && cross.norm() > 0.1)) return 0.0;
  const Eigen::Matrix3d turn = poseAt({n[3], n[4], n[5], n[6], 0, 0, 0}, 0).linear();
  LocalFrame frame;
  frame.unit = kUnit;
  Node node{};
  node.count = 1;
  node.r[0] = static_cast<float>(std::abs(n[13]) + 0.1);
  Slabs slabs{}, crosses{};
  const auto set = [&](Slabs& to, const Eigen::Vector3d& normal, double h) {
    const Eigen::Vector3f unit = normal.normalized().cast<float>();
    to.x[0] = unit.x(), to.y[0] = unit.y(), to.z[0] = unit.z();
    to.h[0] = std::min(static_cast<float>(std::abs(h)), node.r[0]);
    return RealVector(unit.cast<Real>());
  };
  const RealVector u = set(slabs, own, n[14]), v = set(crosses, cross, n[15]);
  const double found = NodeSupport(frame, node, 0, slabs, crosses).along(turn.transpose() * (away / away.norm()));
  const RealVector direction = turn.cast<Real>().transpose() * away.cast<Real>().normalized();
  const Real on_u = direction.dot(u), on_v = direction.dot(v), radius = kUnit * Real{node.r[0]};
  const Real support = std::abs(on_u) * kUnit * slabs.h[0] + std::abs(on_v) * kUnit * crosses.h[0] +
                       (direction - on_u * u - on_v * v).norm() * radius;
  const Real margin = Real{kSupportError} * (support + radius);
  return static_cast<double>((support + margin - Real{found}) / margin);
}

/// Climbs towards the worst case of the bounds in double that far nodes are compared with.
TEST(FarNodes, BoundsHoldUnderAttack)
{
  Random random(63);
  const auto start = [&](std::size_t count) {
    return [&random, count] {
      Numbers n(count);
      for (double& x : n) x = random.uniform(-1, 1) * (random.chance(0.3) ? 1e-3 : 1.0);
      return n;
    };
  };
  const double difference = test::climbFromMany(start(20), betweenFraction, 60, 600, random),
               support = test::climbFromMany(start(16), supportFraction, 60, 600, random);
  std::printf("  difference: %.4f, support: %.4f of the bound\n", difference, support);
  EXPECT_LE(difference, 1.0);
  EXPECT_GE(difference, 0.2);
  EXPECT_LE(support, 1.0);
  EXPECT_GE(support, 0.05);
}

/// All answers at the distance of the nearest pair, a last bit less, and a little less, are those of brute force.
void expectExact(const SphereHierarchy& a, const SphereHierarchy& b, const Eigen::Isometry3d& pose_b,
                 const std::string& what)
{
  const Placed at_a(a), at_b(b, pose_b);
  const DistanceResult expected = brute_force::closestPair(at_a, at_b), found = closestPair(at_a, at_b);
  ASSERT_EQ(found.distance, expected.distance) << what;
  ASSERT_EQ(found.pair, expected.pair) << what;
  if (!expected.pair) return;
  for (const double clearance : {expected.distance, std::nextafter(expected.distance, 0.0),
                                 expected.distance * (1.0 - 1e-6), expected.distance * (1.0 + 1e-7)}) {
    if (!(clearance >= 0.0)) continue;
    const FlagsRequest request{clearance, Flagged::both};
    const FlagsResult flags = brute_force::collisionFlags(at_a, at_b, request),
                      own = collisionFlags(at_a, at_b, request);
    ASSERT_EQ(own.a, flags.a) << what << ", " << clearance;
    ASSERT_EQ(own.b, flags.b) << what << ", " << clearance;
    ASSERT_EQ(anyCollision(at_a, at_b, {clearance, {}}).verdict,
              brute_force::anyCollision(at_a, at_b, {clearance, {}}).verdict)
        << what << ", " << clearance;
  }
}

TEST(FarNodes, AnswersAreThoseOfBruteForce)
{
  Random random(62);
  for (int kind_a = 0; kind_a < 5; ++kind_a)
    for (int kind_b = 0; kind_b <= kind_a; ++kind_b) {
      auto points_a = shapeOf(kind_a, 600, random), points_b = shapeOf(kind_b, 600, random);
      const std::string what = std::to_string(kind_a) + " and " + std::to_string(kind_b);
      const bool concentric = random.chance(0.3);
      const double size = concentric ? std::pow(10.0, random.uniform(-4, -1)) : 1.0;
      for (Point3& p : points_b) p = scaled(p, size);
      for (int k = 0; k < 20; ++k) {
        points_a[static_cast<std::size_t>(random.integer(0, 500))] = {kNan, 0, 0};
        points_b[static_cast<std::size_t>(k)] = points_b[300]; // more points at one place than a leaf has
      }
      Cloud a(points_a), b(points_b);
      if (random.chance(0.2)) b.setRadii(std::vector<float>(points_b.size(), 0.01f));
      HierarchyOptions options;
      if (random.chance(0.3)) options.voxel_edge = 0.3;
      const SphereHierarchy of_a(a.view(), options), of_b(b.view(), options);
      expectExact(of_a, of_b, concentric ? Eigen::Isometry3d::Identity() : poseAt(random.uniform(0, 12), random), what);
      if (HasFatalFailure()) return;
    }
}

TEST(FarNodes, InVoxelsOfAnotherUnit)
{
  Random random(64);
  for (const double size : {1e60, 1e25, 1e-25, 1e-60})
    for (int kind = 0; kind < 4; ++kind) {
      auto points_a = shapeOf(kind, 300, random), points_b = shapeOf((kind + 1) % 4, 300, random);
      for (auto* const points : {&points_a, &points_b})
        for (Point3& p : *points) p = scaled(p, size);
      const Cloud a(points_a, {Scalar::float64}), b(points_b, {Scalar::float64});
      const SphereHierarchy of_a(a.view()), of_b(b.view());
      Eigen::Isometry3d pose = poseAt(random.uniform(8, 14), random);
      pose.translation() *= size;
      expectExact(of_a, of_b, pose, std::to_string(kind) + " at " + std::to_string(std::log10(size)));
      if (HasFatalFailure()) return;
    }
}

TEST(FarNodes, OfOnePoint)
{
  const Cloud one({{0, 0, 0}}), ring(helix(900, 1, 0));
  const SphereHierarchy a(one.view()), b(ring.view());
  expectExact(a, b, Eigen::Isometry3d::Identity(), "one point within a ring");
  expectExact(b, a, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 0.25)), "one point over a ring");
}

TEST(FarNodes, ForgetWhatWasFittedBeforePointsMoved)
{
  // A ring whose points are moved inward, each second one: what was fitted to the round one is too thin for it.
  const std::vector<Point3> round = helix(1600, 1, 0);
  Cloud line(axis(1600, 1)), ring(round);
  const SphereHierarchy a(line.view());
  SphereHierarchy b(ring.view());
  const double before = closestPair(Placed(a), Placed(b)).distance;
  ASSERT_TRUE(b.storage().voxels[0].cross_slabs.isFitted());
  EXPECT_TRUE(b.validate().none());
  std::vector<Point3> moved = round;
  for (std::size_t i = 0; i < moved.size(); i += 2) moved[i] = scaled(moved[i], 0.998);
  Cloud now(moved);
  const RefitReport report = b.refit(now.view(), 100.0);
  ASSERT_FALSE(report.sorted_anew);
  ASSERT_EQ(report.voxels_dropped, 0u);
  EXPECT_LT(closestPair(Placed(a), Placed(b)).distance, before);
  expectExact(a, b, Eigen::Isometry3d::Identity(), "refitted");
  EXPECT_TRUE(b.validate().none());

  // And single records.
  const std::int32_t record = 1200;
  HierarchyUpdate update(b, &record, 1);
  moved[1200] = scaled(moved[1200], 0.9);
  Cloud later(moved);
  update.commit(later.view());
  expectExact(a, b, Eigen::Isometry3d::Identity(), "updated");
}

} // namespace
} // namespace pcl_bsh

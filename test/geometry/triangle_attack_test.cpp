// SPDX-License-Identifier: BSD-3-Clause
// Attacks on the bounds of triangles laid flat, judged in exact arithmetic, on every instruction set; and that bands
// stay narrow however thin a triangle is.
#include <pcl_bsh/geometry/relative_frame.h>
#include <pcl_bsh/geometry/triangle/double_distance.h>
#include <pcl_bsh/geometry/triangle/flat_triangle.h>
#include <pcl_bsh/geometry/triangle/triangle_distance.h>

#include "kernels.h"
#include "support/attack.h"
#include "support/climb.h"
#include "triangle_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace pcl_bsh {
namespace {

using test::floatOf;
using test::onEveryTarget;
using test::Random;
using test::report;
using test::suspect;
using Numbers = std::vector<double>;

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

/// Corners of the first nine numbers.
Triangle3 triangleOf(const Numbers& n)
{
  return {{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}}};
}

float squaredBy(const FlatTriangle<float>& flat, const Point3& p)
{
  float at[3][8] = {};
  for (std::size_t k = 0; k < 3; ++k) at[k][0] = floatOf(p[k]);
  return test::squaredToTriangleEight(flat, at[0], at[1], at[2]).squared[0];
}

/// A triangle and a point (12 numbers): the error of the kernel's distance, as a part of its bound. Corners are floats,
/// and sides not short beside them: where a corner is stored would hide what the kernel does.
double kernelFraction(const Numbers& n)
{
  Triangle3 t = triangleOf(n);
  for (Point3& corner : t)
    for (double& x : corner) x = static_cast<double>(floatOf(x));
  const Point3 p = {static_cast<double>(floatOf(n[9])), static_cast<double>(floatOf(n[10])),
                    static_cast<double>(floatOf(n[11]))};
  const FlatTriangle<float> flat = flatten<float>(t);
  for (const double x : n)
    if (!(flat.length > std::abs(x) / 4)) return 0.0;
  const double squared = static_cast<double>(squaredBy(flat, p));
  if (!(squared >= 0.0)) return 100.0;
  const double found = std::sqrt(squared), truth = TriangleDistance(identity, identity).distance(p, t);
  const double bound = kFlatShare * truth + static_cast<double>(flat.error) + kLengthError * found;
  return std::abs(found - truth) / bound;
}

/// The double stage: the middle of the enclosure, as a part of its width. The judge is rounded, by much less than that.
double doubleFraction(const Numbers& n)
{
  const Triangle3 t = triangleOf(n);
  const auto found = distanceOfOrigin(flatten<double>(t));
  if (!(found.high < 1e30 && found.high > 1e-9)) return 0.0;
  const double truth = TriangleDistance(identity, identity).distance(Point3{0, 0, 0}, t);
  return std::abs(truth - (found.low / 2 + found.high / 2)) / (found.high / 2 - found.low / 2);
}

/// Triangles of ordinary shapes and needles, and points near them or as far as they are long.
Numbers startOf(Random& random)
{
  Numbers n(12);
  for (double& x : n) x = static_cast<double>(floatOf(suspect(random, 3)));
  const int kind = random.integer(0, 3);
  if (kind == 0) // a needle
    for (std::size_t k = 0; k < 3; ++k) n[6 + k] = n[k] + std::ldexp(suspect(random, 3), -16);
  if (kind == 1)
    for (std::size_t k = 0; k < 3; ++k) n[6 + k] = (n[k] + n[3 + k]) / 2 + std::ldexp(suspect(random, 3), -16);
  if (random.chance(0.5)) { // a point over the triangle
    const double u = random.uniform(0, 0.5), v = random.uniform(0, 0.5);
    for (std::size_t k = 0; k < 3; ++k)
      n[9 + k] = n[k] + u * (n[3 + k] - n[k]) + v * (n[6 + k] - n[k]) + std::ldexp(suspect(random, 3), -10);
  }
  return n;
}

TEST(TriangleAttack, Kernel)
{
  onEveryTarget([](const std::string& target) {
    Random random(501);
    const double reached = test::climbFromMany([&] { return startOf(random); }, kernelFraction, 60, 800, random);
    report("triangles, " + target, reached);
    EXPECT_GE(reached, 0.2) << "not all that it adds up can be at its worst at once";
  });
}

TEST(TriangleAttack, DoubleStage)
{
  Random random(502);
  const double reached = test::climbFromMany([&] { return startOf(random); }, doubleFraction, 60, 800, random);
  report("triangles in double", reached);
  EXPECT_GE(reached, 0.1);
}

/// The rows of a triangle laid flat: how far they change a length, as a part of kFlatSkew.
template <class Number>
double skewFraction(const Numbers& n)
{
  const FlatTriangle<Number> flat = flatten<Number>(triangleOf(n));
  if (!(flat.length > 0)) return 0.0;
  // Largest row sum of |R R' - I|, in units of 2^-80.
  using test::Rational;
  Rational most = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    Rational sum = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      Rational product = i == j ? -1 : 0;
      for (std::size_t k = 0; k < 3; ++k)
        product += Rational(double{flat.rows[3 * i + k]}) * Rational(double{flat.rows[3 * j + k]});
      sum += abs(product);
    }
    most = std::max(most, sum);
  }
  // The singular values are within half of the spectral norm, which the row sum bounds.
  return most.template convert_to<double>() / 2 / kFlatSkew<Number>;
}

TEST(TriangleAttack, RowsAreOrthonormal)
{
  Random random(503);
  const auto start = [&] {
    Numbers n = startOf(random);
    if (random.chance(0.5)) // thinner than doubles can tell
      for (std::size_t k = 0; k < 3; ++k) n[6 + k] = n[k] + random.uniform(0, 1) * (n[3 + k] - n[k]);
    return n;
  };
  for (const auto& [name, fraction] : std::map<std::string, double (*)(const Numbers&)>{
           {"rows in float", skewFraction<float>}, {"rows in double", skewFraction<double>}}) {
    const double reached = test::climbFromMany(start, fraction, 20, 200, random);
    report(name, reached);
    EXPECT_GE(reached, 0.1);
  }
}

/// Scan points near triangles, by frames as queries have them: no verdict is wrong, and few are left open.
TEST(TriangleAttack, BandsHoldAndAreNarrow)
{
  Random random(504);
  for (const double thinness : {0.0, 1e-5, 1e-9}) {
    int open = 0, hits = 0, misses = 0;
    for (int round = 0; round < 200; ++round) {
      Eigen::Isometry3d pose_a = random.pose(2.0), pose_b = random.pose(2.0);
      for (Eigen::Isometry3d* pose : {&pose_a, &pose_b}) pose->pretranslate(Eigen::Vector3d(513449.7, 5402650.2, 300));
      // In b's cloud a triangle, in a voxel 4 wide; in a's, eight points near it.
      Triangle3 t = {random.point([&] { return random.uniform(-2, 2); }),
                     random.point([&] { return random.uniform(-2, 2); }),
                     random.point([&] { return random.uniform(-2, 2); })};
      if (thinness > 0.0)
        for (std::size_t k = 0; k < 3; ++k) t[2][k] = t[0][k] + thinness * t[2][k];
      const double clearance = std::pow(10.0, random.uniform(-3, -1));
      LocalFrame frame_a, frame_b;
      frame_b.reach = {2, 2, 2};
      frame_a.reach = {4, 4, 4};
      std::vector<Point3> points;
      float stored[3][8];
      const Eigen::Isometry3d back = pose_a.inverse() * pose_b;
      for (std::size_t i = 0; i < 8; ++i) {
        const double u = random.uniform(0, 0.5), v = random.uniform(0, 0.5);
        Eigen::Vector3d q;
        for (std::size_t k = 0; k < 3; ++k)
          q(static_cast<Eigen::Index>(k)) =
              t[0][k] + u * (t[1][k] - t[0][k]) + v * (t[2][k] - t[0][k]) + 2 * clearance * random.uniform(-1, 1);
        q = back * q;
        Point3 p = {q(0), q(1), q(2)};
        if (i == 0)
          for (std::size_t k = 0; k < 3; ++k) frame_a.origin[k] = p[k];
        for (std::size_t k = 0; k < 3; ++k) stored[k][i] = roundToFloat(p[k] - frame_a.origin[k]);
        points.push_back(p);
      }
      const RelativeFrame change(frame_a, pose_a, frame_b, pose_b);
      float m[9], g[3];
      std::copy(change.m.begin(), change.m.end(), m);
      std::copy(change.g.begin(), change.g.end(), g);
      const test::Carried carried = test::carryEight(m, g, stored[0], stored[1], stored[2]);
      const FlatTriangle<float> flat = flatten(frame_b, t);
      const test::ToTriangle found = test::squaredToTriangleEight(flat, carried.x, carried.y, carried.z);
      const DistanceBand band = change.band(clearance, static_cast<double>(flat.error), kFlatShare);
      const TriangleDistance distance(pose_a, pose_b);
      for (std::size_t i = 0; i < 8; ++i) {
        if (std::abs(stored[0][i]) > 4 || std::abs(stored[1][i]) > 4 || std::abs(stored[2][i]) > 4) continue;
        const int truth = distance.compare(points[i], t, clearance);
        if (found.squared[i] <= band.hit) {
          EXPECT_LE(truth, 0);
          ++hits;
        }
        else if (found.squared[i] > band.miss) {
          EXPECT_GT(truth, 0);
          ++misses;
        }
        else {
          ++open;
        }
        const DistanceBounds bounds = boundsOf(found.squared[i], change.error, change.skew(), flat);
        const double exact = distance.distance(points[i], t);
        EXPECT_LE(bounds.low, exact);
        EXPECT_GE(bounds.high, exact);
        EXPECT_LT(bounds.high - bounds.low, 4e-5);
      }
    }
    std::printf("  thinness %g: %d hits, %d misses, %d open\n", thinness, hits, misses, open);
    EXPECT_GT(hits, 300);
    EXPECT_GT(misses, 300);
    EXPECT_LT(open, 10);
  }
}

TEST(TriangleAttack, KernelIsTheSameOnEveryTarget)
{
  Random random(505);
  std::vector<Numbers> cases;
  for (int i = 0; i < 200; ++i) cases.push_back(startOf(random));
  std::vector<float> first;
  onEveryTarget([&](const std::string& target) {
    std::vector<float> found;
    for (const Numbers& n : cases) found.push_back(squaredBy(flatten<float>(triangleOf(n)), {n[9], n[10], n[11]}));
    if (first.empty()) first = found;
    EXPECT_EQ(found, first) << target;
  });
}

/// Far from its frame's origin a triangle is stored as coarsely as its coordinates are; its error says so, and what the
/// kernel adds.
template <class Number>
void expectErrorHoldsCorners(Random& random)
{
  using Real = long double;
  const double far = std::exp2(random.integer(0, 20)), slack = random.chance(0.5) ? 0.0 : 0.125;
  Triangle3 t;
  const Point3 at = random.point([&] { return far * random.uniform(-1, 1); });
  for (Point3& corner : t)
    for (std::size_t k = 0; k < 3; ++k) corner[k] = at[k] + random.uniform(-1, 1);
  const FlatTriangle<Number> flat = flatten<Number>(t, slack);
  const Real stored[3][2] = {{0, 0}, {flat.length, 0}, {flat.apex_x, flat.apex_y}};
  Real least = std::numeric_limits<Real>::infinity(); // of the orders of corners
  for (std::size_t first = 0; first < 3; ++first) {
    Real apart = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3& corner = t[(first + i) % 3];
      Real squared = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        Real off = k < 2 ? -stored[i][k] : 0;
        for (std::size_t m = 0; m < 3; ++m) off += Real{flat.rows[3 * k + m]} * (Real{corner[m]} - flat.origin[m]);
        squared += off * off;
      }
      apart = std::max(apart, std::sqrt(squared));
    }
    least = std::min(least, apart);
  }
  const Real kernel = kFlatTriangleUnits * Real{kFlatUnit<Number>} * flat.length;
  ASSERT_GE(flat.error, least + slack + kernel) << far;
  ASSERT_LE(flat.error, 1.01L * (least + slack + kernel + 64 * Real{kDoubleUnit} * far)) << far;
}

TEST(FlatTriangle, ErrorHoldsWhereItsCornersAreStored)
{
  Random random(5);
  for (int i = 0; i < 1000 && !HasFatalFailure(); ++i) {
    expectErrorHoldsCorners<float>(random);
    expectErrorHoldsCorners<double>(random);
  }
}

TEST(FlatTriangle, OfSegmentsAndPoints)
{
  const auto distance = [](const Triangle3& t, const Point3& p) {
    return std::sqrt(static_cast<double>(squaredBy(flatten<float>(t), p)));
  };
  const Point3 a = {1, 2, 3}, b = {1, 2, 7}, m = {1, 2, 5};
  for (const Triangle3& t : {Triangle3{a, a, a}, Triangle3{a, a, b}, Triangle3{a, b, a}, Triangle3{b, a, a},
                             Triangle3{a, m, b}, Triangle3{m, a, b}}) {
    EXPECT_NEAR(distance(t, {1, 2, 0}), 3.0, 1e-5);
    EXPECT_NEAR(distance(t, {4, 6, 3}), 5.0, 1e-5);
    if (t != Triangle3{a, a, a}) {
      EXPECT_NEAR(distance(t, {1, 5, 6}), 3.0, 1e-5);
      EXPECT_NEAR(distance(t, {1, 2, 9}), 2.0, 1e-5);
    }
  }
  // Out of the kernel's range nothing is claimed.
  EXPECT_EQ(flatten<float>(Triangle3{a, Point3{1e30, 0, 0}, b}).error, std::numeric_limits<float>::infinity());
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// Attacks that climb towards the worst case of each bound, judged in exact arithmetic, on every instruction set. Each
// says what fraction of the bound it reached: 1 would be the bound itself.
#include <pcl_bsh/geometry/exact/compensated_sum.h>
#include <pcl_bsh/geometry/exact/dyadic.h>
#include <pcl_bsh/geometry/exact_distance.h>
#include <pcl_bsh/geometry/given_sphere.h>
#include <pcl_bsh/geometry/point_frame.h>
#include <pcl_bsh/geometry/relative_frame.h>
#include <pcl_bsh/geometry/sphere_radius.h>
#include <pcl_bsh/hierarchy/storage.h>

#include "kernels.h"
#include "support/attack.h"
#include "support/climb.h"

#include <gtest/gtest.h>

#include <string>

namespace pcl_bsh {
namespace {

using test::floatOf;
using test::onEveryTarget;
using test::Random;
using test::report;
using test::suspect;
using Numbers = std::vector<double>;

const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();

/// x, within 2^-50 of itself.
double toDouble(const Dyadic& x)
{
  const Dyadic::Scaled scaled = x.scaled();
  return scaled.mantissa == 0.0 ? 0.0 : std::ldexp(scaled.mantissa, scaled.exponent);
}

/// The carried point of shift, matrix row and point (7 numbers), by the compiled kernel: its error, as a part of its
/// bound.
double carriedFraction(const Numbers& n)
{
  const float m[9] = {floatOf(n[1]), floatOf(n[2]), floatOf(n[3])};
  const float g[3] = {floatOf(n[0])};
  float x[8] = {}, y[8] = {}, z[8] = {};
  x[0] = floatOf(n[4]), y[0] = floatOf(n[5]), z[0] = floatOf(n[6]);
  const test::Carried carried = test::carryEight(m, g, x, y, z);
  if (carried.x[0] != carried.point[0]) return 100.0;
  const double p[3] = {x[0], y[0], z[0]};
  Dyadic exact(n[0]);
  double products = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    exact += Dyadic(n[k + 1]) * Dyadic(p[k]);
    products += std::abs(n[k + 1] * p[k]);
  }
  const double error = std::abs(toDouble(exact - Dyadic(static_cast<double>(carried.x[0]))));
  const double bound = kCarriedShiftError * std::abs(n[0]) + kCarriedProductError * products;
  return bound > 0x1p-80 ? error / bound : 0.0;
}

TEST(BoundsAttack, CarriedPoints)
{
  onEveryTarget([](const std::string& target) {
    Random random(101);
    const auto start = [&random] {
      Numbers n(7);
      for (double& x : n) x = std::ldexp(suspect(random, 2), random.chance(0.5) ? 0 : -random.integer(0, 28));
      n[1] = suspect(random, 0), n[4] = suspect(random, 0);
      return n;
    };
    const double reached = test::climbFromMany(start, carriedFraction, 60, 800, random);
    report("carried points, " + target, reached);
    EXPECT_GE(reached, 0.9) << "the bound is loose, or the attack weak";
  });
}

/// The squared distance of two points (6 floats): its error, as a part of its bound; `too_small`: of the root's.
template <bool kLength>
double squaredFraction(const Numbers& n)
{
  float at[3][8] = {};
  const float to[3] = {floatOf(n[3]), floatOf(n[4]), floatOf(n[5])};
  Dyadic exact;
  for (std::size_t k = 0; k < 3; ++k) {
    at[k][0] = floatOf(n[k]);
    const Dyadic d = Dyadic(static_cast<double>(at[k][0])) - Dyadic(static_cast<double>(to[k]));
    exact += d * d;
  }
  const double squared = static_cast<double>(test::squaredEight(at[0], at[1], at[2], to).of[0]);
  const double truth = toDouble(exact);
  if (!(truth > 0x1p-90)) return 0.0;
  const double relative = toDouble(Dyadic(squared) - exact) / truth;
  if (kLength) return relative < 0.0 ? (1.0 / std::sqrt(1.0 + relative) - 1.0) / kLengthError : 0.0;
  return std::abs(relative) / kSquaredDistanceError;
}

Numbers twoPoints(Random& random)
{
  Numbers n(6);
  for (double& x : n) x = std::ldexp(suspect(random, 2), -random.integer(0, 26));
  n[0] = suspect(random, 0);
  return n;
}

TEST(BoundsAttack, SquaredDistances)
{
  onEveryTarget([](const std::string& target) {
    Random random(102);
    const auto start = [&random] { return twoPoints(random); };
    const double squared = test::climbFromMany(start, squaredFraction<false>, 40, 800, random);
    report("squared distances, " + target, squared);
    EXPECT_GE(squared, 0.9);
    const double length = test::climbFromMany(start, squaredFraction<true>, 40, 800, random);
    report("lengths, " + target, length);
    EXPECT_GE(length, 0.9);
  });
}

/// Two points of a frame each, with a pose: 18 numbers. How far float arithmetic is from the true vector, as a part of
/// RelativeFrame::error. Each frame has a second point, opposite in a voxel of edge 4.
double frameFraction(const Numbers& n)
{
  Eigen::Isometry3d pose = identity;
  for (int k = 0; k < 9; ++k) pose.linear()(k / 3, k % 3) = n[static_cast<std::size_t>(k) + 6];
  for (int k = 0; k < 3; ++k) pose.translation()(k) = n[static_cast<std::size_t>(k) + 15];
  for (int k = 0; k < 3; ++k)
    if (!(std::abs(pose.linear().row(k).norm() - 1.0) < 1e-6)) return 0.0;
  LocalFrame frames[2];
  Point3 at[2];
  float stored[2][3];
  for (std::size_t side = 0; side < 2; ++side) {
    Point3 low, high;
    for (std::size_t k = 0; k < 3; ++k) {
      at[side][k] = std::clamp(n[3 * side + k], -8.0, 8.0);
      low[k] = std::min(at[side][k], 4.0 - at[side][k]);
      high[k] = std::max(at[side][k], 4.0 - at[side][k]);
    }
    frames[side] = frameBetween(low, high, false);
    if (frames[side].unit != 1.0) return 0.0;
    for (std::size_t k = 0; k < 3; ++k) stored[side][k] = roundToFloat(at[side][k] - frames[side].origin[k]);
  }
  const RelativeFrame frame(frames[0], pose, frames[1], identity);
  for (const float g : frame.g)
    if (std::abs(g) > 0x1p-10f) return 0.0; // a large shift hides what products err by, and so does a large frame b
  for (std::size_t k = 0; k < 3; ++k)
    if (frames[1].reach[k] > 1.01 * frames[0].reach[0]) return 0.0;
  float m[9], g[3], x[3][8] = {};
  std::copy(frame.m.begin(), frame.m.end(), m);
  std::copy(frame.g.begin(), frame.g.end(), g);
  for (std::size_t k = 0; k < 3; ++k) x[k][0] = stored[0][k];
  const test::Carried carried = test::carryEight(m, g, x[0], x[1], x[2]);
  Dyadic squared;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    Dyadic error = Dyadic(pose.translation()(row)) - Dyadic(at[1][k]);
    for (std::size_t j = 0; j < 3; ++j)
      error += Dyadic(pose.linear()(row, static_cast<Eigen::Index>(j))) * Dyadic(at[0][j]);
    error += Dyadic(static_cast<double>(stored[1][k])) - Dyadic(static_cast<double>(carried.point[k]));
    squared += error * error;
  }
  return std::sqrt(toDouble(squared)) / frame.error;
}

TEST(BoundsAttack, RelativeFrames)
{
  Random random(103);
  // A needle along x that hardly turns: its first product is rounded most. The first is one that four roundings miss.
  const Numbers known = {3.0000006556365406,      2.0003448454349684,     2.0003448454349684, 3.010013997569331,
                         2.000172211759491,       2.000172211744939,      0.9999999701976492, 0.0001726335725324467,
                         0.0001726335725324467,   -0.0001726335751048897, 0.9999999850988244, -8.8818008559676e-16,
                         -0.00017263356996000367, -2.98023499212255e-08,  0.9999999850988248, -0.0006904151389910535,
                         0.00034529695256280927,  0.0003453565469702151};
  const auto start = [&] {
    if (random.chance(0.5)) return known;
    const double tilt = std::ldexp(random.uniform(1, 2), -13);
    Numbers n = {3.0 + 1e-6 * random.uniform(-1, 1),        2.0 + 2 * tilt * random.uniform(0.9, 1.1),
                 2.0 + 2 * tilt * random.uniform(0.9, 1.1), 3.01 + 1e-6 * random.uniform(-1, 1),
                 2.0 + tilt * random.uniform(0.9, 1.1),     2.0 + tilt * random.uniform(0.9, 1.1)};
    const double c = 1.0 - tilt * tilt;
    n.insert(n.end(), {c, tilt, tilt, -tilt, std::sqrt(1.0 - tilt * tilt), 0, -tilt, 0, std::sqrt(1.0 - tilt * tilt)});
    n.insert(n.end(), {2.0 - 2.0 * (c + 2 * tilt), 2 * tilt, 2 * tilt});
    return n;
  };
  const double reached = test::climbFromMany(start, frameFraction, 60, 1000, random);
  report("relative frames", reached);
  EXPECT_GE(reached, 0.9);
}

/// A point, its opposite in the frame, and a place to see it from: 9 numbers.
double pointFrameFraction(const Numbers& n, bool slack)
{
  Point3 p, low, high, q;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = n[k], q[k] = n[k + 6];
    low[k] = std::min(n[k], n[k + 3]), high[k] = std::max(n[k], n[k + 3]);
  }
  const LocalFrame frame = frameBetween(low, high, false);
  if (frame.unit != 1.0) return 0.0;
  const PointFrame seen(frame, q);
  Dyadic squared;
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const float x = roundToFloat(p[k] - frame.origin[k]);
    const Dyadic storing = Dyadic(p[k]) - Dyadic(frame.origin[k]) - Dyadic(static_cast<double>(x));
    const Dyadic error = Dyadic(p[k]) - Dyadic(q[k]) - (Dyadic(static_cast<double>(x)) - Dyadic(double{seen.at[k]}));
    squared += error * error;
    largest = std::max(largest, std::abs(toDouble(storing)) / frame.slack(static_cast<int>(k)));
  }
  return slack ? largest : std::sqrt(toDouble(squared)) / seen.error;
}

TEST(BoundsAttack, StoredPointsAndPlacesSeen)
{
  Random random(104);
  const auto start = [&random] {
    Numbers n(9);
    for (double& x : n) x = suspect(random, 20);
    return n;
  };
  const double stored = test::climbFromMany(
      start, [](const Numbers& n) { return pointFrameFraction(n, true); }, 40, 400, random);
  report("stored points", stored);
  EXPECT_GE(stored, 0.9);
  const double seen = test::climbFromMany(
      start, [](const Numbers& n) { return pointFrameFraction(n, false); }, 60, 600, random);
  report("places seen", seen);
  EXPECT_GE(seen, 0.9);
}

/// Two spheres and a reach, of 8 numbers, just so far apart as these say: what rounding takes of kSphereMargin.
///
/// It cannot take all. The margin is a power of two, above the 13 u that rounding takes at most. Some of that comes
/// back by kReachMargin. For spheres inside, the radii's own margins give back more than rounding takes.
double sphereFraction(const Numbers& n, bool inside)
{
  const float ra = std::abs(floatOf(n[6])), rb = std::abs(floatOf(n[7]));
  float at[3][8] = {};
  const float to[3] = {floatOf(n[3]), floatOf(n[4]), floatOf(n[5])};
  Dyadic exact;
  for (std::size_t k = 0; k < 3; ++k) {
    at[k][0] = floatOf(n[k]);
    const Dyadic d = Dyadic(static_cast<double>(at[k][0])) - Dyadic(static_cast<double>(to[k]));
    exact += d * d;
  }
  const double distance = std::sqrt(toDouble(exact));
  const double radii = static_cast<double>(ra) + static_cast<double>(rb);
  const double length = inside ? distance + radii : distance - radii; // the clearance at which the verdict changes
  if (!(length > 0x1p-20 && length < 0x1p50 && distance > 0x1p-20)) return 0.0;
  LocalFrame frame; // of one place: its error is next to nothing
  const PointFrame point(frame, {0, 0, 0});
  const float prune = point.pruneReach(length), accept = point.acceptReach(length);
  const double s = static_cast<double>(test::squaredEight(at[0], at[1], at[2], to).of[0]);
  const float center[3] = {at[0][0], at[1][0], at[2][0]};
  const test::Near verdict = test::testSphere(center, ra, 1.0f, to, rb, prune, accept);
  // The limits again, for the tests say only on which side the distance is.
  const double margin = static_cast<double>(kSphereMargin);
  if (inside) {
    if (verdict.inside) return 2.0; // at the very limit: must not be claimed
    const float rb_over = rb * (1.0f + kSphereMargin), ra_over = ra * (1.0f + kSphereMargin);
    const float room = (accept - rb_over) - ra_over;
    if (!(room > 0.0f)) return 0.0;
    const float limit = (room * room) * (1.0f - kSphereMargin);
    return 1.0 - (s / static_cast<double>(limit) - 1.0) / margin;
  }
  if (!verdict.near) return 2.0;
  const float sum = ra + (rb + prune);
  const float limit = (sum * sum) * (1.0f + kSphereMargin);
  return 1.0 - (static_cast<double>(limit) / s - 1.0) / margin;
}

TEST(BoundsAttack, MarginOfSpheres)
{
  Random random(105);
  const auto start = [&random] {
    Numbers n = twoPoints(random);
    n.push_back(std::ldexp(suspect(random, 4), -random.integer(1, 12)));
    n.push_back(std::ldexp(suspect(random, 4), -random.integer(1, 12)));
    return n;
  };
  const double near = test::climbFromMany(
      start, [](const Numbers& n) { return sphereFraction(n, false); }, 60, 500, random);
  report("spheres that are near", near);
  EXPECT_GE(near, 0.3) << "less than 13 u of 16 u, less what kReachMargin gives";
  const double inside = test::climbFromMany(
      start, [](const Numbers& n) { return sphereFraction(n, true); }, 60, 500, random);
  report("spheres inside", inside);
}

/// Double arithmetic: one point and a ball's radius around another place, of 4 numbers.
///
/// hypot() is taken for as bad as its formula allows; libraries do better, and two of the eight units are for sums and
/// products that cannot all be at their worst.
double givenSphereFraction(const Numbers& n)
{
  const Point3 p = {n[0], n[1], n[2]}, opposite = {-n[0], -n[1], -n[2]};
  const double ball = std::abs(n[3]);
  const GivenSphere sphere = sphereAround(
      2, [&](std::size_t i) { return i == 0 ? p : opposite; }, [&](std::size_t) { return ball; });
  Dyadic squared;
  for (std::size_t k = 0; k < 3; ++k) {
    const Dyadic d = Dyadic(p[k]) - Dyadic(sphere.center[k]);
    squared += d * d;
  }
  const Dyadic room = Dyadic(sphere.radius) - Dyadic(ball); // what is left for the point
  const double over = toDouble(room * room - squared) / (2.0 * toDouble(room)) / sphere.radius;
  return 1.0 - over / kFewDoubleRoundings;
}

TEST(BoundsAttack, GivenSpheres)
{
  Random random(106);
  const auto start = [&random] {
    Numbers n(4);
    for (double& x : n) x = suspect(random, 3);
    return n;
  };
  const double reached = test::climbFromMany(start, givenSphereFraction, 60, 600, random);
  report("given spheres", reached);
  EXPECT_GE(reached, 0.3);
}

/// A sum of eight products and terms that cancel, of 16 numbers. The bound of n terms is (n v)^2 of the absolute sum,
/// as if all errors had the same sign at every step; and it has room for four times that.
double compensatedFraction(const Numbers& n)
{
  CompensatedSum sum;
  Dyadic exact;
  for (std::size_t k = 0; k + 1 < n.size(); k += 2) {
    sum.addProduct(n[k], n[k + 1]);
    exact += Dyadic(n[k]) * Dyadic(n[k + 1]);
  }
  return sum.absolute > 0.0 ? std::abs(toDouble(exact - Dyadic(sum.value()))) / sum.bound() : 0.0;
}

TEST(BoundsAttack, CompensatedSums)
{
  Random random(107);
  const auto start = [&random] {
    Numbers n(16);
    for (std::size_t k = 0; k < 8; ++k) n[k] = suspect(random, 3);
    for (std::size_t k = 8; k < 16; ++k)
      n[k] = k % 2 == 0 ? -n[k - 8] : n[k - 8] * (1.0 + 1e-14 * random.uniform(-1, 1));
    return n;
  };
  const double reached = test::climbFromMany(start, compensatedFraction, 60, 500, random);
  report("compensated sums", reached);
  EXPECT_GE(reached, 0.9); // where nothing cancels, rounding the value is all
}

/// Two points under a pose, of 18 numbers: how far the enclosure's middle is from the distance, as a part of its width.
///
/// The bound adds up all terms of all axes, where errors add up as a vector does. It has 32 v for the 5 v of an axis
/// and the norm. One of so many terms, rounded as often as possible, uses a quarter of it at best.
double enclosureFraction(const Numbers& n)
{
  Eigen::Isometry3d pose = identity;
  for (int k = 0; k < 12; ++k) pose.matrix()(k / 4, k % 4) = n[static_cast<std::size_t>(k) + 6];
  if (pose.linear() == Eigen::Matrix3d::Identity()) return 0.0;
  const Point3 p = {n[0], n[1], n[2]}, q = {n[3], n[4], n[5]};
  const ExactDistance distance(pose, identity);
  const ExactDistance::Enclosure found = distance.enclose(p, q);
  if (distance.compare(p, q, std::max(found.low, 0.0)) < 0 || distance.compare(p, q, found.high) > 0) return 2.0;
  const double middle = 0.5 * (found.low + found.high), half = 0.5 * (found.high - found.low);
  Dyadic squared;
  for (std::size_t k = 0; k < 3; ++k) {
    Dyadic d = Dyadic(n[4 * k + 9]) - Dyadic(q[k]);
    for (std::size_t j = 0; j < 3; ++j) d += Dyadic(n[4 * k + 6 + j]) * Dyadic(p[j]);
    squared += d * d;
  }
  const double off = toDouble(squared - Dyadic(middle) * Dyadic(middle)) / (middle + std::sqrt(toDouble(squared)));
  return half > 0.0 ? std::abs(off) / half : 0.0;
}

TEST(BoundsAttack, Enclosures)
{
  Random random(108);
  const auto start = [&random] {
    Numbers n(18);
    for (double& x : n) x = std::ldexp(suspect(random, 3), -random.integer(0, 60));
    n[0] = suspect(random, 0), n[6] = suspect(random, 0);
    return n;
  };
  const double reached = test::climbFromMany(start, enclosureFraction, 60, 500, random);
  report("enclosures", reached);
  EXPECT_GE(reached, 0.05);
}

} // namespace
} // namespace pcl_bsh

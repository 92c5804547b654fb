// SPDX-License-Identifier: BSD-3-Clause
// Attacks on what floats say of two triangles, judged in exact arithmetic, on every instruction set.
#include <pcl_bsh/geometry/triangle/flat_triangle.h>
#include <pcl_bsh/geometry/triangle/triangle_distance.h>

#include "kernels.h"
#include "support/attack.h"
#include "support/climb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

const TriangleDistance distance(Eigen::Isometry3d::Identity(), Eigen::Isometry3d::Identity());

/// Two triangles, of eighteen numbers rounded to floats: the one that is laid flat, then the one in a lane.
struct Pair {
  explicit Pair(const Numbers& n)
  {
    for (std::size_t i = 0; i < 9; ++i) {
      laid[i / 3][i % 3] = static_cast<double>(floatOf(n[i]));
      corners[i] = floatOf(n[9 + i]);
      other[i / 3][i % 3] = static_cast<double>(corners[i]);
    }
    flat = flatten<float>(laid);
  }

  bool isApart(float reach) const { return test::comparePair(flat, corners, reach, -1.0f).apart; }

  /// The largest reach beyond which the kernel takes them to be apart; below 0: not even that of 0.
  double largestReach() const
  {
    if (!isApart(0.0f)) return -1.0;
    float low = 0.0f, high = 4.0f * static_cast<float>(distance.distance(laid, other)) + 1.0f;
    if (isApart(high)) return static_cast<double>(high);
    for (int step = 0; step < 40; ++step) {
      const float middle = low + (high - low) / 2;
      (isApart(middle) ? low : high) = middle;
    }
    return static_cast<double>(low);
  }

  Triangle3 laid, other;
  float corners[9];
  FlatTriangle<float> flat;
};

/// By how much the kernel exceeds what it would say without any rounding, as a part of what it leaves for that.
double apartFraction(const Numbers& n)
{
  const Pair pair(n);
  double farthest = 0.0;
  for (const Point3& corner : pair.other) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) sum += std::abs(corner[k] - double{pair.flat.origin[k]});
    farthest = std::max(farthest, sum);
  }
  const double truth = distance.distance(pair.laid, pair.other), reach = pair.largestReach();
  if (reach < 0.0) return 0.0;
  const double left = kTrianglePairUnits * kFloatUnit * (farthest + double{pair.flat.length}) +
                      double{kTrianglePairMargin} * reach + double{pair.flat.error};
  return 1.0 - (truth + double{pair.flat.error} - reach) / left;
}

Numbers startOf(Random& random)
{
  Numbers n(18);
  for (double& x : n) x = static_cast<double>(floatOf(suspect(random, 3)));
  const double off = std::ldexp(1.0, -random.integer(0, 12));
  switch (random.integer(0, 4)) {
  case 0: // the same, a little beside
    for (std::size_t i = 0; i < 9; ++i) n[9 + i] = n[i] + (i % 3 == 2 ? off : 0.0);
    break;
  case 1: // needles
    for (std::size_t k = 0; k < 3; ++k) {
      n[6 + k] = n[k] + std::ldexp(suspect(random, 3), -16);
      n[15 + k] = n[9 + k] + std::ldexp(suspect(random, 3), -16);
    }
    break;
  case 2: // facing planes
    for (std::size_t i = 0; i < 18; i += 3) n[i] = i < 9 ? 1.0 : 1.0 + off;
    break;
  default:
    break;
  }
  return n;
}

TEST(TrianglePairAttack, Apart)
{
  onEveryTarget([](const std::string& target) {
    Random random(511);
    const double reached = test::climbFromMany([&] { return startOf(random); }, apartFraction, 30, 400, random);
    report("pairs of triangles apart, " + target, reached);
    EXPECT_GE(reached, 0.02) << "most of what is left is for needles that no start has at their worst";
  });
}

/// Near-ties of all kinds: the reach is the exact distance, or a few floats beside it.
TEST(TrianglePairAttack, NoVerdictIsWrong)
{
  onEveryTarget([](const std::string& target) {
    Random random(512);
    int apart = 0, within = 0;
    for (int round = 0; round < 20000; ++round) {
      Numbers n = startOf(random);
      if (random.chance(0.3)) // a lattice
        for (double& x : n) x = std::round(2 * x);
      if (random.chance(0.1)) // a segment, or a point
        for (std::size_t k = 0; k < 3; ++k) n[12 + k] = n[9 + k], n[15 + k] = random.chance(0.5) ? n[9 + k] : n[15 + k];
      const Pair pair(n);
      const double truth = distance.distance(pair.laid, pair.other), error = double{pair.flat.error};
      const double share = random.pick({0.0, 1e-7, -1e-7, 1e-5, -1e-5, 1e-3, -1e-3});
      const float reach = std::max(0.0f, floatOf(truth * (1.0 + share)));
      const float sure_square = floatOf(truth * truth * (1.0 + share));
      const test::PairVerdict found = test::comparePair(pair.flat, pair.corners, reach, sure_square);
      ASSERT_FALSE(found.apart && !(truth > double{reach} - error)) << target;
      if (found.within) {
        const double root = std::sqrt(double{sure_square});
        ASSERT_LE(truth * (1.0 - kFlatShare - kLengthError), root + error) << target;
      }
      apart += found.apart ? 1 : 0;
      within += found.within ? 1 : 0;
    }
    EXPECT_GT(apart, 1000);
    EXPECT_GT(within, 1000);
  });
}

TEST(TrianglePairAttack, ClaimsNothingOutOfRange)
{
  const Numbers far = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0.25, 0.25, 8, 2, 1, 8, 1, 2, 8};
  const Pair pair(far);
  EXPECT_TRUE(pair.isApart(7.9f));
  EXPECT_FALSE(pair.isApart(8.0f)) << "a tie is not apart";
  EXPECT_FALSE(pair.isApart(std::numeric_limits<float>::infinity()));
  float corners[9];
  std::copy(pair.corners, pair.corners + 9, corners);
  for (const float x : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    corners[4] = x;
    EXPECT_FALSE(test::comparePair(pair.flat, corners, std::numeric_limits<float>::infinity(), -1.0f).apart);
    EXPECT_FALSE(test::comparePair(pair.flat, corners, 1.0f, -1.0f).within);
  }
  // Differences whose squares leave the range of floats.
  Numbers tiny = far;
  for (double& x : tiny) x = std::ldexp(x, -70);
  EXPECT_FALSE(Pair(tiny).isApart(std::ldexp(9.0f, -70)));
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/geometry/relative_frame.h>

#include "support/random.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

namespace pcl_bsh {
namespace {

using Rational = boost::multiprecision::cpp_rational;

/// Rotations are seldom exact in doubles, by as much as rounding makes of computing how much.
TEST(RelativeRotation, SkewIsNoLessThanThatOfExactNumbers)
{
  test::Random random(3);
  for (int i = 0; i < 500; ++i) {
    Eigen::Isometry3d pose = random.pose(1.0);
    if (i % 2 == 0) pose.linear() *= 1.0 + random.uniform(-1e-7, 1e-7); // as far off as poses may be
    const RelativeRotation rotation(random.pose(1.0), pose);
    for (int row = 0; row < 3; ++row) {
      Rational sum = 0;
      for (int column = 0; column < 3; ++column) {
        Rational product = row == column ? -1 : 0;
        for (int k = 0; k < 3; ++k) product += Rational(pose(k, row)) * Rational(pose(k, column));
        sum += abs(product);
      }
      EXPECT_LE(sum, Rational(rotation.skew)) << "row " << row << " of rotation " << i;
    }
  }
}

} // namespace
} // namespace pcl_bsh

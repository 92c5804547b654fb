// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/brute_force/brute_force.h>
#include <pcl_bsh/distances/point_distances.h>

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace pcl_bsh::test {

/// Bit for bit the same distances, points and greatest of all.
inline void expectSame(const PointDistances& found, const PointDistances& truth)
{
  ASSERT_EQ(found.distance.size(), truth.distance.size());
  EXPECT_EQ(found.closest_point, truth.closest_point);
  for (std::size_t i = 0; i < truth.distance.size(); ++i) {
    const double x = found.distance[i], y = truth.distance[i];
    ASSERT_TRUE((std::isnan(x) && std::isnan(y)) || x == y)
        << "record " << i << ": " << x << ", nearest " << found.closest_point[i] << "; not " << y << ", nearest "
        << truth.closest_point[i];
  }
  EXPECT_EQ(found.measured, truth.measured);
  EXPECT_EQ(found.greatest_pair, truth.greatest_pair);
  EXPECT_TRUE(found.greatest == truth.greatest || (std::isnan(found.greatest) && std::isnan(truth.greatest)));
  EXPECT_EQ(found.undecided, 0u);
}

} // namespace pcl_bsh::test

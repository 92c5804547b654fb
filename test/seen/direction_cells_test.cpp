// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/seen/direction_cells.h>

#include "support/random.h"

#include <gtest/gtest.h>

#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;

TEST(FacePlace, IsWhereTheDirectionMeetsTheCube)
{
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    Eigen::Vector3d direction{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (i % 3 == 0) direction[random.integer(0, 2)] = 0.0;
    const FacePlace place = facePlaceOf(direction);
    EXPECT_LT(place.face, kCubeFaces);
    EXPECT_LE(std::max(std::abs(place.u), std::abs(place.w)), 1.0);
    EXPECT_TRUE(directionOf(place).normalized().isApprox(direction.normalized(), 1e-14)) << direction.transpose();
  }
}

/// Cells of all sizes, and cones beside and over their edges and corners, against directions of the cells.
TEST(Cone, MeetsTheCellsThatItSharesADirectionWith)
{
  constexpr int kSteps = 40;
  Random random(2);
  int met = 0, apart = 0, by_an_edge = 0;
  for (int i = 0; i < 3000; ++i) {
    const unsigned level = static_cast<unsigned>(random.integer(0, 4));
    const int last = (1 << level) - 1;
    const DirectionCell cell{static_cast<std::size_t>(random.integer(0, 5)), level,
                             static_cast<std::uint32_t>(random.integer(0, last)),
                             static_cast<std::uint32_t>(random.integer(0, last))};
    const double edge = std::ldexp(2.0, -static_cast<int>(level)), half_angle = edge * random.uniform(0.02, 0.7);
    const double u0 = -1.0 + edge * cell.u, w0 = -1.0 + edge * cell.w;
    const Eigen::Vector3d axis =
        directionOf({cell.face, u0 + edge * random.uniform(-0.7, 1.7), w0 + edge * random.uniform(-0.7, 1.7)})
            .normalized();
    double nearest = 4.0;
    for (int u = 0; u <= kSteps; ++u)
      for (int w = 0; w <= kSteps; ++w) {
        const Eigen::Vector3d d = directionOf({cell.face, u0 + edge * u / kSteps, w0 + edge * w / kSteps}).normalized();
        nearest = std::min(nearest, 2.0 * std::asin(0.5 * (d - axis).norm()));
      }
    const Cone cone(axis, half_angle);
    if (nearest <= half_angle) {
      EXPECT_TRUE(cone.meets(cell)) << i;
      EXPECT_FALSE(cone.isApartFrom(CellSphere(cell))) << i;
      ++met;
      bool has_corner = false;
      for (const Eigen::Vector3d& corner : cell.corners())
        has_corner = has_corner || corner.normalized().dot(axis) >= std::cos(half_angle);
      const FacePlace place = facePlaceOf(axis);
      const bool holds_axis = place.face == cell.face && std::abs(place.u - u0 - 0.5 * edge) <= 0.5 * edge &&
                              std::abs(place.w - w0 - 0.5 * edge) <= 0.5 * edge;
      by_an_edge += !has_corner && !holds_axis;
    }
    else if (nearest > half_angle + edge / kSteps) {
      EXPECT_FALSE(cone.meets(cell)) << i;
      ++apart;
    }
  }
  EXPECT_GT(met, 500);
  EXPECT_GT(apart, 500);
  EXPECT_GT(by_an_edge, 50);
}

/// A beam within the angle of a cell's middle is within 1.2 angles of all of the cell.
TEST(DirectionCell, OfTheLastLevelIsAQuarterOfTheAngleWide)
{
  for (const double angle : {1e-4, 0.01, 0.1, 0.25}) {
    const unsigned level = cellLevels(angle);
    EXPECT_LE(std::ldexp(2.0, -static_cast<int>(level)), 0.25 * angle * (1 + 1e-12)) << angle;
    EXPECT_TRUE(level == 6 || std::ldexp(2.0, 1 - static_cast<int>(level)) > 0.25 * angle) << angle;
  }
}

} // namespace
} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/seen/hole_map.h>

#include "support/random_clouds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace pcl_bsh {
namespace {

using test::Random;

/// Even beams everywhere, except within an angle of one direction: in the middle of a face, over an edge, over a
/// corner. Cones beside the hole and over it, narrow and of up to more than half a turn.
TEST(HoleMap, MeetsConesThatReachIntoAHole)
{
  constexpr double kHole = 0.5;
  constexpr int kSteps = 100; // of a face
  std::size_t reached = 0, apart = 0;
  const std::vector<Eigen::Vector3d> middles = {{1, 0, 0},    {0, -1, 0.3}, {1, 1, 0},
                                                {0, -1, 1.1}, {-1, 1, 0.9}, {1, -1, 1}};
  for (const Eigen::Vector3d& at : middles) {
    SCOPED_TRACE(at.transpose());
    const Eigen::Vector3d middle = at.normalized();
    std::vector<Point3> ends;
    for (std::size_t face = 0; face < kCubeFaces; ++face)
      for (int u = 0; u < kSteps; ++u)
        for (int w = 0; w < kSteps; ++w) {
          const Eigen::Vector3d end = directionOf({face, (2 * u + 1.0) / kSteps - 1.0, (2 * w + 1.0) / kSteps - 1.0});
          if (end.normalized().dot(middle) < std::cos(kHole)) ends.push_back({end.x(), end.y(), end.z()});
        }
    const test::Cloud cloud(ends);
    ScanBeams scan;
    scan.returns = cloud.view();
    const BeamTree beams(scan);
    for (const double angle : {0.06, 0.25}) {
      const double edge = 1.25 * angle; // how far off the hole's edge may be
      const HoleMap holes(beams, angle, 1);
      EXPECT_TRUE(holes.hasAny());
      Random random(7);
      for (int i = 0; i < 4000; ++i) {
        const double half_angle = random.chance(0.8) ? random.uniform(0.0, 0.25) : random.uniform(0.2, 2.0);
        const double off = std::clamp(kHole + half_angle + random.uniform(-0.6, 0.6), 0.0, 3.1);
        const Eigen::Vector3d axis = Eigen::AngleAxisd(random.uniform(0, 7), middle) *
                                     (Eigen::AngleAxisd(off, middle.unitOrthogonal()) * middle);
        std::uint64_t tested = 0;
        const bool meets = holes.meets(Cone(axis, half_angle), tested);
        EXPECT_GT(tested, 0u);
        if (off < kHole + half_angle - edge) {
          EXPECT_TRUE(meets) << axis.transpose() << ", " << half_angle;
          ++reached;
        }
        else if (off > kHole + half_angle + edge) {
          EXPECT_FALSE(meets) << axis.transpose() << ", " << half_angle;
          ++apart;
        }
      }
    }
  }
  EXPECT_GT(reached, 10000u);
  EXPECT_GT(apart, 10000u);
}

TEST(HoleMap, HasNoneWhereNoAngleIsKnown)
{
  const test::Cloud cloud({{1, 0, 0}});
  ScanBeams scan;
  scan.returns = cloud.view();
  const BeamTree beams(scan);
  const HoleMap holes(beams, 0.0, 1);
  std::uint64_t tested = 0;
  EXPECT_FALSE(holes.hasAny());
  EXPECT_FALSE(holes.meets(Cone(Eigen::Vector3d::UnitX(), 0.1), tested));
}

} // namespace
} // namespace pcl_bsh

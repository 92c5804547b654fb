// SPDX-License-Identifier: BSD-3-Clause
// Obstacles with faces are drawn as surfaces, and what collides of them is coloured.
#include "pixels.h"

#include <viewer/clouds_content.h>

#include <gmock/gmock.h>

namespace pcl_bsh::view {
namespace {

/// A floor of points, and a crate of eight corners whose bottom stands over it.
class SurfaceViewTest : public ViewTest {
protected:
  Options options(bool vertices_only) const
  {
    std::ostringstream crate;
    crate << "OFF\n8 6 0\n";
    for (int k = 0; k < 8; ++k) crate << (k & 1) * 2 - 1 << ' ' << (k >> 1 & 1) * 2 - 1 << ' ' << (k >> 2) * 2 << '\n';
    crate << "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
    std::ostringstream scan;
    for (int i = -60; i <= 60; ++i)
      for (int j = -60; j <= 60; ++j) scan << 0.033 * i << ' ' << 0.033 * j << " -0.05\n";
    Options made;
    made.clouds = {folder.write("scan.xyz", scan.str())};
    made.model = folder.write("crate.off", crate.str());
    made.clearance = 0.1;
    made.surface.tolerance = 0.05;
    made.surface.vertices_only = vertices_only;
    made.width = 500;
    made.height = 400;
    made.threads = 1;
    made.camera.kind = Camera::Kind::front;
    return made;
  }
};

TEST_F(SurfaceViewTest, ACrateIsDrawnWithItsFaces)
{
  OffscreenView surface(options(false)), vertices(options(true));
  const double middle[3] = {0.0, -1.0, 1.0}; // of the face towards the camera
  const auto [x, y] = surface.seen(middle);
  EXPECT_GT(surface.draw().countNear(obstacle_color, x, y, 30), 1000u);
  EXPECT_EQ(vertices.draw().countNear(obstacle_color, x, y, 30), 0u);
}

TEST_F(SurfaceViewTest, WhatCollidesOfItStandsOut)
{
  const CloudsContent content(options(false));
  const StepCollisions found = content.collisions(0);
  const CloudsContent corners(options(true));
  EXPECT_GT(found.colliding, 3000u) << "all of the floor below the crate";
  EXPECT_LT(corners.collisions(0).colliding, 200u);
  const PointsView& balls = content.viewedClouds()[1].points();
  ASSERT_EQ(found.flags[1].size(), balls.count);
  for (std::uint32_t i = 0; i < balls.count; ++i)
    if (found.flags[1][i] == 1)
      ASSERT_LE(balls.point(i)[2], 0.05 + balls.radius(i)) << i;
    else
      ASSERT_GT(balls.point(i)[2], 0.001) << i;
  Options seen_from_below = options(false);
  seen_from_below.camera = {Camera::Kind::given, {4, -5, -1}, {0, 0, 0.5}, {0, 0, 1}};
  seen_from_below.clouds = {folder.write("one.xyz", "0 0 -0.05\n0.1 0 -0.05\n3 3 3\n")};
  EXPECT_GT(OffscreenView(seen_from_below).draw().count(obstacle_colliding_color, 60), 20u);
}

} // namespace
} // namespace pcl_bsh::view

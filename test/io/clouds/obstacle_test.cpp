// SPDX-License-Identifier: BSD-3-Clause
// Obstacles from files: points stay points, faces become surfaces.
#include "samples.h"

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/search/cloud_view.h>

#include <gmock/gmock.h>

#include <cmath>

namespace pcl_bsh::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A crate of eight corners, two metres wide.
const std::string crate = "OFF\n8 6 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n0 0 2\n2 0 2\n2 2 2\n0 2 2\n"
                          "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

std::string failureOf(const std::filesystem::path& path, const SurfaceSettings& settings, double clearance)
{
  try {
    readObstacle(path, settings, clearance);
  }
  catch (const files::FileError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Obstacle, IsASurfaceWhereTheFileHasFaces)
{
  const TemporaryFolder folder;
  const Obstacle surface = readObstacle(folder.write("crate.off", crate), {}, 0.5);
  ASSERT_TRUE(surface.isSurface());
  EXPECT_EQ(surface.tolerance(), 0.05);
  EXPECT_EQ(surface.triangles()->size(), 12u);
  EXPECT_EQ(surface.points().width, 8u);
  EXPECT_STREQ(surface.partName(), "triangle");
  EXPECT_TRUE(surface.remarks().empty());
  const PointsView balls = surface.view();
  EXPECT_GT(balls.count, 24 / (2.6 * 0.0025));
  ASSERT_NE(balls.radii, nullptr);
  for (std::uint32_t i = 0; i < balls.count; ++i) {
    EXPECT_LT(surface.partOf(i), 12u);
    EXPECT_LE(balls.radii[i], 0.05f);
  }
}

TEST(Obstacle, IsItsPointsWhereThereAreNoFacesOrNoneAreWanted)
{
  const TemporaryFolder folder;
  const Obstacle cloud = readObstacle(folder.write("a.xyz", "1 2 3\n4 5 6\n"), {}, 0.5);
  const Obstacle corners = readObstacle(folder.write("crate.off", crate), {std::nullopt, true}, 0.5);
  for (const Obstacle* points : {&cloud, &corners}) {
    EXPECT_FALSE(points->isSurface());
    EXPECT_EQ(points->view().radii, nullptr);
    EXPECT_EQ(points->partOf(1), 1u);
    EXPECT_STREQ(points->partName(), "point");
    EXPECT_EQ(points->tolerance(), 0.0);
  }
  EXPECT_EQ(corners.view().count, 8u);
}

TEST(Obstacle, KeepsWhatItsViewShows)
{
  const TemporaryFolder folder;
  PointsView view;
  {
    const Obstacle surface = readObstacle(folder.write("crate.off", crate), {0.3, false}, 0.0);
    view = surface.view();
  }
  EXPECT_LT(view.point(static_cast<std::uint32_t>(view.count - 1))[0], 2.1); // read after free is seen by sanitizers
}

TEST(Obstacle, TakesATenthOfTheClearanceElseOfTheSize)
{
  const TemporaryFolder folder;
  const auto path = folder.write("triangle.obj", "v 0 0 0\nv 3 0 0\nv 0 0.0004 0\nf 1 2 3\n");
  EXPECT_DOUBLE_EQ(readObstacle(path, {}, 0.01).tolerance(), 0.001);
  EXPECT_DOUBLE_EQ(readObstacle(path, {}, 0.0).tolerance(), std::hypot(3.0, 0.0004) / 10000);
  EXPECT_EQ(readObstacle(path, {0.02, false}, 0.01).tolerance(), 0.02);
}

TEST(Obstacle, TakesMoreWhereThatWouldTakeTooManyBalls)
{
  const TemporaryFolder folder;
  const Mesh mesh = readMesh(folder.write("crate.off", crate));
  const UsualTolerance usual = usualTolerance(viewOf(mesh.vertices), mesh.triangles, 0.0);
  EXPECT_DOUBLE_EQ(usual.wanted, std::sqrt(12.0) / 10000);
  EXPECT_NEAR(24 / (1.5 * std::sqrt(3.0) * usual.tolerance * usual.tolerance), 5e4 / 1.3, 1.0);
  const auto far = folder.write("far.obj", "v 513449.7 5402650.2 300\nv 513449.71 5402650.2 300\n"
                                           "v 513449.7 5402650.2 300\nf 1 2 3\n");
  EXPECT_THAT(readObstacle(far, {}, 1e-10).remarks(), ElementsAre(HasSubstr("since one of 1e-11 would take")));
}

TEST(Obstacle, NamesTheCornerThatIsNoPlaceNotATolerance)
{
  const TemporaryFolder folder;
  const auto path = folder.write("hole.off", "OFF\n3 1 0\n0 0 0\n1 0 0\nnan 1 0\n3 0 1 2\n");
  for (const double clearance : {0.0, 0.1}) {
    try {
      readObstacle(path, {}, clearance);
      ADD_FAILURE() << clearance;
    }
    catch (const std::exception& error) {
      EXPECT_THAT(error.what(), HasSubstr("vertex 2 of triangle 0 is not finite"));
    }
  }
}

TEST(Obstacle, CoversWhatHasNoSizeAndWhatIsFarAway)
{
  const TemporaryFolder folder;
  const auto point = folder.write("point.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n");
  const auto far = folder.write("far.obj", "v 513449.7 5402650.2 300\nv 513449.70001 5402650.2 300\n"
                                           "v 513449.7 5402650.20001 300\nf 1 2 3\n");
  for (const double clearance : {0.0, 1e-12, 0.1}) {
    EXPECT_GE(readObstacle(point, {}, clearance).view().count, 1u) << clearance;
    EXPECT_GE(readObstacle(far, {}, clearance).view().count, 1u) << clearance;
  }
}

TEST(Obstacle, TellsOfVerticesWithoutFaces)
{
  const TemporaryFolder folder;
  const auto path = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nv 6 6 6\nf 1 2 3\n");
  const Obstacle surface = readObstacle(path, {0.1, false}, 0.0);
  EXPECT_EQ(surface.cover()->loose, 2U);
}

TEST(Obstacle, NamesTheFileWhereItCannotBeCovered)
{
  const TemporaryFolder folder;
  const auto broken = folder.write("broken.off", "OFF\n3 1 0\n0 0 0\n1 0 0\nnan 1 0\n3 0 1 2\n");
  EXPECT_THAT(failureOf(broken, {}, 0.1),
              testing::AllOf(HasSubstr("broken.off: vertex 2 of triangle 0 is not finite")));
  const auto path = folder.write("crate.off", crate);
  EXPECT_THAT(failureOf(path, {1e-14, false}, 0.1), HasSubstr("crate.off: tolerance 1e-14 is too small"));
  EXPECT_THAT(failureOf(path, {0.0, false}, 0.1), HasSubstr("tolerance 0 is not a length above 0"));
}

} // namespace
} // namespace pcl_bsh::io

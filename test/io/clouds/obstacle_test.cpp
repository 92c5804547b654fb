// SPDX-License-Identifier: BSD-3-Clause
// Obstacles from files: points stay points, faces become surfaces.
#include "samples.h"

#include <pcl_bsh/hierarchy/sphere_hierarchy.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/files/file_error.h>

#include <gmock/gmock.h>

namespace pcl_bsh::io {
namespace {

using testing::HasSubstr;

/// A crate of eight corners, two metres wide.
const std::string crate = "OFF\n8 6 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n0 0 2\n2 0 2\n2 2 2\n0 2 2\n"
                          "4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

TEST(Obstacle, IsASurfaceWhereTheFileHasFaces)
{
  const TemporaryFolder folder;
  const Obstacle surface = readObstacle(folder.write("crate.off", crate), {});
  ASSERT_TRUE(surface.isSurface());
  EXPECT_EQ(surface.triangles()->size(), 12u);
  EXPECT_EQ(surface.points().width, 8u);
  EXPECT_STREQ(surface.partName(), "triangle");
  EXPECT_TRUE(surface.remarks().empty());
  EXPECT_EQ(promiseOf(surface, true), "the obstacle is a solid of 12 triangles: what it encloses is part of it");
  EXPECT_EQ(promiseOf(surface, false),
            "the obstacle is a surface of 12 triangles: what it encloses is no part of it without `solid`");
  const PointsView& view = surface.view();
  ASSERT_NE(view.triangles, nullptr);
  EXPECT_EQ(view.count, 12u);
  for (std::uint32_t i = 0; i < view.count; ++i) EXPECT_EQ(view.triangles->cornersOf(i), (*surface.triangles())[i]);
  EXPECT_TRUE(surface.shape("crate").isSurface());
}

TEST(Obstacle, IsItsPointsWhereThereAreNoFacesOrNoneAreWanted)
{
  const TemporaryFolder folder;
  const Obstacle cloud = readObstacle(folder.write("a.xyz", "1 2 3\n4 5 6\n"), {});
  const Obstacle corners = readObstacle(folder.write("crate.off", crate), {.vertices_only = true});
  for (const Obstacle* points : {&cloud, &corners}) {
    EXPECT_FALSE(points->isSurface());
    EXPECT_EQ(points->view().triangles, nullptr);
    EXPECT_STREQ(points->partName(), "point");
  }
  EXPECT_EQ(corners.view().count, 8u);
}

TEST(Obstacle, KeepsWhatItsViewShows)
{
  const TemporaryFolder folder;
  PointsView view;
  {
    const Obstacle surface = readObstacle(folder.write("crate.off", crate), {});
    view = surface.view();
  }
  EXPECT_LT(view.triangles->triangle(11)[2][0], 2.1); // read after free is seen by sanitizers
}

TEST(Obstacle, TrianglesThatAreNotFiniteAreLeftOut)
{
  const TemporaryFolder folder;
  const auto path = folder.write("hole.off", "OFF\n4 2 0\n0 0 0\n1 0 0\nnan 1 0\n0 1 0\n3 0 1 2\n3 0 1 3\n");
  const Obstacle surface = readObstacle(path, {});
  EXPECT_EQ(SphereHierarchy(surface.view()).size(), 1u);
  EXPECT_EQ(surface.view().count, 2u);
}

TEST(Obstacle, NamesTheFileOfWhatIsNoSurface)
{
  const TemporaryFolder folder;
  const auto path = folder.write("vast.off", "OFF\n3 1 0\n0 0 0\n1e300 0 0\n0 1e300 0\n3 0 1 2\n");
  EXPECT_THAT([&] { readObstacle(path, {}); },
              testing::ThrowsMessage<files::FileError>(HasSubstr("vast.off: triangle 0 is too large for a float32")));
}

TEST(Obstacle, TellsItsCallerTheFactsToo)
{
  const TemporaryFolder folder;
  CloudFacts facts;
  const auto path = folder.write("a.xyz", "1 5 7 9\n2 6 8 0\n3 1 1 1\n");
  const Obstacle told = readObstacle(path, {}, {}, &facts);
  EXPECT_EQ(facts.remarks.size(), 1u);
  EXPECT_EQ(told.remarks(), facts.remarks);
  EXPECT_EQ(readObstacle(path, {}).remarks(), facts.remarks);
  EXPECT_EQ(told.cloud()->width, 3u);
  EXPECT_EQ(&told.points(), told.cloud().get());
}

/// Where a beginning tells it, the rest is not read: these end too early.
TEST(Obstacle, KnowsWhetherAFileHasFaces)
{
  const TemporaryFolder folder;
  const auto facesIn = [&](const char* name, const std::string& text) { return hasFaces(folder.write(name, text)); };
  EXPECT_TRUE(facesIn("a.off", crate));
  EXPECT_FALSE(facesIn("a.off", "OFF\n1 0 0\n1 2 3\n"));
  EXPECT_TRUE(facesIn("a.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
  EXPECT_FALSE(facesIn("a.obj", "v 0 0 0\n"));
  EXPECT_TRUE(facesIn("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n"
                               "endloop\nendfacet\nendsolid\n"));
  EXPECT_FALSE(facesIn("a.stl", "solid\nendsolid\n"));
  EXPECT_FALSE(facesIn("a.xyz", "nothing"));
  const std::string begin = "ply\nformat ascii 1.0\n", vertices = "element vertex 3\nproperty float x\n"
                                                                  "property float y\nproperty float z\n";
  EXPECT_FALSE(facesIn("a.ply", begin + vertices + "end_header\n0 0 0\n"));
  const std::string rows = "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const std::string element : {"face", "tristrips"}) {
    const std::string of_faces = vertices + "element " + element + " 1\nproperty list uchar int vertex_indices\n";
    EXPECT_TRUE(facesIn("a.ply", begin + of_faces + rows)) << element;
    EXPECT_THROW(facesIn("a.ply", begin + of_faces + "end_header\n0 0 0\n"), files::FileError) << "is read";
    std::string comments;
    while (comments.size() < 70000) comments += "comment more than one reads at first\n";
    EXPECT_TRUE(facesIn("a.ply", begin + comments + of_faces + rows)) << "a long header: " << element;
  }
}

} // namespace
} // namespace pcl_bsh::io

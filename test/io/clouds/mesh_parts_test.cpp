// SPDX-License-Identifier: BSD-3-Clause
// Names of a mesh's parts, and each part alone.
#include "samples.h"

#include <pcl_bsh/io/clouds/meshes/mesh_parts.h>
#include <pcl_bsh/io/files/file_error.h>

#include <gmock/gmock.h>

namespace pcl_bsh::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 6 1 0\n";

class MeshPartsOfFiles : public testing::Test {
protected:
  MeshParts parts(const std::string& name, const std::string& text) { return readMeshParts(folder.write(name, text)); }

  std::string refusal(const std::string& name, const std::string& text)
  {
    try {
      parts(name, text);
    }
    catch (const files::FileError& error) {
      return error.what();
    }
    return "nothing is refused";
  }

  const TemporaryFolder folder;
};

TEST_F(MeshPartsOfFiles, AreObjectsOfAnObj)
{
  const std::string text = vertices + "o a plate\nf 1 2 3 4\ng left\nf 1 2 \\\n3\no flag # red\nf 5/1 6/2 7//3\n";
  const MeshParts found = parts("a.obj", text);
  EXPECT_THAT(found.names, ElementsAre("a plate", "flag"));
  EXPECT_THAT(found.part_of, ElementsAre(0, 0, 0, 1));
  EXPECT_THAT(found.remarks, IsEmpty());
  const Mesh whole = readMesh(folder / "a.obj");
  const std::vector<Mesh> meshes = meshesOf(found, whole.vertices, whole.triangles);
  ASSERT_EQ(meshes.size(), 2u);
  const Mesh &plate = meshes[0], &flag = meshes[1];
  EXPECT_EQ(plate.vertices.width, 4u);
  EXPECT_EQ(plate.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
  EXPECT_EQ(flag.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  ASSERT_EQ(flag.vertices.width, 3u);
  EXPECT_EQ(flag.vertices.data.size(), 3u * whole.vertices.point_step);
  EXPECT_EQ(valueOf(flag.vertices, 0, "x"), 5);
  EXPECT_EQ(valueOf(flag.vertices, 2, "y"), 1);
}

TEST_F(MeshPartsOfFiles, AreGroupsOfAnObjWithoutObjects)
{
  const MeshParts found =
      parts("a.obj", vertices + "f 1 2 3\ng a\nf 1 2 3\nf 1 2\ng b\nf 5 6 7\ng c\ng\nf 1 2 3\ng a\nf 1 3 4\n");
  EXPECT_THAT(found.names, ElementsAre("a", "b", "default"));
  ASSERT_EQ(found.part_of.size(), 5u);
  EXPECT_EQ(found.part_of[1], 0u);
  EXPECT_EQ(found.part_of[2], 1u);
  EXPECT_EQ(found.part_of[4], 0u) << "a group goes on";
  EXPECT_THAT(found.remarks, ElementsAre("1 part without faces, 'c' first: left out",
                                         "1 triangle before the first part's name: left out"));
  const Mesh whole = readMesh(folder / "a.obj");
  EXPECT_EQ(meshesOf(found, whole.vertices, whole.triangles)[0].triangles.size(), 2u);
}

TEST_F(MeshPartsOfFiles, AreSolidsOfAnStl)
{
  const std::string facet =
      "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const MeshParts found = parts("a.stl", "solid big pump\n" + facet + facet + "endsolid\nsolid pipe\n" + facet +
                                             "endsolid pipe\nsolid none\nendsolid none\n");
  EXPECT_THAT(found.names, ElementsAre("big pump", "pipe"));
  EXPECT_THAT(found.part_of, ElementsAre(0, 0, 1));
  EXPECT_THAT(found.remarks, ElementsAre(HasSubstr("'none' first")));
}

TEST_F(MeshPartsOfFiles, RefuseWhatHasNoNames)
{
  EXPECT_THAT(refusal("a.obj", vertices + "f 1 2 3\n"), HasSubstr("a.obj: has no parts with names: give it objects"));
  EXPECT_THAT(refusal("a.obj", vertices + "o\nf 1 2 3\n"), HasSubstr("has a part without a name: give it one"));
  EXPECT_THAT(refusal("a.obj", vertices + "o a\nf 1 2 3\no b\no a\n"), HasSubstr("names two parts 'a'"));
  EXPECT_THAT(refusal("a.stl", std::string(84, '\0')), HasSubstr("is a binary STL, whose parts have no names"));
  EXPECT_THAT(refusal("a.ply", "ply\n"), HasSubstr("a.ply: has no parts with names: give an .obj"));
}

TEST_F(MeshPartsOfFiles, AreThoseOfTheFileThatWasRead)
{
  const MeshParts found = parts("a.obj", vertices + "o a\nf 1 2 3\n");
  folder.write("a.obj", vertices + "o a\nf 1 2 3\nf 1 2 3\n");
  const Mesh whole = readMesh(folder / "a.obj");
  EXPECT_THROW(meshesOf(found, whole.vertices, whole.triangles), files::FileError);
}

} // namespace
} // namespace pcl_bsh::io

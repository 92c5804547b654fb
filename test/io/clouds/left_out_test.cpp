// SPDX-License-Identifier: BSD-3-Clause
// Files that say more than points and faces: what is not compared is counted, and corners alone are no shape.
#include "samples.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace pcl_bsh::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
const std::string ply_vertices = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string ply_rows = "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";

class LeftOut : public testing::Test {
protected:
  std::vector<std::string> remarksOf(const std::string& name, const std::string& text) const
  {
    CloudFacts facts;
    readMesh(folder.write(name, text), &facts);
    return facts.remarks;
  }

  std::string refusalOf(const std::string& name, const std::string& text, bool vertices_only = false) const
  {
    try {
      readObstacle(folder.write(name, text), {vertices_only});
      return "read";
    }
    catch (const files::FileError& error) {
      return error.what();
    }
  }

  TemporaryFolder folder;
};

TEST_F(LeftOut, LinesAndFreeFormsOfObjAreCountedBesideFaces)
{
  const std::string face = corners + "f 1 2 3\n";
  EXPECT_THAT(remarksOf("a.obj", face), IsEmpty());
  EXPECT_THAT(remarksOf("a.obj", face + "l 1 4\n"), ElementsAre("its 1 line (l) is not compared"));
  EXPECT_THAT(remarksOf("a.obj", face + "l 1 4 2\nl 2/1 3/1\nl -1 -2\n"),
              ElementsAre("its 3 lines (l) are not compared"));
  EXPECT_THAT(
      remarksOf("a.obj", face + "cstype bspline\ndeg 1 1\ncurv 0 1 1 2\nsurf 0 1 0 1 \\\n1 2 3 4\nparm u 0 1\nend\n"),
      ElementsAre("its 1 free-form curve (curv) and 1 free-form surface (surf) are not compared"));
  EXPECT_THAT(
      remarksOf("a.obj", face + "bzp 1 2 3 4\nbsp 1 2\nbsp 3 4\ncdc 1 2\nl 1 2\n"),
      ElementsAre("its 1 Bezier patch (bzp), 2 B-spline patches (bsp), 1 Cardinal curve (cdc) and 1 line (l) are "
                  "not compared"));
  EXPECT_THAT(remarksOf("a.obj", face + "f 1 2\nf 3\n"),
              ElementsAre("its 2 faces of fewer than three corners are not compared"));
  EXPECT_THAT(remarksOf("a.obj", face + "call other.obj\n"),
              ElementsAre("its 1 file that it calls (call) is not compared"));
}

TEST_F(LeftOut, ElementsOfPlyAreCountedBesideFaces)
{
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
  const std::string head = "ply\nformat ascii 1.0\n" + ply_vertices + faces;
  EXPECT_THAT(remarksOf("a.ply", head + "element edge 2\nproperty int vertex1\nproperty int vertex2\n" + ply_rows +
                                     "3 0 1 2\n0 3\n1 3\n"),
              ElementsAre("its 2 elements 'edge' are not compared"));
  EXPECT_THAT(
      remarksOf("a.ply", head + "element polyline 1\nproperty list uchar int of\nelement label 3\nproperty int id\n" +
                             ply_rows + "3 0 1 2\n2 0 3\n1\n2\n3\n"),
      ElementsAre("its 1 element 'polyline' and 3 elements 'label' are not compared"));
  EXPECT_THAT(remarksOf("a.ply", head + "element material 1\nproperty int red\nelement edge 0\nproperty int vertex1\n" +
                                     ply_rows + "3 0 1 2\n7\n"),
              IsEmpty());
  std::string many = head;
  for (char c = 'a'; c <= 'z'; ++c) many += std::string("element ") + c + " 2\nproperty uchar v\n";
  many += ply_rows + "3 0 1 2\n";
  for (int i = 0; i < 52; ++i) many += "1\n";
  ASSERT_EQ(remarksOf("a.ply", many).size(), 1U);
  EXPECT_THAT(remarksOf("a.ply", many)[0], HasSubstr("2 elements 'h' and 36 things of other kinds are not compared"));
}

TEST_F(LeftOut, CornersAloneAreRefused)
{
  const std::string points = "ply\nformat ascii 1.0\n" + ply_vertices;
  const std::pair<std::string, std::string> files[] = {
      {"l.obj", corners + "l 1 2\nl 3 4\n"},
      {"s.obj", corners + "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nend\n"},
      {"c.obj", corners + "curv 0 1 1 2 3\n"},
      {"f.obj", corners + "f 1 2\n"},
      {"p.obj", corners + "p 1\nl 1 2\n"},
      {"e.ply", points + "element edge 1\nproperty int vertex1\nproperty int vertex2\n" + ply_rows + "0 1\n"},
      {"w.ply", points + "element wire 1\nproperty list uchar int vertex_indices\n" + ply_rows + "2 0 1\n"},
      {"n.ply", points + "element face 1\nproperty list uchar int corners\n" + ply_rows + "3 0 1 2\n"},
      {"t.ply", points + "element face 1\nproperty list uchar int vertex_indices\n" + ply_rows + "2 0 1\n"},
      {"a.off", "OFF\n2 1 0\n0 0 0\n1 0 0\n2 0 1\n"}};
  for (const auto& [name, text] : files) {
    const std::string refusal = refusalOf(name, text);
    EXPECT_THAT(refusal, HasSubstr("and no faces: nothing but its corners would be compared: give --vertices-only"))
        << name;
    EXPECT_EQ(refusalOf(name, text, true), "read") << name;
    EXPECT_THROW(readMesh(folder / name), files::FileError) << name;
    EXPECT_THROW(hasFaces(folder / name), files::FileError) << name;
    EXPECT_GT(readCloud(folder / name).width, 0U) << name << ": points are asked for";
    EXPECT_FALSE(readMeshOrCorners(folder / name).corners_alone.empty()) << name;
  }
  EXPECT_THAT(refusalOf("l.obj", corners + "l 1 2\nl 3 4\n"), HasSubstr("l.obj: holds 2 lines (l) and no faces"));
}

TEST_F(LeftOut, PointsAreNoCorners)
{
  const std::string points = "ply\nformat ascii 1.0\n" + ply_vertices;
  EXPECT_EQ(refusalOf("a.obj", corners + "p 1 2 3 4\n"), "read");
  EXPECT_EQ(refusalOf("a.obj", corners + "l 1 1\np 2\n"), "read") << "a line of one vertex is a point";
  EXPECT_EQ(refusalOf("a.obj", corners + "f 1\n"), "read");
  EXPECT_EQ(refusalOf("a.off", "OFF\n2 1 0\n0 0 0\n1 0 0\n1 0\n"), "read");
  EXPECT_EQ(refusalOf("a.ply", points + "element range_grid 2\nproperty list uchar int vertex_indices\n" + ply_rows +
                                   "1 0\n0\n"),
            "read");
  EXPECT_EQ(refusalOf("a.ply", points + "element label 1\nproperty int id\n" + ply_rows + "7\n"), "read");
  EXPECT_EQ(refusalOf("a.ply", points + "element face 0\nproperty list uchar int vertex_indices\n" + ply_rows), "read");
  EXPECT_FALSE(hasFaces(folder.write("b.ply", points + "element range_grid 1\nproperty list uchar int v\n" + ply_rows)))
      << "known by its header";
}

} // namespace
} // namespace pcl_bsh::io

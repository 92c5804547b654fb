// SPDX-License-Identifier: BSD-3-Clause
// Faces of mesh files: every way in which formats name corners, and files that lie.
#include "samples.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/meshes/mesh_faces.h>
#include <pcl_bsh/search/cloud_view.h>

#include <gmock/gmock.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::io {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using Corners = std::vector<Triangle>;

std::string failureOf(const fs::path& path)
{
  try {
    readMesh(path);
  }
  catch (const files::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr(path.string()));
    return error.what();
  }
  return "no error";
}

double areaOf(const Mesh& mesh)
{
  const PointsView view = viewOf(mesh.vertices);
  const auto at = [&](std::uint32_t i) {
    const Point3 p = view.point(i);
    return Eigen::Vector3d(p[0], p[1], p[2]);
  };
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += 0.5 * (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).norm();
  return area;
}

std::string binaryStl(const std::vector<std::array<float, 9>>& triangles, const std::string& title = "made")
{
  std::string file = title;
  file.resize(80, ' ');
  const auto count = static_cast<std::uint32_t>(triangles.size());
  file.append(reinterpret_cast<const char*>(&count), sizeof count);
  for (const auto& corners : triangles) {
    file.append(12, '\0');
    file.append(reinterpret_cast<const char*>(corners.data()), sizeof corners);
    file.append(2, '\0');
  }
  return file;
}

const std::string square_ply = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                               "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST(MeshFile, HasNoTrianglesWithoutFaces)
{
  const TemporaryFolder folder;
  const Mesh points = readMesh(folder.write("a.xyz", "1 2 3\n4 5 6\n"));
  EXPECT_EQ(points.vertices.width, 2u);
  EXPECT_TRUE(points.triangles.empty());
  EXPECT_TRUE(readMesh(folder.write("a.obj", "v 1 2 3\np 1\nl 1 1\n")).triangles.empty());
}

TEST(MeshFile, ReadsCornersOfObj)
{
  const TemporaryFolder folder;
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  EXPECT_THAT(readMesh(folder.write("a.obj", vertices + "vt 0 0\nvn 0 0 1\nf 1/1/1 2//1 3/1\n")).triangles,
              ElementsAre(Triangle{0, 1, 2}));
  EXPECT_THAT(readMesh(folder.write("b.obj", vertices + "f -4 -3 -2\nv 9 9 9\nf -1 1 2\n")).triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{4, 0, 1}));
  EXPECT_EQ(areaOf(readMesh(folder.write("c.obj", vertices + "f 1 2 \\\n 3 4 # a square\n"))), 1.0);
  EXPECT_THAT(readMesh(folder.write("d.obj", "f 1 2 3\n" + vertices)).triangles, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_THAT(readMesh(folder.write("e.obj", vertices + "fo 1 2 3\n")).triangles, ElementsAre(Triangle{0, 1, 2}));
}

/// How many directed edges no opposite one cancels.
std::size_t openEdges(const Mesh& mesh)
{
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  std::size_t open = 0;
  for (const auto& [edge, count] : edges)
    if (edge.first != edge.second && edges[{edge.second, edge.first}] != count) ++open;
  return open;
}

TEST(MeshFile, StripsOfPlyAreWoundAlternately)
{
  const TemporaryFolder folder;
  const auto meshOf = [&](const std::string& vertices, const std::vector<std::string>& strips) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex " + std::to_string(std::count(vertices.begin(), vertices.end(), '\n')) +
        "\nproperty float x\nproperty float y\nproperty float z\nelement tristrips " + std::to_string(strips.size()) +
        "\nproperty list int int vertex_indices\nend_header\n" + vertices;
    for (const std::string& strip : strips) text += strip + '\n';
    return readMesh(folder.write("s.ply", text));
  };
  const std::string cube = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n";
  for (const std::vector<std::string>& strips :
       {std::vector<std::string>{"14 0 1 4 5 7 1 3 0 2 4 6 7 2 3"},                     // one strip
        {"29 0 2 1 3 -1 4 5 6 7 -1 0 1 4 5 -1 2 6 3 7 -1 0 4 2 6 -1 1 3 5 7"},          // begun anew by -1
        {"4 0 2 1 3", "4 4 5 6 7", "4 0 1 4 5", "4 2 6 3 7", "4 0 4 2 6", "4 1 3 5 7"}, // a row for each
        {"9 0 2 1 3 -1 4 5 6 7", "10 2 6 3 7 -1 1 3 5 7 -1", "3 0 1 4", "3 4 1 5", "6 -1 -1 0 4 2 6"},
        {"10 0 2 1 3 3 5 5 7 4 6", "4 0 1 4 5", "4 2 6 3 7", "4 0 4 2 6", "4 1 3 5 7"}}) { // without area between
    const Mesh mesh = meshOf(cube, strips);
    EXPECT_EQ(openEdges(mesh), 0u) << strips[0];
    EXPECT_EQ(areaOf(mesh), 6.0) << strips[0];
    double volume = 0; // six times that
    const PointsView view = viewOf(mesh.vertices);
    for (const Triangle& t : mesh.triangles) {
      Eigen::Matrix3d corners;
      for (int k = 0; k < 3; ++k) {
        const Point3 p = view.point(t[static_cast<std::size_t>(k)]);
        corners.col(k) = Eigen::Vector3d(p[0], p[1], p[2]);
      }
      volume += corners.determinant();
    }
    EXPECT_EQ(volume, 6.0) << "outwards: " << strips[0];
  }
  EXPECT_EQ(openEdges(meshOf("0 0 0\n1 1 0\n0 1 1\n1 0 1\n", {"6 0 1 2 3 0 1"})), 0u) << "a tetrahedron";
}

TEST(MeshFile, CutsPolygonsIntoTheirArea)
{
  const TemporaryFolder folder;
  // An L, walked either way and begun anywhere; a fan of its first corner would cover more.
  const std::string vertices = "v 0 0 1\nv 3 0 1\nv 3 1 1\nv 1 1 1\nv 1 3 1\nv 0 3 1\n";
  for (int start = 0; start < 6; ++start) {
    for (const int step : {1, 5}) {
      std::string face = "f";
      for (int i = 0; i < 6; ++i) face += " " + std::to_string((start + step * i) % 6 + 1);
      const Mesh mesh = readMesh(folder.write("l.obj", vertices + face + "\n"));
      EXPECT_EQ(mesh.triangles.size(), 4u);
      EXPECT_EQ(areaOf(mesh), 5.0) << face;
    }
  }
}

TEST(MeshFile, ReadsNumbersOfPlyFaces)
{
  const TemporaryFolder folder;
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                           "property float z\n";
  const std::string rows = "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  // A square is two triangles, and what has two corners none.
  const Mesh mesh = readMesh(
      folder.write("a.ply", head +
                                "element face 3\nproperty uchar collision\nproperty list uchar float texture\n"
                                "property list uchar int vertex_indices\nproperty float distance\nelement edge 1\n"
                                "property int vertex1\n" +
                                rows + "1 2 7 8 4 0 1 2 3 0.25\n2 0 2 0 1 0.75\n0 1 9 3 0 1 2 nan\n5\n"));
  ASSERT_EQ(mesh.triangles.size(), 3u);
  ASSERT_EQ(mesh.face_values.size(), 2u);
  EXPECT_EQ(mesh.face_values[0].name, "collision");
  EXPECT_THAT(mesh.face_values[0].values, ElementsAre(1, 1, 0));
  EXPECT_EQ(mesh.face_values[1].name, "distance");
  EXPECT_THAT(mesh.face_values[1].values, ElementsAre(0.25, 0.25, testing::IsNan()));
  // A second element of faces has none, and its numbers are not mistaken for those of the first.
  const Mesh two = readMesh(folder.write(
      "b.ply", head +
                   "element face 1\nproperty list uchar int vertex_indices\nproperty int a\nelement face 1\n"
                   "property int a\nproperty list uchar int vertex_indices\n" +
                   rows + "3 0 1 2 5\n6 3 1 2 3\n"));
  ASSERT_EQ(two.face_values.size(), 1u);
  EXPECT_THAT(two.face_values[0].values, ElementsAre(5, testing::IsNan()));
}

TEST(MeshFile, ReadsPolygonsOfManyCorners)
{
  const TemporaryFolder folder;
  std::string vertices, face = "f";
  constexpr int corners = 100000;
  for (int i = 0; i < corners; ++i) {
    const double turn = 2 * M_PI * i / corners;
    vertices += "v " + std::to_string(1e3 * std::cos(turn)) + " " + std::to_string(1e3 * std::sin(turn)) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  EXPECT_NEAR(areaOf(readMesh(folder.write("round.obj", vertices + face + "\n"))), M_PI * 1e6, 10.0);
  EXPECT_THAT(failureOf(folder.write("dented.obj", vertices + "v 0 0 0\n" + face + " -1\n")),
              HasSubstr("has a face of 100001 corners that is not convex"));
}

TEST(MeshFile, ReadsFacesOfOffAndPly)
{
  const TemporaryFolder folder;
  const std::string rows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  EXPECT_EQ(areaOf(readMesh(folder.write("a.off", "OFF\n4 1 0\n" + rows + "4 0 1 2 3 255 0 0\n"))), 1.0);
  EXPECT_EQ(areaOf(readMesh(folder.write("b.off", "OFF 4 2 0\n# a comment\n" + rows + "3 0 1 2\n3 0 2 3\n"))), 1.0);
  EXPECT_EQ(areaOf(readMesh(folder.write("a.ply", "ply\nformat ascii 1.0\n" + square_ply + rows + "4 0 1 2 3\n"))),
            1.0);
  const std::string strips = "ply\nformat ascii 1.0\nelement tristrips 1\nproperty list int int vertex_indices\n"
                             "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  EXPECT_THAT(readMesh(folder.write("b.ply", strips + "8 0 1 3 2 -1 0 1 2\n" + rows)).triangles,
              ElementsAre(Triangle{0, 1, 3}, Triangle{3, 1, 2}, Triangle{0, 1, 2}));
  std::string binary = "ply\nformat binary_little_endian 1.0\n" + square_ply;
  const float places[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  binary.append(reinterpret_cast<const char*>(places), sizeof places);
  const std::int32_t corners[] = {0, 1, 2, 3};
  binary += '\4';
  binary.append(reinterpret_cast<const char*>(corners), sizeof corners);
  EXPECT_EQ(areaOf(readMesh(folder.write("c.ply", binary))), 1.0);
}

TEST(MeshFile, ReadsStl)
{
  const TemporaryFolder folder;
  const std::string text = "solid two words\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                           "vertex 1 1 0\nendloop\nendfacet\nfacet normal 0 0 1\n outer loop\n vertex 0 0 -0\n"
                           " vertex 1 1 0\n vertex 0 1 0\n endloop\n endfacet\nendsolid two words\n";
  const Mesh ascii = readMesh(folder.write("a.stl", text));
  EXPECT_EQ(ascii.vertices.width, 4u);
  EXPECT_THAT(ascii.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  EXPECT_EQ(areaOf(readMesh(folder.write("b.STL", text + text))), 2.0);
  std::string capitals = text;
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_EQ(areaOf(readMesh(folder.write("capitals.stl", capitals))), 1.0);
  for (const std::string& end : {std::string(1, '\0'), std::string("\x1a"), std::string("\x1a\0\0", 3)})
    EXPECT_EQ(areaOf(readMesh(folder.write("ended.stl", text + end))), 1.0);
  for (const char* title : {"made", "solid made by many programs", "solid\n facet"}) {
    const Mesh binary =
        readMesh(folder.write("c.stl", binaryStl({{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0}}, title)));
    EXPECT_EQ(binary.vertices.width, 4u);
    EXPECT_EQ(areaOf(binary), 1.0) << title;
  }
  EXPECT_TRUE(readMesh(folder.write("empty.stl", binaryStl({}))).triangles.empty());
  EXPECT_EQ(readCloud(folder / "c.stl").width, 4u);
  EXPECT_EQ(readCloudHeader(folder / "c.stl").fields.size(), 3u);
}

TEST(MeshFile, RefusesFilesThatLie)
{
  const TemporaryFolder folder;
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
  const auto obj = [&](const std::string& face) { return failureOf(folder.write("a.obj", vertices + face + "\n")); };
  EXPECT_THAT(obj("f 1 2 4"), HasSubstr("face 0 names vertex 3 (from 0), of 3"));
  EXPECT_THAT(obj("f 1 2 0"), HasSubstr("line 4 is damaged: '0' names no vertex"));
  EXPECT_THAT(obj("f 1 2 -4"), HasSubstr("'-4' names no vertex"));
  EXPECT_THAT(obj("f 1 2 -9223372036854775808"), HasSubstr("names no vertex"));
  EXPECT_THAT(obj("f 1 2 99999999999999999999"), HasSubstr("not a whole number"));
  EXPECT_THAT(obj("f 1 2 x"), HasSubstr("not a whole number"));
  EXPECT_THAT(failureOf(folder.write("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 3\n")),
              HasSubstr("names vertex 3"));
  EXPECT_THAT(failureOf(folder.write("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n9 0 1 2\n")), HasSubstr("line 6"));
  EXPECT_THAT(failureOf(folder.write("a.ply", "ply\nformat ascii 1.0\n" + square_ply +
                                                  "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 4\n")),
              HasSubstr("names vertex 4"));
  EXPECT_THAT(failureOf(folder.write("u.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                                              "property float y\nproperty float z\nelement face 1\n"
                                              "property list uchar uint vertex_indices\nend_header\n"
                                              "0 0 0\n3 0 0 4294967295\n")),
              HasSubstr("names vertex 4294967295"));
  EXPECT_THAT(failureOf(folder.write("b.ply", "ply\nformat ascii 1.0\n" + square_ply +
                                                  "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 -1\n")),
              HasSubstr("vertex -1"));
  const std::string stl = binaryStl({{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0}});
  EXPECT_THAT(failureOf(folder.write("a.stl", stl.substr(0, stl.size() - 1))),
              HasSubstr("has 1 triangle, and its header counts 2"));
  EXPECT_THAT(failureOf(folder.write("b.stl", stl + std::string(50, 'x'))), HasSubstr("has 3 triangles"));
  EXPECT_THAT(failureOf(folder.write("c.stl", "short")), HasSubstr("is not an STL file"));
  EXPECT_THAT(failureOf(folder.write("d.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n")),
              HasSubstr("line 4"));
  EXPECT_THAT(failureOf(folder.write("e.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n")),
              HasSubstr("truncated"));
  EXPECT_THAT(failureOf(folder.write("f.stl", "solid a\n")), HasSubstr("truncated"));
}

TEST(MeshFile, ReadsOrRefusesWhatIsCutAnywhere)
{
  const TemporaryFolder folder;
  const std::string stl = binaryStl({{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0}}, "solid");
  for (std::size_t size = 1; size < stl.size(); ++size)
    EXPECT_NE(failureOf(folder.write("a.stl", stl.substr(0, size))), "no error") << size;
  const std::string ply = "ply\nformat ascii 1.0\n" + square_ply + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
  for (std::size_t size = 1; size + 2 < ply.size(); ++size)
    EXPECT_NE(failureOf(folder.write("a.ply", ply.substr(0, size))), "no error") << size;
}

TEST(MeshFile, ReadsRealFiles)
{
  const fs::path formats = fs::path(PCL_BSH_SHARED_DIR) / "formats";
  const fs::path shared = fs::exists(formats) ? formats : fs::path(PCL_BSH_SHARED_DIR) / "data" / "formats";
  if (!fs::exists(shared / "cabinet.STL")) GTEST_SKIP() << "no shared files of formats";
  const Mesh cube = readMesh(shared / "20mmCube.STL");
  EXPECT_EQ(cube.vertices.width, 8u);
  EXPECT_EQ(cube.triangles.size(), 12u);
  EXPECT_NEAR(areaOf(cube), 6 * 0.4 * 0.4, 1e-5); // whatever its name says
  EXPECT_EQ(readMesh(shared / "stylus_tool.stl").triangles.size(), 7028u);
  for (const char* name : {"cabinet.STL", "shelf.STL"}) EXPECT_GE(readMesh(shared / name).triangles.size(), 12u);
}

TEST(Mesh, WrittenWithValuesOfTriangles)
{
  const TemporaryFolder folder;
  Mesh mesh = readMesh(folder.write("a.off", "OFF\n5 2 0\n0 0 0\n0.1 0 0\n0 1 0\n1 1 1\n7 7 7\n4 0 1 3 2\n3 0 1 3\n"));
  const std::vector<std::uint8_t> collision = {0, 1, 2};
  const std::vector<float> distance = {0.5F, NAN, -1.0F};
  const std::vector<std::int32_t> pose = {-1, 70000, 0};
  const fs::path path = folder / "b.ply";
  writeMesh(path, mesh.vertices, mesh.triangles,
            {{"collision", &collision}, {"distance", &distance}, {"first_pose", &pose}}, {1, 2, 3, 1, 0, 0, 0});
  const Mesh same = readMesh(path);
  EXPECT_EQ(same.triangles, mesh.triangles);
  EXPECT_EQ(same.vertices.data, mesh.vertices.data);
  CloudFacts facts;
  readCloud(path, &facts);
  EXPECT_EQ(facts.viewpoint[1], 2.0);
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  EXPECT_THAT(bytes, HasSubstr("element face 3\nproperty list uchar int vertex_indices\nproperty uchar collision\n"
                               "property float distance\nproperty int first_pose\nelement camera 1\n"));
  mesh.triangles.clear();
  writeMesh(path, mesh.vertices, mesh.triangles);
  EXPECT_TRUE(readMesh(path).triangles.empty());
  try {
    requireWritableMesh("b.obj");
    ADD_FAILURE() << "accepted";
  }
  catch (const files::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("write a .ply file"));
  }
}

TEST(MeshFile, TellsWhatAFacetLacks)
{
  const TemporaryFolder folder;
  const std::string facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\n"
                            "endfacet\n";
  const auto refusalOf = [&](const std::string& text) { return failureOf(folder.write("a.stl", text)); };
  EXPECT_EQ(refusalOf("solid a\n" + facet + "endsolid\n"), "no error");
  std::size_t line = 3;
  for (const std::string word : {"outer", "loop", "vertex", "endloop", "endfacet"}) {
    std::string damaged = facet;
    damaged.replace(damaged.find(word == "loop" ? " loop" : word) + (word == "loop" ? 1 : 0), word.size(), "thing");
    EXPECT_THAT(refusalOf("solid a\n" + damaged + "endsolid\n"),
                HasSubstr("line " + std::to_string(line) + " has no '" + word + "' where a facet needs one"));
    line += word == "outer" ? 0 : word == "loop" ? 1 : word == "vertex" ? 3 : 1;
  }
  EXPECT_THAT(refusalOf("solid a\nendsolid\n" + facet), HasSubstr("line 3 starts with 'facet', which no STL file"));
  EXPECT_THAT(refusalOf("solid a\nthing\nendsolid\n"), HasSubstr("line 2 starts with 'thing', which no STL file"));
}

TEST(MeshFile, StlMayEndWithTwoWords)
{
  const TemporaryFolder folder;
  const std::string facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\n";
  for (const char* end : {"end loop\nend facet\nend solid\n", "endloop\nendfacet\nend solid a b\n",
                          "END LOOP\nEndFacet\n end\tsolid\n", "end loop\nendfacet\nendsolid\n"})
    EXPECT_EQ(readMesh(folder.write("a.stl", "solid a\n" + facet + end)).triangles.size(), 1u) << end;
  EXPECT_THAT(failureOf(folder.write("a.stl", "solid a\n" + facet + "end facet\nend loop\nend solid\n")),
              HasSubstr("has no 'endloop' where a facet needs one"));
  EXPECT_THAT(failureOf(folder.write("a.stl", "solid a\n" + facet + "end loop\nend facet\nend\n")),
              HasSubstr("starts with 'end', which no STL file has there"));
}

TEST(MeshFile, ABackslashJoinsLinesOfObj)
{
  const TemporaryFolder folder;
  const Mesh square = readMesh(
      folder.write("a.obj", "# C:\\made\\\nmtllib C:\\a\\b.mtl\nv 0 \\\n0 0\r\nv 1 0 0 \\\r\n\nv\\\n1\\\n1\\\n0 # c\n"
                            "v 0 1 0\nvn 0 0 \\\n1\nf \\\n1 2 \\  \n3\\\n4 # a square\n"));
  ASSERT_EQ(square.vertices.width, 4u);
  EXPECT_EQ(areaOf(square), 1.0);
  const Mesh coloured = readMesh(folder.write("b.obj", "v 1 2 3 \\\n 1 0 \\\n 1\nvn 0 \\\n0 1\n"));
  EXPECT_EQ(namesOf(coloured.vertices), "x y z normal_x normal_y normal_z rgb");
  EXPECT_EQ(colourOf(coloured.vertices, 0), 0xff00ffU);
  EXPECT_THAT(failureOf(folder.write("c.obj", "v 0 0 \\\n x\nv 1 1 1\n")),
              HasSubstr("line 1 is damaged: 'x' is not a number"));
  EXPECT_THAT(failureOf(folder.write("c.obj", "v 0 0 0 \\\n\nv 1 1 1 \\\n\nv 2 2\n")),
              HasSubstr("line 5 has fewer values"));
  EXPECT_THAT(failureOf(folder.write("c.obj", "v 0 0 \\")), HasSubstr("'\\' is not a number"));
  for (const char* end : {"\\\n", "\\\r\n", " \\ \n"})
    EXPECT_THAT(failureOf(folder.write("c.obj", std::string("v 0 0 0") + end + "v 1 0 0" + end + "v 0 1 0\nf 1 1 1\n")),
                HasSubstr("line 1 is damaged: 'v' is not a number"))
        << "three vertices, joined to one";
  EXPECT_EQ(readMesh(folder.write("d.obj", "v 0 0 0 1\nv 0 0 0 1 2 3 4 5\n")).vertices.width, 2u);
}

TEST(MeshFile, HeadersOfStlAreOfTextOrLongEnough)
{
  const TemporaryFolder folder;
  EXPECT_EQ(readCloudHeader(folder.write("a.stl", "solid\nendsolid\n")).fields.size(), 3u)
      << "shorter than binary ones";
  EXPECT_EQ(readCloudHeader(folder.write("b.stl", binaryStl({}))).fields.size(), 3u);
  for (const std::string& wrong : {std::string("short"), std::string(83, ' '), std::string(83, '\0')})
    EXPECT_THROW(readCloudHeader(folder.write("c.stl", wrong)), files::FileError);
  EXPECT_EQ(readCloudHeader(folder.write("d.stl", std::string(84, ' '))).fields.size(), 3u);
}

TEST(MeshFile, FacesEndWithTheFile)
{
  const TemporaryFolder folder;
  EXPECT_THAT(failureOf(folder.write("a.obj", "v 0 0 0\nf 1 1 \\\n")), HasSubstr("is truncated: it ends in a face"));
  EXPECT_EQ(defectOf([] { parseOffFaces("OFF\n2 1 0\n0 0 0\n"); }),
            "is truncated: it ends before the last of its vertices");
  EXPECT_EQ(defectOf([] { parseOffFaces("OFF\n1 2 0\n0 0 0\n1 0\n"); }),
            "is truncated: it ends before the last of its faces");
}

} // namespace
} // namespace pcl_bsh::io

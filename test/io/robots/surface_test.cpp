// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/robots/surface.h>

#include "io/clouds/samples.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/solid/solid.h>

#include <gmock/gmock.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

namespace pcl_bsh::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A triangle and a square, as a modeller writes them; the square is in two nodes.
std::string collada(const std::string& asset, const std::string& nodes)
{
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
         asset + R"(</asset><library_geometries><geometry id="part"><mesh>
<source id="p"><float_array id="pa" count="21">1 2 3 4 2 3 1 7 3 0 0 8 2 0 8 2 2 8 0 2 8</float_array>
<technique_common><accessor source="#pa" count="7" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="2"><input semantic="VERTEX" source="#v" offset="0"/><vcount>3 4</vcount><p>0 1 2 3 4 5 6</p></polylist>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s">)" +
         nodes + R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

const std::string node = R"(<node id="n"><instance_geometry url="#part"/></node>)";

class ReadSurface : public testing::Test {
protected:
  Surface read(const std::string& text, const std::string& name = "mesh.dae") const
  {
    std::ofstream(folder / name) << text;
    return readSurface(folder / name);
  }

  /// The corners of all triangles.
  static std::vector<Point3> cornersOf(const Surface& surface)
  {
    std::vector<Point3> corners;
    for (const Triangle& triangle : surface.triangles)
      for (const std::uint32_t corner : triangle) corners.push_back(surface.vertices[corner]);
    return corners;
  }

  static double areaOf(const Surface& surface)
  {
    double area = 0;
    for (const Triangle& t : surface.triangles) {
      const auto edge = [&](std::size_t k) {
        const Point3 &from = surface.vertices[t[0]], &to = surface.vertices[t[k]];
        return Eigen::Vector3d(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
      };
      area += edge(1).cross(edge(2)).norm() / 2;
    }
    return area;
  }

  const io::TemporaryFolder folder;
};

TEST_F(ReadSurface, RefusesWhatIsNoMesh)
{
  for (const char* name : {"a.las", "a.csv", "a.pcd", "a.fbx", "a"}) {
    try {
      read("text", name);
      ADD_FAILURE() << name;
    }
    catch (const files::FileError& error) {
      EXPECT_THAT(error.what(),
                  AllOf(HasSubstr(name), HasSubstr("save it as .stl, .obj, .ply"), Not(HasSubstr(".las,"))));
    }
  }
}

#ifdef PCL_BSH_ASSIMP

TEST_F(ReadSurface, OfColladaTakesTheUnit)
{
  const Surface metres = read(collada("", node));
  EXPECT_EQ(metres.triangles.size(), 3U);
  EXPECT_DOUBLE_EQ(areaOf(metres), 7.5 + 4);
  const Surface inches = read(collada(R"(<unit name="quarter" meter="0.25"/>)", node));
  ASSERT_EQ(inches.vertices.size(), metres.vertices.size());
  for (std::size_t i = 0; i < metres.vertices.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(inches.vertices[i][k], 0.25 * metres.vertices[i][k]);
}

TEST_F(ReadSurface, OfColladaLeavesAxesAsTheyAre)
{
  const std::vector<Point3> plain = cornersOf(read(collada("", node)));
  EXPECT_THAT(plain, AllOf(testing::Contains(Point3{4, 2, 3}), testing::Contains(Point3{1, 7, 3}),
                           testing::Contains(Point3{0, 2, 8})));
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"})
    EXPECT_EQ(cornersOf(read(collada(std::string("<up_axis>") + up + "</up_axis>", node))), plain) << up;
}

TEST_F(ReadSurface, OfColladaPlacesNodes)
{
  const std::string nodes = R"(<node id="a"><translate>10 0 0</translate><node id="b"><scale>2 2 2</scale>
<instance_geometry url="#part"/></node></node><node id="c"><translate>0 -5 0</translate><instance_geometry url="#part"/></node>)";
  const std::vector<Point3> corners = cornersOf(read(collada(R"(<unit meter="0.5"/><up_axis>Z_UP</up_axis>)", nodes)));
  EXPECT_EQ(corners.size(), 18U);
  EXPECT_THAT(corners, testing::Contains(Point3{0.5 * (10 + 2 * 4), 0.5 * 4, 0.5 * 6}));
  EXPECT_THAT(corners, testing::Contains(Point3{0.5 * 4, 0.5 * (2 - 5), 0.5 * 3}));
}

TEST_F(ReadSurface, OfColladaWithoutFacesIsEmpty)
{
  EXPECT_TRUE(read(collada("", "")).triangles.empty()); // what no node has is not there
}

TEST_F(ReadSurface, OfBrokenColladaIsRefusedInOneLine)
{
  const std::string whole = collada("", node);
  for (const std::string& text : {std::string("no xml"), whole.substr(0, whole.size() / 2)}) {
    try {
      read(text);
      ADD_FAILURE() << text;
    }
    catch (const files::FileError& error) {
      EXPECT_THAT(error.what(), AllOf(HasSubstr("mesh.dae: is refused by assimp: "), Not(HasSubstr("\n"))));
    }
  }
  EXPECT_THROW(read(""), files::FileError);
  EXPECT_THROW(readSurface(folder / "none.dae"), files::FileError);
}

#else

TEST_F(ReadSurface, OfColladaSaysWhatToDo)
{
  try {
    read(collada("", node));
    ADD_FAILURE();
  }
  catch (const files::FileError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("mesh.dae: is COLLADA"), HasSubstr("libassimp-dev"), HasSubstr(".stl")));
  }
}

#endif

TEST(SurfaceOf, RoundShapesCloseAndStayWithinTheSagitta)
{
  for (const double sagitta : {0.1, 0.03, 0.01, 0.003, 0.001}) {
    for (const double length : {0.0, 0.7}) {
      const robots::Shape shape =
          length > 0.0 ? robots::Shape{robots::Capsule{0.5, length}} : robots::Shape{robots::Sphere{0.5}};
      const Surface surface = surfaceOf(shape, sagitta);
      EXPECT_NO_THROW(Solid(*surface.view().triangles)) << sagitta << ' ' << length;
      for (const Triangle& t : surface.triangles) {
        const auto corner = [&](std::size_t k) { return Eigen::Vector3d(surface.vertices[t[k]].data()); };
        const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
        const double reach = 0.5 + 0.5 * length * std::abs(normal.z());
        EXPECT_GE(std::abs(normal.dot(corner(0))), reach - sagitta) << sagitta << ' ' << length;
        EXPECT_LE(std::abs(normal.dot(corner(0))), reach + 1e-12);
      }
    }
  }
}

} // namespace
} // namespace pcl_bsh::io

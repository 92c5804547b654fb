// SPDX-License-Identifier: BSD-3-Clause
// Headers that count more or fewer than their file holds are told, whatever the format.
#include "samples.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/meshes/mesh_faces.h>

#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <vector>

namespace pcl_bsh::io {
namespace {

using testing::HasSubstr;

/// x y z float32 of some points, in either byte order.
std::string places(std::size_t count, bool big = false)
{
  std::string bytes;
  for (std::size_t i = 0; i < 3 * count; ++i) {
    const auto value = static_cast<float>(i);
    std::string number(reinterpret_cast<const char*>(&value), sizeof value);
    if (big) std::reverse(number.begin(), number.end());
    bytes += number;
  }
  return bytes;
}

std::string pcd(const std::string& storage, const std::string& body)
{
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA " + storage + "\n" +
         body;
}

std::string ply(const std::string& format, const std::string& more, const std::string& body)
{
  return "ply\nformat " + format + " 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n" +
         more + "end_header\n" + body;
}

class HeaderCounts : public testing::Test {
protected:
  /// The refusal of a file, or its remarks; "" where nothing is said.
  std::string saidOf(const std::string& name, const std::string& text) const
  {
    try {
      CloudFacts facts;
      readMesh(folder.write(name, text), &facts);
      std::string said;
      for (const std::string& remark : facts.remarks) said += "remark: " + remark;
      return said;
    }
    catch (const files::FileError& error) {
      return error.what();
    }
  }

  TemporaryFolder folder;
};

TEST_F(HeaderCounts, OfPcd)
{
  EXPECT_EQ(saidOf("a.pcd", pcd("ascii", "1 2 3\n4 5 6\n\n")), "");
  EXPECT_THAT(saidOf("a.pcd", pcd("ascii", "1 2 3\n")), HasSubstr("is truncated"));
  EXPECT_THAT(saidOf("a.pcd", pcd("ascii", "1 2 3\n4 5 6\n7 8 9\n")),
              HasSubstr("is one more point than the header promises"));
  EXPECT_EQ(saidOf("a.pcd", pcd("binary", places(2))), "");
  EXPECT_EQ(saidOf("a.pcd", pcd("binary", places(2) + "\n")), "");
  EXPECT_THAT(saidOf("a.pcd", pcd("binary", places(1))), HasSubstr("is truncated"));
  const std::string remark = "its header counts 2 of the 5 points there is room for: 3 are left out";
  EXPECT_EQ(saidOf("a.pcd", pcd("binary", places(5))), "remark: " + remark);
  EXPECT_EQ(saidOf("a.pcd", pcd("binary", places(2) + "no record")), "");
  EXPECT_THAT(openCloud(folder.write("b.pcd", pcd("binary", places(5))), 1 << 20)->facts().remarks,
              testing::ElementsAre(remark));
  EXPECT_TRUE(openCloud(folder.write("b.pcd", pcd("binary", places(2) + "\n")), 1 << 20)->facts().remarks.empty());

  writeCloud(folder / "c.pcd", randomCloud<float>(20, 1, {}));
  const std::string packed = contentOf(folder / "c.pcd");
  EXPECT_EQ(saidOf("d.pcd", packed), "");
  EXPECT_EQ(saidOf("d.pcd", packed + std::string(1000, '\0')), "") << "padding, as PCL writes it";
  EXPECT_THAT(saidOf("d.pcd", packed + packed), HasSubstr("remark: its header counts 20 of the "));
  for (const char* storage : {"ascii", "binary", "binary_compressed"}) {
    std::string none = pcd(storage, "1 2 3\n4 5 6\n7 8 9\n");
    none.replace(none.find("POINTS 2"), 8, "POINTS 0");
    none.replace(none.find("WIDTH 2"), 7, "WIDTH 0");
    EXPECT_NE(saidOf("e.pcd", none), "") << storage;
  }
}

TEST_F(HeaderCounts, OfPly)
{
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  EXPECT_EQ(saidOf("a.ply", ply("ascii", "", "1 2 3\n4 5 6\n")), "");
  EXPECT_THAT(saidOf("a.ply", ply("ascii", "", "1 2 3\n")), HasSubstr("is truncated"));
  EXPECT_THAT(
      saidOf("a.ply", ply("ascii", "", "1 2 3\n4 5 6\n7 8 9\n")),
      HasSubstr("line 10 is one more row 'vertex' than the header promises: mend the count in its header, for there "
                "are 3 rows 'vertex'"));
  EXPECT_THAT(saidOf("a.ply", ply("ascii", face, "1 2 3\n4 5 6\n3 0 1 0\n3 0 1 1\n")),
              HasSubstr("is one more row 'face' than the header promises"));
  for (const bool big : {false, true}) {
    const std::string format = big ? "binary_big_endian" : "binary_little_endian";
    EXPECT_EQ(saidOf("a.ply", ply(format, "", places(2, big))), "") << format;
    EXPECT_EQ(saidOf("a.ply", ply(format, "", places(2, big) + "\r\n")), "") << format;
    EXPECT_THAT(saidOf("a.ply", ply(format, "", places(1, big))), HasSubstr("is truncated")) << format;
    EXPECT_THAT(saidOf("a.ply", ply(format, "", places(7, big))),
                HasSubstr("has 7 rows 'vertex', and its header counts 2"))
        << format;
    EXPECT_THAT(
        saidOf("a.ply", ply(format, "element face 0\nproperty list uchar int vertex_indices\n", places(4, big))),
        HasSubstr("has 24 bytes behind the 0 rows 'face' that its header counts"))
        << format;
  }
}

TEST_F(HeaderCounts, OfTextMeshes)
{
  const std::string rows = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(saidOf("a.off", "OFF\n3 1 3\n" + rows + "3 0 1 2\n# the end\n"), "");
  EXPECT_THAT(saidOf("a.off", "OFF\n3 2 0\n" + rows + "3 0 1 2\n"), HasSubstr("is truncated"));
  EXPECT_THAT(saidOf("a.off", "OFF\n3 1 0\n" + rows + "3 0 1 2\n3 2 1 0\n"),
              HasSubstr("line 7 is one more face than the header promises"));
  EXPECT_THROW(readCloud(folder.write("b.off", "OFF\n2 0 0\n" + rows)), files::FileError);

  const std::string v = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
  EXPECT_EQ(saidOf("a.obj", "# Vertices: 4\n# Faces: 1\n" + v + "f 1 2 3\n"), "");
  EXPECT_EQ(saidOf("a.obj", "# Vertices: 4\n# Faces: 2\n" + v + "f 1 2 3 4\n"), "") << "MeshLab counts triangles";
  EXPECT_THAT(saidOf("a.obj", "# Vertices: 5\n" + v), HasSubstr("is truncated"));
  EXPECT_EQ(saidOf("a.obj", "# Vertices: 3\n" + v),
            "remark: its header counts 3 vertices, and 4 are there: all that are there are read");
  EXPECT_EQ(saidOf("a.obj", "# Faces: 1\n" + v + "f 1 2 3\nf 1 2 4\n"),
            "remark: its header counts 1 face, and 2 are there: all that are there are read");
  EXPECT_EQ(saidOf("a.obj", "# Faces: 9\n" + v + "f 1 2 3\n"),
            "remark: its header counts 9 faces, and 1 is there: all that are there are read");
  for (const char* count :
       {"# 5 vertices", "#Vertices: 5", "# vertices = 5", "# Vertex count: 5", "# Number of vertices: 5"})
    EXPECT_THAT(saidOf("a.obj", count + ("\n" + v)), HasSubstr("is truncated: it has 4 of the 5 vertices")) << count;
  for (const char* other : {"# 5 vertices of 9", "# vertices", "# 5", "# 5 vertices and more", "# vertices 5 faces"})
    EXPECT_EQ(saidOf("a.obj", other + ("\n" + v)), "") << other;
  EXPECT_EQ(saidOf("a.obj", "# 2 faces\n" + v + "f 1 2 3\n"),
            "remark: its header counts 2 faces, and 1 is there: all that are there are read");
}

TEST_F(HeaderCounts, OfBinaryStl)
{
  std::string stl(80, ' ');
  const std::uint32_t count = 1;
  stl.append(reinterpret_cast<const char*>(&count), sizeof count);
  stl += std::string(12, '\0') + places(3) + std::string(2, '\0');
  EXPECT_EQ(saidOf("a.stl", stl), "");
  EXPECT_EQ(saidOf("a.stl", stl + '\n'), "");
  EXPECT_THAT(saidOf("a.stl", stl + std::string(50, '\0')), HasSubstr("has 2 triangles, and its header counts 1"));
  EXPECT_THAT(saidOf("a.stl", stl.substr(0, 130)), HasSubstr("has 0 triangles, and its header counts 1"));
}

TEST_F(HeaderCounts, OfScans)
{
  EXPECT_EQ(saidOf("a.pts", "2\n1 2 3\n4 5 6\n"), "");
  EXPECT_EQ(saidOf("a.pts", "1 2 3\n4 5 6\n"), "") << "nothing is counted";
  EXPECT_THAT(saidOf("a.pts", "2\n1.25 2.25 3.25\n"), HasSubstr("is truncated: 1 of 2 points are there"));
  EXPECT_EQ(saidOf("a.pts", "1\n1 2 3\n4 5 6\n2\n7 8 9\n1 2 3\n"),
            "remark: its header counts 3 points, and 4 are there: all that are there are read");
  EXPECT_EQ(saidOf("a.pts", "0\n1 2 3\n"),
            "remark: its header counts 0 points, and 1 is there: all that are there are read");
  const std::string head = "2\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
  const std::string point = "1.25 2.25 3.25 0.5\n";
  EXPECT_EQ(saidOf("a.ptx", head + point + point), "");
  EXPECT_THAT(saidOf("a.ptx", head + point), HasSubstr("is truncated: 1 of 2 points are there"));
  EXPECT_THAT(saidOf("a.ptx", head + point + head + point + point), HasSubstr("is truncated: 1 of 2 points are there"));
  EXPECT_THAT(saidOf("a.ptx", head + point + point + point + point),
              HasSubstr("has 4 points, and its header counts 2"));
  EXPECT_THAT(saidOf("a.ptx", head + point + point + point + head + point + point),
              HasSubstr("has 3 points, and its header counts 2"));
}

TEST_F(HeaderCounts, OfColumns)
{
  EXPECT_EQ(saidOf("a.txt", "//X;Y;Z\n2\n1;2;3\n4;5;6\n"), "");
  EXPECT_THAT(saidOf("a.txt", "//X;Y;Z\n3\n1;2;3\n4;5;6\n"), HasSubstr("is truncated: 2 of 3 points are there"));
  EXPECT_EQ(saidOf("a.csv", "x,y,z\n1\n1,2,3\n4,5,6\n"),
            "remark: its header counts 1 point, and 2 are there: all that are there are read");
  EXPECT_THAT(saidOf("a.xyz", "//X Y Z\n3\n"), HasSubstr("is truncated: 0 of 3 points are there"));
}

} // namespace
} // namespace pcl_bsh::io

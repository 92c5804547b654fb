// SPDX-License-Identifier: BSD-3-Clause
#include "samples.h"

#include <pcl_bsh/io/clouds/ply/ply.h>

#include <pcl/io/ply_io.h>

#include <algorithm>
#include <limits>

namespace pcl_bsh::io {

namespace {

std::string written(const pcl::PCLPointCloud2& cloud)
{
  std::ostringstream out;
  writePly(out, cloud, no_viewpoint);
  return out.str();
}

pcl::PCLPointCloud2 parse(const std::string& file)
{
  Viewpoint viewpoint;
  return parsePly(file, viewpoint);
}

std::string defect(const std::string& file)
{
  return defectOf([&] { parse(file); });
}

std::string ascii(const std::string& elements, const std::string& rows)
{
  return "ply\nformat ascii 1.0\ncomment made for a test\n" + elements + "end_header\n" + rows;
}

std::string xyz(std::size_t count)
{
  return "element vertex " + std::to_string(count) + "\nproperty float x\nproperty float y\nproperty float z\n";
}

/// The bytes of a value in the byte order asked for.
template <typename T>
std::string bytes(T value, bool big)
{
  std::string text(reinterpret_cast<const char*>(&value), sizeof value);
  if (big) std::reverse(text.begin(), text.end());
  return text;
}

} // namespace

TEST(Ply, EveryTypeComesBackAsItWas)
{
  const pcl::PCLPointCloud2 cloud = withoutOpacity(randomCloud<double>(1000, 1, ply_datatypes));
  expectSame(parse(written(cloud)), cloud);
}

TEST(Ply, OrganisedCloudsStayOrganised)
{
  const pcl::PCLPointCloud2 cloud = withoutOpacity(randomCloud<float>(64, 16, ply_datatypes));
  expectSame(parse(written(cloud)), cloud);
}

TEST(Ply, EmptyCloudKeepsItsFields)
{
  const pcl::PCLPointCloud2 cloud = parse(written(randomCloud<float>(0, 1, ply_datatypes)));
  EXPECT_EQ(cloud.width, 0U);
  EXPECT_EQ(cloud.fields.size(), 13U);
}

TEST(Ply, ColoursAndNormalsHavePclsNames)
{
  const std::string head = "property double x\nproperty double y\nproperty double z\nproperty float nx\n"
                           "property uchar green\nproperty float ny\nproperty uchar red\nproperty float nz\n"
                           "property float quality\nproperty uchar blue\n";
  const pcl::PCLPointCloud2 cloud =
      parse(ascii("element vertex 2\n" + head, "1 2 3 0 100 0 200 1 7 50\n4 5 6 0.6 2 0.8 1 0 8 3\n"));
  EXPECT_EQ(namesOf(cloud), "x y z normal_x rgb normal_y normal_z quality");
  EXPECT_EQ(cloud.fields[4].datatype, Field::FLOAT32) << "as PCL's points have it";
  EXPECT_EQ(colourOf(cloud, 0), 0xc86432U);
  EXPECT_EQ(colourOf(cloud, 1), 0x010203U);
  EXPECT_EQ(valueOf(cloud, 0, "normal_z"), 1);
  EXPECT_EQ(valueOf(cloud, 1, "normal_x"), 0.6F);
  EXPECT_EQ(valueOf(cloud, 1, "normal_y"), 0.8F);
  EXPECT_EQ(valueOf(cloud, 1, "quality"), 8);

  const pcl::PCLPointCloud2 opaque =
      parse(ascii("element vertex 1\n" + head + "property uchar alpha\n", "1 2 3 0 100 0 200 1 7 50 254\n"));
  EXPECT_EQ(namesOf(opaque), "x y z normal_x rgba normal_y normal_z quality");
  EXPECT_EQ(opaque.fields[4].datatype, Field::UINT32);
  EXPECT_EQ(colourOf(opaque, 0, "rgba"), 0xfec86432U);
}

TEST(Ply, FilesHaveTheNamesOfTheFormat)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z", "rgb", "normal_x", "normal_y", "normal_z", "curvature"})
    addField(cloud, name, Field::FLOAT32);
  allocate(cloud, 1);
  const std::uint32_t colour = 0xffc86432U;
  std::memcpy(&cloud.data[12], &colour, sizeof colour);
  const std::string file = written(cloud);
  const std::string vertex = "property float x\nproperty float y\nproperty float z\nproperty uchar red\n"
                             "property uchar green\nproperty uchar blue\nproperty float nx\nproperty float ny\n"
                             "property float nz\nproperty float curvature\n";
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + vertex + "end_header\n";
  ASSERT_EQ(file.substr(0, head.size()), head);
  EXPECT_EQ(file.substr(head.size() + 12, 3), "\xc8\x64\x32");
  EXPECT_EQ(file.size(), head.size() + 12 + 3 + 16);
  EXPECT_EQ(colourOf(parse(file), 0), 0xc86432U) << "rgb has no opacity";

  cloud.fields[3].name = "rgba";
  cloud.fields[3].datatype = Field::UINT32;
  expectSame(parse(written(cloud)), cloud);
}

TEST(Ply, OtherColoursAndNamesThatAreTakenStayAsTheyAre)
{
  const std::string xyz_of_one = xyz(1);
  for (const char* type : {"float", "double", "ushort", "int", "char"}) {
    std::string head = xyz_of_one;
    for (const char* channel : {"red", "green", "blue"}) head += std::string("property ") + type + ' ' + channel + '\n';
    const pcl::PCLPointCloud2 cloud = parse(ascii(head, "1 2 3 1 0 1\n"));
    EXPECT_EQ(namesOf(cloud), "x y z red green blue") << type;
    expectSame(parse(written(cloud)), cloud);
  }
  const std::string rows = "1 2 3 4 5 6 7\n";
  const std::string colour = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  EXPECT_EQ(namesOf(parse(ascii(xyz_of_one + colour + "property float rgb\n", rows))), "x y z red green blue rgb");
  EXPECT_EQ(namesOf(parse(ascii(xyz_of_one + colour + "property float alpha\n", rows))), "x y z rgb alpha");
  EXPECT_EQ(namesOf(parse(ascii(xyz_of_one + "property uchar red\nproperty uchar green\n", "1 2 3 4 5\n"))),
            "x y z red green");
  const std::string normal = "property float nx\nproperty float ny\n";
  EXPECT_EQ(namesOf(parse(ascii(xyz_of_one + normal, "1 2 3 4 5\n"))), "x y z nx ny");
  EXPECT_EQ(namesOf(parse(ascii(xyz_of_one + normal + "property int nz\n", "1 2 3 4 5 6\n"))), "x y z nx ny nz");
  EXPECT_EQ(namesOf(parse(ascii(xyz_of_one + normal + "property float nz\nproperty float normal_z\n", rows))),
            "x y z nx ny nz normal_z");
}

TEST(Ply, ReadsTheSensorOfPclsCamera)
{
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = parse(ascii(xyz(2), "1 2 3\n4 5 6\n"));
  const Eigen::Vector4f origin(1.5F, -2, 3, 0);
  const Eigen::Quaternionf turn(Eigen::AngleAxisf(0.5F, Eigen::Vector3f(1, 2, 3).normalized()));
  const auto check = [&](const std::string& file) {
    Viewpoint viewpoint;
    EXPECT_EQ(parsePly(file, viewpoint).width, 2U);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(viewpoint[static_cast<std::size_t>(k)], origin[k]);
    const Eigen::Quaterniond read(viewpoint[3], viewpoint[4], viewpoint[5], viewpoint[6]);
    EXPECT_LT(read.angularDistance(turn.cast<double>()), 1e-6);
  };
  pcl::PLYWriter().writeASCII((folder / "a.ply").string(), cloud, origin, turn, 9, true);
  check(contentOf(folder / "a.ply"));
  pcl::PLYWriter().writeBinary((folder / "b.ply").string(), cloud, origin, turn, true);
  check(contentOf(folder / "b.ply"));
  std::ostringstream out;
  writePly(out, cloud, {origin[0], origin[1], origin[2], turn.w(), turn.x(), turn.y(), turn.z()});
  check(out.str());
}

TEST(Ply, ACameraThatMakesNoSenseIsNoViewpoint)
{
  const auto viewpointOf = [](const std::string& properties, const std::string& row) {
    Viewpoint viewpoint;
    std::string camera = "element camera 1\n";
    std::istringstream names(properties);
    for (std::string name; names >> name;) camera += "property double " + name + "\n";
    parsePly(ascii(camera + xyz(1), row + "\n1 2 3\n"), viewpoint);
    return viewpoint;
  };
  const std::string position = "view_px view_py view_pz ";
  const std::string axes = position + "x_axisx x_axisy x_axisz y_axisx y_axisy y_axisz z_axisx z_axisy z_axisz";
  EXPECT_EQ(viewpointOf(position, "1 2 3"), (Viewpoint{1, 2, 3, 1, 0, 0, 0}));
  EXPECT_EQ(viewpointOf("view_px view_py", "1 2"), no_viewpoint);
  EXPECT_EQ(viewpointOf(position, "1 1e300 3"), no_viewpoint);
  EXPECT_EQ(viewpointOf(axes, "1 2 3 0 0 0 0 0 0 0 0 0"), (Viewpoint{1, 2, 3, 1, 0, 0, 0}));
  const std::string rows[][2] = {{"1 2 3 1 0 0 0 1 0 0 0 -1", "mirrors"},
                                 {"1 2 3 nan 0 0 0 1 0 0 0 1", "is not finite"},
                                 {"1 2 3 1 0 0 0 1 0 0 1 0", "flattens space"},
                                 {"1 2 3 2 0 0 0 2 0 0 0 2", "scales by 2"},
                                 {"1 2 3 1 0 0.01 0 1 0 0 0 1", "shears or scales unevenly"}};
  for (const auto& [row, wrong] : rows) {
    EXPECT_THAT(defectOf([&, &given = row] { viewpointOf(axes, given); }),
                testing::HasSubstr("has a camera whose rotation " + wrong));
  }
  for (const char* row : {"1 nan 3", "inf 2 3"})
    EXPECT_EQ(defectOf([&] { viewpointOf(position, row); }), "has a camera whose position is not finite");
  Viewpoint viewpoint;
  const std::string lists = "element camera 2\nproperty list uchar float view_px\nproperty float k1\n" + xyz(1);
  EXPECT_EQ(parsePly(ascii(lists, "2 1 1 0\n0 0\n1 2 3\n"), viewpoint).width, 1U);
  EXPECT_EQ(viewpoint, no_viewpoint);
}

TEST(Ply, ACameraOfFewDigitsIsTurnedByTheNearestRotation)
{
  std::string camera = "element camera 1\n";
  for (const char* name : {"view_px", "view_py", "view_pz", "x_axisx", "x_axisy", "x_axisz", "y_axisx", "y_axisy",
                           "y_axisz", "z_axisx", "z_axisy", "z_axisz"})
    camera += std::string("property float ") + name + "\n";
  for (const auto& [rows, told] :
       {std::pair{"0.8 -0.6 0 0.60002 0.8 0 0 0 1", true}, {"0.8 -0.6 0 0.6 0.8 0 0 0 1", false}}) {
    Viewpoint viewpoint;
    std::vector<std::string> remarks;
    parsePly(ascii(camera + xyz(1), std::string("1 2 3 ") + rows + "\n1 2 3\n"), viewpoint, nullptr, &remarks);
    EXPECT_NEAR(viewpoint[6], std::sqrt(0.1), 1e-5) << rows;
    EXPECT_EQ(remarks.size(), told ? 1U : 0U) << rows;
    if (!told) continue;
    EXPECT_THAT(remarks.at(0), testing::HasSubstr("camera: |R'R - I| is "));
  }
}

TEST(Ply, FacesMayHaveMoreValuesThanTheHeaderSays)
{
  const std::string header = xyz(3) + "element face 2\nproperty list uchar int vertex_indices\n";
  const std::string rows = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0 255\n3 2 1 0 0 255 0 255\n";
  Viewpoint viewpoint;
  Polygons faces;
  EXPECT_EQ(parsePly(ascii(header, rows), viewpoint, &faces).width, 3U);
  ASSERT_EQ(faces.size(), 2U);
  EXPECT_EQ(faces[1][0], 2U);
  EXPECT_EQ(parse(ascii(header, rows)).width, 3U) << "where the faces are skipped";
  EXPECT_EQ(defectOf([&] { parse(ascii(xyz(1), "1 2 3 4\n")); }).substr(0, 4), "line") << "but points may not";
  EXPECT_EQ(defectOf([&] { parsePly(ascii(header, "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 2 1\n"), viewpoint, &faces); }),
            "line 15 has fewer values than it should");
}

TEST(Ply, AMovedCameraOutdoesTheComment)
{
  const pcl::PCLPointCloud2 cloud = parse(ascii(xyz(1), "1 2 3\n"));
  const Viewpoint viewpoint = {500000.123, 2, 3, 1, 0, 0, 0};
  std::ostringstream out;
  writePly(out, cloud, viewpoint);
  std::string file = out.str();
  Viewpoint read;
  parsePly(file, read);
  EXPECT_EQ(read, viewpoint);
  const std::string comment = "comment viewpoint 500000.123 2 3 1 0 0 0\n";
  const std::size_t at = file.find(comment);
  ASSERT_NE(at, std::string::npos);
  parsePly(std::string(file).erase(at, comment.size()), read);
  EXPECT_EQ(read[0], 500000.125) << "as PCL's reader takes it";
  const std::string moved = "comment viewpoint 500001.123 2 3 1 0 0 0\n"; // of another place than the camera's
  parsePly(std::string(file).replace(at, comment.size(), moved), read);
  EXPECT_EQ(read[0], 500000.125);
  for (const char* other : {"comment viewpoint\n", "comment viewpoint 1 2 3 1 0 0 east\n", "comment\n"}) {
    parsePly(std::string(file).replace(at, comment.size(), other), read);
    EXPECT_EQ(read[0], 500000.125) << other;
  }
}

TEST(Ply, PclReadsWhatIsWritten)
{
  const TemporaryFolder folder;
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z", "intensity"}) addField(cloud, name, Field::FLOAT32);
  addField(cloud, "collision", Field::UINT8);
  allocate(cloud, 8, 2);
  std::generate(cloud.data.begin(), cloud.data.end(), [n = 0]() mutable { return static_cast<std::uint8_t>(n++); });
  pcl::PCLPointCloud2 read;
  ASSERT_EQ(pcl::PLYReader().read(folder.write("cloud.ply", written(cloud)).string(), read), 0);
  expectSame(read, cloud);
}

TEST(Ply, BoolIsWrittenAsItsByte)
{
  pcl::PCLPointCloud2 cloud = randomCloud<float>(2, 1, {Field::BOOL});
  cloud.fields[3].datatype = Field::BOOL;
  EXPECT_EQ(parse(written(cloud)).fields[3].datatype, Field::UINT8);
}

TEST(Ply, RefusesTypesItCannotHold)
{
  const pcl::PCLPointCloud2 cloud = randomCloud<float>(1, 1, {Field::INT64});
  EXPECT_EQ(defectOf([&] { written(cloud); }), "field 'field_9' has a type that PLY does not know");
}

TEST(Ply, ReadsAscii)
{
  const pcl::PCLPointCloud2 cloud =
      parse(ascii("obj_info made by hand\nelement vertex 2\nproperty float64 x\nproperty double y\nproperty double z\n"
                  "property uint8 red\nproperty int16 label\nelement face 1\nproperty list uchar int vertex_indices\n",
                  "1.1 2 3 255 -7\n4 5 6 0 7\n3 0 1 0\n"));
  EXPECT_EQ(cloud.width, 2U);
  EXPECT_EQ(cloud.fields.size(), 5U);
  EXPECT_EQ(valueOf(cloud, 0, "x"), 1.1);
  EXPECT_EQ(valueOf(cloud, 0, "red"), 255);
  EXPECT_EQ(valueOf(cloud, 0, "label"), -7);
  EXPECT_EQ(valueOf(cloud, 1, "z"), 6);
}

TEST(Ply, ReadsBothByteOrdersBehindOtherElements)
{
  for (const bool big : {false, true}) {
    std::string file = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                       "_endian 1.0\nelement strip 2\nproperty list ushort short index\nproperty uchar closed\n"
                       "element vertex 2\nproperty double x\nproperty float y\nproperty ushort label\n"
                       "element face 1\nproperty list uchar uint vertex_indices\nend_header\n";
    file += bytes<std::uint16_t>(2, big) + bytes<std::int16_t>(1, big) + bytes<std::int16_t>(2, big) + "\x01";
    file += bytes<std::uint16_t>(0, big) + "\x02";
    for (const double x : {596648.1, -2.5}) {
      file += bytes(x, big) + bytes(0.1F, big) + bytes<std::uint16_t>(513, big);
    }
    file += "\x01" + bytes<std::uint32_t>(1, big);

    const pcl::PCLPointCloud2 cloud = parse(file);
    ASSERT_EQ(cloud.width, 2U);
    EXPECT_EQ(valueOf(cloud, 0, "x"), 596648.1);
    EXPECT_EQ(valueOf(cloud, 1, "x"), -2.5);
    EXPECT_EQ(valueOf(cloud, 1, "y"), 0.1F);
    EXPECT_EQ(valueOf(cloud, 1, "label"), 513);
    for (std::size_t cut = 1; cut < 60; ++cut) {
      EXPECT_THROW(parse(file.substr(0, file.size() - cut)), FormatError) << cut;
    }
  }
}

TEST(Ply, ListsOfOneLengthAreFields)
{
  const std::string head =
      "element vertex 2\nproperty float x\nproperty list uchar float uv\nproperty list uchar int none\n";
  const pcl::PCLPointCloud2 cloud = parse(ascii(head, "1 2 3 4 0\n5 2 6 7 0\n"));
  ASSERT_EQ(cloud.fields.size(), 2U);
  EXPECT_EQ(cloud.fields[1].count, 2U);
  EXPECT_EQ(valueOf(cloud, 1, "uv"), 6);
  EXPECT_EQ(defect(ascii(head, "1.25 2 3 4 0\n5 1 6 0\n")), "the lists of its vertex property 'uv' differ in length");
  EXPECT_EQ(defect(ascii("element vertex 1\nproperty list char int a\n", "-1\n")),
            "a list of 'a' has an impossible length");
  EXPECT_EQ(defect(ascii("element vertex 1\nproperty list float int a\n", "nan\n")),
            "a list of 'a' has an impossible length");
}

TEST(Ply, RefusesTruncatedAndLyingFiles)
{
  EXPECT_EQ(defect(ascii(xyz(2000000000), "1 2 3\n")),
            "is truncated: its header promises 2000000000 points, its size allows 1 at most");
  EXPECT_EQ(defect(ascii(xyz(3000000000), "1 2 3\n")),
            "it has 3000000000 points, more than the 2147483647 that an index can name");
  EXPECT_EQ(defect(ascii(xyz(2), "1.25 2.25 3.25\n")),
            "is truncated: it ends before the last row that its header promises");
  EXPECT_EQ(defect(ascii(xyz(2), "1.25 2 3\n4 5\n")), "line 10 has fewer values than it should");
  EXPECT_EQ(defect(ascii(xyz(1), "1 2 3 4\n")), "line 9 has more values than it should, from '4' on");
  EXPECT_EQ(defect(ascii(xyz(1), "1 2 z\n")), "line 9 is damaged: 'z' is not a number");
  EXPECT_EQ(defect(ascii(xyz(1) + "element face 2\nproperty list uchar int i\n", "1 2 3\n1 0\n")),
            "is truncated: it ends before the last row that its header promises");
  EXPECT_EQ(defect(ascii("element vertex 9\nproperty list uint double a\n", "4294967295 1\n")),
            "line 7 has fewer values than it should");
  EXPECT_EQ(defect("ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty list uint double a\nend_header\n" +
                   bytes<std::uint32_t>(0xffffffff, false)),
            "is truncated: it ends before the last row that its header promises");
}

TEST(Ply, RefusesHeadersThatMakeNoCloud)
{
  EXPECT_EQ(defect("plywood\n"), "is not a PLY file: it does not start with 'ply'");
  EXPECT_EQ(defect("ply\nformat ascii 1.0\n" + xyz(1)), "is truncated: its header does not end");
  EXPECT_EQ(defect("ply\nformat zip 1.0\n" + xyz(1) + "end_header\n1 2 3\n"), "has the unknown format 'zip'");
  EXPECT_EQ(defect(ascii("element face 0\nproperty list uchar int i\n", "")), "has no 'vertex' element");
  EXPECT_EQ(defect(ascii(xyz(1) + xyz(1), "1 2 3\n1 2 3\n")), "its header has two 'vertex' elements");
  EXPECT_EQ(defect(ascii("element vertex 1\n", "")), "its vertices have no properties");
  EXPECT_EQ(defect(ascii("element vertex 1\nproperty half x\n", "1\n")),
            "line 5 has the type 'half', which PLY does not know");
  EXPECT_EQ(defect(ascii("property float x\n", "")), "line 4 starts with 'property', which no PLY header has there");
  EXPECT_EQ(defect(ascii("element vertex many\n", "")),
            "line 4 is damaged: 'many' is not a whole number in the range of its type");
  // Rows without values take no bytes: nothing to walk through.
  EXPECT_EQ(parse(ascii("element nothing 18446744073709551615\n" + xyz(1), "1 2 3\n")).width, 1U);
}

/// Each type of a length or an index is tried: no number may be cut or turned into another.
TEST(Ply, RefusesLengthsAndIndicesThatNoFileCanHave)
{
  const auto list = [](const std::string& value) {
    return ascii("element vertex 1\nproperty float x\nproperty list double float a\n", "1 " + value + " 2 3\n");
  };
  EXPECT_EQ(defect(list("4294967296")), "a list of 'a' has an impossible length");
  EXPECT_EQ(defect(list("inf")), "a list of 'a' has an impossible length");
  EXPECT_EQ(defect(list("4294967295")), "line 8 has fewer values than it should");
  for (const std::string index : {"-2", "4294967296", "nan", "1e300"}) {
    Viewpoint viewpoint;
    Polygons faces;
    EXPECT_EQ(defectOf([&] {
                parsePly(ascii(xyz(1) + "element face 1\nproperty list uchar double vertex_index\n",
                               "1 2 3\n1 " + index + "\n"),
                         viewpoint, &faces);
              }),
              "its list 'vertex_index' holds no index of a vertex")
        << index;
  }
}

TEST(Ply, CornersOfFacesHaveEitherName)
{
  Viewpoint viewpoint;
  for (const std::string name : {"vertex_index", "vertex_indices"}) {
    Polygons faces;
    const std::string face = "element face 1\nproperty float a\nproperty list uchar int " + name + "\n";
    parsePly(ascii(xyz(1) + face, "1 2 3\n7 2 0 5\n"), viewpoint, &faces);
    ASSERT_EQ(faces.size(), 1U) << name;
    EXPECT_EQ(faces[0][1], 5U);
    ASSERT_EQ(faces.values().size(), 1U);
    EXPECT_EQ(faces.values()[0].values, std::vector<double>{7});
  }
  Polygons faces;
  const std::string both = "element face 1\nproperty list uchar int vertex_index\nproperty float a\n"
                           "property list uchar int vertex_indices\n";
  parsePly(ascii(xyz(1) + both, "1 2 3\n1 0 7 2 0 0\n"), viewpoint, &faces);
  EXPECT_EQ(faces.size(), 2U);
  EXPECT_TRUE(faces.values().empty()) << "of which of the two a row tells something is not known";
  Polygons none;
  parsePly(ascii("element face 18446744073709551615\n" + xyz(1), "1 2 3\n"), viewpoint, &none);
  EXPECT_EQ(none.size(), 0U) << "rows without values take no bytes";
}

/// Neither takes a line.
TEST(Ply, CamerasWithoutRowsOrValuesAreNone)
{
  Viewpoint viewpoint;
  for (const char* camera : {"element camera 0\nproperty float view_px\n", "element camera 1\n"}) {
    EXPECT_EQ(parsePly(ascii(camera + xyz(1), "1 2 3\n"), viewpoint).width, 1U) << camera;
    EXPECT_EQ(viewpoint, no_viewpoint);
  }
}

/// Equal to the byte, except for the comment that has it in full.
TEST(Ply, AViewpointWithoutATurnIsWrittenAsNotTurned)
{
  const pcl::PCLPointCloud2 cloud = parse(ascii(xyz(1), "1 2 3\n"));
  const auto fileOf = [&](double w) {
    std::ostringstream out;
    writePly(out, cloud, {1, 2, 3, w, 0, 0, 0});
    std::string file = out.str();
    const std::size_t comment = file.find("comment viewpoint");
    return file.erase(comment, file.find('\n', comment) + 1 - comment);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (const double w : {0.0, nan, infinite, 7.0}) EXPECT_TRUE(fileOf(w) == fileOf(1.0)) << w;
  Viewpoint viewpoint;
  parsePly(fileOf(0.0), viewpoint);
  EXPECT_EQ(viewpoint, (Viewpoint{1, 2, 3, 1, 0, 0, 0}));
}

/// Lists are no channels and no normals; a colour of another size is no packed one.
TEST(Ply, OnlySingleValuesAreChannelsAndNormals)
{
  std::string channels = xyz(1), normals = xyz(1);
  for (const char* name : {"red", "green"}) channels += std::string("property uchar ") + name + '\n';
  for (const char* name : {"nx", "ny"}) normals += std::string("property float ") + name + '\n';
  EXPECT_EQ(namesOf(parse(ascii(channels + "property list uchar uchar blue\n", "1 2 3 4 5 2 6 7\n"))),
            "x y z red green blue");
  EXPECT_EQ(namesOf(parse(ascii(normals + "property list uchar float nz\n", "1 2 3 0 0 2 1 1\n"))), "x y z nx ny nz");

  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z"}) addField(cloud, name, Field::FLOAT32);
  pcl::PCLPointCloud2 wide = cloud, twice = cloud, beside = cloud;
  addField(wide, "rgb", Field::FLOAT64);
  addField(twice, "rgb", Field::FLOAT32, 2);
  addField(beside, "rgb", Field::FLOAT32);
  addField(beside, "Green", Field::FLOAT32);
  for (pcl::PCLPointCloud2* const odd : {&wide, &twice, &beside}) {
    allocate(*odd, 1);
    expectSame(parse(written(*odd)), *odd);
  }
}

/// Beyond what is written at once.
TEST(Ply, ManyFacesArriveInOrder)
{
  constexpr std::uint32_t count = 200000;
  pcl::PCLPointCloud2 vertices = parse(ascii(xyz(1), "1 2 3\n"));
  std::vector<Triangle> triangles(count);
  for (std::uint32_t i = 0; i < count; ++i) triangles[i] = {i, i + 1, i + 2};
  std::ostringstream out;
  writePlyMesh(out, vertices, triangles, {}, no_viewpoint);
  Viewpoint viewpoint;
  Polygons faces;
  parsePly(out.str(), viewpoint, &faces);
  ASSERT_EQ(faces.size(), count);
  for (std::uint32_t i = 0; i < count; ++i) {
    ASSERT_EQ(faces[i].size(), 3U);
    ASSERT_EQ(faces[i][2], i + 2);
  }
}

TEST(Ply, RowsOfOtherElementsAreAsLongAsTheirHeaderSays)
{
  const std::string other = "element other 1\nproperty int a\n";
  EXPECT_EQ(parse(ascii(other + xyz(1), "7\n1 2 3\n")).width, 1U);
  EXPECT_EQ(defect(ascii(other + xyz(1), "7 8\n1 2 3\n")), "line 11 has more values than it should, from '8' on");
  EXPECT_EQ(defect(ascii("element vertex 1\nproperty float\n", "1\n")), "line 5 names no property");
}

/// Tabs, too.
TEST(Ply, WordsOfAHeaderAreSeparatedByAnyBlanks)
{
  const std::string head = "element\tvertex  1\nproperty\tfloat\tx\nproperty list\tuchar \tfloat\tuv\n";
  const pcl::PCLPointCloud2 cloud = parse(ascii(head, "1\t2 3\t4\n"));
  ASSERT_EQ(cloud.fields.size(), 2U);
  EXPECT_EQ(cloud.fields[1].count, 2U);
  EXPECT_EQ(valueOf(cloud, 0, "uv"), 3);
}

} // namespace pcl_bsh::io

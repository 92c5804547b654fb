// SPDX-License-Identifier: BSD-3-Clause
#include "las_sample.h"
#include "samples.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/formats.h>

#include <gmock/gmock.h>

#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <sys/stat.h>

#include <thread>

namespace pcl_bsh::io {

namespace fs = std::filesystem;

namespace {

std::string failureOf(const fs::path& path)
{
  try {
    readCloud(path);
  }
  catch (const files::FileError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find(path.string() + ": "), 0U) << message;
    return message.substr(std::min(message.size(), path.string().size() + 2));
  }
  ADD_FAILURE() << path << " was read";
  return {};
}

} // namespace

TEST(CloudFile, FormatIsToldByTheExtension)
{
  const TemporaryFolder folder;
  const std::string rows = "1 2 3\n";
  EXPECT_EQ(readCloud(folder.write("a.xyz", rows)).width, 1U);
  EXPECT_EQ(readCloud(folder.write("a.TXT", rows)).width, 1U);
  EXPECT_EQ(readCloud(folder.write("a.obj", "v 1 2 3\n")).width, 1U);
  EXPECT_EQ(readCloud(folder.write("a.off", "OFF 1 0 0\n" + rows)).width, 1U);
  EXPECT_EQ(
      readCloud(folder.write("a.Pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n" + rows)).width,
      1U);
  EXPECT_EQ(
      readCloud(folder.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                                      "property float z\nend_header\n" +
                                          rows))
          .width,
      1U);
}

TEST(CloudFile, EveryFieldSurvivesEveryRoundTrip)
{
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = withoutOpacity(randomCloud<double>(300, 1, ply_datatypes));
  writeCloud(folder / "a.pcd", cloud);
  writeCloud(folder / "b.ply", readCloud(folder / "a.pcd"));
  writeCloud(folder / "c.pcd", readCloud(folder / "b.ply"));
  expectSame(readCloud(folder / "c.pcd"), cloud);
  EXPECT_EQ(folder.files(), 3U);
}

TEST(CloudFile, ViewpointIsKeptByPcdAndPly)
{
  const TemporaryFolder folder;
  const Viewpoint viewpoint = {500000.123456789, 5400000.1, -1.0 / 3, 0.5, 0.5, -0.5, 0.5000000001};
  const pcl::PCLPointCloud2 cloud = randomCloud<float>(3, 1, {});
  writeCloud(folder / "a.pcd", cloud, viewpoint);
  writeCloud(folder / "a.ply", cloud, viewpoint);
  CloudFacts read;
  readCloud(folder / "a.pcd", &read);
  EXPECT_EQ(read.viewpoint, viewpoint);
  expectSame(withoutOpacity(readCloud(folder / "a.ply", &read)), withoutOpacity(cloud));
  EXPECT_EQ(read.viewpoint, viewpoint);
  writeCloud(folder / "a.ply", cloud);
  EXPECT_EQ(contentOf(folder / "a.ply").find("camera"), std::string::npos) << "nothing to say";
  readCloud(folder / "a.ply", &read);
  EXPECT_EQ(read.viewpoint, no_viewpoint);
  readCloud(folder.write("a.xyz", "1 2 3\n"), &read);
  EXPECT_EQ(read.viewpoint, no_viewpoint);
}

TEST(CloudFile, DenseMeansAllFloatsAreFinite)
{
  const TemporaryFolder folder;
  EXPECT_TRUE(readCloud(folder.write("a.xyz", "1 2 3 4\n")).is_dense);
  EXPECT_FALSE(readCloud(folder.write("a.xyz", "1 2 3 4\n1 inf 3 4\n")).is_dense);
  EXPECT_FALSE(readCloud(folder.write("a.xyz", "1 2 3 nan\n")).is_dense);
}

TEST(CloudFile, HeadersHaveTheFieldsButNoPoints)
{
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = randomCloud<double>(5, 2, {Field::UINT8});
  for (const char* name : {"a.pcd", "a.ply"}) {
    writeCloud(folder / name, cloud);
    const pcl::PCLPointCloud2 header = readCloudHeader(folder / name);
    EXPECT_EQ(header.fields.size(), cloud.fields.size()) << name;
    EXPECT_EQ(header.width * header.height, 10U) << name;
    EXPECT_TRUE(header.data.empty()) << name;
  }
  EXPECT_EQ(readCloudHeader(folder.write("a.obj", "v 1 2 broken\n")).fields.size(), 3U);
  EXPECT_THROW(readCloudHeader(folder.write("a.txt", "u v w\n1 2 3\n")), files::FileError);
  EXPECT_THROW(readCloudHeader(folder / "none.pcd"), files::FileError);
}

TEST(CloudFile, AnEmptyCloudIsReadBackFromEveryFormat)
{
  const TemporaryFolder folder;
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z", "rgb"}) addField(cloud, name, Field::FLOAT32);
  cloud.height = 1;
  for (const char* name : {"a.pcd", "a.ply", "a.xyz", "a.txt", "a.obj"}) {
    writeCloud(folder / name, cloud);
    const pcl::PCLPointCloud2 read = readCloud(folder / name);
    EXPECT_EQ(read.width, 0U) << name;
    EXPECT_EQ(namesOf(read), std::string(name) == "a.obj" ? "x y z" : "x y z rgb") << name;
    EXPECT_EQ(namesOf(readCloudHeader(folder / name)), namesOf(read)) << name;
  }
}

TEST(CloudFile, ColoursAndNormalsPassThroughEveryFormat)
{
  const TemporaryFolder folder;
  pcl::PCLPointCloud2 cloud;
  for (const char* name : {"x", "y", "z"}) addField(cloud, name, Field::FLOAT64);
  addField(cloud, "rgb", Field::FLOAT32);
  for (const char* name : {"normal_x", "normal_y", "normal_z"}) addField(cloud, name, Field::FLOAT64);
  allocate(cloud, 256);
  for (std::size_t i = 0; i < 256; ++i) {
    std::uint8_t* const record = &cloud.data[i * cloud.point_step];
    const auto k = static_cast<double>(i);
    const double xyz[] = {596648.1 + k, 0.1 * k, -k}, normal[] = {std::sin(k), std::cos(k), 0};
    const auto colour = static_cast<std::uint32_t>((i << 16) | ((255 - i) << 8) | (i * 7 % 256));
    std::memcpy(record, xyz, sizeof xyz);
    std::memcpy(record + cloud.fields[3].offset, &colour, sizeof colour);
    std::memcpy(record + cloud.fields[4].offset, normal, sizeof normal);
  }
  for (const char* name : {"a.pcd", "a.ply", "a.xyz", "a.txt", "a.obj"}) {
    writeCloud(folder / name, cloud);
    const pcl::PCLPointCloud2 read = readCloud(folder / name);
    EXPECT_EQ(namesOf(readCloudHeader(folder / name)), namesOf(read)) << name;
    ASSERT_EQ(read.width, 256U) << name;
    for (std::size_t i = 0; i < 256; ++i) {
      for (const char* field : {"x", "y", "z", "normal_x", "normal_y", "normal_z"})
        EXPECT_EQ(valueOf(read, i, field), valueOf(cloud, i, field)) << name << ' ' << field << ' ' << i;
      EXPECT_EQ(colourOf(read, i), colourOf(cloud, i)) << name << ' ' << i;
    }
  }
}

TEST(CloudFile, SaysWhatCannotBeRead)
{
  const TemporaryFolder folder;
  EXPECT_EQ(failureOf(folder / "none.pcd"), "no such file: check the name");
  fs::create_directory(folder / "sub.pcd");
  EXPECT_EQ(failureOf(folder / "sub.pcd"), "is a folder: name a file in it");
  EXPECT_EQ(failureOf("/dev/null"), "is neither a file nor a pipe: save the cloud to a file first");
  EXPECT_EQ(failureOf(folder.write("a.pcd", "")), "is empty: export or copy the file again");
  const std::string readable =
      "give a .pcd, .ply, .las, .laz, .e57, .obj, .off, .stl, .pts, .ptx, .csv, .xyz, .asc or .txt file";
  EXPECT_EQ(failureOf(folder.write("a.rcp", "x")), "unknown extension '.rcp': " + readable);
  EXPECT_EQ(failureOf(folder.write("a", "x")), "has no extension: " + readable);
  EXPECT_EQ(failureOf(folder.write("a.ply", "ply\nformat ascii 1.0\nelement face 0\nend_header\n")),
            "has no 'vertex' element: export it with vertices");
  EXPECT_EQ(
      failureOf(folder.write("a.txt", "u v w\n1 2 3\n")).find("its columns are named u v w: none of them is x: name"),
      0U);
  EXPECT_EQ(failureOf(folder.write("a.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F I\nPOINTS 1\nDATA ascii\n1 2 3\n"))
                .find("field 'z' has data type 5"),
            0U);
  EXPECT_EQ(failureOf(folder.write("a.txt", "x y z x\n1 2 3 4\n")), "has two fields named 'x': rename one");
}

TEST(CloudFile, MessagesAreOneCleanLine)
{
  const TemporaryFolder folder;
  const std::string message = failureOf(folder.write("a.ply", "ply\nformat \x1b[31m\x07 1.0\nend_header\n"));
  EXPECT_EQ(message.find_first_of("\x1b\x07\n"), std::string::npos) << message;
}

TEST(CloudFile, SaysWhatCannotBeWritten)
{
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = randomCloud<float>(3, 1, {Field::INT64});
  EXPECT_THROW(writeCloud(folder / "a.xyz", cloud), files::FileError);
  EXPECT_THROW(writeCloud(folder / "none/a.pcd", cloud), files::FileError);
  folder.write("a.ply", "old");
  EXPECT_THROW(writeCloud(folder / "a.ply", cloud), files::FileError) << "PLY has no int64";
  EXPECT_EQ(contentOf(folder / "a.ply"), "old");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(CloudFile, ACloudMayReplaceTheFileItCameFrom)
{
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = withoutOpacity(randomCloud<float>(1000, 1, {}));
  writeCloud(folder / "a.ply", cloud);
  writeCloud(folder / "a.ply", readCloud(folder / "a.ply"));
  expectSame(readCloud(folder / "a.ply"), cloud);
}

TEST(CloudFile, RealScansAreReadAsPclReadsThem)
{
  const fs::path scans = fs::path(PCL_BSH_SHARED_DIR) / "data";
  if (!fs::is_directory(scans)) GTEST_SKIP() << "no scans at " << scans;
  const TemporaryFolder folder;
  for (const char* name : {"lidar_os0_128_organized.pcd", "robot_panda_sampled.pcd", "statue_lion_takanawa.pcd",
                           "tabletop_rgbd_organized.pcd", "terrain_stbarth_utm20_f64.pcd"}) {
    pcl::PCLPointCloud2 expected;
    ASSERT_EQ(pcl::PCDReader().read((scans / name).string(), expected), 0);
    const pcl::PCLPointCloud2 cloud = readCloud(scans / name);
    expectSame(cloud, expected);
    EXPECT_EQ(cloud.is_dense, expected.is_dense) << name;
    writeCloud(folder / "copy.ply", cloud);
    expectSame(readCloud(folder / "copy.ply"), withoutOpacity(expected));
  }
}

TEST(CloudFile, PipesTellTheirFormatByHowTheyBegin)
{
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                          "property float z\nend_header\n1 2 3\n";
  for (const std::string& cloud :
       {ply, std::string("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n"),
        std::string("OFF 1 0 0\n1 2 3\n"), std::string("1 2 3\n")}) {
    std::thread writer([&] { std::ofstream(pipe) << cloud; });
    EXPECT_EQ(valueOf(readCloud(pipe), 0, "z"), 3) << cloud;
    writer.join();
  }
  EXPECT_THROW(readCloudHeader(pipe), files::FileError) << "it would be gone for readCloud()";
}

TEST(CloudFile, HeadersAreReadAlone)
{
  const TemporaryFolder folder;
  const std::string begin = "ply\nformat ascii 1.0\n";
  const std::string end = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";
  std::string comments;
  while (comments.size() < 200000) comments += "comment more than one reads at first\n";
  EXPECT_EQ(readCloudHeader(folder.write("long.ply", begin + comments + end)).fields.size(), 3U);
}

TEST(CloudFile, EachNameThatCanBeWrittenIsReadAgain)
{
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = readCloud(folder.write("in.xyz", "0.1 2 3\n4 5 6\n"));
  const std::string rows = "0.1 2 3\n4 5 6\n", csv = "x,y,z\n0.1,2,3\n4,5,6\n";
  const std::string ptx = "2\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n" + rows;
  for (const auto& [name, content] : {std::pair<const char*, std::string>{"a.pts", "2\n" + rows},
                                      {"a.ptx", ptx},
                                      {"a.csv", csv},
                                      {"a.xyz", "x y z\n" + rows},
                                      {"a.TXT", "x y z\n" + rows},
                                      {"a.obj", "# Vertices: 2\nv 0.1 2 3\nv 4 5 6\n"},
                                      {"a.pcd", ""},
                                      {"a.ply", ""},
                                      {"a.las", ""}}) {
    writeCloud(folder / name, cloud);
    if (!content.empty()) {
      EXPECT_EQ(contentOf(folder / name), content) << name;
    }
    const pcl::PCLPointCloud2 read = readCloud(folder / name);
    EXPECT_EQ(read.width, 2U) << name;
    EXPECT_NEAR(valueOf(read, 0, "x"), 0.1, 1e-6) << name;
    EXPECT_EQ(namesOf(readCloudHeader(folder / name)), namesOf(read)) << name;
  }
  const auto refusalOf = [&](const std::string& name) -> std::string {
    try {
      requireWritableCloud(folder / name);
    }
    catch (const files::FileError& error) {
      return std::string(error.what()).substr((folder / name).string().size());
    }
    return "none";
  };
  const std::string known = ": write a " + extensionsOf(isWritten, ", ", " or ") + " file";
  EXPECT_EQ(refusalOf("b.e57"), ": unknown extension '.e57'" + known);
  EXPECT_EQ(refusalOf("b"), ": has no extension" + known);
  EXPECT_EQ(refusalOf("b.off"), ": unknown extension '.off'" + known) << "read, but not written";
  EXPECT_EQ(refusalOf("b.las"), "none");
}

/// It has no name to tell a format by, and gets PCL's own.
TEST(CloudFile, StandardOutputIsPcd)
{
  const pcl::PCLPointCloud2 cloud = randomCloud<float>(3, 1, {});
  const TemporaryFolder folder;
  EXPECT_NO_THROW(requireWritableCloud("-"));
  testing::internal::CaptureStdout();
  writeCloud("-", cloud);
  expectSame(readCloud(folder.write("a.pcd", testing::internal::GetCapturedStdout())), cloud);
}

TEST(CloudFile, NamesOfColumnsAreForFilesOfColumnsAlone)
{
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = randomCloud<float>(3, 1, {});
  writeCloud(folder / "a.pcd", cloud);
  LasSample sample(4, 6);
  sample.addPoints(2);
  folder.write("a.las", sample.text());
  for (const char* name : {"a.pcd", "a.las"}) {
    const std::string wrong =
        std::string(name) + ": is a " + fs::path(name).extension().string() +
        ", which names its fields itself: give names of columns for .xyz, .asc, .txt and .csv files alone";
    EXPECT_THAT(
        [&] {
          readCloud(folder / name, nullptr, {"x", "y", "z"});
        },
        testing::ThrowsMessage<files::FileError>(testing::HasSubstr(wrong)));
    EXPECT_THAT(
        [&] {
          readCloudHeader(folder / name, {"x", "y", "z"});
        },
        testing::ThrowsMessage<files::FileError>(testing::HasSubstr(wrong)));
  }
  for (const char* name : {"b.xyz", "b.asc", "b.txt", "b.csv"}) {
    folder.write(name, "1 2 3\n");
    EXPECT_EQ(valueOf(readCloud(folder / name, nullptr, {"z", "y", "x"}), 0, "x"), 3) << name;
    EXPECT_EQ(namesOf(readCloudHeader(folder / name, {"z", "y", "x"})), "z y x") << name;
  }
}

/// The content of a pipe is held in memory, LAS too, whatever the pipe is called.
TEST(CloudFile, PipesMayBeginInAnyWayOfTheirFormat)
{
  const TemporaryFolder folder;
  LasSample sample(4, 6);
  sample.addPoints(3);
  const std::string rest = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 3\nDATA ascii\n1 2 3\n4 5 6\n7 8 9\n";
  for (const auto& [name, content] : {std::pair<const char*, std::string>{"pipe", sample.text()},
                                      {"pipe.las", sample.text()},
                                      {"pipe.1", "# .PCD v0.7\n" + rest},
                                      {"pipe.2", "VERSION .7\n" + rest}}) {
    ASSERT_EQ(mkfifo((folder / name).c_str(), 0600), 0);
    std::thread writer([&, file = name, text = content] { std::ofstream(folder / file, std::ios::binary) << text; });
    CloudFacts facts;
    EXPECT_NO_THROW(EXPECT_EQ(readCloud(folder / name, &facts).width, 3U) << name);
    EXPECT_EQ(facts.las != nullptr, content == sample.text()) << name;
    writer.join();
  }
}

TEST(CloudFile, ListsOfNumbersAreDenseWhereEachIsFinite)
{
  for (std::size_t i = 0; i < 5; ++i) {
    pcl::PCLPointCloud2 cloud;
    addField(cloud, "x", Field::INT32);
    addField(cloud, "histogram", Field::FLOAT64, 5);
    allocate(cloud, 2);
    setDense(cloud);
    EXPECT_TRUE(cloud.is_dense);
    const double infinite = std::numeric_limits<double>::infinity();
    std::memcpy(&cloud.data[cloud.point_step + 4 + 8 * i], &infinite, sizeof infinite);
    setDense(cloud);
    EXPECT_FALSE(cloud.is_dense) << i;
  }
}

/// Clouds that lie about themselves are refused, before a byte beyond them is read.
TEST(CloudFile, RefusesCloudsThatLie)
{
  const auto refusalOf = [](const pcl::PCLPointCloud2& cloud) { return defectOf([&] { namedFields(cloud); }); };
  const pcl::PCLPointCloud2 sound = randomCloud<float>(3, 2, {});
  EXPECT_EQ(namedFields(sound).size(), 5U);
  pcl::PCLPointCloud2 cloud = sound;
  cloud.fields[4].count = 6;
  EXPECT_EQ(refusalOf(cloud), "field 'histogram' lies outside the records");
  cloud = sound;
  ++cloud.fields[4].offset;
  EXPECT_EQ(refusalOf(cloud), "field 'histogram' lies outside the records");
  cloud = sound;
  cloud.data.pop_back();
  EXPECT_EQ(refusalOf(cloud), "the cloud has fewer records than width x height");
  cloud = sound;
  cloud.fields[3].name.clear();
  EXPECT_EQ(refusalOf(cloud), "a field named '' cannot be written");
  cloud.fields[3].name = "_";
  EXPECT_EQ(namedFields(cloud).size(), 4U) << "padding";
  cloud = sound;
  cloud.fields[3].count = 0;
  EXPECT_EQ(namedFields(cloud)[3].count, 1U) << "as PCL takes it";
}

} // namespace pcl_bsh::io

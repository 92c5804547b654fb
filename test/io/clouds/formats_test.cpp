// SPDX-License-Identifier: BSD-3-Clause
#include "support/temporary_folder.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/formats.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>

#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <string>

namespace pcl_bsh::io {
namespace {

/// The rows of FORMATS.md: what it says of reading and of writing.
std::map<std::string, std::pair<std::string, std::string>> documentedFormats()
{
  std::ifstream page(PCL_BSH_SOURCE_DIR "/pcl_bsh/io/FORMATS.md");
  std::map<std::string, std::pair<std::string, std::string>> rows;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("| `.", 0) != 0) continue;
    const std::size_t read = line.find(" | "), write = line.find(" | ", read + 3), kept = line.find(" | ", write + 3);
    const std::string names = line.substr(0, read);
    for (const CloudFormat& format : cloud_formats)
      if (names.find('`' + std::string(format.extension) + '`') < names.find(" of "))
        rows[std::string(format.extension)] = {line.substr(read + 3, write - read - 3),
                                               line.substr(write + 3, kept - write - 3)};
  }
  return rows;
}

TEST(CloudFormats, AreThoseOfThePage)
{
  const auto rows = documentedFormats();
  EXPECT_EQ(rows.size(), std::size(cloud_formats));
  for (const CloudFormat& format : cloud_formats) {
    SCOPED_TRACE(format.extension);
    const auto& [read, write] = rows.at(std::string(format.extension));
    EXPECT_EQ(read.find("faces") != std::string::npos, format.has_faces);
    EXPECT_EQ(write != "no", format.is_written);
  }
}

TEST(CloudFormats, AreReadAndWrittenAsTheTableSays)
{
  const files::TemporaryFolder folder;
  for (const CloudFormat& format : cloud_formats) {
    const std::filesystem::path file = folder / ("a" + std::string(format.extension));
    SCOPED_TRACE(file);
    EXPECT_EQ(cloudFormat(format.extension), &format);
    EXPECT_EQ(mayHaveFaces(file), format.has_faces);
    if (isWritten(format))
      EXPECT_NO_THROW(requireWritableCloud(file));
    else
      EXPECT_THROW(requireWritableCloud(file), files::FileError);
  }
  EXPECT_EQ(cloudFormat(".doc"), nullptr);
  EXPECT_EQ(cloudFormat(""), nullptr);
}

TEST(CloudFormats, AreListedInHelp)
{
  EXPECT_EQ(withFormats("Reads {read}, not {unwritten}."),
            std::string("Reads .pcd .ply .las .laz .e57 .obj .off .stl .pts .ptx .csv .xyz .asc .txt, not ") +
                (writesLaz() ? ".e57 .off .stl." : ".laz .e57 .off .stl."));
  EXPECT_EQ(extensionsOf(isWritten, ", ", " or "), std::string(".pcd, .ply, .las, ") + (writesLaz() ? ".laz, " : "") +
                                                       ".obj, .pts, .ptx, .csv, .xyz, .asc or .txt");
}

TEST(CloudFormats, OnlyOneBeginsSo)
{
  for (const auto& [beginning, extension] : std::map<std::string, std::string>{{"# .PCD v0.7", ".pcd"},
                                                                               {"VERSION 0.7", ".pcd"},
                                                                               {"ply\nformat", ".ply"},
                                                                               {"LASF", ".las"},
                                                                               {"OFF\n8 6 0\n", ".off"},
                                                                               {"1 2 3\n", ""}}) {
    std::string told;
    for (const CloudFormat& format : cloud_formats)
      if (format.begins && format.begins(beginning)) told += format.extension;
    EXPECT_EQ(told, extension) << beginning;
  }
}

} // namespace
} // namespace pcl_bsh::io

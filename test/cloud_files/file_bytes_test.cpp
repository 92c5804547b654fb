// SPDX-License-Identifier: BSD-3-Clause
#include "samples.h"

#include <pcl_bsh/filters/cloud_files/cloud_file.h>
#include <pcl_bsh/filters/cloud_files/file_bytes.h>

#include <sys/stat.h>

#include <thread>

namespace pcl_bsh::io {

namespace fs = std::filesystem;

TEST(FileBytes, AreAllOrTheFirst)
{
  const TemporaryFolder folder;
  for (const std::size_t size : {1U, 4096U, 65536U, 65537U, 1000000U}) {
    std::string content(size, 'a');
    content.back() = 'z';
    const fs::path file = folder.write("file", content);
    EXPECT_TRUE(FileBytes(file).view() == content);
    EXPECT_TRUE(FileBytes(file).isWhole());
    const FileBytes first(file, 1000);
    EXPECT_EQ(first.view(), content.substr(0, 1000));
    EXPECT_EQ(first.isWhole(), size == 1);
  }
}

TEST(FileBytes, StayWhenTheFileIsCutShort)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", std::string(1000000, 'a'));
  const FileBytes bytes(file);
  fs::resize_file(file, 1); // what is mapped and cut off ends the process
  EXPECT_EQ(std::count(bytes.view().begin(), bytes.view().end(), 'a'), 1000000);
}

TEST(FileBytes, ComeThroughPipes)
{
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto through = [&](const std::string& content) {
    return std::thread([&pipe, content] { std::ofstream(pipe) << content; });
  };
  const std::string content(300000, 'a');
  std::thread writer = through(content);
  EXPECT_TRUE(FileBytes(pipe).view() == content);
  writer.join();

  // What it holds is told by how it begins.
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                          "property float z\nend_header\n1 2 3\n";
  for (const std::string& cloud :
       {ply, std::string("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n"),
        std::string("OFF 1 0 0\n1 2 3\n"), std::string("1 2 3\n")}) {
    writer = through(cloud);
    EXPECT_EQ(valueOf(readCloud(pipe), 0, "z"), 3) << cloud;
    writer.join();
  }
  writer = through("");
  EXPECT_THROW(FileBytes{pipe}, CloudFileError);
  writer.join();
  EXPECT_THROW(readCloudHeader(pipe), CloudFileError) << "it would be gone for readCloud()";
}

TEST(FileBytes, HeadersAreReadAlone)
{
  const TemporaryFolder folder;
  const std::string begin = "ply\nformat ascii 1.0\n";
  const std::string end = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";
  std::string comments;
  while (comments.size() < 200000) comments += "comment more than one reads at first\n";
  EXPECT_EQ(readCloudHeader(folder.write("long.ply", begin + comments + end)).fields.size(), 3U);
}

} // namespace pcl_bsh::io

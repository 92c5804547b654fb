// SPDX-License-Identifier: BSD-3-Clause
#include "defect.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/file_bytes.h>

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
  writer = through("");
  EXPECT_THROW(FileBytes{pipe}, files::FileError);
  writer.join();
}

} // namespace pcl_bsh::io

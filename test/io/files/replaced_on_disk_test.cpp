// SPDX-License-Identifier: BSD-3-Clause
// The state after a loss of power: the content is on the disk before it gets its name, and the name before the call
// returns.
#include "support/disk_calls.h"
#include "support/temporary_folder.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/new_file.h>
#include <pcl_bsh/io/files/replace_file.h>

#include <gmock/gmock.h>

#include <cerrno>

namespace pcl_bsh::files {
namespace {

using testing::ElementsAre;

class ReplacedOnDisk : public testing::Test {
protected:
  void replace()
  {
    replaceFile(file, [](std::ostream& out) { out << "new"; });
  }

  /// The call fails: the file is as it was, and nothing is left beside it.
  void expectKept(const std::string& call)
  {
    {
      test::DiskCalls disk;
      disk.failing[call] = EIO;
      EXPECT_THROW(replace(), FileError) << call;
      EXPECT_EQ(disk.calls.back(), call) << "and nothing after it";
    }
    EXPECT_EQ(contentOf(file), "old") << call;
    EXPECT_EQ(folder.files(), 1U) << call;
  }

  void SetUp() override
  {
    replaceFile(file, [](std::ostream& out) { out << "old"; });
  }

  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "out";
  const std::string fsync_folder = "fsync " + file.parent_path().filename().string();
};

TEST_F(ReplacedOnDisk, ContentThenNameThenFolder)
{
  test::DiskCalls disk;
  replace();
  EXPECT_THAT(disk.calls, ElementsAre("write out.part0", "fsync out.part0", "rename out.part0 out", fsync_folder));
}

/// Content larger than the buffer is written at once, after the buffer's content.
TEST_F(ReplacedOnDisk, LargeContentInOneCall)
{
  test::DiskCalls disk;
  replaceFile(file, [](std::ostream& out) { out << "head" << std::string(1 << 20, 'x') << "tail"; });
  EXPECT_EQ(disk.made, 3U + 3U) << "of which fsync, rename and fsync";
}

TEST_F(ReplacedOnDisk, KeepsTheOldFileWhereTheNewOneCannotBeBroughtToTheDisk)
{
  expectKept("write out.part0");
  expectKept("fsync out.part0");
  expectKept("rename out.part0 out");
}

TEST_F(ReplacedOnDisk, TellsThatTheNameMayNotSurvive)
{
  test::DiskCalls disk;
  disk.failing[fsync_folder] = EIO;
  EXPECT_THROW(replace(), FileError);
}

TEST_F(ReplacedOnDisk, OnFileSystemsThatCannotSyncFolders)
{
  test::DiskCalls disk;
  for (const int error : {EINVAL, ENOTSUP}) {
    disk.failing[fsync_folder] = error;
    EXPECT_NO_THROW(replace());
  }
}

/// As by a signal that the program handles.
TEST_F(ReplacedOnDisk, WritesAgainWhatWasInterrupted)
{
  test::DiskCalls disk;
  disk.failing_once["write out.part0"] = EINTR;
  replace();
  EXPECT_EQ(contentOf(file), "new");
  NewFile other(folder / "other");
  disk.failing_once["write other"] = EINTR;
  other.append("abc");
  EXPECT_TRUE(disk.failing_once.empty());
  EXPECT_EQ(contentOf(folder / "other"), "abc");
}

/// Whoever writes may stop at once.
TEST_F(ReplacedOnDisk, TellsTheWriterThatWritingFails)
{
  test::DiskCalls disk;
  disk.failing["write out.part0"] = ENOSPC;
  const auto writing = [&](const auto& write) {
    EXPECT_THROW(replaceFile(file,
                             [&](std::ostream& out) {
                               write(out);
                               EXPECT_TRUE(out.bad());
                             }),
                 FileError);
    EXPECT_EQ(contentOf(file), "old");
  };
  writing([](std::ostream& out) {
    for (int i = 0; i <= 1 << 16; ++i) out.put('x'); // one more than the buffer holds
  });
  writing([](std::ostream& out) { out << std::string((1 << 16) + 1, 'x'); });
  writing([](std::ostream& out) { out << 'x' << std::flush; });
}

} // namespace
} // namespace pcl_bsh::files

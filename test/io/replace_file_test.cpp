// SPDX-License-Identifier: BSD-3-Clause
#include "samples.h"

#include <pcl_bsh/filters/io/cloud_file_error.h>
#include <pcl_bsh/filters/io/replace_file.h>

#include <sys/stat.h>

namespace pcl_bsh::io {

namespace fs = std::filesystem;

TEST(ReplaceFile, WritesAndReplaces)
{
  const TemporaryFolder folder;
  const fs::path file = folder / "out";
  replaceFile(file, [](std::ostream& out) { out << "first"; });
  EXPECT_EQ(contentOf(file), "first");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  replaceFile(file, [&](std::ostream& out) {
    out << "second";
    EXPECT_EQ(contentOf(file), "first") << "is there until the new one is complete";
  });
  EXPECT_EQ(contentOf(file), "second");
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(folder.files(), 1U);
}

TEST(ReplaceFile, LeavesNothingBehindWhenWritingFails)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("out", "old");
  EXPECT_THROW(replaceFile(file, [](std::ostream&) { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_THROW(replaceFile(file, [](std::ostream& out) { out.setstate(std::ios::badbit); }), CloudFileError);
  EXPECT_EQ(contentOf(file), "old");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(ReplaceFile, UnfinishedFilesCanBeDiscarded)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("out", "old");
  EXPECT_THROW(replaceFile(file,
                           [&](std::ostream& out) {
                             out << "new";
                             EXPECT_EQ(folder.files(), 2U);
                             discardUnfinishedFiles();
                             EXPECT_EQ(folder.files(), 1U);
                           }),
               CloudFileError);
  EXPECT_EQ(contentOf(file), "old");
  replaceFile(file, [](std::ostream& out) { out << "newer"; });
  EXPECT_EQ(contentOf(file), "newer");
}

TEST(ReplaceFile, FollowsLinks)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "old");
  fs::create_symlink(file, folder / "link");
  replaceFile(folder / "link", [](std::ostream& out) { out << "new"; });
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(contentOf(file), "new");
}

TEST(ReplaceFile, DoesNotReplaceDevices)
{
  replaceFile("/dev/null", [](std::ostream& out) { out << "gone"; });
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(ReplaceFile, SaysWhatIsWrongWithTheDisk)
{
  try {
    replaceFile("/dev/full", [](std::ostream& out) { out << "text"; });
    FAIL();
  }
  catch (const CloudFileError& error) {
    EXPECT_STREQ(error.what(), "/dev/full: cannot be written (No space left on device): choose a folder with room that "
                               "you may write to");
  }
}

TEST(ReplaceFile, RefusesFoldersBeforeWriting)
{
  const TemporaryFolder folder;
  const auto never = [](std::ostream&) { FAIL(); };
  EXPECT_THROW(replaceFile(folder / "nowhere/out", never), CloudFileError);
  EXPECT_THROW(replaceFile(folder / "", never), CloudFileError);
  fs::create_directory(folder / "sub");
  EXPECT_THROW(replaceFile(folder / "sub", never), CloudFileError);
  EXPECT_NO_THROW(requireWritable(folder / "new"));
  EXPECT_FALSE(fs::exists(folder / "new"));
}

} // namespace pcl_bsh::io

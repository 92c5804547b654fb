// SPDX-License-Identifier: BSD-3-Clause
#include "support/temporary_folder.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/files/unfinished.h>

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

namespace pcl_bsh::files {

namespace fs = std::filesystem;

TEST(OutputFolder, GoesUnlessSomethingIsInIt)
{
  const TemporaryFolder folder;
  {
    const OutputFolder made(folder / "a/b/");
    EXPECT_TRUE(fs::is_directory(folder / "a/b"));
  }
  EXPECT_EQ(folder.files(), 0U);
  {
    const OutputFolder made(folder / "a/b");
    replaceFile(folder / "a/out", [](std::ostream& out) { out << "x"; });
  }
  EXPECT_TRUE(fs::exists(folder / "a/out"));
  EXPECT_FALSE(fs::exists(folder / "a/b"));
  {
    const OutputFolder found(folder / "a");
    fs::remove(folder / "a/out");
  }
  EXPECT_TRUE(fs::exists(folder / "a")) << "was there before";
}

TEST(OutputFolder, IsDiscardedWithWhatIsInIt)
{
  const TemporaryFolder folder;
  const OutputFolder made(folder / "a/b");
  const FileReplacement file(folder / "a/b/out");
  discardUnfinished();
  EXPECT_EQ(folder.files(), 0U);
}

TEST(OutputFolder, SaysWhatIsInTheWay)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "x");
  EXPECT_THROW(OutputFolder made(file), FileError);
  EXPECT_THROW(OutputFolder made(file / "sub/sub"), FileError);
  EXPECT_EQ(folder.files(), 1U);
}

TEST(OutputFolder, TakesBackTheFoldersAboveOneThatCannotBeMade)
{
  const TemporaryFolder folder;
  try {
    const OutputFolder made(folder / "a/b" / std::string(300, 'x'));
    ADD_FAILURE() << "a name of 300 letters was accepted";
  }
  catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("cannot be made (File name too long)"), std::string::npos) << error.what();
  }
  EXPECT_EQ(folder.files(), 0U);
}

TEST(OutputFolder, MayBeMadeBySomeoneElseMeanwhile)
{
  const TemporaryFolder folder;
  std::string wrong;
  auto lock = lockUnfinished();
  std::thread maker([&] {
    try {
      const OutputFolder made(folder / "a");
    }
    catch (const FileError& error) {
      wrong = error.what();
    }
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(50)); // it has looked, and waits for the lock
  fs::create_directory(folder / "a");
  lock.unlock();
  maker.join();
  EXPECT_EQ(wrong, "");
  EXPECT_TRUE(fs::exists(folder / "a")) << "is not its own";
}

TEST(OutputFolder, IsNoLinkToNothing)
{
  const TemporaryFolder folder;
  fs::create_symlink("nowhere", folder / "link");
  for (const char* name : {"link", "link/sub"}) {
    try {
      const OutputFolder made(folder / name);
      ADD_FAILURE() << name;
    }
    catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("link' is a link to what is not there"), std::string::npos);
    }
  }
  EXPECT_FALSE(fs::exists(folder / "nowhere"));
  fs::create_symlink("loop", folder / "loop");
  EXPECT_THROW(OutputFolder made(folder / "loop"), FileError);
  fs::create_directory(folder / "somewhere");
  fs::create_symlink("somewhere", folder / "good");
  const OutputFolder made(folder / "good/sub");
  EXPECT_TRUE(fs::is_directory(folder / "somewhere/sub"));
}

} // namespace pcl_bsh::files

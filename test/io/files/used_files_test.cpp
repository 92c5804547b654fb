// SPDX-License-Identifier: BSD-3-Clause
#include "support/temporary_folder.h"

#include <pcl_bsh/io/files/used_files.h>

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pcl_bsh::files {

namespace fs = std::filesystem;

namespace {

UsedFile in(const std::string& name, const fs::path& path)
{
  return {name, path, Use::read};
}

UsedFile out(const std::string& name, const fs::path& path, const std::string& replaces = "")
{
  return {name, path, Use::written, replaces};
}

/// `file` and `other` of the clash, by their names, and what is wrong.
std::string clashOf(const std::vector<UsedFile>& files)
{
  const auto clash = findClash(files);
  return clash ? files[clash->file].name + ": " + clash->wrong : "";
}

} // namespace

TEST(UsedFiles, ReadingIsNoClash)
{
  const TemporaryFolder folder;
  const fs::path a = folder.write("a", "x"), b = folder.write("b", "x");
  EXPECT_EQ(clashOf({in("A", a), in("B", a), out("C", b), out("D", folder / "d")}), "");
}

TEST(UsedFiles, AnyTwoNamesOfOneFile)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "x");
  fs::create_directory(folder / "sub");
  fs::create_symlink(file, folder / "link");
  fs::create_hard_link(file, folder / "hard");
  fs::create_directory_symlink(folder.path(), folder / "sub/up");
  fs::create_symlink("new", folder / "dangling");
  const std::string read = "B: is the file of A, which is read: choose another name";
  const std::string twice = "B: is the file of A, too: choose another name";
  for (const char* other : {"file", "./file", "sub/../file", "link", "hard", "sub/up/file", "sub/up/sub/up/link"}) {
    EXPECT_EQ(clashOf({in("A", file), out("B", folder / other)}), read) << other;
    EXPECT_EQ(clashOf({out("B", folder / other), in("A", file)}), read) << other;
    EXPECT_EQ(clashOf({out("A", file), out("B", folder / other)}), twice) << other;
  }
  // None of these is there yet.
  for (const char* other : {"new", "./new", "sub/../new", "sub/up/new", "dangling", "sub/up/dangling", "NEW", "./New"})
    EXPECT_EQ(clashOf({out("A", folder / "new"), out("B", folder / other)}), twice) << other;
  EXPECT_EQ(clashOf({out("A", folder / "AMZ"), out("B", folder / "amz")}), twice) << "on disks that know no capitals";
  EXPECT_EQ(clashOf({out("A", folder / "@["), out("B", folder / "`{")}), "");
  for (const char* other : {"nowhere/new", "nowhere/./new", "sub/up/nowhere/new", "sub/../nowhere/new"})
    EXPECT_EQ(clashOf({out("A", folder / "nowhere/new"), out("B", folder / other)}), twice) << other;
  for (const char* other : {"newer", "sub/new", "file", "nowhere/new"})
    EXPECT_EQ(clashOf({out("A", folder / "new"), out("B", folder / other)}), "") << other;
}

TEST(UsedFiles, RelativeToTheFolderOfTheProgram)
{
  const fs::path name = "pcl_bsh_no_such_file";
  EXPECT_NE(clashOf({out("A", name), out("B", "." / name)}), "");
  EXPECT_NE(clashOf({out("A", name), out("B", fs::current_path() / name)}), "");
}

TEST(UsedFiles, WhatTheUserWantsReplaced)
{
  const TemporaryFolder folder;
  const fs::path a = folder.write("a", "x");
  EXPECT_EQ(clashOf({in("A", a), out("B", a, "A")}), "");
  EXPECT_EQ(clashOf({in("A", a), in("C", a), out("B", a, "A")}),
            "B: is the file of C, which is read: choose another name");
  EXPECT_NE(clashOf({in("A", a), out("B", a, "A"), out("C", a, "A")}), "") << "by one";
}

TEST(UsedFiles, PipesCanBeReadOnceAndDevicesTakeAnything)
{
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(clashOf({in("A", pipe), in("B", pipe)}),
            "B: is the pipe of A, and can be read only once: save it to a file first");
  EXPECT_NE(clashOf({out("A", pipe), out("B", pipe)}), "");
  EXPECT_EQ(clashOf({in("A", "/dev/null"), out("B", "/dev/null"), out("C", "/dev/null")}), "");
}

TEST(UsedFiles, APipeIsNotWrittenToByItsReader)
{
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(clashOf({in("A", pipe), out("B", pipe)}), "B: is the file of A, which is read: choose another name");
  EXPECT_EQ(clashOf({out("B", pipe), in("A", pipe)}), "B: is the file of A, which is read: choose another name");
}

/// Files of which only the name is known.
TEST(UsedFiles, FoldersThatLeadBackToThemselvesAreTwoWhereTheyHaveTwoNames)
{
  const TemporaryFolder folder;
  for (const char* loop : {"loop", "round"}) fs::create_symlink(loop, folder / loop);
  EXPECT_EQ(clashOf({out("A", folder / "loop/file"), out("B", folder / "round/file")}), "");
  EXPECT_NE(clashOf({out("A", folder / "loop/file"), out("B", folder / "loop/file")}), "");
}

/// They may be led to a file, which has a name of its own.
TEST(UsedFiles, StandardStreamsAreWhatTheyAreLedTo)
{
  const TemporaryFolder folder;
  const fs::path a = folder.write("a", "x"), b = folder.write("b", "x");
  const auto clashWith = [](int stream, const fs::path& led_to, const std::vector<UsedFile>& files) {
    const int before = dup(stream), file = open(led_to.c_str(), O_RDWR | O_CLOEXEC);
    dup2(file, stream);
    const std::string clash = clashOf(files);
    dup2(before, stream);
    close(before);
    close(file);
    return clash;
  };
  const std::string read = "B: is the file of A, which is read: choose another name";
  EXPECT_EQ(clashWith(STDIN_FILENO, a, {in("A", "-"), out("B", a)}), read);
  EXPECT_EQ(clashWith(STDIN_FILENO, a, {in("A", "-"), out("B", b)}), "");
  EXPECT_EQ(clashWith(STDOUT_FILENO, a, {in("A", a), out("B", "-")}), read);
  EXPECT_EQ(clashWith(STDOUT_FILENO, a, {in("A", b), out("B", "-")}), "");
  EXPECT_EQ(clashWith(STDOUT_FILENO, a, {in("A", "-"), out("B", "-")}), "") << "input and output are two";
}

} // namespace pcl_bsh::files

// SPDX-License-Identifier: BSD-3-Clause
#include "support/temporary_folder.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/new_file.h>
#include <pcl_bsh/io/files/one_line.h>
#include <pcl_bsh/io/files/unfinished.h>

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace pcl_bsh::files {

namespace fs = std::filesystem;

TEST(NewFile, GoesOnWhereAnEarlierRunEnded)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "written, and half of");
  {
    NewFile again(file, 8);
    again.append("anew");
  }
  EXPECT_EQ(contentOf(file), "written,anew") << "and stays";
}

TEST(NewFile, RefusesWhatHasBecomeShorterOrIsGone)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "short");
  EXPECT_NO_THROW(NewFile(file, 5));
  for (const fs::path& wrong : {file, folder / "none"}) {
    try {
      const NewFile again(wrong, 6);
      ADD_FAILURE() << wrong;
    }
    catch (const FileError& error) {
      EXPECT_NE(std::string(error.what()).find("is shorter than it was when it was last written: remove the folder"),
                std::string::npos)
          << error.what();
    }
  }
  EXPECT_EQ(contentOf(file), "short");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(NewFile, IsGoneUnlessItIsKept)
{
  const TemporaryFolder folder;
  {
    NewFile file(folder / "left");
    file.append("abc");
    EXPECT_EQ(contentOf(folder / "left"), "abc");
  }
  EXPECT_EQ(folder.files(), 0U);
  {
    NewFile file(folder / "kept");
    file.append("head, ");
    file.append("and more");
    file.append("");
    file.append(".");
    file.replaceHead("HEAD");
    file.keep();
    static_cast<void>(discardUnfinished()); // as when the program is told to stop
  }
  EXPECT_EQ(contentOf(folder / "kept"), "HEAD, and more.");
  EXPECT_THROW(NewFile(folder / "kept"), FileError) << "nobody's file is written to";
  EXPECT_EQ(contentOf(folder / "kept"), "HEAD, and more.");
}

/// A file with the name of a file that is gone is nobody's unfinished file.
TEST(NewFile, IsForgottenWhenItIsGone)
{
  const TemporaryFolder folder;
  NewFile(folder / "file").append("abc");
  EXPECT_THROW(NewFile(folder / "none" / "file"), FileError);
  folder.write("file", "of somebody else");
  fs::create_directory(folder / "none");
  folder.write("none/file", "as well");
  static_cast<void>(discardUnfinished());
  EXPECT_EQ(contentOf(folder / "file"), "of somebody else");
  EXPECT_EQ(contentOf(folder / "none/file"), "as well");
}

TEST(NewFile, IsRemovedWhenTheProgramIsToldToStop)
{
  const TemporaryFolder folder;
  NewFile file(folder / "file");
  static_cast<void>(discardUnfinished());
  EXPECT_EQ(folder.files(), 0U);
}

/// An error other than an interruption is not tried again.
TEST(NewFile, TellsThatTheDiskIsFull)
{
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    alarm(10);
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {6, 6};
    setrlimit(RLIMIT_FSIZE, &limit);
    NewFile file(folder / "file");
    file.append("room");
    try {
      file.append(", and none");
    }
    catch (const FileError& error) {
      _exit(std::string(error.what()).find("file: cannot be written (File too large): ") != std::string::npos ? 3 : 4);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3);
}

TEST(OneLine, HasNoCharacterThatSteersATerminal)
{
  EXPECT_EQ(oneLine("a\nb\x1b[31m\x7f\tc"), "a?b?[31m??c");
  EXPECT_EQ(oneLine(std::string("\0 ~", 3)), "? ~");
  EXPECT_EQ(oneLine("\xc3\xa4"), "\xc3\xa4");
}

TEST(NewFile, SaysThatItMayNotBeCut)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "longer");
  fs::permissions(folder.path(), fs::perms::all);
  fs::permissions(file, fs::perms::owner_read | fs::perms::others_read);
  const pid_t child = fork();
  if (child == 0) {
    constexpr uid_t nobody = 65534;
    if (geteuid() == 0 && (setgid(nobody) != 0 || setuid(nobody) != 0)) _exit(1);
    try {
      const NewFile again(file, 4);
    }
    catch (const FileError& error) {
      _exit(std::string(error.what()).find("file: cannot be written (Permission denied): ") != std::string::npos ? 3
                                                                                                                 : 4);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3);
  EXPECT_EQ(contentOf(file), "longer");
}

} // namespace pcl_bsh::files

// SPDX-License-Identifier: BSD-3-Clause
#include "support/temporary_folder.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/files/unfinished.h>

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <functional>
#include <set>
#include <thread>

namespace pcl_bsh::files {

namespace fs = std::filesystem;

namespace {

/// In a process of its own. @return its exit code; -1 when a signal ended it
int exitCodeOf(const std::function<int()>& body)
{
  const pid_t child = fork();
  if (child == 0) _exit(body());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

constexpr uid_t nobody = 65534;

mode_t modeOf(const fs::path& path)
{
  struct stat status = {};
  stat(path.c_str(), &status);
  return status.st_mode & 07777;
}

} // namespace

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

TEST(ReplaceFile, EveryByteArrives)
{
  const TemporaryFolder folder;
  std::string wanted;
  replaceFile(folder / "out", [&](std::ostream& out) {
    for (const std::size_t size : {1U, 65535U, 65536U, 65537U, 3U, 200000U, 0U, 65533U}) { // about the buffer's size
      const std::string piece(size, static_cast<char>('a' + wanted.size() % 26));
      out << piece;
      out.put('\n');
      wanted += piece + '\n';
    }
  });
  EXPECT_TRUE(contentOf(folder / "out") == wanted);
}

TEST(ReplaceFile, LeavesNothingBehindWhenWritingFails)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("out", "old");
  EXPECT_THROW(replaceFile(file, [](std::ostream&) { throw std::runtime_error("no"); }), std::runtime_error);
  EXPECT_THROW(replaceFile(file, [](std::ostream& out) { out.setstate(std::ios::badbit); }), FileError);
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
                             discardUnfinished();
                             EXPECT_EQ(folder.files(), 1U);
                           }),
               FileError);
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

TEST(ReplaceFile, FollowsLinksThatLeadToNoFileYet)
{
  const TemporaryFolder folder;
  fs::create_directory(folder / "sub");
  fs::create_symlink("sub/second", folder / "first");
  fs::create_symlink("file", folder / "sub/second");
  replaceFile(folder / "first", [](std::ostream& out) { out << "new"; });
  EXPECT_TRUE(fs::is_symlink(folder / "first"));
  EXPECT_TRUE(fs::is_symlink(folder / "sub/second"));
  EXPECT_EQ(contentOf(folder / "sub/file"), "new");

  fs::create_symlink("round", folder / "round");
  EXPECT_THROW(requireWritable(folder / "round"), FileError);
}

TEST(ReplaceFile, APrivateFileIsPrivateFromItsFirstByte)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("out", "old");
  fs::permissions(file, fs::perms::owner_read | fs::perms::owner_write);
  FileReplacement replacement(file);
  EXPECT_EQ(modeOf(replacement.name()), 0600U);
  replacement.stream() << "secret";
  replacement.commit();
  EXPECT_EQ(modeOf(file), 0600U);

  const mode_t mask = umask(027);
  const FileReplacement fresh(folder / "fresh");
  umask(mask);
  EXPECT_EQ(modeOf(fresh.name()), 0640U) << "a new file has the permissions of any other";
}

TEST(ReplaceFile, KeepsTheOwner)
{
  if (geteuid() != 0) GTEST_SKIP() << "give files away: run as root";
  const TemporaryFolder folder;
  const fs::path file = folder.write("out", "old");
  ASSERT_EQ(chown(file.c_str(), nobody, nobody), 0);
  ASSERT_EQ(chmod(file.c_str(), 0640), 0);
  replaceFile(file, [](std::ostream& out) { out << "new"; });
  struct stat status = {};
  ASSERT_EQ(stat(file.c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, nobody);
  EXPECT_EQ(status.st_gid, nobody);
  EXPECT_EQ(modeOf(file), 0640U);

  // Who may not give it away does not open it to a group of his own.
  ASSERT_EQ(chmod(folder.path().c_str(), 0777), 0);
  const fs::path ours = folder.write("ours", "old");
  ASSERT_EQ(chmod(ours.c_str(), 0666), 0);
  ASSERT_EQ(chown(ours.c_str(), 0, 12345), 0);
  ASSERT_EQ(chmod(ours.c_str(), 0662), 0);
  EXPECT_EQ(exitCodeOf([&] {
              if (setgid(nobody) != 0 || setuid(nobody) != 0) return 1;
              replaceFile(ours, [](std::ostream& out) { out << "new"; });
              return 0;
            }),
            0);
  EXPECT_EQ(modeOf(ours), 0622U);
}

TEST(ReplaceFile, AProtectedFileIsNotReplaced)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("out", "old");
  ASSERT_EQ(chmod(file.c_str(), 0444), 0);
  ASSERT_EQ(chmod(folder.path().c_str(), 0777), 0);
  EXPECT_EQ(exitCodeOf([&] {
              if (geteuid() == 0 && (setgid(nobody) != 0 || setuid(nobody) != 0)) return 1;
              try {
                replaceFile(file, [](std::ostream& out) { out << "new"; });
              }
              catch (const FileError&) {
                return 3;
              }
              return 0;
            }),
            3);
  EXPECT_EQ(contentOf(file), "old");
  EXPECT_EQ(folder.files(), 1U);
}

TEST(ReplaceFile, LongNames)
{
  const TemporaryFolder folder;
  const std::string longest(255, 'x');
  replaceFile(folder / longest, [](std::ostream& out) { out << "new"; });
  EXPECT_EQ(contentOf(folder / longest), "new");
  EXPECT_THROW(requireWritable(folder / (longest + "x")), FileError);
}

TEST(ReplaceFile, AFullDiskIsAnErrorAtEveryByte)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("out", "old");
  for (const rlim_t room : {0U, 1U, 65535U, 65536U, 65537U, 131071U}) {
    EXPECT_EQ(
        exitCodeOf([&] {
          std::signal(SIGXFSZ, SIG_IGN);
          const rlimit limit = {room, room};
          setrlimit(RLIMIT_FSIZE, &limit);
          try {
            replaceFile(file, [](std::ostream& out) { out << std::string(70000, 'a') << std::string(61072, 'b'); });
          }
          catch (const FileError& error) {
            return std::string(error.what()).find("out: cannot be written (File too large): ") != std::string::npos ? 3
                                                                                                                    : 4;
          }
          return 0;
        }),
        3)
        << room;
    EXPECT_EQ(contentOf(file), "old");
    EXPECT_EQ(folder.files(), 1U);
  }
}

TEST(ReplaceFile, KilledAtAnyMomentTheOldFileOrTheNew)
{
  const TemporaryFolder folder;
  const std::string before(300000, 'o'), after(400000, 'n');
  std::size_t replaced = 0, kept = 0;
  for (int moment = 0; moment < 60; ++moment) {
    const fs::path file = folder.write("out", before);
    const pid_t child = fork();
    if (child == 0) {
      replaceFile(file, [&](std::ostream& out) {
        for (std::size_t i = 0; i < after.size(); i += 4000) out << after.substr(i, 4000) << std::flush;
      });
      _exit(0);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(100 * moment));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const std::string found = contentOf(file);
    ASSERT_TRUE(found == before || found == after) << found.size();
    replaced += found == after;
    kept += found == before;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder.path()))
      EXPECT_TRUE(entry.path() == file || entry.path().filename().string().rfind("out.part", 0) == 0) << entry.path();
  }
  EXPECT_GT(kept, 0U) << replaced;
}

TEST(ReplaceFile, DoesNotReplaceDevices)
{
  replaceFile("/dev/null", [](std::ostream& out) { out << "gone"; });
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(ReplaceFile, SaysWhatCannotBeOpened)
{
  const TemporaryFolder folder;
  const fs::path path = folder / "socket";
  sockaddr_un address = {AF_UNIX, {}};
  path.string().copy(address.sun_path, sizeof address.sun_path - 1);
  const int listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  close(listener);
  try {
    const FileReplacement replacement(path);
    FAIL();
  }
  catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("cannot be written (No such device or address)"), std::string::npos)
        << error.what();
  }
  EXPECT_TRUE(fs::is_socket(path));
}

TEST(ReplaceFile, SaysWhatIsWrongWithTheDisk)
{
  try {
    replaceFile("/dev/full", [](std::ostream& out) { out << "text"; });
    FAIL();
  }
  catch (const FileError& error) {
    EXPECT_STREQ(error.what(), "/dev/full: cannot be written (No space left on device): choose a folder with room that "
                               "you may write to");
  }
}

TEST(ReplaceFile, RefusesFoldersBeforeWriting)
{
  const TemporaryFolder folder;
  const auto never = [](std::ostream&) { FAIL(); };
  EXPECT_THROW(replaceFile(folder / "nowhere/out", never), FileError);
  EXPECT_THROW(replaceFile(folder / "", never), FileError);
  fs::create_directory(folder / "sub");
  EXPECT_THROW(replaceFile(folder / "sub", never), FileError);
  EXPECT_THROW(replaceFile("", never), FileError);
  EXPECT_NO_THROW(requireWritable(folder / "new"));
  EXPECT_FALSE(fs::exists(folder / "new"));
}

TEST(ReplaceFile, AFolderThatVanishesIsAnError)
{
  const TemporaryFolder folder;
  fs::create_directory(folder / "sub");
  EXPECT_THROW(replaceFile(folder / "sub/out",
                           [&](std::ostream& out) {
                             out << "text";
                             fs::rename(folder / "sub", folder / "moved");
                           }),
               FileError);
  EXPECT_FALSE(fs::exists(folder / "sub"));
  EXPECT_FALSE(fs::exists(folder / "moved/out"));
}

TEST(ReplaceFile, RefusesFoldersBeforeAnythingIsComputed)
{
  const TemporaryFolder folder;
  try {
    requireWritable(folder.path());
    ADD_FAILURE() << "a folder was accepted";
  }
  catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("is a folder: name a file in it"), std::string::npos) << error.what();
  }
}

/// Who discards what is unfinished must not miss a file that is just being made.
TEST(ReplaceFile, MakesNoFileWhileUnfinishedOnesAreListed)
{
  const TemporaryFolder folder;
  auto lock = lockUnfinished();
  std::thread maker([&] { const FileReplacement made(folder / "out"); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(folder.files(), 0U);
  lock.unlock();
  maker.join();
}

TEST(ReplaceFile, WritesToStandardOutputWhereAsked)
{
  const TemporaryFolder folder;
  for (const char* name : {"-", "/dev/stdout"}) {
    EXPECT_NO_THROW(requireWritable(name)) << name;
    testing::internal::CaptureStdout();
    replaceFile(name, [](std::ostream& out) { out << "abc" << std::flush << std::string(100000, 'd'); });
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "abc" + std::string(100000, 'd')) << name;
  }
  EXPECT_FALSE(fs::exists("-"));
}

/// A thousand names beside the file are tried.
TEST(ReplaceFile, TakesAFreeNameIfThereIsOne)
{
  const TemporaryFolder folder;
  for (int i = 0; i < 999; ++i) folder.write("file.part" + std::to_string(i), "");
  replaceFile(folder / "file", [](std::ostream& out) { out << "abc"; });
  EXPECT_EQ(contentOf(folder / "file"), "abc");
  folder.write("file.part999", "");
  try {
    replaceFile(folder / "file", [](std::ostream& out) { out << "d"; });
    ADD_FAILURE() << "a name of another file was taken";
  }
  catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("file: cannot be written (File exists)"), std::string::npos)
        << error.what();
  }
  EXPECT_EQ(contentOf(folder / "file"), "abc");
  EXPECT_EQ(folder.files(), 1001U);
}

/// A program that is started meanwhile does not hold the file open.
TEST(ReplaceFile, IsNotInherited)
{
  const TemporaryFolder folder;
  FileReplacement file(folder / "file");
  std::size_t found = 0;
  for (int descriptor = 0; descriptor < 256; ++descriptor) {
    std::error_code error;
    const fs::path target = fs::read_symlink("/proc/self/fd/" + std::to_string(descriptor), error);
    if (error || target.filename() != "file.part0") continue;
    ++found;
    EXPECT_NE(fcntl(descriptor, F_GETFD) & FD_CLOEXEC, 0);
  }
  EXPECT_EQ(found, 1U);
}

TEST(ReplaceFile, SaysWhatIsWrongWithStandardOutput)
{
  std::fflush(stdout);
  const int before = dup(STDOUT_FILENO), full = open("/dev/full", O_WRONLY | O_CLOEXEC);
  dup2(full, STDOUT_FILENO);
  std::string wrong;
  try {
    replaceFile("-", [](std::ostream& out) { out << "text"; });
  }
  catch (const FileError& error) {
    wrong = error.what();
  }
  dup2(before, STDOUT_FILENO);
  close(before);
  close(full);
  EXPECT_EQ(wrong, "standard output: cannot be written (No space left on device): choose a folder with room that you "
                   "may write to");
}

/// It cannot be opened to be brought to the disk.
TEST(ReplaceFile, AFolderMayBeWrittenToButNotRead)
{
  const TemporaryFolder folder;
  ASSERT_EQ(chmod(folder.path().c_str(), 0733), 0);
  EXPECT_EQ(exitCodeOf([&] {
              if (geteuid() == 0 && (setgid(nobody) != 0 || setuid(nobody) != 0)) return 1;
              replaceFile(folder / "out", [](std::ostream& out) { out << "new"; });
              return 0;
            }),
            0);
  EXPECT_EQ(contentOf(folder / "out"), "new");
}

} // namespace pcl_bsh::files

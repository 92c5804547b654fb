// SPDX-License-Identifier: BSD-3-Clause
#include "defect.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/byte_source.h>
#include <pcl_bsh/io/text/file_bytes.h>

#include <gmock/gmock.h>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <memory>
#include <thread>
#include <utility>

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

TEST(FileBytes, OfAFileThatIsAsLongAsMayBeReadAreNotKnownToBeAll)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "abcd");
  EXPECT_EQ(FileBytes(file, 3).view(), "abc");
  EXPECT_FALSE(FileBytes(file, 3).isWhole());
  EXPECT_EQ(FileBytes(file, 4).view(), "abcd");
  EXPECT_FALSE(FileBytes(file, 4).isWhole()) << "nobody has looked behind the last";
  EXPECT_TRUE(FileBytes(file, 5).isWhole());
}

/// Refusals of FileBytes and openBytes(), each with its remedy.
TEST(FileBytes, AreRefusedWithReasons)
{
  const TemporaryFolder folder;
  folder.write("empty", "");
  const auto fault = [](const auto& open) -> std::string {
    try {
      open();
    }
    catch (const files::FileError& error) {
      return error.what();
    }
    return "";
  };
  const std::pair<const char*, const char*> cases[] = {{"none", "no such file: check the name"},
                                                       {"empty/none", "no such file: check the name"},
                                                       {"empty", "is empty: export or copy the file again"},
                                                       {"", "is a folder: name a file in it"}};
  for (const auto& [name, wrong] : cases) {
    EXPECT_THAT(fault([&, file = name] { FileBytes(folder / file); }), testing::EndsWith(wrong)) << name;
    EXPECT_THAT(fault([&, file = name] { openBytes(folder / file); }), testing::EndsWith(wrong)) << name;
  }
  EXPECT_THAT(fault([] { FileBytes("/dev/null"); }), testing::HasSubstr("is neither a file nor a pipe"));
  EXPECT_THAT(fault([] { FileBytes("/proc/self/mem"); }), testing::HasSubstr("cannot be read")) << "nothing lies at 0";
}

TEST(ByteSource, ReadsFromAnyPlace)
{
  const TemporaryFolder folder;
  const std::string content = "0123456789";
  const std::unique_ptr<ByteSource> file = openBytes(folder.write("file", content));
  HeldBytes held(content);
  for (ByteSource* const source : {file.get(), static_cast<ByteSource*>(&held)}) {
    EXPECT_EQ(source->size(), 10U);
    errno = EINTR; // of a call before
    EXPECT_EQ(source->text(0, 10), content);
    EXPECT_EQ(source->text(3, 4), "3456");
    EXPECT_EQ(source->text(9, 1), "9");
    EXPECT_EQ(source->text(10, 0), "");
    EXPECT_EQ(source->text(0, 1), "0") << "again, from before";
  }
  fs::resize_file(folder / "file", 5);
  EXPECT_EQ(file->text(2, 3), "234");
  EXPECT_THAT([&] { file->text(4, 2); },
              testing::ThrowsMessage<files::FileError>(testing::HasSubstr("became shorter while it was read")));
}

TEST(FileBytes, KnowWhatIsAPipe)
{
  const TemporaryFolder folder;
  const fs::path pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(isPipe(pipe));
  EXPECT_TRUE(isPipe("-"));
  EXPECT_FALSE(isPipe(folder.write("file", "a")));
  EXPECT_FALSE(isPipe(folder / "none"));
}

namespace {

/// Standard input is that descriptor, which is closed, as long as it lives.
class AsInput {
public:
  explicit AsInput(int descriptor) : before_(dup(STDIN_FILENO))
  {
    dup2(descriptor, STDIN_FILENO);
    close(descriptor);
  }
  ~AsInput()
  {
    dup2(before_, STDIN_FILENO);
    close(before_);
  }
  AsInput(const AsInput&) = delete;
  AsInput& operator=(const AsInput&) = delete;

private:
  int before_;
};

} // namespace

/// It may be a file, a pipe or a socket, and stays open.
TEST(FileBytes, OfStandardInput)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "from a file");
  {
    const AsInput input(open(file.c_str(), O_RDONLY | O_CLOEXEC));
    EXPECT_EQ(FileBytes("-").view(), "from a file");
    EXPECT_NE(fcntl(STDIN_FILENO, F_GETFD), -1);
  }
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
  ASSERT_EQ(write(ends[0], "from a socket", 13), 13);
  close(ends[0]);
  const AsInput input(ends[1]);
  EXPECT_EQ(FileBytes("-").view(), "from a socket");
}

/// Which ends where its user says so.
TEST(FileBytes, OfATerminal)
{
  const int master = posix_openpt(O_RDWR | O_NOCTTY);
  if (master < 0 || grantpt(master) != 0 || unlockpt(master) != 0) GTEST_SKIP() << "no terminals here";
  const fs::path terminal = ptsname(master);
  const int held = open(terminal.c_str(), O_RDWR | O_NOCTTY); // or what is typed before it is opened is lost
  ASSERT_EQ(write(master, "1 2 3\n\x04", 7), 7);
  EXPECT_EQ(FileBytes(terminal).view(), "1 2 3\n");
  close(held);
  close(master);
}

TEST(FileBytes, TellWhatTheSystemSays)
{
  const TemporaryFolder folder;
  fs::create_symlink("loop", folder / "loop");
  const std::string wrong =
      "loop: cannot be opened (Too many levels of symbolic links): check its permissions and its disk";
  EXPECT_THAT([&] { FileBytes(folder / "loop"); }, testing::ThrowsMessage<files::FileError>(testing::HasSubstr(wrong)));
  EXPECT_THAT([&] { openBytes(folder / "loop"); }, testing::ThrowsMessage<files::FileError>(testing::HasSubstr(wrong)));
  const AsInput input(open(folder.path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  close(STDIN_FILENO);
  EXPECT_THAT([] { FileBytes("-"); },
              testing::ThrowsMessage<files::FileError>(testing::HasSubstr("-: cannot be read (Bad file descriptor)")));
}

TEST(FileBytes, LeaveNoFileOpen)
{
  const TemporaryFolder folder;
  const fs::path file = folder.write("file", "a");
  const auto open_files = [] {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
  };
  const auto before = open_files();
  EXPECT_EQ(FileBytes(file).view(), "a");
  EXPECT_EQ(openBytes(file)->text(0, 1), "a");
  EXPECT_EQ(open_files(), before);
}

} // namespace pcl_bsh::io

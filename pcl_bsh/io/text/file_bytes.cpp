// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/file_identity.h>
#include <pcl_bsh/io/text/byte_source.h>
#include <pcl_bsh/io/text/file_bytes.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <system_error>

namespace pcl_bsh::io {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void failToRead(const fs::path& path, const char* what, int error)
{
  throw files::FileError(path, std::string(what) + " (" + std::generic_category().message(error) + ")",
                         "check its permissions and its disk");
}

/// Closed at the end, unless it is standard input.
class Descriptor {
public:
  explicit Descriptor(const fs::path& path)
  : number_(path == files::standard_stream ? STDIN_FILENO : open(path.c_str(), O_RDONLY | O_CLOEXEC))
  {
    if (number_ >= 0) return;
    if (errno == ENOENT || errno == ENOTDIR) throw files::FileError(path, "no such file", "check the name");
    failToRead(path, "cannot be opened", errno);
  }
  ~Descriptor()
  {
    if (number_ != STDIN_FILENO) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const noexcept { return number_; }

private:
  int number_;
};

/// Requires that a file ends, and returns its length; 0 where that is not known.
std::size_t expectedSize(const fs::path& path, int descriptor)
{
  struct stat status = {};
  if (fstat(descriptor, &status) != 0) failToRead(path, "cannot be read", errno);
  if (S_ISDIR(status.st_mode)) throw files::FileError(path, "is a folder", "name a file in it");
  const bool is_terminal = S_ISCHR(status.st_mode) && isatty(descriptor) != 0;
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode) && !S_ISSOCK(status.st_mode) && !is_terminal) {
    throw files::FileError(path, "is neither a file nor a pipe", "save the cloud to a file first");
  }
  return S_ISREG(status.st_mode) ? static_cast<std::size_t>(std::max<off_t>(status.st_size, 0)) : 0;
}

class OpenFile : public ByteSource {
public:
  explicit OpenFile(const fs::path& path)
  : path_(path),
    descriptor_(path),
    size_(expectedSize(path, descriptor_.number()))
  {
    if (size_ == 0) throw files::FileError(path, "is empty", "export or copy the file again");
  }

  std::uint64_t size() const override { return size_; }

  void read(std::uint64_t at, char* to, std::size_t count) override
  {
    while (count > 0) {
      const ssize_t got = pread(descriptor_.number(), to, count, static_cast<off_t>(at));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) failToRead(path_, "cannot be read", errno);
      if (got == 0) throw files::FileError(path_, "became shorter while it was read", "read it when it is complete");
      at += static_cast<std::uint64_t>(got);
      to += got;
      count -= static_cast<std::size_t>(got);
    }
  }

private:
  fs::path path_;
  Descriptor descriptor_;
  std::uint64_t size_;
};

} // namespace

std::unique_ptr<ByteSource> openBytes(const fs::path& path)
{
  return std::make_unique<OpenFile>(path);
}

FileBytes::FileBytes(const fs::path& path, std::size_t most)
{
  const Descriptor descriptor(path);
  try {
    read(descriptor.number(), expectedSize(path, descriptor.number()), most);
  }
  catch (const std::system_error& error) {
    failToRead(path, "cannot be read", error.code().value());
  }
  if (size_ == 0) throw files::FileError(path, "is empty", "export or copy the file again");
}

void FileBytes::reserve(std::size_t size)
{
  char* const bytes = static_cast<char*>(std::realloc(bytes_.get(), size)); // large ones move without a copy
  if (bytes == nullptr) throw std::bad_alloc();
  static_cast<void>(bytes_.release());
  bytes_.reset(bytes);
  reserved_ = size;
}

void FileBytes::read(int descriptor, std::size_t expected, std::size_t most)
{
  constexpr std::size_t step = std::size_t{1} << 16;
  reserve(std::min(expected, most - 1) + 1); // one more, to see the end
  while (size_ < most) {
    if (size_ == reserved_) reserve(std::max(size_ + size_ / 2, size_ + step));
    const ssize_t count = ::read(descriptor, bytes_.get() + size_, std::min(reserved_, most) - size_);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw std::system_error(errno, std::generic_category());
    if (count == 0) {
      is_whole_ = true;
      return;
    }
    size_ += static_cast<std::size_t>(count);
  }
}

bool isPipe(const fs::path& path)
{
  return path == files::standard_stream || files::FileIdentity(path, files::Use::read).isStream();
}

} // namespace pcl_bsh::io

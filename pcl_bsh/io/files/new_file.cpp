// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/new_file.h>
#include <pcl_bsh/io/files/unfinished.h>
#include <pcl_bsh/io/files/write_error.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

namespace pcl_bsh::files {

namespace {

/// An open descriptor, closed in the end.
class Descriptor {
public:
  Descriptor(const std::filesystem::path& path, int flags) : path_(path), number_(open(path.c_str(), flags, 0666))
  {
    if (number_ < 0) failToWrite(path, errno);
  }
  ~Descriptor() { close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write(std::string_view bytes, std::uint64_t at) const
  {
    while (!bytes.empty()) {
      const ssize_t count = pwrite(number_, bytes.data(), bytes.size(), static_cast<off_t>(at));
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) failToWrite(path_, count < 0 ? errno : ENOSPC);
      bytes.remove_prefix(static_cast<std::size_t>(count));
      at += static_cast<std::uint64_t>(count);
    }
  }

  void sync() const
  {
    if (syncfs(number_) != 0) failToWrite(path_, errno);
  }

private:
  const std::filesystem::path& path_;
  int number_;
};

} // namespace

NewFile::NewFile(const std::filesystem::path& path) : path_(path)
{
  const auto lock = lockUnfinished();
  // The name is listed first: if the list cannot grow, no file has been made. O_EXCL: no existing file is written to.
  addUnfinished(path_);
  try {
    const Descriptor made(path_, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC);
  }
  catch (...) {
    dropUnfinished(path_);
    throw;
  }
}

NewFile::NewFile(const std::filesystem::path& path, std::uint64_t size) : path_(path), size_(size), kept_(true)
{
  std::error_code error;
  const std::uint64_t there = std::filesystem::file_size(path, error);
  if (error || there < size)
    throw FileError(path, "is shorter than it was when it was last written", "remove the folder, and begin again");
  std::filesystem::resize_file(path, size, error);
  if (error) failToWrite(path, error.value());
}

NewFile::~NewFile()
{
  if (kept_) return;
  const auto lock = lockUnfinished();
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  dropUnfinished(path_);
}

void NewFile::append(std::string_view bytes)
{
  Descriptor(path_, O_WRONLY | O_CLOEXEC).write(bytes, size_);
  size_ += bytes.size();
}

void NewFile::replaceHead(std::string_view bytes)
{
  Descriptor(path_, O_WRONLY | O_CLOEXEC).write(bytes, 0);
}

void syncDisk(const std::filesystem::path& folder)
{
  Descriptor(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC).sync();
}

void NewFile::keep()
{
  if (!kept_) dropUnfinished(path_);
  kept_ = true;
}

} // namespace pcl_bsh::files

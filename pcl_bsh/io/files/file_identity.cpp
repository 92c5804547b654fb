// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/file_identity.h>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

namespace pcl_bsh::files {

namespace fs = std::filesystem;

namespace {

std::string withoutCase(std::string name)
{
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return name;
}

} // namespace

fs::path folderOf(const fs::path& path)
{
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

fs::path destinationOf(const fs::path& path)
{
  constexpr int most_links = 40; // as Linux has it
  fs::path at = path;
  for (int links = 0; links <= most_links; ++links) {
    std::error_code error;
    if (fs::symlink_status(at, error).type() != fs::file_type::symlink) {
      const fs::path folder = fs::weakly_canonical(folderOf(at), error);
      return error ? at : folder / at.filename();
    }
    const fs::path target = fs::read_symlink(at, error);
    if (error) return at;
    at = target.is_absolute() ? target : folderOf(at) / target;
  }
  throw FileError(path, "is a link that leads back to itself", "remove the link, or name another file");
}

FileIdentity::FileIdentity(const fs::path& path, Use use)
{
  struct stat status = {};
  const bool is_there = path == standard_stream ? fstat(use == Use::read ? STDIN_FILENO : STDOUT_FILENO, &status) == 0
                                                : stat(path.c_str(), &status) == 0;
  if (is_there) {
    device_ = status.st_dev;
    inode_ = status.st_ino;
    is_stream_ = S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode);
    is_device_ = S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode);
    return;
  }
  const fs::path destination = destinationOf(path);
  if (stat(folderOf(destination).c_str(), &status) == 0) {
    device_ = status.st_dev;
    inode_ = status.st_ino;
    place_ = withoutCase(destination.filename().string());
  }
  else {
    place_ = withoutCase(destination.lexically_normal().string());
  }
}

} // namespace pcl_bsh::files

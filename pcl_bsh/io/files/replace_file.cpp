// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/file_identity.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/files/unfinished.h>
#include <pcl_bsh/io/files/write_error.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <locale>
#include <string>
#include <system_error>

namespace pcl_bsh::files {

namespace fs = std::filesystem;

namespace {

/// Whether the output is written to directly, because there is no file to replace.
bool isDirect(const fs::path& path)
{
  if (path == standard_stream || path == "/dev/stdout") return true;
  std::error_code error;
  return fs::exists(path, error) && !fs::is_regular_file(path, error);
}

void requireSense(const fs::path& path)
{
  std::error_code error;
  if (isDirect(path)) {
    if (fs::is_directory(path, error)) throw FileError(path, "is a folder", "name a file in it");
    return;
  }
  const fs::path folder = folderOf(destinationOf(path));
  if (!fs::is_directory(folder, error)) {
    throw FileError(path, "cannot be written, there is no folder " + folderOf(path).string(), "create it first");
  }
  struct stat status = {}; // a name too long for the disk shows only here: the temporary one is shorter
  if (lstat(path.c_str(), &status) != 0 && errno != ENOENT) failToWrite(path, errno);
  if (!path.has_filename()) throw FileError(path, "is a folder", "name a file in it");
  if (fs::exists(path, error) && faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) failToWrite(path, errno);
}

/// A free name beside `path`, no longer than a name may be.
fs::path temporaryName(const fs::path& path, int attempt)
{
  constexpr std::size_t longest = 200;
  const std::string name = path.filename().string();
  return path.parent_path() / ((name.size() > longest ? "pcl_bsh" : name) + ".part" + std::to_string(attempt));
}

/// Makes a name survive a loss of power. Some file systems cannot, and report so.
void syncFolder(const fs::path& folder, const fs::path& named)
{
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return; // a folder that may be written to, but not read
  const int error = fsync(descriptor) != 0 ? errno : 0;
  close(descriptor);
  if (error != 0 && error != EINVAL && error != ENOTSUP) failToWrite(named, error);
}

} // namespace

FileReplacement::FileReplacement() : stream_(nullptr)
{
}

// When a statement below throws, the destructor cleans up, because the delegated constructor has ended.
FileReplacement::FileReplacement(const fs::path& path) : FileReplacement()
{
  requireSense(path);
  path_ = path;
  direct_ = isDirect(path);
  if (direct_) {
    const bool standard = path == standard_stream || path == "/dev/stdout";
    descriptor_ =
        standard ? fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0) : open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
    if (descriptor_ < 0) failToWrite(path, errno);
    name_ = path;
  }
  else {
    destination_ = destinationOf(path);
    makeTemporary();
  }
  stream_.rdbuf(&buffer_.emplace(descriptor_)); // which clears the stream's state, too
  stream_.imbue(std::locale::classic());        // files do not depend on the host's language
}

FileReplacement::~FileReplacement()
{
  if (descriptor_ >= 0) close(descriptor_);
  if (!temporary_) return;
  const auto lock = lockUnfinished();
  std::error_code ignored;
  fs::remove(name_, ignored);
  dropUnfinished(name_);
}

void FileReplacement::makeTemporary()
{
  std::error_code error;
  // The replacement of a private file is private from its first byte on.
  const mode_t mode = fs::exists(destination_, error) ? 0600 : 0666;
  const auto lock = lockUnfinished();
  for (int attempt = 0; attempt < 1000; ++attempt) {
    name_ = temporaryName(destination_, attempt);
    // O_EXCL: only if the name is free, so two programs never share one, and no planted link is followed.
    descriptor_ = open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (descriptor_ >= 0) {
      temporary_ = true;
      addUnfinished(name_);
      return;
    }
    if (errno != EEXIST) break;
  }
  failToWrite(path_, errno);
}

/// Owner and permissions of the file that is replaced.
void FileReplacement::takeOver()
{
  struct stat old = {};
  if (stat(destination_.c_str(), &old) != 0) return;
  mode_t mode = old.st_mode & 0777;
  // Only the superuser may give the owner; a member of the group may give the group. Where the group stays another, it
  // gets no more rights than all others have.
  constexpr auto as_it_is = static_cast<uid_t>(-1);
  if (fchown(descriptor_, old.st_uid, old.st_gid) != 0 && fchown(descriptor_, as_it_is, old.st_gid) != 0)
    mode &= ((mode & 07) << 3) | ~mode_t{070};
  if (fchmod(descriptor_, mode) != 0) failToWrite(path_, errno);
}

void FileReplacement::commit(const std::function<void()>& with)
{
  stream_.flush();
  if (!stream_) failToWrite(path_, buffer_->error());
  if (direct_) return;
  takeOver();
  if (fsync(descriptor_) != 0) failToWrite(path_, errno); // or the new name may outlive a loss of power without content
  {
    const auto lock = lockUnfinished();
    if (::rename(name_.c_str(), destination_.c_str()) != 0) failToWrite(path_, errno);
    dropUnfinished(name_);
    temporary_ = false;
    if (with) with();
  }
  syncFolder(folderOf(destination_), path_);
}

void replaceFile(const fs::path& path, const std::function<void(std::ostream&)>& write)
{
  FileReplacement file(path);
  write(file.stream());
  file.commit();
}

void requireWritable(const fs::path& path)
{
  if (!isDirect(path)) {
    const FileReplacement probe(path);
    return;
  }
  requireSense(path);
}

} // namespace pcl_bsh::files

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/io/cloud_file_error.h>
#include <pcl_bsh/filters/io/replace_file.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <locale>
#include <set>
#include <system_error>

namespace pcl_bsh::io {

namespace {

namespace fs = std::filesystem;

constexpr auto remedy = "choose a folder with room that you may write to";

[[noreturn]] void failToWrite(const fs::path& path, int error)
{
  const std::string reason = error != 0 ? " (" + std::generic_category().message(error) + ")" : "";
  throw CloudFileError(path, "cannot be written" + reason, remedy);
}

fs::path folderOf(const fs::path& path)
{
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// The temporary files there are.
struct Unfinished {
  std::mutex mutex;
  std::set<fs::path> names;
};

Unfinished& unfinished()
{
  static Unfinished files;
  return files;
}

/// A file of its own beside `path`, removed again unless renamed.
class TemporaryFile {
public:
  explicit TemporaryFile(const fs::path& path) : target_(path)
  {
    const std::lock_guard lock(unfinished().mutex);
    for (int attempt = 0; attempt < 1000; ++attempt) {
      name_ = path;
      name_ += ".part" + std::to_string(attempt);
      // "x": only if the name is free, so two programs never share one, and no planted link is followed.
      if (std::FILE* file = std::fopen(name_.c_str(), "wbx")) {
        std::fclose(file);
        unfinished().names.insert(name_);
        return;
      }
      if (errno != EEXIST) break;
    }
    failToWrite(path, errno);
  }

  ~TemporaryFile()
  {
    const std::lock_guard lock(unfinished().mutex);
    std::error_code ignored;
    if (!renamed_) fs::remove(name_, ignored);
    unfinished().names.erase(name_);
  }

  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const fs::path& name() const { return name_; }

  void rename()
  {
    const std::lock_guard lock(unfinished().mutex);
    std::error_code error;
    if (fs::exists(target_, error)) fs::permissions(name_, fs::status(target_).permissions(), error);
    fs::rename(name_, target_, error);
    if (error) failToWrite(target_, error.value());
    renamed_ = true;
  }

private:
  fs::path target_;
  fs::path name_;
  bool renamed_ = false;
};

void writeTo(const fs::path& file, const fs::path& named, const std::function<void(std::ostream&)>& write)
{
  errno = 0;
  std::ofstream stream(file, std::ios::binary);
  stream.imbue(std::locale::classic()); // the host's language is not the files'
  if (stream) write(stream);
  stream.close();
  if (!stream) failToWrite(named, errno);
}

} // namespace

void requireWritable(const fs::path& path)
{
  const fs::path folder = folderOf(path);
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw CloudFileError(path, "cannot be written, there is no folder " + folder.string(), "create it first");
  }
  if (fs::is_directory(path, error)) throw CloudFileError(path, "is a folder", "name a file in it");
  const bool replaced = !fs::exists(path, error) || fs::is_regular_file(path, error);
  if (replaced) TemporaryFile probe(fs::weakly_canonical(path));
}

void replaceFile(const fs::path& path, const std::function<void(std::ostream&)>& write)
{
  requireWritable(path);
  if (fs::exists(path) && !fs::is_regular_file(path)) return writeTo(path, path, write);

  TemporaryFile temporary(fs::weakly_canonical(path));
  writeTo(temporary.name(), path, write);
  temporary.rename();
}

std::unique_lock<std::mutex> discardUnfinishedFiles()
{
  std::unique_lock lock(unfinished().mutex);
  std::error_code ignored;
  for (const fs::path& name : unfinished().names) fs::remove(name, ignored);
  return lock;
}

} // namespace pcl_bsh::io

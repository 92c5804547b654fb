// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/output_folder.h>
#include <pcl_bsh/io/files/unfinished.h>

#include <algorithm>
#include <system_error>

namespace pcl_bsh::files {

namespace fs = std::filesystem;

OutputFolder::OutputFolder(const fs::path& path) : path_(path)
{
  std::error_code error;
  std::vector<fs::path> missing;
  const auto fail = [&path](const std::string& why) {
    throw FileError(path, "cannot be made (" + why + ")", "name a folder that can");
  };
  const fs::path whole = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) fail(error.message());
  for (fs::path at = whole; !fs::exists(at, error); at = at.parent_path()) {
    if (error) fail(error.message());
    if (fs::is_symlink(fs::symlink_status(at, error)))
      throw FileError(path, "'" + at.string() + "' is a link to what is not there",
                      "remove the link, or name another folder");
    if (at.has_filename()) missing.push_back(at); // "a/" is "a"
  }
  const auto lock = lockUnfinished();
  for (auto folder = missing.rbegin(); folder != missing.rend(); ++folder) {
    if (!fs::create_directory(*folder, error)) {
      if (!error) continue; // someone else has made it meanwhile
      for (auto made = made_.rbegin(); made != made_.rend(); ++made) {
        std::error_code ignored;
        fs::remove(*made, ignored);
        dropUnfinished(*made);
      }
      fail(error.message());
    }
    made_.push_back(*folder);
    addUnfinished(*folder);
  }
  if (!fs::is_directory(path, error)) throw FileError(path, "is no folder", "name a folder");
}

OutputFolder::~OutputFolder()
{
  const auto lock = lockUnfinished();
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) {
    std::error_code ignored;
    fs::remove(*folder, ignored); // fails where something is in it
    dropUnfinished(*folder);
  }
}

} // namespace pcl_bsh::files

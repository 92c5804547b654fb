// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/files/file_error.h>
#include <pcl_bsh/files/replace_file.h>
#include <pcl_bsh/site/unfinished_site.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <string>

namespace pcl_bsh::sites {

namespace fs = std::filesystem;

namespace {

constexpr auto mark_name = "unfinished_site";
constexpr auto mark_text = "pcl_bsh_site makes a site here. If it was ended, the same command begins again.\n";

/// Whether it is a name that UnfinishedSite gives.
bool isTileName(const std::string& name)
{
  constexpr std::string_view begin = "tile_", end = ".pcd";
  if (name.size() <= begin.size() + end.size() || !name.starts_with(begin) || !name.ends_with(end)) return false;
  const std::string_view digits = std::string_view(name).substr(begin.size(), name.size() - begin.size() - end.size());
  return std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool isSiteFileLeft(const std::string& name)
{
  return name == overview_file_name || name.starts_with(std::string(site_file_name) + ".part");
}

/// Removes what a run that was killed has made.
void clear(const fs::path& folder)
{
  std::error_code error;
  const fs::path tiles = folder / tiles_folder_name;
  if (fs::is_directory(fs::symlink_status(tiles, error))) {
    for (const auto& entry : fs::directory_iterator(tiles))
      if (isTileName(entry.path().filename().string())) fs::remove(entry.path());
  }
  for (const auto& entry : fs::directory_iterator(folder))
    if (isSiteFileLeft(entry.path().filename().string())) fs::remove(entry.path());
}

} // namespace

bool isUnfinished(const fs::path& folder)
{
  std::error_code error;
  return fs::is_regular_file(folder / mark_name, error) && !fs::exists(folder / site_file_name, error);
}

UnfinishedSite::UnfinishedSite(const fs::path& folder) : folder_(folder)
{
  std::error_code error;
  if (fs::exists(folder / site_file_name, error))
    throw files::FileError(folder, "is a site already", "name a new folder");
  const bool was_begun = isUnfinished(folder);
  if (!was_begun && !fs::is_empty(folder, error)) throw files::FileError(folder, "is not empty", "name a new folder");
  if (!was_begun) {
    mark_file_ = std::make_unique<files::NewFile>(folder / mark_name);
    mark_file_->append(mark_text);
  }
  try {
    mark();
    if (was_begun) clear(folder);
    tiles_ = std::make_unique<files::OutputFolder>(folder / tiles_folder_name);
  }
  catch (const fs::filesystem_error& failure) {
    throw files::FileError(folder, std::string("cannot be cleared (") + failure.code().message() + ")",
                           "name a new folder");
  }
}

void UnfinishedSite::mark()
{
  mark_ = open((folder() / mark_name).c_str(), O_RDWR | O_CLOEXEC);
  if (mark_ < 0 || flock(mark_, LOCK_EX | LOCK_NB) != 0) {
    if (mark_ >= 0) close(mark_);
    mark_ = -1;
    throw files::FileError(folder(), "another program makes a site there", "wait for it, or name a new folder");
  }
}

UnfinishedSite::~UnfinishedSite()
{
  files_.clear();
  tiles_.reset();
  std::error_code ignored;
  if (mark_ >= 0) {
    fs::remove(folder() / mark_name, ignored);
    close(mark_);
  }
}

files::NewFile& UnfinishedSite::add(const fs::path& name)
{
  files_.push_back(std::make_unique<files::NewFile>(folder() / name));
  return *files_.back();
}

void UnfinishedSite::finish(const Site& site)
{
  files::syncDisk(folder());
  files::FileReplacement document(folder() / site_file_name);
  document.stream() << siteText(site) << '\n';
  document.commit([&] {
    for (const auto& file : files_) file->keep();
  });
}

} // namespace pcl_bsh::sites

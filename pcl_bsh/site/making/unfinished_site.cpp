// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/free_space.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/files/unfinished.h>
#include <pcl_bsh/io/files/write_error.h>
#include <pcl_bsh/site/make_site.h>
#include <pcl_bsh/site/making/unfinished_site.h>
#include <pcl_bsh/site/tiles/tile_file.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <set>
#include <string>

namespace pcl_bsh::site {

namespace fs = std::filesystem;

namespace {

constexpr auto mark_name = "unfinished_site";
constexpr auto mark_text =
    "pcl_bsh_site makes a site here. If it was ended, the same command goes on, or begins again.\n";
constexpr auto state_name = "unfinished_site.state";
constexpr auto plan_name = "unfinished_site.plan";

/// Whether it is the name of a tile's file, or of the file with the answer about a tile, also of one that was being
/// written.
bool isTileName(const std::string& name)
{
  constexpr std::string_view begin = "tile_";
  if (!name.starts_with(begin)) return false;
  const std::size_t dot = std::min(name.find('.'), name.size());
  const std::string_view digits = std::string_view(name).substr(begin.size(), dot - begin.size());
  const std::string_view end = std::string_view(name).substr(dot);
  constexpr std::size_t least_digits = 6; // tileFileName() writes so many
  return digits.size() >= least_digits &&
         (end == ".pcd" || end == answer_extension || end.starts_with(std::string(answer_extension) + ".part")) &&
         std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool isSiteFileLeft(const std::string& name)
{
  if (name == overview_file_name) return true;
  for (const char* own : {site_file_name, state_name, plan_name})
    if (name.starts_with(std::string(own) + ".part")) return true;
  return name == plan_name;
}

/// Removes the tiles' files that `goes` is true of, by their names.
void removeTiles(const fs::path& folder, const std::function<bool(const std::string&)>& goes)
{
  std::error_code error;
  const fs::path tiles = folder / tiles_folder_name;
  if (!fs::is_directory(fs::symlink_status(tiles, error))) return;
  std::vector<fs::path> gone;
  for (const auto& entry : fs::directory_iterator(tiles)) {
    const std::string name = entry.path().filename().string();
    if (isTileName(name) && goes(name)) gone.push_back(entry.path());
  }
  for (const fs::path& path : gone) fs::remove(path);
}

} // namespace

bool isUnfinished(const fs::path& folder)
{
  std::error_code error;
  return fs::is_regular_file(folder / mark_name, error) && !fs::exists(folder / site_file_name, error);
}

bool isBegun(const fs::path& folder)
{
  std::error_code error;
  return isUnfinished(folder) && fs::is_regular_file(folder / state_name, error);
}

std::uint64_t spaceWanted(const fs::path& folder, std::uint64_t bytes)
{
  const std::uint64_t there = isUnfinished(folder) ? files::spaceTaken(folder / tiles_folder_name) : 0;
  return bytes - std::min(bytes, there);
}

UnfinishedSite::UnfinishedSite(const fs::path& folder, Use use, std::uint64_t bytes) : folder_(folder)
{
  std::error_code error;
  if (fs::exists(folder / site_file_name, error))
    throw files::FileError(folder, "is a site already", "name a new folder");
  const bool was_begun = isUnfinished(folder);
  if (!was_begun && !fs::is_empty(folder, error)) {
    throw files::FileError(folder, error ? "cannot be read (" + error.message() + ")" : "is not empty",
                           "name a new folder");
  }
  files::requireSpace({{folder, spaceWanted(folder, bytes)}});
  if (!was_begun) {
    mark_file_ = std::make_unique<files::NewFile>(folder / mark_name);
    mark_file_->append(mark_text);
  }
  try {
    mark();
    was_saved_ = was_begun && fs::exists(stateFile());
    if (was_saved_ && use != Use::continuable) {
      throw files::FileError(folder, "holds a site that is not complete",
                             "repeat the command that makes it to go on, or name a new folder");
    }
    const bool is_shared = use == Use::shared || use == Use::resumed;
    stays_ = was_saved_ || is_shared;
    if (was_begun && !was_saved_ && use != Use::resumed) clear();
    tiles_ = std::make_unique<files::OutputFolder>(folder / tiles_folder_name);
    if (is_shared) keepMark();
  }
  catch (const fs::filesystem_error& failure) {
    throw files::FileError(folder, std::string("cannot be cleared (") + failure.code().message() + ")",
                           "name a new folder");
  }
}

/// Removes what a run that was killed has made.
void UnfinishedSite::clear()
{
  removeTiles(folder(), [](const std::string&) { return true; });
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(folder()))
    if (isSiteFileLeft(entry.path().filename().string())) left.push_back(entry.path());
  for (const fs::path& path : left) fs::remove(path);
}

fs::path UnfinishedSite::stateFile() const
{
  return folder() / state_name;
}

fs::path UnfinishedSite::planFile() const
{
  return folder() / plan_name;
}

void UnfinishedSite::discardTilesFrom(std::size_t tiles)
{
  std::set<std::size_t> stay;
  for (std::size_t i = 0; i < tiles; ++i) stay.insert(i);
  discardTiles(stay);
}

void UnfinishedSite::discardTiles(const std::set<std::size_t>& stay)
{
  std::set<std::string> names;
  for (const std::size_t i : stay)
    for (const fs::path& file : {fs::path(tileFileName(i)), answerFileName(i)}) names.insert(file.filename().string());
  removeTiles(folder(), [&](const std::string& name) { return names.count(name) == 0; });
}

void UnfinishedSite::forget()
{
  std::error_code ignored;
  files_.clear();
  try {
    clear();
  }
  catch (const fs::filesystem_error&) { // what cannot be removed stays, with the mark
    return;
  }
  fs::remove(folder() / tiles_folder_name, ignored);
  stays_ = false;
}

void UnfinishedSite::discard(const fs::path& name)
{
  std::error_code ignored; // add() fails where it is still there
  fs::remove(folder() / name, ignored);
}

files::NewFile& UnfinishedSite::goOn(const fs::path& name, std::uint64_t bytes)
{
  files_.push_back(std::make_unique<files::NewFile>(folder() / name, bytes));
  return *files_.back();
}

void UnfinishedSite::keepMark()
{
  stays_ = true;
  const auto lock = files::lockUnfinished();
  if (mark_file_) mark_file_->keep();
}

void UnfinishedSite::savePlan(const std::string& bytes)
{
  files::replaceFile(planFile(), [&](std::ostream& out) { out << bytes; });
}

void UnfinishedSite::save(const std::string& state)
{
  files::syncDisk(folder());
  keepMark();
  files::FileReplacement document(stateFile());
  document.stream() << state << '\n';
  document.commit([&] {
    for (const auto& file : files_) file->keep();
  });
}

void UnfinishedSite::mark()
{
  mark_.file = open((folder() / mark_name).c_str(), O_RDWR | O_CLOEXEC);
  if (mark_.file < 0 && errno != ENOENT) files::failToWrite(folder() / mark_name, errno);
  if (mark_.file < 0 || flock(mark_.file, LOCK_EX | LOCK_NB) != 0)
    throw files::FileError(folder(), "another program makes a site there", "wait for it, or name a new folder");
  // Another program may have completed the site, and removed its mark, before the lock was ours.
  struct stat locked = {}, named = {};
  const bool is_there = fstat(mark_.file, &locked) == 0 && stat((folder() / mark_name).c_str(), &named) == 0 &&
                        locked.st_dev == named.st_dev && locked.st_ino == named.st_ino;
  std::error_code error;
  if (!is_there || fs::exists(folder() / site_file_name, error))
    throw files::FileError(folder(), "another program has made a site there", "name a new folder");
}

UnfinishedSite::Mark::~Mark()
{
  if (file >= 0) close(file);
}

UnfinishedSite::~UnfinishedSite()
{
  files_.clear();
  tiles_.reset();
  if (finished_ || !stays_) {
    std::error_code ignored;
    for (const char* name : {state_name, plan_name, mark_name}) fs::remove(folder() / name, ignored);
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
  finished_ = true;
  try { // answers may be needed until the site is there
    removeTiles(folder(), [](const std::string& name) { return !name.ends_with(".pcd"); });
  }
  catch (const fs::filesystem_error&) { // they are in nobody's way
  }
}

} // namespace pcl_bsh::site

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/unfinished.h>

#include <algorithm>
#include <vector>

namespace pcl_bsh::files {

namespace fs = std::filesystem;

namespace {

/// Never destroyed: a program may be told to stop while it ends.
struct Unfinished {
  std::mutex mutex;
  std::vector<fs::path> paths; ///< in the order they were made: a folder before what lies in it
};

Unfinished& unfinished()
{
  static auto* const all = new Unfinished;
  return *all;
}

} // namespace

std::unique_lock<std::mutex> discardUnfinished()
{
  std::unique_lock lock(unfinished().mutex);
  auto& paths = unfinished().paths;
  std::error_code ignored;
  for (auto path = paths.rbegin(); path != paths.rend(); ++path) fs::remove(*path, ignored); // a folder if it is empty
  return lock;
}

std::unique_lock<std::mutex> lockUnfinished()
{
  return std::unique_lock(unfinished().mutex);
}

void addUnfinished(const fs::path& path)
{
  unfinished().paths.push_back(path);
}

void dropUnfinished(const fs::path& path)
{
  auto& paths = unfinished().paths;
  paths.erase(std::remove(paths.begin(), paths.end(), path), paths.end());
}

} // namespace pcl_bsh::files

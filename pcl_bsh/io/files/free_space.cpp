// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/free_space.h>

#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <limits>
#include <map>
#include <string>
#include <system_error>

namespace pcl_bsh::files {

namespace fs = std::filesystem;

namespace {

/// The place itself, or the first folder above it that is there.
fs::path foundOf(const fs::path& place)
{
  std::error_code error;
  fs::path at = fs::weakly_canonical(fs::absolute(place, error), error);
  while (!error && !fs::exists(at, error) && at != at.parent_path()) at = at.parent_path();
  return at;
}

std::uint64_t sum(std::uint64_t a, std::uint64_t b)
{
  constexpr auto most = std::numeric_limits<std::uint64_t>::max();
  return a > most - b ? most : a + b;
}

constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20;

} // namespace

void requireSpace(const std::vector<WantedSpace>& wanted)
{
  std::map<dev_t, std::uint64_t> of_disk;
  for (const WantedSpace& output : wanted) {
    const fs::path at = foundOf(output.place);
    struct stat status = {};
    struct statvfs disk = {};
    if (stat(at.c_str(), &status) != 0 || statvfs(at.c_str(), &disk) != 0 || disk.f_blocks == 0) continue;
    std::uint64_t& needed = of_disk[status.st_dev];
    needed = sum(needed, output.bytes);
    // Some blocks are kept for the superuser.
    const std::uint64_t blocks = geteuid() == 0 ? disk.f_bfree : disk.f_bavail;
    const std::uint64_t size = disk.f_frsize;
    if (size != 0 && blocks > std::numeric_limits<std::uint64_t>::max() / size) continue;
    const std::uint64_t free = blocks * size;
    if (needed <= free) continue;
    const std::uint64_t rounded_up = needed / mebibyte + (needed % mebibyte != 0 ? 1 : 0);
    throw FileError(output.place,
                    "needs " + std::to_string(rounded_up) + " MiB" +
                        (needed > output.bytes ? " together with what else is written there" : "") +
                        ", and its disk has " + std::to_string(free / mebibyte) + " MiB free",
                    "make room, or choose a place on another disk");
  }
}

std::uint64_t spaceTaken(const fs::path& folder)
{
  constexpr std::uint64_t block = 512; // that of st_blocks, whatever the disk's
  std::uint64_t bytes = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    struct stat status = {};
    if (lstat(entry->path().c_str(), &status) == 0 && S_ISREG(status.st_mode))
      bytes += static_cast<std::uint64_t>(status.st_blocks) * block;
  }
  return bytes;
}

} // namespace pcl_bsh::files

// SPDX-License-Identifier: BSD-3-Clause
#include "support/temporary_folder.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/files/free_space.h>

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <string>

namespace pcl_bsh::files {

namespace fs = std::filesystem;

class FreeSpace : public testing::Test {
protected:
  static std::string refusalOf(const std::vector<WantedSpace>& wanted)
  {
    try {
      requireSpace(wanted);
      return "";
    }
    catch (const FileError& error) {
      return error.what();
    }
  }

  TemporaryFolder folder;
  std::uint64_t free = fs::space(folder.path()).free;
};

TEST_F(FreeSpace, RefusesWhatDoesNotFit)
{
  const std::uint64_t more = 2 * free + (std::uint64_t{1} << 30);
  for (const fs::path& place : {folder.path(), folder / "new/folder/file"}) {
    EXPECT_EQ(refusalOf({{place, 1}}), "");
    const std::string refusal = refusalOf({{place, more}});
    EXPECT_EQ(refusal.find(place.string() + ": needs " + std::to_string((more + (1 << 20) - 1) >> 20) +
                           " MiB, and its disk has "),
              0U)
        << refusal;
    EXPECT_NE(refusal.find(" MiB free: make room"), std::string::npos);
  }
  EXPECT_NE(refusalOf({{folder.path(), std::numeric_limits<std::uint64_t>::max()}}), "");
  EXPECT_FALSE(fs::exists(folder / "new"));
}

TEST_F(FreeSpace, AddsUpWhatIsOnOneDisk)
{
  const std::uint64_t most = free / 2 + free / 4;
  EXPECT_EQ(refusalOf({{folder / "a", free / 4}, {folder / "b", free / 4}}), "");
  const std::string refusal = refusalOf({{folder / "a", most}, {folder / "b", most}});
  EXPECT_NE(refusal.find("/b: needs "), std::string::npos) << refusal;
  EXPECT_NE(refusal.find(" together with what else is written there"), std::string::npos) << refusal;
}

/// As /proc, and some disks of networks: they have no blocks.
TEST_F(FreeSpace, RefusesNothingWhereNoSizeIsTold)
{
  EXPECT_EQ(fs::space("/proc").capacity, 0U);
  EXPECT_EQ(refusalOf({{"/proc/self", std::numeric_limits<std::uint64_t>::max()}}), "");
}

TEST_F(FreeSpace, KnowsWhatAFolderTakes)
{
  EXPECT_EQ(spaceTaken(folder / "none"), 0U);
  fs::create_directories(folder / "a/b");
  std::ofstream(folder / "a/b/file") << std::string(100000, 'x') << std::flush;
  std::ofstream(folder / "a/sparse").close();
  fs::resize_file(folder / "a/sparse", std::uintmax_t{1} << 30);
  EXPECT_GE(spaceTaken(folder.path()), 100000U);
  EXPECT_LT(spaceTaken(folder.path()), 1U << 20) << "holes take nothing";
  const std::uint64_t of_files = spaceTaken(folder.path());
  fs::create_directories(folder / "c/d");
  fs::create_symlink(std::string(200, 'x'), folder / "link");
  EXPECT_EQ(spaceTaken(folder.path()), of_files) << "folders and links are no files";
}

/// Sums beyond all numbers, too; and told in whole mebibytes.
TEST_F(FreeSpace, CountsWithoutOverflow)
{
  constexpr auto most = std::numeric_limits<std::uint64_t>::max();
  EXPECT_NE(refusalOf({{folder / "a", 1000}, {folder / "b", most}}), "");
  EXPECT_NE(refusalOf({{folder / "a", 1}, {folder / "b", most - 1}}), "");
  const std::uint64_t mebibytes = (2 * free >> 20) + 1024;
  for (const std::uint64_t less : {0U, 1U, (1U << 20) - 1}) {
    const std::string refusal = refusalOf({{folder / "a", (mebibytes << 20) - less}});
    EXPECT_NE(refusal.find("a: needs " + std::to_string(mebibytes) + " MiB, and"), std::string::npos) << refusal;
  }
}

/// Who cannot look there will hear of it when something is written.
TEST_F(FreeSpace, RefusesNothingWhereItCannotLook)
{
  fs::create_symlink("loop", folder / "loop");
  EXPECT_EQ(refusalOf({{folder / "loop/file", std::numeric_limits<std::uint64_t>::max()}}), "");
}

} // namespace pcl_bsh::files

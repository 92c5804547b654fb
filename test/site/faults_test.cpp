// SPDX-License-Identifier: BSD-3-Clause
// Sites that are damaged, disks that are full, and programs that are ended: an error that says so, and never a folder
// that passes for a site.
#include "../programs/process.h"

#include <pcl_bsh/site/check_site.h>
#include <pcl_bsh/site/make_site.h>

#include <gmock/gmock.h>

#include <sys/resource.h>

#include <chrono>
#include <thread>

namespace pcl_bsh::sites {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class SiteFaults : public testing::Test {
protected:
  SiteFaults()
  {
    std::string text = "x y z\n";
    for (int i = 0; i < 20000; ++i)
      text += std::to_string(i % 100) + ' ' + std::to_string(i / 100) + ' ' + std::to_string(0.01 * (i % 7)) + '\n';
    folder.write("scan.xyz", text);
  }

  Site make()
  {
    MakeOptions options;
    options.tile_points = 5000;
    return makeSite({folder / "scan.xyz"}, folder / "site", options);
  }

  void expectDefect(const std::string& words) const
  {
    try {
      checkSite(readSite(folder / "site"));
      ADD_FAILURE() << "not seen: " << words;
    }
    catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), HasSubstr(words));
    }
  }

  void replace(const std::string& what, const std::string& by) const
  {
    std::string text = files::contentOf(folder / "site/site.json");
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    folder.write("site/site.json", text.replace(at, what.size(), by));
  }

  files::TemporaryFolder folder;
};

TEST_F(SiteFaults, Tiles)
{
  const Site site = make();
  const fs::path tile = site.folder / site.tiles[1].file;
  const std::string whole = files::contentOf(tile), name = site.tiles[1].file;
  const auto put = [&](const std::string& bytes) { folder.write("site/" + name, bytes); };

  fs::remove(tile);
  expectDefect(name + ": a tile of the site is missing");
  put(whole.substr(0, whole.size() - 100));
  expectDefect("is truncated");
  std::string damaged = whole;
  damaged[whole.size() - 50] ^= 1;
  put(damaged);
  expectDefect("its points are not those that the site was made with");
  put(files::contentOf(site.folder / site.tiles[0].file));
  expectDefect(name + ": has ");
  put("");
  expectDefect(name);
  std::string other = whole;
  other.replace(other.find("record"), 6, "rekord");
  put(other);
  expectDefect("has other fields than the site says");
  put(whole);
  EXPECT_NO_THROW(checkSite(readSite(folder / "site")));
}

TEST_F(SiteFaults, Documents)
{
  make();
  const std::string text = files::contentOf(folder / "site/site.json");
  const auto each = [&](const std::string& what, const std::string& by, const std::string& words) {
    folder.write("site/site.json", text);
    replace(what, by);
    expectDefect(words);
  };
  each("\"version\": 1", "\"version\": 2", "version: this program reads version 1");
  each("tiles/tile_000001.pcd", "../scan.xyz", "tiles[1].file: '../scan.xyz' leaves the folder");
  each("tiles/tile_000001.pcd", "/etc/passwd", "leaves the folder");
  each("tiles/tile_000001.pcd", "tiles/../../scan.xyz", "leaves the folder");
  each("tiles/tile_000001.pcd", "tiles/tile_000000.pcd", "tile_000000.pcd: ");
  each("\"points\": 20000", "\"points\": 19999", "20000 points together");
  each("\"points\": 20000", "\"points\": -1", "points: ");
  each("\"crc32\": ", "\"crc\": ", "'crc'");
  each("\"name\": \"source\"", "\"name\": \"sauce\"", "there is no field 'source'");
  each("\"name\": \"x\"", "\"name\": \"y\"", "'y' is there twice");
  each("\"version\"", "version", "site.json");
  folder.write("site/site.json", text);
  fs::create_symlink(folder / "scan.xyz", folder / "site/tiles/link.pcd");
  replace("tile_000001.pcd", "link.pcd");
  expectDefect("leaves the folder");
}

TEST_F(SiteFaults, AFullDisk)
{
  for (const rlim_t room : {rlim_t{0}, rlim_t{64}, rlim_t{30000}}) { // the last is enough for the mark and for headers
    const auto limit = [room] {
      const rlimit limits = {room, room};
      setrlimit(RLIMIT_FSIZE, &limits);
    };
    Process program("pcl_bsh_site", {"make", "scan.xyz", "--out", "site"}, folder.path(), limit);
    EXPECT_EQ(program.end(), 1);
    EXPECT_THAT(program.err(), HasSubstr("cannot be written (File too large)"));
    EXPECT_FALSE(fs::exists(folder / "site"));
  }
}

/// Ends the program in the moments after it has begun: whatever is left is continued, or is a site.
TEST_F(SiteFaults, ProgramsThatAreEnded)
{
  const std::vector<std::string> arguments = {"make", "scan.xyz", "--out", "site", "--tile-points", "100"};
  int complete = 0, unfinished = 0;
  for (int wait = 0; wait < 12; ++wait) {
    const bool kill = wait % 3 != 0;
    if (!kill) fs::remove_all(folder / "site"); // else the run goes on where the last one was killed
    Process program("pcl_bsh_site", arguments, folder.path());
    while (!program.hasEnded() && !fs::exists(folder / "site")) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(5 * wait));
    program.send(kill ? SIGKILL : SIGINT);
    program.end();
    if (!fs::exists(folder / "site")) continue;
    if (fs::exists(folder / "site/site.json")) {
      EXPECT_NO_THROW(checkSite(readSite(folder / "site")));
      fs::remove_all(folder / "site");
      ++complete;
      continue;
    }
    EXPECT_TRUE(kill) << program.err();
    ++unfinished;
    Process info("pcl_bsh_site", {"info", "site"}, folder.path());
    EXPECT_EQ(info.end(), 1);
  }
  Process last("pcl_bsh_site", arguments, folder.path());
  EXPECT_EQ(last.end(), 0) << last.err();
  EXPECT_NO_THROW(checkSite(readSite(folder / "site")));
  EXPECT_GT(complete + unfinished, 0);
}

} // namespace
} // namespace pcl_bsh::sites

// SPDX-License-Identifier: BSD-3-Clause
// Sites that are damaged, disks that are full, and programs that are ended: an error that says so, and never a folder
// that passes for a site.
#include "support/in_a_fork.h"
#include "tools/programs/process.h"
#include "tools/programs/program_run.h"

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/pcd/pcd.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/json/json_document.h>
#include <pcl_bsh/site/check_site.h>
#include <pcl_bsh/site/export_site.h>
#include <pcl_bsh/site/make_site.h>
#include <pcl_bsh/site/making/make_state.h>
#include <pcl_bsh/site/tiles/checksum.h>
#include <pcl_bsh/site/tiles/records.h>
#ifdef PCL_BSH_SITE_QUERIES
#include <pcl_bsh/site/result_site.h>
#endif

#include <gmock/gmock.h>

#include <sys/resource.h>

#include <chrono>
#include <functional>
#include <map>
#include <thread>

namespace pcl_bsh::site {
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

  /// Writes another site.json. @return the site as it was
  template <typename Change>
  Site document(Site site, const Change& change) const
  {
    const Site before = site;
    change(site);
    folder.write("site/site.json", siteText(site));
    return before;
  }

  files::TemporaryFolder folder;
};

/// A tile whose checksum is right, which is not what the site was made with: each point is there once, in its order.
TEST_F(SiteFaults, TilesThatLie)
{
  const Site made = make();
  const pcl::PCLPointCloud2 points = readTile(made, made.tiles[1]);
  const PointNames names(points);
  const auto rewrite = [&](const auto& change) {
    pcl::PCLPointCloud2 cloud = points;
    change(cloud.data.data(), cloud.data.data() + cloud.point_step);
    folder.write("site/" + made.tiles[1].file,
                 io::binaryPcdHeader(made.fields, cloud.width) + std::string(cloud.data.begin(), cloud.data.end()));
    document(made, [&](Site& site) { site.tiles[1].crc32 = crcOf(cloud.data); });
  };
  const auto expectNoExport = [&] {
    try {
      exportCloud(readSite(made.folder), folder / "all.pcd");
      ADD_FAILURE();
    }
    catch (const files::FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr("its tiles do not hold each record once: make the site again"));
    }
    EXPECT_FALSE(fs::exists(folder / "all.pcd"));
  };
  const SitePoint first = names(points.data.data()), second = names(points.data.data() + points.point_step);
  rewrite([&](std::uint8_t*, std::uint8_t*) {});
  EXPECT_NO_THROW(checkSite(readSite(made.folder)));
  rewrite([&](std::uint8_t* record, std::uint8_t*) { names.set(record, {0, 20000}); });
  expectDefect("has record 20000 of source 0, which there is not");
  expectNoExport();
  rewrite([&](std::uint8_t* record, std::uint8_t*) { names.set(record, {1, 0}); });
  expectDefect("has record 0 of source 1, which there is not");
  expectNoExport();
  rewrite([&](std::uint8_t* record, std::uint8_t*) { names.set(record, second); });
  expectDefect("has record " + std::to_string(second.record) + " of source 0, which is there twice");
  expectNoExport();
  rewrite([&](std::uint8_t* record, std::uint8_t* next) {
    names.set(record, second);
    names.set(next, first);
  });
  expectDefect("its points are not in the order of their sources and records");
  EXPECT_NO_THROW(exportCloud(readSite(made.folder), folder / "all.pcd")) << "which has an order of its own";
}

TEST_F(SiteFaults, BoundsThatLie)
{
  const Site made = make();
  const std::string of_tile = "its points have other bounds than site.json says",
                    of_site = "site.json: its bounds are not those of its tiles: make the site again";
  for (const double by : {-1.0, 1.0}) {
    document(made, [&](Site& site) { (by < 0 ? site.tiles[1].bounds->low : site.tiles[1].bounds->high)[1] += by; });
    expectDefect(made.tiles[1].file + ": " + of_tile);
    document(made, [&](Site& site) { (by < 0 ? site.bounds->low : site.bounds->high)[1] += by; });
    expectDefect(of_site);
  }
  document(made, [](Site& site) { site.tiles[1].bounds.reset(); });
  expectDefect(of_tile);
  document(made, [](Site& site) { site.bounds.reset(); });
  expectDefect(of_site);
  for (const std::size_t k : {0U, 1U, 2U}) {
    document(made, [&](Site& site) { site.tiles[1].bounds->high[k] = site.tiles[1].bounds->low[k] - 1; });
    expectDefect("the low corner lies above the high one");
  }
}

TEST_F(SiteFaults, ChecksAndExportsTellHowFarTheyAre)
{
  const Site made = make();
  std::vector<std::uint64_t> told;
  const auto go_on = [&](std::uint64_t done, std::uint64_t all) {
    EXPECT_EQ(all, 20000U);
    told.push_back(done);
    return true;
  };
  const auto stop = [](std::uint64_t done, std::uint64_t) { return done < 15000; };
  checkSite(made, go_on);
  std::uint64_t sum = 0;
  ASSERT_EQ(told.size(), made.tiles.size());
  for (std::size_t i = 0; i < told.size(); ++i) EXPECT_EQ(told[i], sum += made.tiles[i].points);
  EXPECT_THROW(checkSite(made, stop), Cancelled);
  ExportOptions options;
  options.memory = 2 * 6000 * recordBytes(made);
  options.progress = go_on;
  told.clear();
  exportCloud(made, folder / "all.pcd", options);
  EXPECT_THAT(told, testing::ElementsAre(6000, 12000, 18000, 20000));
  options.progress = stop;
  EXPECT_THROW(exportCloud(made, folder / "new.pcd", options), Cancelled);
  EXPECT_FALSE(fs::exists(folder / "new.pcd"));
}

TEST_F(SiteFaults, ExportsThatCannotBe)
{
  Site site = make();
  const auto refuse = [&](const std::string& name, const std::string& words) {
    try {
      exportCloud(site, folder / name);
      ADD_FAILURE() << words;
    }
    catch (const files::FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr(name + ": " + words));
    }
    EXPECT_FALSE(fs::exists(folder / name));
  };
  refuse("all.ply", "is not the name of a .pcd file, which is what sites are exported to: name a .pcd file");
  site.sources[0].points = std::uint64_t{1} << 31;
  refuse("all.pcd", "would have more than 2147483647 points: export the sources one by one");
}

TEST_F(SiteFaults, FoldersThatAreNoSite)
{
  fs::create_directory(folder / "empty");
  for (const auto& [name, words] : {std::pair{"none", "none: is no folder: name the folder of a site"},
                                    {"scan.xyz", "scan.xyz: is no folder"},
                                    {"empty", "empty: is no site: it has no site.json"}}) {
    try {
      readSite(folder / name);
      ADD_FAILURE() << name;
    }
    catch (const files::FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr(words));
    }
  }
}

TEST_F(SiteFaults, FieldsThatLie)
{
  const Site made = make();
  const auto defect = [&](const std::string& name, std::uint8_t datatype, std::uint32_t count,
                          const std::string& words) {
    document(made, [&](Site& site) {
      for (auto& field : site.fields)
        if (field.name == name) field.datatype = datatype, field.count = count;
    });
    expectDefect(words);
  };
  using Field = pcl::PCLPointField;
  for (const std::string own : {"source", "record"}) {
    defect(own, Field::INT32, 1, "there is no field '" + own + "' of type uint32");
    defect(own, Field::UINT32, 2, "there is no field '" + own + "' of type uint32");
  }
  defect("y", Field::INT32, 1, "make the site again");
  defect("y", made.fields[0].datatype == Field::FLOAT32 ? Field::FLOAT64 : Field::FLOAT32, 1, "make the site again");
}

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
  each("\"version\": 3", "\"version\": 4", "version: this program reads versions 1 to 3");
  each("\"version\": 3", "\"version\": 0", "version: this program reads versions 1 to 3");
  each("\"version\": 3", "\"version\": \"3\"", "version");
  each("\"version\": 3,", "", "version");
  folder.write("site/site.json", "[3]");
  expectDefect("site.json");
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
  each("\"spacing\"", "\"greatest\": { \"z\": 0.06 }, \"spacing\"", "'z' has another greatest value");
  folder.write("site/site.json", text);
  fs::create_symlink(folder / "scan.xyz", folder / "site/tiles/link.pcd");
  replace("tile_000001.pcd", "link.pcd");
  expectDefect("leaves the folder");
}

/// Memory for as many points as site.json says is taken when the tiles have as many.
TEST_F(SiteFaults, CountsOfNoPoints)
{
  const Site made = make();
  Site site = made;
  const std::uint64_t more = std::uint64_t{1} << 53;
  site.points = site.sources[0].points = more;
  site.tiles.back().points += more - made.points;
  folder.write("site/site.json", siteText(site));
  expectDefect(site.tiles.back().file + ": has ");
}

/// An hour's work is not begun where its result would not fit: before a tile is read or a file made.
TEST_F(SiteFaults, DisksWithoutRoom)
{
  const std::uint64_t free = fs::space(folder.path()).free;
  const auto expectRefusal = [&](const Outcome& refused, const std::string& place) {
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_THAT(refused.err, testing::MatchesRegex(".*" + place +
                                                   ": needs [0-9]+ MiB, and its disk has [0-9]+ MiB "
                                                   "free: make room, or choose a place on another "
                                                   "disk\n"));
    EXPECT_FALSE(fs::exists(folder / place));
  };
  Site site = make();
  const std::uint64_t bytes = 3 * free + (std::uint64_t{1} << 40), points = bytes / recordBytes(site) + 1;
  { // A cloud of holes, which takes no room itself.
    std::ofstream cloud(folder / "holes.pcd");
    constexpr std::uint64_t most = 2147483647, step = 12 + 1000000;
    cloud << "VERSION 0.7\nFIELDS x y z more\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 1000000\nWIDTH "
          << std::min(bytes / step, most) << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS "
          << std::min(bytes / step, most) << "\nDATA binary\n";
  }
  std::error_code too_large;
  fs::resize_file(folder / "holes.pcd", bytes + (1 << 20), too_large);
  if (!too_large)
    expectRefusal(run("pcl_bsh_site", "make holes.pcd --tile-points 500 --out made", folder.path()), "made");
  fs::remove(folder / "holes.pcd");

  site.tiles.back().points += points - site.points; // which it has not: that would be noticed when it is read
  site.points = site.sources[0].points = points;
  folder.write("site/site.json", siteText(site));
#ifdef PCL_BSH_SITE_QUERIES
  const std::string asked = "collide site scan.xyz --clearance 1 --out out";
  expectRefusal(run("pcl_bsh_site", asked, folder.path()), "out");
  // The output of the obstacle is refused by its own name.
  expectRefusal(run("pcl_bsh_site", "collide site site --clearance 1 --obstacle-out marked", folder.path()), "marked");
  // The refusal leaves the answers of an earlier run.
  fs::create_directories(folder / "out/tiles");
  folder.write("out/unfinished_site", "left");
  folder.write("out/tiles/tile_000000.answer", "left");
  EXPECT_EQ(run("pcl_bsh_site", asked, folder.path()).exit_code, 1);
  EXPECT_EQ(files::contentOf(folder / "out/tiles/tile_000000.answer"), "left");
#endif
}

/// So many points as a file may have, a megabyte each.
TEST_F(SiteFaults, ExportsThatDoNotFit)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) io::addField(cloud, axis, io::Field::FLOAT32);
  io::addField(cloud, "more", io::Field::UINT8, 1000000);
  io::allocate(cloud, 2);
  io::writeCloud(folder / "wide.pcd", cloud);
  Site site = makeSite({folder / "wide.pcd"}, folder / "site");
  constexpr std::uint64_t most = 2147483647;
  if (fs::space(folder.path()).free > most * recordBytes(site)) GTEST_SKIP() << "a disk of petabytes";
  site.tiles.back().points += most - site.points;
  site.points = site.sources[0].points = most;
  folder.write("site/site.json", siteText(site));
  const Outcome refused = run("pcl_bsh_site", "export site all.pcd", folder.path());
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, testing::MatchesRegex(".*all.pcd: needs 2048[0-9]+ MiB, and its disk has .*"));
  EXPECT_FALSE(fs::exists(folder / "all.pcd"));
}

/// Names in a document of someone else must not steer the terminal.
TEST_F(SiteFaults, NamesThatSteer)
{
  Site site = make();
  site.sources[0].file = "\x1b[2Jscan";
  folder.write("site/site.json", siteText(site));
  const Outcome info = run("pcl_bsh_site", "info site", folder.path());
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_THAT(info.out, HasSubstr("  ?[2Jscan: 20000"));
}

TEST_F(SiteFaults, AnOverviewOfOtherFields)
{
  const Site site = make();
  const std::string overview = files::contentOf(site.folder / overview_file_name);
  std::string other = overview;
  other.replace(other.find("record"), 6, "rekord");
  folder.write("site/overview.pcd", other);
  expectDefect("overview.pcd: has other fields than the site says");
  other = overview;
  const std::size_t types = other.find("TYPE F F F U U");
  ASSERT_NE(types, std::string::npos);
  folder.write("site/overview.pcd", other.replace(types, 14, "TYPE F F F U I"));
  expectDefect("overview.pcd: has other fields than the site says");
  fs::remove(site.folder / overview_file_name); // sites may be made without
  EXPECT_NO_THROW(checkSite(readSite(folder / "site")));
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

/// All files below a folder, and what they hold.
std::map<std::string, std::string> contentsOf(const fs::path& place)
{
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(place))
    if (entry.is_regular_file()) files[fs::relative(entry.path(), place).string()] = files::contentOf(entry.path());
  return files;
}

class SitesContinued : public SiteFaults {
protected:
  SitesContinued()
  {
    const std::string text = files::contentOf(folder / "scan.xyz");
    folder.write("more.xyz", text + "nan 1 2\n1 2 nan\n"); // points that are nowhere
    options.tile_points = 5000;
    options.overview_points = 777;
    options.save_points = 12000;
  }

  Site makeBoth() const { return makeSite({folder / "scan.xyz", folder / "more.xyz"}, folder / "site", options); }

  /// In a process that is killed at the n-th call of its progress. @return whether it lived to the end
  bool makeAndDie(int calls)
  {
    return files::endsInAFork([&] {
      options.progress = [&](MakeStep, std::uint64_t, std::uint64_t) {
        if (calls-- == 0) ::kill(::getpid(), SIGKILL);
        return true;
      };
      makeBoth();
    });
  }

  /// The points that all steps of a run tell together.
  std::uint64_t pointsOfWork() const
  {
    std::uint64_t work = 0, last = 0;
    MakeStep at = MakeStep::count;
    MakeOptions telling = options;
    bool first = true;
    telling.progress = [&](MakeStep step, std::uint64_t done, std::uint64_t) {
      if (!first && step == at) work += done - last;
      first = false;
      at = step;
      last = done;
      return true;
    };
    makeSite({folder / "scan.xyz", folder / "more.xyz"}, folder / "site", telling);
    return work;
  }

  MakeOptions options;
};

/// Killed wherever it tells its progress, and then continued: the same files, byte by byte.
TEST_F(SitesContinued, AfterAKillAtEachStage)
{
  makeBoth();
  const auto whole = contentsOf(folder / "site");
  fs::remove_all(folder / "site");
  int kills = 0;
  for (bool ended = false; !ended; ++kills) {
    SCOPED_TRACE(kills);
    ended = makeAndDie(kills);
    if (!ended) {
      EXPECT_THROW(readSite(folder / "site"), files::FileError);
      makeBoth();
    }
    EXPECT_TRUE(contentsOf(folder / "site") == whole);
    fs::remove_all(folder / "site");
  }
  EXPECT_GT(kills, 10);
}

/// Killed again and again, each time a little later: it comes to its end, for what was saved is not done again.
TEST_F(SitesContinued, AfterManyKills)
{
  makeBoth();
  const auto whole = contentsOf(folder / "site");
  fs::remove_all(folder / "site");
  int runs = 0;
  while (!makeAndDie(5)) ASSERT_LT(++runs, 20);
  EXPECT_GT(runs, 0);
  EXPECT_TRUE(contentsOf(folder / "site") == whole);
}

TEST_F(SitesContinued, IsRefusedForAnotherQuestionOrDamage)
{
  ASSERT_FALSE(makeAndDie(6));
  const auto left = contentsOf(folder / "site");
  ASSERT_TRUE(left.count("unfinished_site.state"));
  const auto refuse = [&](const std::string& words) {
    try {
      makeBoth();
      ADD_FAILURE() << words;
    }
    catch (const files::FileError& error) {
      EXPECT_THAT(error.what(), HasSubstr(words));
      EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    }
    EXPECT_THROW(readSite(folder / "site"), files::FileError);
  };
  const auto put = [&](const std::string& name, const std::string& bytes) { folder.write("site/" + name, bytes); };

  EXPECT_TRUE(isBegun(folder / "site"));
#ifdef PCL_BSH_SITE_QUERIES
  try {
    ResultSite(makeSite({folder / "scan.xyz"}, folder / "other"), folder / "site", {});
    ADD_FAILURE();
  }
  catch (const files::FileError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("holds a site that is not complete: repeat the command that makes it to go on"));
  }
#endif
  EXPECT_TRUE(contentsOf(folder / "site") == left);

  --options.tile_points;
  refuse("of other clouds or options");
  EXPECT_TRUE(contentsOf(folder / "site") == left);
  ++options.tile_points;
  std::vector<std::function<void()>> changes = {
      [&] { options.unit = "ft"; },
      [&] { options.unit = "mm", options.to_unit = "m"; },
      [&] { options.columns = [](const fs::path&) {
              return io::ColumnNames{"y", "x", "z"};
            }; },
      [&] { options.scan = 0; },
  };
  if (io::hasProj()) changes.emplace_back([&] { options.crs = "EPSG:25832"; });
  for (const auto& change : changes) {
    const MakeOptions before = options;
    change();
    refuse("of other clouds or options");
    options = before;
    EXPECT_TRUE(contentsOf(folder / "site") == left);
  }
  const auto written = fs::last_write_time(folder / "scan.xyz");
  fs::last_write_time(folder / "scan.xyz", written + std::chrono::seconds(1));
  refuse("of other clouds or options");
  fs::last_write_time(folder / "scan.xyz", written);

  const std::string state = left.at("unfinished_site.state"), plan = left.at("unfinished_site.plan");
  put("unfinished_site.state", state.substr(0, state.size() / 2));
  refuse("is damaged");
  put("unfinished_site.state", "{}");
  refuse("is damaged");
  io::Json changed = io::Json::parse(state);
  changed["open"][0] = changed["files"].size();
  put("unfinished_site.state", changed.dump());
  refuse("is damaged");
  changed = io::Json::parse(state);
  for (std::size_t i = 0; i <= changed["files"].size(); ++i)
    changed["measured"][i] = {nullptr, 0.0, 0, io::Json::object()};
  put("unfinished_site.state", changed.dump());
  refuse("is damaged");
  put("unfinished_site.state", state);
  std::string wrong = plan;
  wrong[wrong.size() / 2] ^= 1;
  put("unfinished_site.plan", wrong);
  refuse("is damaged");
  put("unfinished_site.plan", plan);
  put("tiles/tile_000000.pcd", "short");
  refuse("is shorter than it was");
  put("tiles/tile_000000.pcd", left.at("tiles/tile_000000.pcd"));
  makeBoth();
  EXPECT_NO_THROW(checkSite(readSite(folder / "site")));
  EXPECT_FALSE(fs::exists(folder / "site/unfinished_site"));
  EXPECT_FALSE(fs::exists(folder / "site/unfinished_site.state"));
  EXPECT_FALSE(isBegun(folder / "site"));
}

/// Nothing has a place, or a tile has none.
TEST(MakeState, IsReadAsItWasWritten)
{
  const files::TemporaryFolder folder;
  MakeState state;
  state.plan_crc32 = 1;
  state.source = 2;
  state.record = 3;
  state.dealt = 4;
  state.overview = 5;
  state.files = {6, 7};
  state.open = {std::nullopt, 1, 0};
  state.measured.resize(2);
  state.measured[1].bounds = Bounds{{1, 2, 3}, {4, 5, 6}};
  state.measured[1].spacing = 0.5;
  state.measured[1].crc32 = 8;
  state.measured[1].greatest["intensity"] = 9.5;
  const io::Json question = {{"asked", 1}};
  for (const std::optional<Bounds>& bounds : {std::optional<Bounds>(), std::optional(Bounds{{0, 1, 2}, {3, 4, 5}})}) {
    state.bounds = bounds;
    const MakeState read = readState(folder.write("state", stateText(state, question)), question);
    EXPECT_EQ(stateText(read, question), stateText(state, question));
    ASSERT_EQ(read.bounds.has_value(), bounds.has_value());
    if (bounds) {
      EXPECT_EQ(read.bounds->high, bounds->high);
    }
    EXPECT_FALSE(read.measured[0].bounds);
    EXPECT_EQ(read.measured[1].bounds->low, (Point3{1, 2, 3}));
    EXPECT_EQ(read.open[1], 1U);
  }
  const std::string bytes = planBytes({1, 2, 3});
  EXPECT_EQ(readPlan(folder.write("plan", bytes), crcOf(bytes)), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_THROW(readPlan(folder.write("plan", bytes + "4"), crcOf(bytes + "4")), files::FileError);
}

/// A disk that was full, or a stop that the caller wanted: the folder says so, and goes on.
TEST_F(SitesContinued, AfterAnException)
{
  makeBoth();
  const auto whole = contentsOf(folder / "site");
  for (const MakeStep stop : {MakeStep::deal, MakeStep::measure}) {
    fs::remove_all(folder / "site");
    MakeOptions stopping = options;
    stopping.progress = [&](MakeStep step, std::uint64_t done, std::uint64_t all) {
      return step != stop || done < all / 2;
    };
    EXPECT_THROW(makeSite({folder / "scan.xyz", folder / "more.xyz"}, folder / "site", stopping), Cancelled);
    EXPECT_THROW(readSite(folder / "site"), files::FileError);
    const std::uint64_t work = pointsOfWork();
    EXPECT_LT(work, stop == MakeStep::deal ? 80000 : 40000) << "what is done is not done again";
    EXPECT_TRUE(contentsOf(folder / "site") == whole);
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
} // namespace pcl_bsh::site

// SPDX-License-Identifier: BSD-3-Clause
#include "io/clouds/coordinate_samples.h"
#include "io/clouds/laz_encoder.h"
#include "io/clouds/laz_sample.h"
#include "io/clouds/samples.h"
#include "support/temporary_folder.h"
#include "support/threads_of.h"

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/pcd/pcd.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/search/cloud_view.h>
#include <pcl_bsh/site/check_site.h>
#include <pcl_bsh/site/export_site.h>
#include <pcl_bsh/site/make_site.h>
#include <pcl_bsh/site/making/density_tree.h>
#include <pcl_bsh/site/tiles/tile_file.h>

#include <gmock/gmock.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cmath>
#include <limits>
#include <map>

namespace pcl_bsh::site {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Cloud = pcl::PCLPointCloud2;

void writeBinary(const fs::path& path, const Cloud& cloud)
{
  std::ofstream out(path, std::ios::binary);
  out << io::binaryPcdHeader(cloud.fields, cloud.width);
  out.write(reinterpret_cast<const char*>(cloud.data.data()), static_cast<std::streamsize>(cloud.data.size()));
}

/// One row, as sites export it.
Cloud asRow(Cloud cloud)
{
  cloud.width *= cloud.height;
  cloud.height = 1;
  return cloud;
}

/// Clustered: a part of the points is a thousand times denser, a few are not finite, some are at one place.
Cloud unevenCloud(std::uint32_t points, unsigned seed)
{
  Cloud cloud;
  for (const char* axis : {"x", "y", "z"}) io::addField(cloud, axis, io::Field::FLOAT32);
  io::addField(cloud, "intensity", io::Field::UINT16);
  io::allocate(cloud, points);
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  for (std::uint32_t i = 0; i < points; ++i) {
    const float size = i % 3 == 0 ? 100.0F : 0.05F;
    float p[3] = {size * normal(random), size * normal(random), 0.01F * normal(random)};
    if (i % 50 == 0) p[0] = p[1] = p[2] = 7.0F;
    if (i % 97 == 0) p[i % 3] = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(&cloud.data[i * cloud.point_step], p, sizeof p);
    const auto intensity = static_cast<std::uint16_t>(random());
    std::memcpy(&cloud.data[i * cloud.point_step + sizeof p], &intensity, sizeof intensity);
  }
  return cloud;
}

MakeOptions tilesOf(std::uint64_t points)
{
  MakeOptions options;
  options.tile_points = points;
  return options;
}

TEST(MakeSite, HoldsEachPointOnceAndGivesItBack)
{
  const files::TemporaryFolder folder;
  const Cloud uneven = unevenCloud(20000, 1), all_types = io::randomCloud<double>(60, 50, io::pcd_datatypes);
  writeBinary(folder / "uneven.pcd", uneven);
  writeBinary(folder / "types.pcd", asRow(all_types));
  for (const std::uint64_t most : {1000000u, 3000u, 100u}) {
    SCOPED_TRACE(most);
    const fs::path place = folder / ("site" + std::to_string(most));
    const Site made = makeSite({folder / "uneven.pcd", folder / "types.pcd"}, place, tilesOf(most));
    const Site site = readSite(place);
    EXPECT_EQ(siteText(site), siteText(made));
    EXPECT_NO_THROW(checkSite(site));
    EXPECT_EQ(site.points, 23000U);
    std::uint64_t finite = 0;
    for (const Tile& tile : site.tiles) {
      EXPECT_LE(tile.points, most);
      if (tile.bounds) finite += tile.points;
    }
    EXPECT_EQ(finite, 23000U - (20000 + 96) / 97) << "points that are nowhere have tiles of their own";
    EXPECT_LE(site.tiles.size(), 5 * (23000 / most) / 2 + 2);

    ExportOptions little;
    little.memory = 1000000; // several windows
    exportSource(site, 0, place / "a.pcd", little);
    exportSource(site, 1, place / "b.pcd", little);
    Cloud a = io::readCloud(place / "a.pcd"), b = io::readCloud(place / "b.pcd");
    io::expectSame(a, uneven);
    io::expectSame(b, asRow(all_types));
    exportCloud(site, place / "all.pcd", little);
    const Cloud all = io::readCloud(place / "all.pcd");
    ASSERT_EQ(all.width, 23000U);
    for (std::uint32_t i : {0U, 19999U, 20000U, 22999U}) {
      EXPECT_EQ(io::valueOf(all, i, "source"), i < 20000 ? 0 : 1);
      EXPECT_EQ(io::valueOf(all, i, "record"), i < 20000 ? i : i - 20000);
    }
    EXPECT_EQ(io::valueOf(all, 19999, "y"), io::valueOf(uneven, 19999, "y")) << "float32, held as float64";
    EXPECT_TRUE(std::isnan(io::valueOf(all, 1, "rgb"))) << "the first source has none";
    EXPECT_EQ(io::valueOf(all, 22000, "intensity"), 0);
  }
}

TEST(MakeSite, ReadsAllFormats)
{
  const files::TemporaryFolder folder;
  Cloud cloud;
  for (const char* axis : {"x", "y", "z"}) io::addField(cloud, axis, io::Field::FLOAT64);
  io::allocate(cloud, 5000);
  std::mt19937 random(3);
  for (std::size_t i = 0; i < 15000; ++i) {
    const double value = static_cast<double>(random() % 100000) / 1000 + (i % 3 == 0 ? 597000.0 : 0.0);
    std::memcpy(&cloud.data[8 * i], &value, 8);
  }
  std::vector<fs::path> files;
  for (const char* extension : {".las", ".ply", ".pcd", ".csv", ".xyz", ".obj"}) {
    files.push_back(folder / (std::string("cloud") + extension));
    io::writeCloud(files.back(), cloud);
  }
  const Site site = makeSite(files, folder / "site", tilesOf(2000));
  checkSite(site);
  for (std::size_t i = 0; i < files.size(); ++i) {
    SCOPED_TRACE(files[i]);
    exportSource(site, i, folder / "out.pcd");
    io::expectSame(io::readCloud(folder / "out.pcd"), io::readCloud(files[i]));
  }
}

TEST(MakeSite, ReadsLazOnAsManyThreadsAsAreAskedFor)
{
  static const files::TemporaryFolder folder;
  io::LasSample sample(4, 6);
  io::addScan(sample, 1000);
  const auto file = folder.write("a.laz", io::laz_test::compressed(sample.text()));
  const auto make_on = [&](unsigned threads) {
    MakeOptions options;
    options.threads = threads;
    makeSite({file}, folder / "site", options);
  };
  expectOtherThreads(false, [&] { make_on(1); });
  if (threadCount(2) == 2) expectOtherThreads(true, [&] { make_on(2); });
}

TEST(MakeSite, KeepsTheCoordinateSystemsOfItsSources)
{
  const files::TemporaryFolder folder;
  std::vector<fs::path> files = {folder / "c.pcd"};
  writeBinary(files[0], unevenCloud(10, 2));
  for (const std::string name : {"A + heights", "B", "A + heights"}) {
    io::LasSample sample(4, 6);
    sample.records = {io::LasSample::record("LASF_Projection", 2112, "PROJCS[\"" + name + "\"]")};
    sample.addPoints(5);
    files.push_back(folder.write(std::to_string(files.size()) + ".las", sample.text()));
  }
  makeSite(files, folder / "site");
  const Site site = readSite(folder / "site");
  ASSERT_EQ(site.sources.size(), 4U);
  EXPECT_EQ(site.sources[0].coordinate_system, "");
  EXPECT_EQ(site.sources[1].coordinate_system, "A + heights");
  EXPECT_EQ(coordinateSystemOf(site), "A + heights; B") << "each once";
}

TEST(MakeSite, CloudsOfDifferentCoordinateSystemsAreRefused)
{
  if (!io::hasProj()) GTEST_SKIP() << "install libproj-dev";
  const files::TemporaryFolder folder;
  const auto file = [&](const std::string& name, const std::string& wkt) {
    io::LasSample sample(4, 6);
    sample.records = {io::LasSample::record("LASF_Projection", 2112, wkt)};
    for (std::int32_t i = 0; i < 5; ++i) {
      std::string point(sample.length(), '\0');
      for (std::size_t k = 0; k < 3; ++k) io::put(point, k * sizeof i, 1000 * i);
      sample.points.push_back(point);
    }
    return folder.write(name, sample.text());
  };
  std::string zone_32 = io::utm_33_wkt;
  zone_32.replace(zone_32.find("33N"), 3, "32N");
  zone_32.replace(zone_32.find("central_meridian\",15"), 20, "central_meridian\",9");
  const auto a = file("a.las", io::utm_33_wkt), b = file("b.las", zone_32);
  EXPECT_THAT(
      [&] {
        makeSite({a, a, b}, folder / "site");
      },
      testing::ThrowsMessage<files::FileError>(
          testing::HasSubstr("b.las: is in 'ETRS89 / UTM zone 32N', and " + a.string() + " in 'ETRS89 / UTM ")));
  EXPECT_FALSE(std::filesystem::exists(folder / "site"));
  EXPECT_EQ(makeSite({a, a}, folder / "site").points, 10U);

  MakeOptions to_33;
  to_33.to_crs = "EPSG:25833";
  const Site site = makeSite({a, b}, folder / "one", to_33);
  EXPECT_EQ(coordinateSystemOf(site), "ETRS89 / UTM zone 33N; ETRS89 / UTM zone 33N (EPSG:25833)") << "one system";
  checkSite(site);
  io::ReadSettings settings;
  settings.to_crs = to_33.to_crs;
  for (std::size_t i = 0; i < 2; ++i) {
    exportSource(site, i, folder / "out.pcd");
    io::expectSame(io::readCloud(folder / "out.pcd"), io::readCloud(i == 0 ? a : b, nullptr, settings));
  }
  to_33.to_unit = "ft";
  EXPECT_THROW(makeSite({a, b}, folder / "feet", to_33), files::FileError);
  EXPECT_FALSE(std::filesystem::exists(folder / "feet"));
}

TEST(MakeSite, DrawsAnOverviewEvenly)
{
  const files::TemporaryFolder folder;
  writeBinary(folder / "a.pcd", unevenCloud(10000, 2));
  MakeOptions options = tilesOf(1000);
  options.overview_points = 300;
  makeSite({folder / "a.pcd"}, folder / "site", options);
  const Cloud overview = io::readCloud(folder / "site/overview.pcd");
  EXPECT_EQ(overview.width, 295U);
  for (std::uint32_t i = 0; i < overview.width; ++i) EXPECT_EQ(io::valueOf(overview, i, "record"), 34.0 * i);
}

TEST(MakeSite, OfNothing)
{
  const files::TemporaryFolder folder;
  writeBinary(folder / "a.pcd", unevenCloud(0, 2));
  const Site site = makeSite({folder / "a.pcd"}, folder / "site");
  EXPECT_EQ(site.tiles.size(), 0U);
  EXPECT_NO_THROW(checkSite(readSite(folder / "site")));
}

/// Expects that a call is refused with these words, and leaves the folder as it was.
template <typename Call>
void expectRefused(const fs::path& folder, const std::string& words, const Call& call)
{
  const auto listed = [&] {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      files[entry.path().string()] = entry.is_regular_file() ? files::contentOf(entry.path()) : "";
    return files;
  };
  const auto before = listed();
  try {
    call();
    ADD_FAILURE() << "not refused: " << words;
  }
  catch (const std::exception& error) {
    EXPECT_THAT(error.what(), HasSubstr(words));
  }
  EXPECT_TRUE(listed() == before) << words;
}

TEST(MakeSite, Refuses)
{
  const files::TemporaryFolder folder;
  writeBinary(folder / "a.pcd", unevenCloud(3000, 2));
  Cloud other = unevenCloud(10, 2);
  other.fields[3].datatype = io::Field::INT16;
  writeBinary(folder / "other.pcd", other);
  Cloud own = unevenCloud(10, 2);
  own.fields[3].name = "record";
  writeBinary(folder / "own.pcd", own);
  folder.write("two.pcd", "FIELDS x y z intensity intensity\nSIZE 4 4 4 4 4\nTYPE F F F F F\nCOUNT 1 1 1 1 1\nWIDTH 1\n"
                          "HEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3 4 5\n");
  folder.write("short.pcd", files::contentOf(folder / "a.pcd").substr(0, 3000));
  const auto refuse = [&](const char* words, const std::vector<fs::path>& clouds, const fs::path& place,
                          const MakeOptions& options = {}) {
    expectRefused(folder.path(), words, [&] { makeSite(clouds, place, options); });
  };
  refuse("no such file", {folder / "none.pcd"}, folder / "site");
  refuse("its field 'intensity' has another type", {folder / "a.pcd", folder / "other.pcd"}, folder / "site");
  refuse("has a field named 'record'", {folder / "own.pcd"}, folder / "site");
  refuse("has two fields named 'intensity'", {folder / "two.pcd"}, folder / "site");
  own.fields[3].name = "source";
  writeBinary(folder / "own.pcd", own);
  refuse("has a field named 'source'", {folder / "own.pcd"}, folder / "site");
  folder.write("pairs.pcd", "FIELDS x y z intensity\nSIZE 4 4 4 2\nTYPE F F F U\nCOUNT 1 1 1 2\nWIDTH 1\nHEIGHT 1\n"
                            "POINTS 1\nDATA ascii\n1 2 3 4 5\n");
  refuse("its field 'intensity' has another type", {folder / "a.pcd", folder / "pairs.pcd"}, folder / "site");
  folder.write("faces.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  refuse("faces.off: has faces, which a site cannot hold: take its vertices alone", {folder / "faces.off"},
         folder / "site");
  refuse("truncated", {folder / "short.pcd"}, folder / "site");
  refuse("name one", {}, folder / "site");
  refuse("is not empty", {folder / "a.pcd"}, folder.path());
  refuse("tile of 0 points", {folder / "a.pcd"}, folder / "site", tilesOf(0));
  refuse("a tile of 2147483648 points cannot be: give from 1 to 2147483647", {folder / "a.pcd"}, folder / "site",
         tilesOf(std::uint64_t{1} << 31));
  MakeOptions options;
  options.memory = 1000;
  refuse("give 64 MiB or more", {folder / "a.pcd"}, folder / "site", options);
  options.memory = std::uint64_t{64} << 20;
  std::string text = "x y z\n";
  for (int i = 0; i < 1500000; ++i) text += "1 2 3 4 5\n";
  folder.write("large.xyz", text);
  refuse("does not fit into the memory given", {folder / "large.xyz"}, folder / "site", options);
  fs::remove(folder / "large.xyz");

  for (const MakeStep step : {MakeStep::count, MakeStep::deal, MakeStep::measure}) {
    MakeOptions stopping = tilesOf(100);
    stopping.progress = [&](MakeStep at, std::uint64_t, std::uint64_t) { return at != step; };
    const auto call = [&] {
      EXPECT_THROW(makeSite({folder / "a.pcd"}, folder / "site", stopping), Cancelled);
      throw 0;
    };
    try {
      call();
    }
    catch (int) {
    }
    EXPECT_FALSE(fs::exists(folder / "site"));
  }
  makeSite({folder / "a.pcd"}, folder / "site");
  refuse("is a site already", {folder / "a.pcd"}, folder / "site");
}

/// A cloud of holes: so many records of `bytes` more, each at a place of its own.
void writeWide(const fs::path& path, std::uint32_t points, std::uint32_t bytes)
{
  Cloud header;
  for (const char* axis : {"x", "y", "z"}) io::addField(header, axis, io::Field::FLOAT32);
  io::addField(header, "more", io::Field::UINT8, bytes);
  const std::string head = io::binaryPcdHeader(header.fields, points);
  std::ofstream out(path, std::ios::binary);
  out << head;
  for (std::uint32_t i = 0; i < points; ++i) {
    const auto x = static_cast<float>(i);
    out.seekp(static_cast<std::streamoff>(head.size() + std::size_t{i} * header.point_step));
    out.write(reinterpret_cast<const char*>(&x), sizeof x);
  }
  out.close();
  fs::resize_file(path, head.size() + std::size_t{points} * header.point_step);
}

TEST(MakeSite, RefusesTilesThatDoNotFitIntoTheMemory)
{
  const files::TemporaryFolder folder;
  MakeOptions options = tilesOf(100);
  options.memory = std::uint64_t{64} << 20;
  options.overview_points = 0;
  const auto refuse = [&](const char* name, const std::string& words) {
    expectRefused(folder.path(), words, [&] { makeSite({folder / name}, folder / "site", options); });
  };
  writeWide(folder / "a.pcd", 100, 700000);
  refuse("a.pcd", "a tile of 100 points needs 67 MiB, more than the memory given: make tiles smaller, or give more");
  fs::remove(folder / "a.pcd");
  options.tile_points = 1; // so many tiles that a buffer of each has no room for a record
  const std::string too_fine = "tiles of 1 point are too many for 64 MiB: make tiles larger, or give more memory";
  writeWide(folder / "a.pcd", 300, 60000);
  refuse("a.pcd", too_fine);
  writeBinary(folder / "a.pcd", unevenCloud(260000, 3)); // or that the plan of them has none
  refuse("a.pcd", too_fine);
}

TEST(MakeSite, RefusesCloudsThatChange)
{
  const files::TemporaryFolder folder;
  writeBinary(folder / "a.pcd", unevenCloud(3000, 2));
  MakeOptions options;
  options.progress = [&](MakeStep step, std::uint64_t, std::uint64_t) {
    if (step == MakeStep::count) writeBinary(folder / "a.pcd", unevenCloud(2999, 2));
    return true;
  };
  try {
    makeSite({folder / "a.pcd"}, folder / "site", options);
    ADD_FAILURE();
  }
  catch (const files::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a.pcd: has changed while it was read: make the site when it is complete"));
  }
  EXPECT_FALSE(fs::exists(folder / "site"));
}

TEST(MakeSite, ColumnsMayBeNamedAndWhatIsAssumedIsTold)
{
  const files::TemporaryFolder folder;
  std::string rows;
  for (int i = 1; i < 13; ++i) rows += std::to_string(i) + ",2.5,3.5,4.5\n";
  const fs::path counted = folder.write("counted.csv", rows);
  writeBinary(folder / "a.pcd", unevenCloud(10, 2));
  std::vector<fs::path> told;
  MakeOptions options;
  options.remark = [&](const fs::path& file, const std::vector<std::string>& remarks) {
    EXPECT_THAT(remarks, testing::ElementsAre(HasSubstr("its first column counts up by one")));
    told.push_back(file);
  };
  const Site plain = makeSite({folder / "a.pcd", counted}, folder / "plain", options);
  EXPECT_THAT(told, testing::ElementsAre(counted));
  options.columns = [&](const fs::path& file) {
    return file == counted ? std::vector<std::string>{"_", "x", "y", "z"} : std::vector<std::string>();
  };
  const Site named = makeSite({counted}, folder / "named", options);
  EXPECT_EQ(named.bounds->low, (Point3{2.5, 3.5, 4.5}));
  EXPECT_EQ(told.size(), 1U) << "names are no guess";
}

TEST(MakeSite, ClearsNothingButWhatIsItsOwn)
{
  const files::TemporaryFolder folder;
  writeBinary(folder / "a.pcd", unevenCloud(3000, 2));
  const fs::path place = folder / "site";
  const auto begin = [&] {
    fs::remove_all(place);
    fs::create_directories(place / "tiles");
    folder.write("site/unfinished_site", "");
  };
  begin();
  const std::vector<std::string> users = {"tile_00000.pcd", "tile_00000x.pcd", "tile_000000.txt",
                                          "tile_000000",    "file_000000.pcd", "tile_000000.pcd.part0"};
  for (const std::string& name : users) folder.write("site/tiles/" + name, "the user's");
  for (const char* const name : {"tiles/tile_000009.answer", "tiles/tile_000009.answer.part0", "tiles/tile_1234567.pcd",
                                 "overview.pcd", "unfinished_site.plan", "unfinished_site.state.part1"})
    folder.write(std::string("site/") + name, "left");
  makeSite({folder / "a.pcd"}, place);
  checkSite(readSite(place));
  for (const std::string& name : users) EXPECT_EQ(files::contentOf(place / "tiles" / name), "the user's") << name;
  std::size_t found = 0;
  for (const auto& entry : fs::recursive_directory_iterator(place)) found += entry.is_regular_file() ? 1U : 0U;
  EXPECT_EQ(found, users.size() + 4) << "two tiles, the overview and site.json";

  begin(); // a folder of the user's in the place of a tile
  fs::create_directories(place / "tiles/tile_000003.pcd/letters");
  for (int again = 0; again < 2; ++again) // the folder is not locked after the first refusal
    expectRefused(folder.path(), "cannot be cleared (Directory not empty): name a new folder",
                  [&] { makeSite({folder / "a.pcd"}, place); });

  begin(); // a way to a folder of the user's
  fs::create_directory(folder / "mine");
  folder.write("mine/tile_000000.pcd", "the user's");
  fs::remove(place / "tiles");
  fs::create_directory_symlink(folder / "mine", place / "tiles");
  EXPECT_THROW(makeSite({folder / "a.pcd"}, place), files::FileError);
  EXPECT_EQ(files::contentOf(folder / "mine/tile_000000.pcd"), "the user's");

  begin();
  const int mark = ::open((place / "unfinished_site").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(mark, LOCK_EX), 0);
  expectRefused(folder.path(), "another program makes a site there: wait for it, or name a new folder",
                [&] { makeSite({folder / "a.pcd"}, place); });
  ::close(mark);
  EXPECT_NO_THROW(makeSite({folder / "a.pcd"}, place));
}

TEST(TileFiles, AreWrittenBufferByBuffer)
{
  const files::TemporaryFolder folder;
  const Cloud cloud = unevenCloud(10, 4);
  for (const std::size_t buffer : {std::size_t{1}, 3 * std::size_t{cloud.point_step}, std::size_t{1} << 20}) {
    const fs::path path = folder / ("tile" + std::to_string(buffer) + ".pcd");
    files::NewFile file(path);
    TileFile tile(file, cloud.fields, buffer);
    for (std::size_t i = 0; i < cloud.width; ++i) {
      tile.add(&cloud.data[i * cloud.point_step], cloud.point_step);
      // Never more than the buffer is waiting.
      const std::uint64_t waiting = TileFile::bytesOf(cloud.fields, i + 1) - fs::file_size(path);
      EXPECT_LE(waiting, std::max<std::uint64_t>(buffer, cloud.point_step));
    }
    tile.finish();
    file.keep();
    EXPECT_EQ(tile.points(), 10U);
    io::expectSame(io::readCloud(path), cloud);
  }
}

TEST(TileFiles, TakeTheirBytesAndABlockEach)
{
  const Cloud cloud = unevenCloud(1, 4); // 14 bytes
  EXPECT_EQ(diskSpaceOf(cloud.fields, 1000, 7, 100), 1100U * 14 + 9 * 4096);
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max() / 2;
  EXPECT_EQ(diskSpaceOf(cloud.fields, most / 14, 0, 0), most / 14 * 14 + 2 * 4096);
  EXPECT_EQ(diskSpaceOf(cloud.fields, most / 14 + 1, 0, 0), most + 2 * 4096) << "and no overflow";
}

TEST(MakeSite, BeginsAgainWhereOneWasKilled)
{
  const files::TemporaryFolder folder;
  writeBinary(folder / "a.pcd", unevenCloud(3000, 2));
  const fs::path place = folder / "site";
  fs::create_directories(place / "tiles");
  folder.write("site/unfinished_site", "");
  folder.write("site/tiles/tile_000000.pcd", "half");
  folder.write("site/tiles/tile_999999.pcd", "half");
  folder.write("site/tiles/mine.pcd", "the user's");
  folder.write("site/site.json.part0", "{");
  EXPECT_THROW(readSite(place), files::FileError);
  const Site site = makeSite({folder / "a.pcd"}, place, tilesOf(1000));
  checkSite(readSite(place));
  EXPECT_EQ(files::contentOf(place / "tiles/mine.pcd"), "the user's");
  EXPECT_FALSE(fs::exists(place / "tiles/tile_999999.pcd"));
  EXPECT_FALSE(fs::exists(place / "unfinished_site"));
  EXPECT_FALSE(fs::exists(place / "site.json.part0"));
}

TEST(CloudStream, GivesWhatReadCloudGives)
{
  const files::TemporaryFolder folder;
  const Cloud cloud = io::randomCloud<float>(40, 25, io::ply_datatypes);
  writeBinary(folder / "binary.pcd", asRow(cloud));
  io::writeCloud(folder / "compressed.pcd", cloud);
  io::writeCloud(folder / "cloud.ply", cloud);
  for (const char* name : {"binary.pcd", "compressed.pcd", "cloud.ply"}) {
    const Cloud expected = asRow(io::readCloud(folder / name));
    const auto stream = io::openCloud(folder / name, std::uint64_t{1} << 30);
    EXPECT_EQ(stream->size(), 1000U);
    Cloud read = stream->header();
    io::allocate(read, 1000);
    std::size_t done = 0;
    while (const std::size_t points = stream->read(&read.data[done * read.point_step], 77)) {
      done += points;
      if (done == 1000) break;
    }
    EXPECT_EQ(done, 1000U);
    io::expectSame(read, expected);
  }
}

TEST(Overview, HasAsManyPointsAsItMay)
{
  for (const auto& [points, step] : std::vector<std::pair<std::uint64_t, std::uint64_t>>{
           {0, 1}, {1, 1}, {999, 1}, {1000, 1}, {1001, 2}, {2000, 2}, {2001, 3}})
    EXPECT_EQ(overviewStep(points, 1000), step) << points;
}

/// Counts the points of each tile that a tree of them plans.
std::vector<std::uint64_t> tilesFor(const std::vector<Point3>& points, std::uint64_t most)
{
  DensityTree tree(most);
  for (const Point3& point : points) tree.add(point);
  std::vector<std::uint64_t> counts(tree.plan(), 0);
  for (const Point3& point : points) ++counts.at(tree.tileOf(point));
  return counts;
}

TEST(DensityTree, LimitsTilesWhateverTheDensity)
{
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double scale : {1.0, 1e-4, 1e-8, 1e6, 1e290, 1e-280}) {
    for (const bool shuffled : {false, true}) {
      SCOPED_TRACE(scale);
      std::vector<Point3> points;
      for (int i = 0; i < 30000; ++i) {
        const double size = i < 10000 ? 1.0 : i < 20000 ? 1e-2 : 1e-4; // per volume up to 10^12 times as dense
        const double shift = i < 10000 ? 0.0 : 0.3;
        points.push_back({scale * (size * unit(random) + shift), scale * (size * unit(random) - shift),
                          scale * size * unit(random)});
      }
      if (shuffled) std::shuffle(points.begin(), points.end(), random);
      for (const std::uint64_t most : {200u, 5000u}) {
        const std::vector<std::uint64_t> counts = tilesFor(points, most);
        EXPECT_LE(*std::max_element(counts.begin(), counts.end()), most);
        EXPECT_LE(counts.size(), 2.5 * static_cast<double>(points.size()) / static_cast<double>(most));
      }
    }
  }
}

/// Only a cell whose points are all at one place may have more than a tile: one of them elsewhere is not.
TEST(DensityTree, DividesCellsOfTwoPlaces)
{
  const Point3 near = {0.1, 0.1, 0.1}, far = {0.9, 0.9, 0.9};
  for (const auto& [often, once] : {std::pair{near, far}, std::pair{far, near}}) {
    std::vector<Point3> points(129, often);
    points[1] = once;
    const std::vector<std::uint64_t> counts = tilesFor(points, 128);
    EXPECT_LE(*std::max_element(counts.begin(), counts.end()), 128U);
  }
}

/// The cell of the point that was asked about before is looked at first.
TEST(DensityTree, FindsTheSameTileAfterAnyOtherPoint)
{
  std::mt19937 random(10);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Point3> points;
  for (int i = 0; i < 400; ++i) points.push_back({unit(random), unit(random), unit(random)});
  DensityTree tree(10);
  for (const Point3& point : points) tree.add(point);
  EXPECT_GT(tree.plan(), 20U);
  const DensityTree planned = tree;
  std::vector<std::pair<Point3, std::uint32_t>> expected;
  for (const Point3& point : points) expected.emplace_back(point, DensityTree(planned).tileOf(point));
  for (int order = 0; order < 20; ++order) {
    std::shuffle(expected.begin(), expected.end(), random);
    for (const auto& [point, tile] : expected) ASSERT_EQ(tree.tileOf(point), tile);
  }
}

/// Where nobody was counted, there is no tile but the first.
TEST(DensityTree, FindsTheFirstTileInAnEmptyOctant)
{
  DensityTree tree(2);
  for (int i = 0; i < 40; ++i) tree.add({1.0 + i, 2.0, 3.0});
  EXPECT_GT(tree.plan(), 10U);
  EXPECT_EQ(tree.tileOf({-1, 2, 3}), 0U);
}

TEST(DensityTree, APlanIsReadAsItWasWrittenOrRefused)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Point3> points(300);
  for (Point3& point : points)
    for (double& c : point) c = unit(random);
  DensityTree tree(10);
  for (const Point3& point : points) tree.add(point);
  tree.plan();
  const std::vector<std::uint32_t> numbers = tree.planned();
  DensityTree read = DensityTree::fromPlanned(numbers);
  EXPECT_EQ(read.planned(), numbers);
  for (const Point3& point : points) EXPECT_EQ(read.tileOf(point), tree.tileOf(point));

  constexpr std::size_t head = 17, per_cell = 10;
  const auto cells = static_cast<std::uint32_t>((numbers.size() - head) / per_cell);
  const auto expectRefusal = [](const std::vector<std::uint32_t>& wrong) {
    EXPECT_THROW(DensityTree::fromPlanned(wrong), std::invalid_argument);
  };
  for (const std::size_t size : {std::size_t{0}, head - per_cell, head - 1, numbers.size() - 1})
    expectRefusal({numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(size)});
  for (const std::size_t place : {std::size_t{1}, std::size_t{15}, head, head + 7, numbers.size() - 3}) {
    std::vector<std::uint32_t> wrong = numbers;
    wrong[place] = cells; // roots and parts of cells: one behind the last
    expectRefusal(wrong);
    wrong[place] = cells - 1;
    EXPECT_NO_THROW(DensityTree::fromPlanned(wrong)) << place;
  }
  EXPECT_EQ(DensityTree::fromPlanned(DensityTree(10).planned()).planned(), DensityTree(10).planned()) << "of nothing";
}

TEST(DensityTree, TakesAnyPlace)
{
  const double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  std::vector<Point3> points = {{0, 0, 0}, {-0.0, 0, -0.0}, {most, -most, most}, {least, -least, 0}, {1, most, least}};
  for (int i = 0; i < 500; ++i) points.push_back({3, 3, 3}); // more than a tile may have: one cell, whatever follows
  points.push_back({3, 3, std::nextafter(3.0, 4.0)});
  const std::vector<std::uint64_t> counts = tilesFor(points, 100);
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}), points.size());
  DensityTree empty(10);
  EXPECT_EQ(empty.plan(), 0U);
}

} // namespace
} // namespace pcl_bsh::site

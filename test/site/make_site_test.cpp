// SPDX-License-Identifier: BSD-3-Clause
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
  for (const std::uint64_t most : {1000000, 3000, 100}) {
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

/// That a call is refused with these words, and leaves the folder as it was.
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
  refuse("truncated", {folder / "short.pcd"}, folder / "site");
  refuse("name one", {}, folder / "site");
  refuse("is not empty", {folder / "a.pcd"}, folder.path());
  refuse("tile of 0 points", {folder / "a.pcd"}, folder / "site", tilesOf(0));
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
      for (const std::uint64_t most : {200, 5000}) {
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

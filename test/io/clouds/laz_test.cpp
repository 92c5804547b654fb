// SPDX-License-Identifier: BSD-3-Clause
// LAZ as files of clouds: all that holds for LAS.
#include "laz_encoder.h"
#include "laz_sample.h"
#include "samples.h"

#include "support/threads_of.h"

#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/las/las.h>
#include <pcl_bsh/io/clouds/las/laz/compressor.h>
#include <pcl_bsh/io/clouds/meshes/obstacle.h>
#include <pcl_bsh/io/files/file_error.h>

#include <gmock/gmock.h>

#include <functional>

namespace pcl_bsh::io {

namespace {

/// With records of all kinds, and extra bytes that are described.
LasSample describedScan(std::uint8_t format)
{
  LasSample sample(4, format, 4 + 2);
  sample.records = {
      LasSample::record("LASF_Projection", 2112, "PROJCS[...]"),
      LasSample::record("LASF_Spec", 4,
                        LasSample::descriptor(9, "amplitude") + LasSample::descriptor(3, "echo width", 8, 0.1))};
  sample.extended = {LasSample::extendedRecord("somebody", 9, "more")};
  sample.global_encoding = 16;
  addScan(sample, 1000, 4, 3);
  return sample;
}

std::string refusalOf(const std::filesystem::path& file)
{
  try {
    readCloud(file);
  }
  catch (const files::FileError& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST(Laz, FilesGiveWhatTheirLasGives)
{
  const TemporaryFolder folder;
  for (const std::uint8_t format : std::initializer_list<std::uint8_t>{3, 8}) {
    const std::string las = describedScan(format).text(), laz = laz_test::compressed(las);
    const pcl::PCLPointCloud2 expected = readCloud(folder.write("a.las", las));
    ASSERT_EQ(expected.width, 1000U);
    for (const char* name : {"a.laz", "A.LAZ", "a.copc.laz", "compressed.las"}) { // the content tells
      const auto file = folder.write(name, laz);
      for (const unsigned threads : {0U, 1U, 2U}) expectSame(readCloud(file, nullptr, {}, threads), expected);
      expectSame(readMesh(file).vertices, expected);
      EXPECT_EQ(readCloudHeader(file).width, 1000U);
      EXPECT_EQ(readCloudHeader(file).fields.size(), expected.fields.size());
    }
    expectSame(readCloud(folder.write("uncompressed.laz", las)), expected);
  }
}

/// As of LAS, whose records behind the points are counted.
TEST(Laz, TellsPointsThatItsHeaderDoesNotCount)
{
  const TemporaryFolder folder;
  const auto remarksOf = [&](const std::string& laz) {
    const auto file = folder.write("a.laz", laz);
    CloudFacts facts;
    readCloud(file, &facts);
    EXPECT_EQ(openCloud(file, 1 << 20)->facts().remarks, facts.remarks);
    return facts.remarks;
  };
  LasSample sample(2, 1);
  addScan(sample, 250);
  laz_test::LazOptions differing;
  differing.chunks = {100, 120, 30};
  const std::string alike = laz_test::compressed(sample.text()),
                    different = laz_test::compressed(sample.text(), differing);
  EXPECT_TRUE(remarksOf(alike).empty()) << "also where it is far shorter than its points";
  EXPECT_TRUE(remarksOf(different).empty());
  for (const std::uint32_t told : {1U, 99U, 100U, 101U, 200U}) {
    const auto remarkOn = [&](std::string laz) {
      put(laz, 107, told);
      return remarksOf(laz);
    };
    const std::string begin = "its header counts " + std::to_string(told) + " of at least ";
    EXPECT_THAT(remarkOn(alike),
                testing::ElementsAre(begin + "201 points that its chunks have: the others are left out"));
    EXPECT_THAT(remarkOn(different),
                testing::ElementsAre(begin + "250 points that its chunks have: the others are left out"));
  }
}

TEST(Laz, IsReadOnAsManyThreadsAsAreAskedFor)
{
  static const TemporaryFolder folder;
  const auto file = folder.write("a.laz", laz_test::compressed(describedScan(6).text()));
  const auto read_stream = [&](unsigned threads) {
    const auto stream = openCloud(file, 0, {}, threads);
    std::vector<std::uint8_t> records(stream->header().point_step * std::size_t{1000});
    stream->read(records.data(), 1000);
  };
  SurfaceSettings vertices;
  vertices.vertices_only = true;
  const std::vector<std::function<void(unsigned)>> readers = {
      [&](unsigned threads) { readCloud(file, nullptr, {}, threads); },
      [&](unsigned threads) { readMesh(file, nullptr, {}, threads); },
      [&](unsigned threads) { readMesh(file, vertices, nullptr, {}, threads); },
      [&](unsigned threads) { readObstacle(file, {}, {}, nullptr, threads); },
      [&](unsigned threads) { readObstacle(file, vertices, {}, nullptr, threads); },
      read_stream};
  for (const auto& reader : readers) {
    expectOtherThreads(false, [&] { reader(1); });
    if (threadCount(2) == 2) expectOtherThreads(true, [&] { reader(2); });
  }
}

TEST(Laz, CopcWrittenAsLasDoesNotSayWhereItsPartsWere)
{
  const TemporaryFolder folder;
  LasSample copc(4, 7);
  copc.records = {LasSample::record("copc", 1, std::string(160, 'i'))};
  copc.extended = {LasSample::extendedRecord("copc", 1000, std::string(96, 'h'))};
  addScan(copc, 300);
  CloudFacts facts;
  const auto cloud = readCloud(folder.write("a.copc.laz", laz_test::compressed(copc.text())), &facts);
  writeCloud(folder / "b.las", cloud, no_viewpoint, facts.las);
  copc.records.clear();
  copc.extended.clear();
  EXPECT_EQ(contentOf(folder / "b.las"), copc.text());
}

TEST(Laz, WrittenAsLasIsTheFileThatWasCompressed)
{
  const TemporaryFolder folder;
  for (std::uint8_t format = 0; format <= 10; ++format) {
    const std::string las = describedScan(format).text();
    CloudFacts facts;
    const auto cloud = readCloud(folder.write("a.laz", laz_test::compressed(las)), &facts);
    ASSERT_NE(facts.las, nullptr);
    writeCloud(folder / "b.las", cloud, no_viewpoint, facts.las);
    EXPECT_EQ(contentOf(folder / "b.las"), las) << unsigned{format};
  }
}

TEST(Laz, StreamsInBatchesOfAnySize)
{
  const TemporaryFolder folder;
  const auto file = folder.write("a.laz", laz_test::compressed(describedScan(7).text()));
  const pcl::PCLPointCloud2 expected = readCloud(file);
  const auto stream = openCloud(file, 0);
  EXPECT_EQ(stream->size(), 1000U);
  pcl::PCLPointCloud2 read = stream->header();
  allocate(read, 1000);
  const std::size_t step = read.point_step;
  std::size_t done = 0;
  for (const std::size_t most : {1u, 99u, 250u, 33u}) done += stream->read(&read.data[done * step], most);
  stream->skip(400);
  std::copy_n(&expected.data[done * step], 400 * step, &read.data[done * step]);
  done += 400;
  done += stream->read(&read.data[done * step], 1000);
  EXPECT_EQ(done, 1000U);
  EXPECT_EQ(stream->read(read.data.data(), 10), 0U);
  EXPECT_EQ(read.data, expected.data);
}

TEST(Laz, RefusalsNameTheFileAndTheChunkInOneLine)
{
  using testing::HasSubstr;
  const TemporaryFolder folder;
  const LasSample sample = describedScan(6);
  const std::string laz = laz_test::compressed(sample.text());
  std::string damaged = laz;
  const std::size_t first_chunk = get<std::uint32_t>(laz, 96) + 8;
  put(damaged, first_chunk + sample.length() + 4, 0xffffffffU);
  const auto file = folder.write("damaged.laz", damaged);
  const std::string text = refusalOf(file);
  EXPECT_THAT(text, HasSubstr("damaged.laz"));
  EXPECT_THAT(text, HasSubstr("chunk 1 of 10"));
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(readCloudHeader(file).width, 1000U);
  const auto stream = openCloud(file, 0);
  std::vector<std::uint8_t> records(stream->header().point_step * std::size_t{1000});
  try {
    stream->read(records.data(), 1000);
    ADD_FAILURE();
  }
  catch (const files::FileError& error) {
    EXPECT_THAT(error.what(), HasSubstr("damaged.laz"));
    EXPECT_THAT(error.what(), HasSubstr("chunk 1 of 10"));
  }
  EXPECT_THAT(refusalOf(folder.write("no.laz", "anything")), HasSubstr("LASF"));
}

TEST(Laz, IsNotWrittenWhereItCannotBe)
{
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = randomCloud<double>(3, 1, {});
  const auto refusalOfWriting = [&](const char* name) {
    try {
      writeCloud(folder / name, cloud);
    }
    catch (const files::FileError& error) {
      EXPECT_FALSE(std::filesystem::exists(folder / name));
      return std::string(error.what()).substr((folder / name).string().size());
    }
    return std::string("none");
  };
  EXPECT_EQ(refusalOfWriting("b.laz"), writesLaz() ? "none"
                                                   : ": is the name of a compressed file, which is not written without "
                                                     "LASzip: write a .las file, or build it where liblaszip-dev is "
                                                     "installed");
  if (writesLaz()) {
    EXPECT_EQ(refusalOfWriting("b.copc.laz"),
              ": is the name of a COPC file, whose tree of parts is not written: write a .laz file");
  }
}

} // namespace pcl_bsh::io

// SPDX-License-Identifier: BSD-3-Clause
// .laz as LASzip writes it. LASzip is a second decoder, too: of our files, and of those that the tests of ours make.
#include <pcl_bsh/io/clouds/las/laz/compressor.h>

#include "../laz_encoder.h"
#include "../laz_sample.h"
#include "../samples.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/text/format_error.h>

#include <gmock/gmock.h>

#include <fstream>
#include <laszip/laszip_api.h>
#include <sstream>

namespace pcl_bsh::io {

namespace {

LasSample describedScan(std::uint8_t format, std::size_t points)
{
  LasSample sample(4, format, 4 + 2);
  sample.records = {
      LasSample::record("LASF_Projection", 2112, "PROJCS[...]"),
      LasSample::record("LASF_Spec", 4,
                        LasSample::descriptor(9, "amplitude") + LasSample::descriptor(3, "echo width", 8, 0.1))};
  sample.extended = {LasSample::extendedRecord("somebody", 9, "more")};
  sample.global_encoding = 16;
  addScan(sample, points, 4, 3);
  return sample;
}

/// The points' bytes, as LASzip unpacks them.
std::string pointsByLaszip(const std::string& laz)
{
  const auto must = [](laszip_I32 failed) { EXPECT_EQ(failed, 0); };
  laszip_POINTER in = nullptr, out = nullptr;
  must(laszip_create(&in));
  must(laszip_create(&out));
  std::istringstream file(laz);
  std::ostringstream unpacked;
  laszip_BOOL is_compressed = 0;
  must(laszip_open_reader_stream(in, file, &is_compressed));
  EXPECT_TRUE(is_compressed);
  laszip_header* header = nullptr;
  must(laszip_get_header_pointer(in, &header));
  laszip_point* point = nullptr;
  must(laszip_get_point_pointer(in, &point));
  must(laszip_set_point_type_and_size(out, header->point_data_format, header->point_data_record_length));
  must(laszip_open_writer_stream(out, unpacked, 0, 1));
  const std::uint64_t count =
      header->number_of_point_records ? header->number_of_point_records : header->extended_number_of_point_records;
  for (std::uint64_t i = 0; i < count; ++i) {
    must(laszip_read_point(in));
    must(laszip_set_point(out, point));
    must(laszip_write_point(out));
  }
  must(laszip_close_writer(out));
  must(laszip_close_reader(in));
  must(laszip_destroy(in));
  must(laszip_destroy(out));
  return unpacked.str();
}

std::string joined(const std::vector<std::string>& points)
{
  std::string bytes;
  for (const std::string& point : points) bytes += point;
  return bytes;
}

} // namespace

TEST(LazCompressor, FilesAreTheLasFilesCompressed)
{
  const TemporaryFolder folder;
  for (std::uint8_t format = 0; format <= 10; ++format) {
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{1000}, std::size_t{50001}}) {
      if (count > 1000 && format != 3 && format != 7) continue; // a second chunk
      SCOPED_TRACE(testing::Message() << unsigned{format} << ", " << count);
      const LasSample sample = describedScan(format, count);
      CloudFacts facts;
      const auto cloud = readCloud(folder.write("a.las", sample.text()), &facts);
      writeCloud(folder / "b.laz", cloud, no_viewpoint, facts.las);
      const std::string laz = contentOf(folder / "b.laz");
      if (count > 1) {
        EXPECT_LT(laz.size(), sample.text().size());
      }
      if (count > 0) {
        EXPECT_EQ(pointsByLaszip(laz), joined(sample.points));
      }
      CloudFacts again;
      expectSame(readCloud(folder / "b.laz", &again), cloud);
      writeCloud(folder / "c.las", cloud, no_viewpoint, again.las);
      EXPECT_EQ(contentOf(folder / "c.las"), sample.text()) << "records before and behind the points, too";
    }
  }
}

TEST(LazCompressor, AnyBytesArePoints)
{
  const TemporaryFolder folder;
  for (std::uint8_t format = 0; format <= 10; ++format) {
    SCOPED_TRACE(unsigned{format});
    LasSample sample(4, format, 3);
    sample.addPoints(500);
    CloudFacts facts;
    const auto cloud = readCloud(folder.write("a.las", sample.text()), &facts);
    writeCloud(folder / "b.laz", cloud, no_viewpoint, facts.las);
    expectSame(readCloud(folder / "b.laz"), cloud);
  }
}

TEST(LazCompressor, FilesWithoutAHeaderAreNew)
{
  const TemporaryFolder folder;
  const pcl::PCLPointCloud2 cloud = randomCloud<double>(3, 100, {});
  writeCloud(folder / "a.las", cloud);
  writeCloud(folder / "b.laz", cloud);
  expectSame(readCloud(folder / "b.laz"), readCloud(folder / "a.las"));
  EXPECT_EQ(openCloud(folder / "b.laz", 1 << 20)->size(), std::uint64_t{cloud.width} * cloud.height);
}

TEST(LazCompressor, LaszipReadsWhatTheTestsCompress)
{
  for (std::uint8_t format = 0; format <= 10; ++format) {
    SCOPED_TRACE(unsigned{format});
    const LasSample sample = describedScan(format, 1000);
    EXPECT_EQ(pointsByLaszip(laz_test::compressed(sample.text())), joined(sample.points));
  }
}

TEST(LazCompressor, NamesWhatLaszipRefuses)
{
  try {
    LazCompressor(11, 40);
    ADD_FAILURE();
  }
  catch (const FormatError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("LASzip says"));
    EXPECT_EQ(error.remedy(), "write a .las file");
  }
}

} // namespace pcl_bsh::io

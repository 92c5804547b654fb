// SPDX-License-Identifier: BSD-3-Clause
// Clouds read in batches are those that are read at once.
#include "las_sample.h"
#include "samples.h"

#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/cloud_stream.h>

#include <gmock/gmock.h>

namespace pcl_bsh::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr std::uint64_t plenty = std::uint64_t{1} << 30;

/// The records of all points, read seven at a time.
std::vector<std::uint8_t> recordsOf(CloudStream& stream)
{
  constexpr std::size_t most = 7;
  const std::size_t step = stream.header().point_step;
  std::vector<std::uint8_t> records, batch(most * step);
  std::uint64_t points = 0;
  while (const std::size_t count = stream.read(batch.data(), most)) {
    EXPECT_EQ(count, std::min<std::uint64_t>(most, stream.size() - points)) << "as many as there is room for";
    records.insert(records.end(), batch.begin(), batch.begin() + static_cast<std::ptrdiff_t>(count * step));
    points += count;
  }
  EXPECT_EQ(points, stream.size());
  EXPECT_EQ(stream.read(batch.data(), most), 0U) << "at the end, again";
  return records;
}

std::string binaryPcd(const pcl::PCLPointCloud2& cloud, const std::string& comments = "")
{
  return comments + "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS " + std::to_string(cloud.width) + "\nDATA binary\n" +
         std::string(cloud.data.begin(), cloud.data.end());
}

pcl::PCLPointCloud2 smallCloud(std::uint32_t points)
{
  pcl::PCLPointCloud2 cloud;
  for (const char* axis : {"x", "y", "z"}) addField(cloud, axis, Field::FLOAT32);
  allocate(cloud, points);
  for (std::size_t i = 0; i < 3 * std::size_t{points}; ++i) {
    const auto value = static_cast<float>(i);
    std::memcpy(&cloud.data[4 * i], &value, sizeof value);
  }
  return cloud;
}

/// One file of each way of reading: LAS, binary PCD, held whole.
std::vector<fs::path> filesOf(const TemporaryFolder& folder)
{
  LasSample sample(4, 6);
  sample.addPoints(20);
  writeCloud(folder / "a.ply", smallCloud(20));
  return {folder.write("a.las", sample.text()), folder.write("a.pcd", binaryPcd(smallCloud(20))), folder / "a.ply"};
}

TEST(CloudStream, ReadsInBatchesWhatIsReadAtOnce)
{
  const TemporaryFolder folder;
  for (const fs::path& file : filesOf(folder)) {
    const pcl::PCLPointCloud2 cloud = readCloud(file);
    const auto stream = openCloud(file, plenty);
    EXPECT_EQ(stream->size(), 20U) << file;
    EXPECT_EQ(namesOf(stream->header()), namesOf(cloud)) << file;
    EXPECT_EQ(stream->header().point_step, cloud.point_step) << file;
    EXPECT_EQ(stream->header().width, 0U) << file;
    EXPECT_TRUE(stream->header().data.empty()) << file;
    EXPECT_TRUE(recordsOf(*stream) == cloud.data) << file;
  }
}

/// Wherever that begins and ends, also beyond the last point.
TEST(CloudStream, LeavesOutPoints)
{
  const TemporaryFolder folder;
  for (const fs::path& file : filesOf(folder)) {
    const pcl::PCLPointCloud2 cloud = readCloud(file);
    std::vector<std::uint8_t> record(cloud.point_step);
    const auto expectNext = [&](CloudStream& stream, std::size_t point) {
      ASSERT_EQ(stream.read(record.data(), 1), 1U) << file << ' ' << point;
      EXPECT_EQ(std::memcmp(record.data(), &cloud.data[point * cloud.point_step], cloud.point_step), 0) << point;
    };
    const auto stream = openCloud(file, plenty);
    stream->skip(3);
    expectNext(*stream, 3);
    stream->skip(0);
    expectNext(*stream, 4);
    stream->skip(14);
    expectNext(*stream, 19);
    EXPECT_EQ(stream->read(record.data(), 1), 0U);
    const auto other = openCloud(file, plenty);
    other->skip(21);
    EXPECT_EQ(other->read(record.data(), 1), 0U) << file;
  }
}

/// Counts up; leaves out points as every stream does that says nothing else.
class Numbers : public CloudStream {
public:
  explicit Numbers(std::uint64_t size) : size_(size) { addField(header_, "x", Field::FLOAT64); }

  const pcl::PCLPointCloud2& header() const override { return header_; }
  std::uint64_t size() const override { return size_; }
  std::size_t read(std::uint8_t* records, std::size_t most) override
  {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(most, size_ - next_));
    for (std::size_t i = 0; i < count; ++i) {
      const auto value = static_cast<double>(next_++);
      std::memcpy(records + i * sizeof value, &value, sizeof value);
    }
    return count;
  }

private:
  pcl::PCLPointCloud2 header_;
  std::uint64_t size_, next_ = 0;
};

TEST(CloudStream, LeavesOutByReading)
{
  for (const std::uint64_t skipped : {0U, 1U, 65535U, 65536U, 65537U, 150000U}) {
    Numbers numbers(200000);
    numbers.skip(skipped);
    double value = -1;
    ASSERT_EQ(numbers.read(reinterpret_cast<std::uint8_t*>(&value), 1), 1U);
    EXPECT_EQ(value, static_cast<double>(skipped));
    EXPECT_TRUE(numbers.facts().remarks.empty());
    EXPECT_EQ(numbers.facts().coordinate_system.name, "");
  }
  Numbers few(5);
  few.skip(1000000);
  double value = -1;
  EXPECT_EQ(few.read(reinterpret_cast<std::uint8_t*>(&value), 1), 0U) << "and ends";
}

/// Beyond what one reads of a file at first: it is held, and no less right.
TEST(CloudStream, ReadsBinaryPcdOfLongHeaders)
{
  const TemporaryFolder folder;
  std::string comments;
  while (comments.size() < 70000) comments += "# more than one reads at first\n";
  const pcl::PCLPointCloud2 cloud = smallCloud(9);
  const auto stream = openCloud(folder.write("long.pcd", binaryPcd(cloud, comments)), plenty);
  EXPECT_TRUE(recordsOf(*stream) == cloud.data);
}

TEST(CloudStream, TellsWhatDoesNotFit)
{
  const TemporaryFolder folder;
  const fs::path xyz = folder.write("a.xyz", "1 2 3\n4 5 6\n"), pcd = folder.write("a.pcd", binaryPcd(smallCloud(9)));
  EXPECT_NO_THROW(openCloud(xyz, 5 * 12)) << "a double for each two letters, and the text";
  EXPECT_THAT([&] { openCloud(xyz, 5 * 12 - 1); },
              ThrowsMessage<files::FileError>(HasSubstr("a.xyz: does not fit into the memory given, and its format is "
                                                        "not read in pieces: give more memory")));
  writeCloud(folder / "a.ply", smallCloud(9));
  const std::uint64_t needed = fs::file_size(folder / "a.ply") + 2 * 9 * 12;
  EXPECT_NO_THROW(openCloud(folder / "a.ply", needed));
  EXPECT_THROW(openCloud(folder / "a.ply", needed - 1), files::FileError);
  EXPECT_NO_THROW(openCloud(pcd, 0)) << "is read in pieces";

  const std::string whole = binaryPcd(smallCloud(9));
  EXPECT_THAT(
      [&] { openCloud(folder.write("cut.pcd", whole.substr(0, whole.size() - 1)), plenty); },
      ThrowsMessage<files::FileError>(HasSubstr("cut.pcd: is truncated: its header promises 9 points, 8 are there")));
  EXPECT_NO_THROW(openCloud(folder.write("more.pcd", whole + "x"), plenty));
}

TEST(CloudStream, TellsWhatIsToBeKnown)
{
  const TemporaryFolder folder;
  const std::string rows = "1 5 7 9\n2 6 8 0\n3 1 1 1\n";
  EXPECT_THAT(openCloud(folder.write("a.xyz", rows), plenty)->facts().remarks,
              testing::ElementsAre(HasSubstr("its first column counts up by one")));
  const auto named = openCloud(folder / "a.xyz", plenty, {"_", "x", "y", "z"});
  EXPECT_TRUE(named->facts().remarks.empty());
  EXPECT_EQ(namesOf(named->header()), "x y z");
}

} // namespace
} // namespace pcl_bsh::io

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/conversion.h>
#include <pcl_bsh/io/clouds/coordinates.h>
#include <pcl_bsh/io/clouds/e57/reader.h>
#include <pcl_bsh/io/clouds/las/reader.h>
#include <pcl_bsh/io/clouds/pcd/pcd.h>
#include <pcl_bsh/io/clouds/records.h>
#include <pcl_bsh/io/text/byte_source.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/header_count.h>
#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {
namespace {

namespace fs = std::filesystem;

/// The points of a binary PCD file stand there as they do in memory.
class PcdStream : public CloudStream {
public:
  PcdStream(std::unique_ptr<ByteSource> file, PcdBody body)
  : file_(std::move(file)),
    header_(std::move(body.header)),
    at_(body.at)
  {
    size_ = std::uint64_t{header_.width} * header_.height;
    const std::uint64_t wanted = size_ * header_.point_step, there = file_->size() - std::min(file_->size(), at_);
    if (wanted > there) {
      throw FormatError("is truncated: its header promises " + counted(size_, "point") + ", " +
                        std::to_string(there / header_.point_step) + " are there");
    }
    const std::uint64_t left = there - wanted;
    const std::string first =
        file_->text(at_ + wanted, static_cast<std::size_t>(std::min<std::uint64_t>(left, most_padding)));
    if (const auto more = remarkOnMoreBytes({size_}, left, first, header_.point_step)) facts_.remarks.push_back(*more);
    header_.width = header_.height = 0;
  }

  const pcl::PCLPointCloud2& header() const override { return header_; }
  std::uint64_t size() const override { return size_; }
  CloudFacts facts() const override { return facts_; }
  std::size_t read(std::uint8_t* records, std::size_t most) override
  {
    const auto points = static_cast<std::size_t>(std::min<std::uint64_t>(most, size_ - next_));
    if (points == 0) return 0;
    const std::size_t step = header_.point_step;
    file_->read(at_ + next_ * step, reinterpret_cast<char*>(records), points * step);
    next_ += points;
    return points;
  }
  void skip(std::uint64_t points) override { next_ += std::min(points, size_ - next_); }

private:
  std::unique_ptr<ByteSource> file_;
  pcl::PCLPointCloud2 header_;
  std::uint64_t at_, size_ = 0, next_ = 0;
  CloudFacts facts_;
};

class HeldCloud : public CloudStream {
public:
  HeldCloud(const fs::path& path, const ReadSettings& settings)
  : cloud_(readCloud(path, &facts_, settings)),
    header_(cloud_)
  {
    header_.data.clear();
    header_.width = header_.height = header_.row_step = 0;
  }

  const pcl::PCLPointCloud2& header() const override { return header_; }
  std::uint64_t size() const override { return std::uint64_t{cloud_.width} * cloud_.height; }
  std::size_t read(std::uint8_t* records, std::size_t most) override
  {
    const auto points = static_cast<std::size_t>(std::min<std::uint64_t>(most, size() - next_));
    const std::uint8_t* const first = cloud_.data.data() + next_ * cloud_.point_step;
    std::copy(first, first + points * cloud_.point_step, records);
    next_ += points;
    return points;
  }
  CloudFacts facts() const override { return facts_; }
  void skip(std::uint64_t points) override { next_ += std::min(points, size() - next_); }

private:
  CloudFacts facts_; // which reading cloud_ sets
  pcl::PCLPointCloud2 cloud_, header_;
  std::uint64_t next_ = 0;
};

/// Points of a file, in the unit or the coordinate system that is wanted. Errors name the file.
class FileStream : public CloudStream {
public:
  /// @param box of the points as they are given, where another system is wanted
  FileStream(fs::path path, std::unique_ptr<CloudStream> given, const ReadSettings& settings,
             const Eigen::AlignedBox3d& box)
  : path_(std::move(path)),
    given_(std::move(given)),
    header_(given_->header())
  {
    if (!settings.converts()) return;
    facts_ = given_->facts();
    conversion_.emplace(facts_, settings, box);
    (*conversion_)(header_);
  }

  const pcl::PCLPointCloud2& header() const override { return header_; }
  std::uint64_t size() const override { return given_->size(); }
  CloudFacts facts() const override { return conversion_ ? facts_ : given_->facts(); }
  void skip(std::uint64_t points) override
  {
    naming(path_, [&] { given_->skip(points); });
    next_ += points;
  }
  std::size_t read(std::uint8_t* records, std::size_t most) override
  {
    return naming(path_, [&] {
      if (!conversion_ || conversion_->isNothing()) return given_->read(records, most);
      pcl::PCLPointCloud2 batch = given_->header();
      batch.data.resize(most * batch.point_step);
      const std::size_t points = given_->read(batch.data.data(), most);
      batch.data.resize(points * batch.point_step);
      (*conversion_)(batch, next_);
      std::copy(batch.data.begin(), batch.data.end(), records);
      next_ += points;
      return points;
    });
  }

private:
  fs::path path_;
  std::unique_ptr<CloudStream> given_;
  pcl::PCLPointCloud2 header_;
  CloudFacts facts_; ///< of what is converted
  std::optional<Conversion> conversion_;
  std::uint64_t next_ = 0;
};

Eigen::AlignedBox3d boxOf(CloudStream& stream)
{
  constexpr std::size_t most = 65536;
  Eigen::AlignedBox3d box;
  pcl::PCLPointCloud2 batch = stream.header();
  batch.height = 1;
  batch.data.resize(most * batch.point_step);
  while (const std::size_t points = stream.read(batch.data.data(), most)) {
    batch.width = static_cast<std::uint32_t>(points);
    batch.row_step = batch.width * batch.point_step;
    extendBy(batch, box);
  }
  return box;
}

/// Where the points of a binary PCD file are; none for other files, and where x y z are to be converted.
std::optional<PcdBody> binaryBody(const fs::path& path)
{
  if (extensionOf(path) != ".pcd") return std::nullopt;
  constexpr std::size_t usual = std::size_t{1} << 16;
  const FileBytes beginning(path, usual);
  try {
    PcdBody body = findPcdBody(beginning.view());
    if (body.storage == "binary" && !hasIntegerCoordinates(body.header)) return body;
  }
  catch (const FormatError&) { // a longer header, or a defect that readCloud() tells
  }
  return std::nullopt;
}

/// A stream that holds no more than a batch; null for a format that is read at once.
std::unique_ptr<CloudStream> streamByPlace(const fs::path& path, const ReadSettings& settings, unsigned threads)
{
  const std::string extension = extensionOf(path);
  if (isReadByPlace(extension)) return readerByPlace(extension, openBytes(path), settings, threads);
  std::optional<PcdBody> body = binaryBody(path);
  return body ? std::make_unique<PcdStream>(openBytes(path), std::move(*body)) : nullptr;
}

/// Memory for reading a file at once, at most: the file, and its cloud. A cloud of text may have a double for each two
/// letters. A cloud of a compressed PCD file may have 88 bytes for each byte, and its header tells how many.
std::uint64_t bytesWhenHeld(const fs::path& path, const pcl::PCLPointCloud2& header)
{
  const std::uint64_t file = fs::file_size(path);
  const std::uint64_t promised = std::uint64_t{header.width} * header.height * header.point_step;
  return promised > 0 ? file + 2 * promised : 5 * file;
}

} // namespace

void CloudStream::skip(std::uint64_t points)
{
  constexpr std::size_t most = 65536;
  std::vector<std::uint8_t> dropped(most * header().point_step);
  while (points > 0) {
    const std::size_t count = read(dropped.data(), static_cast<std::size_t>(std::min<std::uint64_t>(most, points)));
    if (count == 0) return;
    points -= count;
  }
}

pcl::PCLPointCloud2 CloudStream::readAll()
{
  requirePoints(size());
  constexpr std::size_t at_once = std::size_t{1} << 16;
  const auto points = static_cast<std::size_t>(size());
  pcl::PCLPointCloud2 cloud = header();
  cloud.data.reserve(points * cloud.point_step);
  for (std::size_t done = 0; done < points;) { // memory is touched only for points that were read before
    resizeRecords(cloud, static_cast<std::uint32_t>(std::min(done + at_once, points)));
    done += read(cloud.data.data() + done * cloud.point_step, at_once);
  }
  return cloud;
}

bool isReadByPlace(std::string_view extension)
{
  return isLasExtension(extension) || extension == ".e57";
}

std::unique_ptr<CloudStream> readerByPlace(std::string_view extension, std::unique_ptr<ByteSource> file,
                                           const ReadSettings& settings, unsigned threads)
{
  if (isLasExtension(extension)) return std::make_unique<LasReader>(std::move(file), threads);
  return std::make_unique<E57Reader>(std::move(file), settings.scan, settings.beams);
}

std::unique_ptr<CloudStream> openCloud(const fs::path& path, std::uint64_t memory, const ReadSettings& settings,
                                       unsigned threads)
{
  const pcl::PCLPointCloud2 header = readCloudHeader(path, settings); // which checks that it can be read
  std::unique_ptr<CloudStream> stream = naming(path, [&]() -> std::unique_ptr<CloudStream> {
    std::unique_ptr<CloudStream> given = streamByPlace(path, settings, threads);
    if (!given) return nullptr;
    Eigen::AlignedBox3d box;
    if (settings.transforms()) box = boxOf(*streamByPlace(path, settings, threads));
    return std::make_unique<FileStream>(path, std::move(given), settings, box);
  });
  if (stream) return stream;
  if (bytesWhenHeld(path, header) > memory) {
    throw files::FileError(path, "does not fit into the memory given, and its format is not read in pieces",
                           "give more memory, or convert it to .las, .e57 or binary .pcd");
  }
  return std::make_unique<HeldCloud>(path, settings);
}

} // namespace pcl_bsh::io

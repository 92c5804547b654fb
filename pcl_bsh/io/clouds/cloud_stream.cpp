// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/cloud_file.h>
#include <pcl_bsh/io/clouds/cloud_stream.h>
#include <pcl_bsh/io/clouds/conversion.h>
#include <pcl_bsh/io/clouds/coordinates.h>
#include <pcl_bsh/io/clouds/e57/reader.h>
#include <pcl_bsh/io/clouds/las/notes.h>
#include <pcl_bsh/io/clouds/las/reader.h>
#include <pcl_bsh/io/clouds/pcd/pcd.h>
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

class LasStream : public CloudStream {
public:
  LasStream(const fs::path& path, unsigned threads) : path_(path), reader_(openBytes(path), threads) {}

  const pcl::PCLPointCloud2& header() const override { return reader_.cloudHeader(); }
  std::uint64_t size() const override { return reader_.size(); }
  std::vector<std::string> remarks() const override { return reader_.remarks(); }
  CoordinateSystem coordinateSystem() const override { return systemOf(reader_.header()); }
  std::optional<LengthUnit> unit() const override { return unitOf(reader_.header()); }
  std::size_t read(std::uint8_t* records, std::size_t most) override
  {
    try {
      return reader_.read(records, most);
    }
    catch (const FormatError& error) {
      throw files::FileError(path_, error.what(), error.remedy());
    }
  }
  void skip(std::uint64_t points) override { reader_.skip(points); }

private:
  fs::path path_;
  LasReader reader_;
};

class E57Stream : public CloudStream {
public:
  E57Stream(const fs::path& path, const ReadSettings& settings)
  : path_(path),
    reader_(openBytes(path), settings.scan, settings.beams),
    facts_(reader_.facts())
  {
  }

  const pcl::PCLPointCloud2& header() const override { return reader_.cloudHeader(); }
  std::uint64_t size() const override { return reader_.size(); }
  std::vector<std::string> remarks() const override { return facts_.remarks; }
  CoordinateSystem coordinateSystem() const override { return facts_.coordinate_system; }
  std::optional<LengthUnit> unit() const override { return facts_.unit; }
  std::size_t read(std::uint8_t* records, std::size_t most) override
  {
    try {
      return reader_.read(records, most);
    }
    catch (const FormatError& error) {
      throw files::FileError(path_, error.what(), error.remedy());
    }
  }

private:
  fs::path path_;
  E57Reader reader_;
  CloudFacts facts_;
};

/// The points of a binary PCD file stand there as they do in memory.
class PcdStream : public CloudStream {
public:
  PcdStream(const fs::path& path, PcdBody body) : file_(openBytes(path)), header_(std::move(body.header)), at_(body.at)
  {
    size_ = std::uint64_t{header_.width} * header_.height;
    const std::uint64_t wanted = size_ * header_.point_step, there = file_->size() - std::min(file_->size(), at_);
    if (wanted > there) {
      throw files::FileError(path,
                             "is truncated: its header promises " + counted(size_, "point") + ", " +
                                 std::to_string(there / header_.point_step) + " are there",
                             remedy_for_damage);
    }
    const std::uint64_t left = there - wanted;
    const std::string first =
        file_->text(at_ + wanted, static_cast<std::size_t>(std::min<std::uint64_t>(left, most_padding)));
    if (const auto more = remarkOnMoreBytes({size_}, left, first, header_.point_step)) remarks_.push_back(*more);
    header_.width = header_.height = 0;
  }

  const pcl::PCLPointCloud2& header() const override { return header_; }
  std::uint64_t size() const override { return size_; }
  std::vector<std::string> remarks() const override { return remarks_; }
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
  std::vector<std::string> remarks_;
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
  std::vector<std::string> remarks() const override { return facts_.remarks; }
  CoordinateSystem coordinateSystem() const override { return facts_.coordinate_system; }
  std::optional<LengthUnit> unit() const override { return facts_.unit; }
  void skip(std::uint64_t points) override { next_ += std::min(points, size() - next_); }

private:
  CloudFacts facts_; // which reading cloud_ sets
  pcl::PCLPointCloud2 cloud_, header_;
  std::uint64_t next_ = 0;
};

/// Another stream in the unit or the coordinate system that is wanted.
class ConvertedStream : public CloudStream {
public:
  /// @param box of the points as they are given, where another system is wanted
  ConvertedStream(fs::path path, std::unique_ptr<CloudStream> given, const ReadSettings& settings,
                  const Eigen::AlignedBox3d& box)
  : path_(std::move(path)),
    given_(std::move(given)),
    header_(given_->header())
  {
    facts_.coordinate_system = given_->coordinateSystem();
    facts_.unit = given_->unit();
    facts_.remarks = given_->remarks();
    naming([&] {
      conversion_.emplace(facts_, settings, box);
      (*conversion_)(header_);
    });
  }

  const pcl::PCLPointCloud2& header() const override { return header_; }
  std::uint64_t size() const override { return given_->size(); }
  std::vector<std::string> remarks() const override { return facts_.remarks; }
  CoordinateSystem coordinateSystem() const override { return facts_.coordinate_system; }
  std::optional<LengthUnit> unit() const override { return facts_.unit; }
  void skip(std::uint64_t points) override
  {
    given_->skip(points);
    next_ += points;
  }
  std::size_t read(std::uint8_t* records, std::size_t most) override
  {
    if (conversion_->isNothing()) return given_->read(records, most);
    pcl::PCLPointCloud2 batch = given_->header();
    batch.data.resize(most * batch.point_step);
    const std::size_t points = given_->read(batch.data.data(), most);
    batch.data.resize(points * batch.point_step);
    naming([&] { (*conversion_)(batch, next_); });
    std::copy(batch.data.begin(), batch.data.end(), records);
    next_ += points;
    return points;
  }

private:
  template <typename Do>
  void naming(const Do& run) const
  {
    try {
      run();
    }
    catch (const FormatError& error) {
      throw files::FileError(path_, error.what(), error.remedy());
    }
  }

  fs::path path_;
  std::unique_ptr<CloudStream> given_;
  CloudFacts facts_; ///< of what is converted
  std::optional<Conversion> conversion_;
  pcl::PCLPointCloud2 header_;
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
  if (isLasExtension(extensionOf(path))) return std::make_unique<LasStream>(path, threads);
  if (isE57Extension(extensionOf(path))) return std::make_unique<E57Stream>(path, settings);
  if (std::optional<PcdBody> body = binaryBody(path)) return std::make_unique<PcdStream>(path, std::move(*body));
  return nullptr;
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

std::unique_ptr<CloudStream> openCloud(const fs::path& path, std::uint64_t memory, const ReadSettings& settings,
                                       unsigned threads)
{
  const pcl::PCLPointCloud2 header = readCloudHeader(path, settings); // which checks that it can be read
  if (std::unique_ptr<CloudStream> stream = streamByPlace(path, settings, threads)) {
    if (!settings.converts()) return stream;
    Eigen::AlignedBox3d box;
    if (settings.transforms()) box = boxOf(*streamByPlace(path, settings, threads));
    return std::make_unique<ConvertedStream>(path, std::move(stream), settings, box);
  }
  if (bytesWhenHeld(path, header) > memory) {
    throw files::FileError(path, "does not fit into the memory given, and its format is not read in pieces",
                           "give more memory, or convert it to .las, .e57 or binary .pcd");
  }
  return std::make_unique<HeldCloud>(path, settings);
}

} // namespace pcl_bsh::io

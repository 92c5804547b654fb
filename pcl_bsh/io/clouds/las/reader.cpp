// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/las/notes.h>
#include <pcl_bsh/io/clouds/las/reader.h>
#include <pcl_bsh/io/clouds/las/unpacked_laz.h>
#include <pcl_bsh/io/clouds/records.h>

#include <algorithm>

namespace pcl_bsh::io {

namespace {

constexpr std::size_t most_bytes_at_once = std::size_t{1} << 17; // which the caches hold, decoded as well

/// Whether a red, green or blue of some records, which lie `step` apart, is above 255.
bool hasChannelAboveByte(const char* records, std::size_t red_at, std::size_t points, std::size_t step)
{
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      std::uint16_t value;
      std::memcpy(&value, records + i * step + red_at + channel * sizeof value, sizeof value);
      if (value > 255) return true;
    }
  }
  return false;
}

} // namespace

std::vector<LasField> lasFieldsOf(const LasBlock& block, std::string_view descriptors)
{
  std::vector<LasField> fields = lasFields(block.format, block.scale, block.offset);
  addExtraBytes(fields, descriptors, lasRecordBytes(block.format), block.record_length);
  return fields;
}

LasReader::LasReader(std::unique_ptr<ByteSource> file, unsigned threads)
: file_(unpackedLaz(std::move(file), threads, &left_out_)),
  block_(readLasBlock(*file_))
{
  header_.block = block_;
  header_.before_points = file_->text(0, block_.points_at);
  findDescriptors();
  fields_ = lasFieldsOf(block_, header_.descriptors);
  offsets_ = layOutLas(fields_, cloud_);
  cloud_.height = 1;
}

CloudFacts LasReader::facts() const
{
  const auto header = std::make_shared<const LasHeader>(lasHeader());
  CloudFacts facts;
  facts.las = header;
  facts.coordinate_system = systemOf(*header);
  facts.unit = unitOf(*header);
  facts.remarks = remarksOn(block_, file_->size());
  if (left_out_ > 0)
    facts.remarks.push_back("its header counts " + std::to_string(block_.points) + " of at least " +
                            counted(block_.points + left_out_, "point") +
                            " that its chunks have: the others are left out");
  return facts;
}

void LasReader::findDescriptors()
{
  const std::vector<LasExtendedRecord> behind = lasExtendedRecords(*file_, block_);
  for (const LasRecord& record : lasRecordsOf(header_.before_points, block_).records) {
    if (record.user() != las_specification || record.id() != las_extra_bytes_id) continue;
    header_.descriptors = record.content();
    return;
  }
  for (const LasExtendedRecord& record : behind) {
    if (record.user != las_specification || record.id != las_extra_bytes_id) continue;
    header_.descriptors = file_->text(record.at + las_extended_head, static_cast<std::size_t>(record.content_bytes));
    header_.described_behind = record.at - block_.endOfPoints();
    return;
  }
}

LasHeader LasReader::lasHeader() const
{
  LasHeader header = header_;
  const std::uint64_t end = block_.endOfPoints();
  header.behind_points = file_->text(end, static_cast<std::size_t>(file_->size() - end));
  return header;
}

/// Channels have 16 bits, but many writers put bytes there. A file without a channel above 255 is taken for one of
/// those; most others show one in their first points.
unsigned LasReader::colourShift()
{
  if (colour_shift_) return *colour_shift_;
  const std::size_t at = lasFields(block_.format, block_.scale, block_.offset).size();
  const auto colour = std::find_if(fields_.begin(), fields_.begin() + static_cast<std::ptrdiff_t>(at),
                                   [](const LasField& field) { return field.kind == LasField::Kind::colour; });
  colour_shift_ = 0;
  const std::uint64_t batch = std::max<std::uint64_t>(most_bytes_at_once / block_.record_length, 1);
  for (std::uint64_t i = 0; colour != fields_.end() && i < block_.points && *colour_shift_ == 0; i += batch) {
    const std::uint64_t points = std::min(batch, block_.points - i);
    const std::string records = file_->text(block_.points_at + i * block_.record_length, points * block_.record_length);
    if (hasChannelAboveByte(records.data(), colour->at, points, block_.record_length)) colour_shift_ = 8;
  }
  return *colour_shift_;
}

std::size_t LasReader::read(std::uint8_t* records, std::size_t most)
{
  const unsigned colour_shift = hasLasColours(block_.format) ? colourShift() : 0;
  const std::size_t step = cloud_.point_step, length = block_.record_length;
  const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(most, block_.points - next_));
  for (std::size_t done = 0; done < wanted;) {
    const std::size_t points = std::min(std::max<std::size_t>(most_bytes_at_once / length, 1), wanted - done);
    records_.resize(points * length);
    file_->read(block_.points_at + next_ * length, records_.data(), records_.size());
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      decodeLas(fields_[f], records_.data(), length, points, records + done * step + offsets_[f], step, colour_shift);
    }
    done += points;
    next_ += points;
  }
  return wanted;
}

pcl::PCLPointCloud2 LasReader::readAll()
{
  colour_shift_ = 0; // the points are not all looked at first: colours are packed anew where this is wrong
  pcl::PCLPointCloud2 cloud = CloudStream::readAll();
  const std::size_t step = cloud.point_step;
  const auto colour = std::find_if(fields_.begin(), fields_.end(),
                                   [](const LasField& field) { return field.kind == LasField::Kind::colour; });
  if (colour == fields_.end()) return cloud;
  const auto position = static_cast<std::size_t>(colour - fields_.begin());
  LasField channels = *colour; // which lie in the cloud as they do in the file
  channels.at = offsets_[position - 3];
  const auto* const records = reinterpret_cast<const char*>(cloud.data.data());
  if (hasChannelAboveByte(records, channels.at, cloud.width, step)) {
    decodeLas(channels, records, step, cloud.width, cloud.data.data() + offsets_[position], step, 8);
  }
  return cloud;
}

} // namespace pcl_bsh::io

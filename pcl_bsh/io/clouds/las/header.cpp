// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/clouds/las/fields.h>
#include <pcl_bsh/io/clouds/las/header.h>
#include <pcl_bsh/io/text/format_error.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace pcl_bsh::io {

namespace {

static_assert(std::endian::native == std::endian::little, "LAS is little endian");

constexpr std::uint16_t internal_waveforms = 2; // of the global encoding

void requireScale(const LasBlock& block)
{
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    if (!std::isfinite(block.scale[k]) || block.scale[k] == 0) {
      throw FormatError("its header scales " + axis + " by " + std::to_string(block.scale[k]));
    }
    if (!std::isfinite(block.offset[k])) throw FormatError("its header moves " + axis + " by no number");
    if (!std::isfinite(std::abs(block.scale[k]) * 0x1p31 + std::abs(block.offset[k]))) {
      throw FormatError("its header scales " + axis + " beyond all numbers");
    }
  }
}

std::uint64_t pointsOf(std::string_view bytes, const LasBlock& block)
{
  const std::uint64_t old_count = lasNumber<std::uint32_t>(bytes, las_at::old_points);
  if (block.minor < 4) return old_count;
  const auto count = lasNumber<std::uint64_t>(bytes, las_at::points);
  if (count != 0 && old_count != 0 && count != old_count) {
    throw FormatError("its header says " + counted(count, "point") + ", and for readers of LAS 1.3 " +
                      std::to_string(old_count) + ", which disagree");
  }
  return std::max(count, old_count);
}

void requireInside(const LasBlock& block, std::uint64_t file_bytes)
{
  const std::size_t least = block.minor >= 4 ? las_block_bytes : las_old_block_bytes;
  if (block.header_size < least) {
    throw FormatError("its header of LAS 1." + std::to_string(block.minor) + " has " +
                      std::to_string(block.header_size) + " bytes, fewer than the " + std::to_string(least) +
                      " of its version");
  }
  if (block.points_at < block.header_size || block.points_at > file_bytes) {
    throw FormatError("its points should begin at byte " + std::to_string(block.points_at) +
                      ", which is not between its header and its end");
  }
  const std::size_t record = lasRecordBytes(block.format);
  if (block.record_length < record) {
    throw FormatError("its points take " + std::to_string(block.record_length) + " bytes each, fewer than the " +
                      std::to_string(record) + " of point format " + std::to_string(block.format));
  }
  if (block.compressed) return;
  const std::uint64_t room = (file_bytes - block.points_at) / block.record_length;
  if (block.points > room) {
    throw FormatError("is truncated: its header promises " + counted(block.points, "point") + ", its size allows " +
                      std::to_string(room) + " at most");
  }
}

/// Requires the record of waveforms that the header points to.
void requireWaveforms(ByteSource& file, const LasBlock& block)
{
  const bool inside = (block.global_encoding & internal_waveforms) != 0 && block.waveforms_at != 0;
  if (!inside || !hasLasWaves(block.format)) return;
  const std::uint64_t at = block.waveforms_at;
  const bool headed = at >= block.points_at && at <= file.size() && file.size() - at >= las_extended_head;
  const std::string head = headed ? file.text(at, las_extended_head) : std::string();
  if (!headed || lasNumber<std::uint64_t>(head, 20) > file.size() - at - las_extended_head) {
    throw FormatError("is truncated: its waveforms, from byte " + std::to_string(at) + " on, are not all there");
  }
}

} // namespace

LasBlock readLasBlock(ByteSource& file)
{
  const std::string bytes =
      file.text(0, static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), las_block_bytes)));
  if (!bytes.starts_with("LASF")) throw FormatError("is not a LAS file: it does not start with 'LASF'");
  if (bytes.size() < las_old_block_bytes) {
    throw FormatError("is truncated: " + std::to_string(bytes.size()) + " of the " +
                      std::to_string(las_old_block_bytes) + " bytes of its header are there");
  }
  LasBlock block;
  const auto major = lasNumber<std::uint8_t>(bytes, las_at::major);
  block.minor = lasNumber<std::uint8_t>(bytes, las_at::minor);
  if (major != 1 || block.minor > 4) {
    throw FormatError("is of LAS version " + std::to_string(major) + "." + std::to_string(block.minor),
                      "save it as LAS 1.4 or an earlier version");
  }
  if (block.minor >= 4 && bytes.size() < las_block_bytes) {
    throw FormatError("is truncated: " + std::to_string(bytes.size()) + " of the " + std::to_string(las_block_bytes) +
                      " bytes of its header are there");
  }
  block.global_encoding = lasNumber<std::uint16_t>(bytes, las_at::global_encoding);
  block.header_size = lasNumber<std::uint16_t>(bytes, las_at::header_size);
  block.points_at = lasNumber<std::uint32_t>(bytes, las_at::points_at);
  block.variable_records = lasNumber<std::uint32_t>(bytes, las_at::variable_records);
  block.format = lasNumber<std::uint8_t>(bytes, las_at::format);
  block.record_length = lasNumber<std::uint16_t>(bytes, las_at::record_length);
  block.compressed = (block.format & las_compressed) != 0;
  block.format = static_cast<std::uint8_t>(block.format & ~las_compressed);
  if (block.format > 10) {
    throw FormatError("its points have the format " + std::to_string(block.format) + ", LAS 1.4 knows 0 to 10");
  }
  block.points = pointsOf(bytes, block);
  for (std::size_t k = 0; k < 3; ++k) {
    block.scale[k] = lasNumber<double>(bytes, las_at::scale + k * sizeof(double));
    block.offset[k] = lasNumber<double>(bytes, las_at::offset + k * sizeof(double));
  }
  const bool has_waveforms =
      block.minor >= 3 && block.header_size >= las_at::extended && bytes.size() >= las_at::extended;
  if (has_waveforms) block.waveforms_at = lasNumber<std::uint64_t>(bytes, las_at::waveforms);
  if (block.minor >= 4) {
    block.extended_at = lasNumber<std::uint64_t>(bytes, las_at::extended);
    block.extended_records = lasNumber<std::uint32_t>(bytes, las_at::extended_records);
  }
  requireInside(block, file.size());
  requireScale(block);
  if (!block.compressed) requireWaveforms(file, block);
  return block;
}

LasRecords lasRecordsOf(const std::string& before_points, const LasBlock& block)
{
  LasRecords found;
  std::size_t at = block.header_size;
  while (found.records.size() < block.variable_records && before_points.size() - at >= las_record_head) {
    const std::size_t content = lasNumber<std::uint16_t>(before_points, at + 20);
    if (before_points.size() - at - las_record_head < content) break;
    found.records.emplace_back().bytes.assign(before_points, at, las_record_head + content);
    at += las_record_head + content;
  }
  found.padding = before_points.substr(at);
  return found;
}

std::vector<LasExtendedRecord> lasExtendedRecords(ByteSource& file, const LasBlock& block)
{
  std::vector<LasExtendedRecord> records;
  std::uint64_t at = block.extended_at;
  if (block.extended_records > 0 && at < block.endOfPoints()) {
    throw FormatError("its extended records should begin at byte " + std::to_string(at) + ", before its points end");
  }
  for (std::uint32_t i = 0; i < block.extended_records; ++i) {
    const bool headed = at <= file.size() && file.size() - at >= las_extended_head;
    const std::string head = headed ? file.text(at, las_extended_head) : std::string(las_extended_head, '\0');
    const auto content = lasNumber<std::uint64_t>(head, 20);
    if (!headed || content > file.size() - at - las_extended_head) {
      throw FormatError("is truncated: extended record " + std::to_string(i + 1) + " of " +
                        std::to_string(block.extended_records) + ", from byte " + std::to_string(at) +
                        " on, is not all there");
    }
    records.push_back(
        {at, content, std::string(head.data() + 2, strnlen(head.data() + 2, 16)), lasNumber<std::uint16_t>(head, 18)});
    at += las_extended_head + content;
  }
  return records;
}

} // namespace pcl_bsh::io

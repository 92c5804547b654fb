// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/parallel.h>
#include <pcl_bsh/io/clouds/las/fields.h>
#include <pcl_bsh/io/clouds/las/laz/chunk_decoder.h>
#include <pcl_bsh/io/clouds/las/laz/chunk_table.h>
#include <pcl_bsh/io/clouds/las/unpacked_laz.h>
#include <pcl_bsh/io/text/format_error.h>

#include <algorithm>
#include <limits>

namespace pcl_bsh::io {

namespace {

constexpr std::size_t most_piece_bytes = std::size_t{1} << 22; // of points unpacked at once by a thread

/// All before the points, without what says how they are compressed.
struct UnpackedHead {
  std::string bytes;
  laz::Scheme scheme;
};

bool isLazRecord(const LasRecord& record)
{
  return record.user() == laz::laz_user && record.id() == laz::laz_id;
}

/// Whether a record tells where the parts of a COPC file are; no other file has such records.
bool isOfCopc(std::string_view user, std::uint16_t id)
{
  constexpr std::uint16_t info = 1, hierarchy = 1000;
  return user == "copc" && (id == info || id == hierarchy);
}

UnpackedHead headOf(ByteSource& file, const LasBlock& block)
{
  const std::string packed = file.text(0, block.points_at);
  const LasRecords found = lasRecordsOf(packed, block);
  const auto of_laz = std::find_if(found.records.begin(), found.records.end(), isLazRecord);
  if (of_laz == found.records.end()) {
    throw FormatError("is compressed, but has no record 'laszip encoded' that says how");
  }
  UnpackedHead head = {packed.substr(0, block.header_size), laz::parseScheme(of_laz->content(), block.record_length)};
  auto records = block.variable_records;
  for (const LasRecord& record : found.records) {
    if (isLazRecord(record) || isOfCopc(record.user(), record.id()))
      --records;
    else
      head.bytes += record.bytes;
  }
  head.bytes += found.padding;
  setLasNumber(head.bytes, las_at::points_at, static_cast<std::uint32_t>(head.bytes.size()));
  setLasNumber(head.bytes, las_at::variable_records, records);
  head.bytes[las_at::format] = static_cast<char>(block.format);
  return head;
}

class UnpackedLaz : public ByteSource {
public:
  UnpackedLaz(std::unique_ptr<ByteSource> file, const LasBlock& block, unsigned threads)
  : file_(std::move(file)),
    length_(block.record_length),
    threads_(threads)
  {
    UnpackedHead head = headOf(*file_, block);
    head_ = std::move(head.bytes);
    scheme_ = std::move(head.scheme);
    laz::ChunkTable table = laz::readChunkTable(*file_, block, scheme_);
    chunks_ = std::move(table.chunks);
    left_out_ = table.more;
    points_end_ = head_.size() + block.points * length_;
    keepBehind(block, table.end);
  }

  /// Points of chunks that the header does not count.
  std::uint64_t pointsLeftOut() const noexcept { return left_out_; }

  std::uint64_t size() const override { return placeOf(std::numeric_limits<std::uint64_t>::max()); }

  void read(std::uint64_t at, char* to, std::size_t count) override
  {
    while (count > 0) {
      std::size_t part = count;
      if (at < head_.size()) {
        part = head_.copy(to, count, static_cast<std::size_t>(at));
      }
      else if (at < points_end_) {
        part = readPoints(at - head_.size(), to,
                          static_cast<std::size_t>(std::min<std::uint64_t>(count, points_end_ - at)));
      }
      else {
        part = readBehind(at - points_end_, to, count);
      }
      at += part;
      to += part;
      count -= part;
    }
  }

private:
  struct Range {
    std::uint64_t at, end;
  };

  /// Records behind the points stay behind them, unpacked.
  void keepBehind(const LasBlock& block, std::uint64_t end)
  {
    const bool extended = block.extended_records > 0 && block.extended_at >= block.points_at;
    const bool waves = hasLasWaves(block.format) && block.waveforms_at >= block.points_at;
    std::uint64_t at = end;
    if (extended) at = std::min(at, block.extended_at);
    if (waves) at = std::min(at, block.waveforms_at);
    LasBlock packed = block;
    packed.points = 0; // else endOfPoints() would add the length of unpacked points
    std::uint32_t left_out = 0;
    if (extended) {
      for (const LasExtendedRecord& record : lasExtendedRecords(*file_, packed)) {
        if (!isOfCopc(record.user, record.id) || record.at < at || record.at >= end) continue;
        behind_.push_back({at, record.at});
        at = record.at + las_extended_head + record.content_bytes;
        ++left_out;
      }
    }
    behind_.push_back({at, std::max(at, end)});
    if (extended)
      setLasNumber(head_, las_at::extended, left_out < block.extended_records ? placeOf(block.extended_at) : 0);
    if (extended) setLasNumber(head_, las_at::extended_records, block.extended_records - left_out);
    if (waves) setLasNumber(head_, las_at::waveforms, placeOf(block.waveforms_at));
  }

  /// The place in the unpacked file of a place behind the points in the compressed file. A place behind all kept ranges
  /// becomes the end.
  std::uint64_t placeOf(std::uint64_t packed) const
  {
    std::uint64_t place = points_end_;
    for (const Range& kept : behind_) place += std::clamp(packed, kept.at, kept.end) - kept.at;
    return place;
  }

  /// @param at behind the points. @return how many bytes were read
  std::size_t readBehind(std::uint64_t at, char* to, std::size_t count)
  {
    auto kept = behind_.begin();
    for (; at >= kept->end - kept->at && kept + 1 != behind_.end(); ++kept) at -= kept->end - kept->at;
    const std::uint64_t left = kept->end - kept->at - at;
    if (kept + 1 != behind_.end()) count = static_cast<std::size_t>(std::min<std::uint64_t>(count, left));
    file_->read(kept->at + at, to, count);
    return count;
  }

  /// @param at in all points. @return how many bytes were read
  std::size_t readPoints(std::uint64_t at, char* to, std::size_t count)
  {
    const std::uint64_t point = at / length_;
    if (point < first_ || point - first_ >= records_.size() / length_) unpack(point);
    const std::size_t from = static_cast<std::size_t>(at - first_ * length_);
    return records_.copy(to, count, from);
  }

  /// Unpacks some records from the point on, or from before it.
  void unpack(std::uint64_t point)
  {
    const auto after = std::upper_bound(chunks_.begin(), chunks_.end(), point,
                                        [](std::uint64_t of, const laz::Chunk& chunk) { return of < chunk.first; });
    const auto chunk = static_cast<std::size_t>(after - chunks_.begin()) - 1;
    const std::uint64_t kept = first_ + records_.size() / length_;
    const bool goes_on = piece_ != nullptr && chunk == piece_chunk_ && point >= kept;
    if (isSmall(chunk)) {
      piece_.reset();
      unpackChunks(chunk);
      return;
    }
    if (!goes_on) {
      records_.clear();
      first_ = chunks_[chunk].first;
      piece_chunk_ = chunk;
      naming(chunk,
             [&] { piece_ = std::make_unique<laz::ChunkDecoder>(scheme_, bytesOf(chunk), chunks_[chunk].points); });
    }
    do {
      first_ += records_.size() / length_;
      const std::uint64_t left = chunks_[chunk].first + chunks_[chunk].points - first_;
      const auto points = static_cast<std::size_t>(std::min<std::uint64_t>(left, most_piece_bytes / length_));
      std::string records(points * length_, '\0');
      auto piece = std::move(piece_); // neither is kept where reading fails
      records_.clear();
      naming(chunk, [&] { piece->read(records.data(), points); });
      piece_ = std::move(piece);
      records_ = std::move(records);
    } while (point - first_ >= records_.size() / length_);
  }

  /// Whole chunks, one for each thread, or more that are small.
  void unpackChunks(std::size_t begin)
  {
    const unsigned threads =
        threads_ != 0 ? threadCount(threads_) : static_cast<unsigned>(tbb::this_task_arena::max_concurrency());
    std::size_t end = begin, bytes = 0;
    for (; end < chunks_.size() && isSmall(end); ++end) {
      bytes += static_cast<std::size_t>(chunks_[end].points) * length_;
      if (end >= begin + threads && bytes > threads * most_piece_bytes / 4) break;
    }
    const std::uint64_t last = chunks_[end - 1].first + chunks_[end - 1].points;
    records_.clear();
    first_ = chunks_[begin].first;
    std::string records(static_cast<std::size_t>(last - first_) * length_, '\0');
    std::vector<std::string> packed;
    for (std::size_t i = begin; i < end; ++i) packed.push_back(bytesOf(i));
    parallelFor(end - begin, threads, [&](std::size_t i) {
      const laz::Chunk& chunk = chunks_[begin + i];
      const auto points = static_cast<std::size_t>(chunk.points);
      char* const to = records.data() + (chunk.first - first_) * length_;
      naming(begin + i, [&] { laz::ChunkDecoder(scheme_, std::move(packed[i]), points).read(to, points); });
    });
    records_ = std::move(records);
  }

  bool isSmall(std::size_t chunk) const { return chunks_[chunk].points <= most_piece_bytes / length_; }

  std::string bytesOf(std::size_t chunk)
  {
    return file_->text(chunks_[chunk].at, static_cast<std::size_t>(chunks_[chunk].bytes));
  }

  /// Names the chunk when `use` throws.
  template <typename Use>
  void naming(std::size_t chunk, const Use& use) const
  {
    try {
      use();
    }
    catch (const FormatError& error) {
      throw FormatError("is damaged: chunk " + std::to_string(chunk + 1) + " of " + std::to_string(chunks_.size()) +
                            ", from byte " + std::to_string(chunks_[chunk].at) + " on, " + error.what(),
                        error.remedy());
    }
  }

  std::unique_ptr<ByteSource> file_;
  std::size_t length_; ///< of a record
  unsigned threads_;
  std::string head_;
  laz::Scheme scheme_;
  std::vector<laz::Chunk> chunks_;
  std::uint64_t left_out_ = 0;
  std::uint64_t points_end_ = 0;             ///< unpacked
  std::vector<Range> behind_;                ///< what is kept of the compressed file behind its points
  std::uint64_t first_ = 0;                  ///< point of records_
  std::string records_;                      ///< unpacked last
  std::unique_ptr<laz::ChunkDecoder> piece_; ///< of a chunk that is read in pieces; behind records_
  std::size_t piece_chunk_ = 0;
};

} // namespace

std::unique_ptr<ByteSource> unpackedLaz(std::unique_ptr<ByteSource> file, unsigned threads, std::uint64_t* more)
{
  const LasBlock block = readLasBlock(*file);
  if (!block.compressed) return file;
  auto unpacked = std::make_unique<UnpackedLaz>(std::move(file), block, threads);
  if (more != nullptr) *more = unpacked->pointsLeftOut();
  return unpacked;
}

} // namespace pcl_bsh::io

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/las/laz/chunk_decoder.h>
#include <pcl_bsh/io/text/format_error.h>

#include <algorithm>

namespace pcl_bsh::io::laz {

ChunkDecoder::ChunkDecoder(const Scheme& scheme, std::string bytes, std::uint64_t points)
: scheme_(scheme),
  bytes_(std::move(bytes)),
  points_left_(points)
{
  for (const Scheme::Part& part : scheme.parts) record_length_ += part.size;
  startChunk();
}

void ChunkDecoder::startChunk()
{
  at_ = in_ ? at_ + record_length_ + in_->consumed() : layers_end_;
  if (at_ > bytes_.size() || bytes_.size() - at_ < record_length_) throw FormatError("ends before its points do");
  const bool is_last_point = points_left_ == 1;
  chunk_left_ = scheme_.chunk_points == 0 ? points_left_ : std::min<std::uint64_t>(scheme_.chunk_points, points_left_);
  points_left_ -= chunk_left_;
  at_first_ = true;
  parts_.clear();
  std::size_t at = 0;
  for (const Scheme::Part& part : scheme_.parts) {
    Part& added = parts_.emplace_back(Part{at, nullptr, nullptr});
    if (scheme_.layered)
      added.layered = part.layered(part.version, part.size);
    else
      added.pointwise = part.pointwise(part.version, part.size);
    at += part.size;
  }
  if (is_last_point) return; // a writer may leave out what follows
  if (scheme_.layered) {
    startLayers();
    return;
  }
  in_.emplace(std::string_view(bytes_).substr(at_ + record_length_));
  for (Part& part : parts_) part.pointwise->start(bytes_.data() + at_ + part.at);
}

/// Behind the first record: the number of points, the sizes of all layers, the layers.
void ChunkDecoder::startLayers()
{
  std::size_t count = 0;
  for (const Part& part : parts_) count += part.layered->layers();
  const std::size_t sizes_at = at_ + record_length_ + sizeof(std::uint32_t);
  std::size_t at = sizes_at + count * sizeof(std::uint32_t);
  if (at > bytes_.size()) throw FormatError("ends before its points do");
  if (const auto told = loaded<std::uint32_t>(bytes_.data() + at_ + record_length_); told < chunk_left_) {
    throw FormatError("has " + std::to_string(told) + " points, not " + std::to_string(chunk_left_));
  }
  layers_.clear();
  layers_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t size = loaded<std::uint32_t>(bytes_.data() + sizes_at + i * sizeof(std::uint32_t));
    if (size > bytes_.size() - at) throw FormatError("has layers of more bytes than itself");
    Layer& layer = layers_.emplace_back();
    if (size > 0 || i == 0) layer.emplace(std::string_view(bytes_).substr(at, size));
    at += size;
  }
  layers_end_ = at;
  count = 0;
  for (Part& part : parts_) {
    const std::size_t own = part.layered->layers();
    part.layered->start(bytes_.data() + at_ + part.at, std::span(layers_).subspan(count, own), channel_);
    count += own;
  }
}

void ChunkDecoder::read(char* records, std::size_t count)
{
  for (; count > 0; --count, --chunk_left_, records += record_length_) {
    if (chunk_left_ == 0) startChunk();
    if (at_first_) {
      std::copy_n(bytes_.data() + at_, record_length_, records);
      at_first_ = false;
      continue;
    }
    for (Part& part : parts_) {
      if (part.layered)
        part.layered->read(records + part.at, channel_);
      else
        part.pointwise->read(*in_, records + part.at);
    }
  }
}

} // namespace pcl_bsh::io::laz

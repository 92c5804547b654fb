// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/las/laz/chunk_decoder.h>
#include <pcl_bsh/io/text/format_error.h>

#include <algorithm>

namespace pcl_bsh::io::laz {

ChunkDecoder::ChunkDecoder(const Scheme& scheme, std::string bytes, std::uint64_t points) : bytes_(std::move(bytes))
{
  for (const Scheme::Part& part : scheme.parts) {
    Part& added = parts_.emplace_back(Part{record_length_, nullptr, nullptr});
    if (scheme.layered)
      added.layered = part.layered(part.version, part.size);
    else
      added.pointwise = part.pointwise(part.version, part.size);
    record_length_ += part.size;
  }
  if (bytes_.size() < record_length_) throw FormatError("ends before its points do");
  if (points == 1) return; // a writer may leave out what follows
  if (scheme.layered) {
    startLayers(points);
    return;
  }
  in_.emplace(std::string_view(bytes_).substr(record_length_));
  for (Part& part : parts_) part.pointwise->start(bytes_.data() + part.at);
}

/// Behind the first record: the number of points, the sizes of all layers, the layers.
void ChunkDecoder::startLayers(std::uint64_t points)
{
  std::size_t count = 0;
  for (const Part& part : parts_) count += part.layered->layers();
  const std::size_t sizes_at = record_length_ + sizeof(std::uint32_t);
  std::size_t at = sizes_at + count * sizeof(std::uint32_t);
  if (at > bytes_.size()) throw FormatError("ends before its points do");
  if (const auto told = loaded<std::uint32_t>(bytes_.data() + record_length_); told < points) {
    throw FormatError("has " + std::to_string(told) + " points, not " + std::to_string(points));
  }
  layers_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t size = loaded<std::uint32_t>(bytes_.data() + sizes_at + i * sizeof(std::uint32_t));
    if (size > bytes_.size() - at) throw FormatError("has layers of more bytes than itself");
    Layer& layer = layers_.emplace_back();
    if (size > 0 || i == 0) layer.emplace(std::string_view(bytes_).substr(at, size));
    at += size;
  }
  count = 0;
  for (Part& part : parts_) {
    const std::size_t own = part.layered->layers();
    part.layered->start(bytes_.data() + part.at, std::span(layers_).subspan(count, own), channel_);
    count += own;
  }
}

void ChunkDecoder::read(char* records, std::size_t count)
{
  if (count > 0 && at_first_) {
    records = std::copy_n(bytes_.data(), record_length_, records);
    at_first_ = false;
    --count;
  }
  for (; count > 0; --count, records += record_length_) {
    for (Part& part : parts_) {
      if (part.layered)
        part.layered->read(records + part.at, channel_);
      else
        part.pointwise->read(*in_, records + part.at);
    }
  }
}

} // namespace pcl_bsh::io::laz

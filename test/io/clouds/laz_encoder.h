// SPDX-License-Identifier: BSD-3-Clause
// Makes a LAZ file of a LAS file, for tests; see laz_coder.h.
#pragma once

#include "las_sample.h"
#include "laz_layers.h"

namespace pcl_bsh::io::laz_test {

struct LazOptions {
  unsigned version = 0;              ///< of the items; 0: 2, or 3 of formats 6 to 10
  std::uint32_t chunk_points = 100;  ///< of each chunk
  std::vector<std::uint32_t> chunks; ///< of chunks that differ, instead
  bool one_stream = false;           ///< compressor 1
  bool place_of_table_at_end = false;
  bool without_table = false; ///< as by a writer that could neither go back nor end its file
};

struct ItemCode {
  std::uint16_t type, size, version;
};

inline std::vector<ItemCode> itemsOf(unsigned format, std::size_t extra, unsigned version)
{
  const auto size = static_cast<std::uint16_t>(extra);
  const auto of_version = static_cast<std::uint16_t>(version);
  std::vector<ItemCode> items;
  if (format < 6) {
    items.push_back({6, 20, of_version});
    if (format == 1 || format >= 3) items.push_back({7, 8, of_version});
    if (format == 2 || format == 3 || format == 5) items.push_back({8, 6, of_version});
    if (format >= 4) items.push_back({9, 29, 1});
    if (extra > 0) items.push_back({0, size, of_version});
    return items;
  }
  items.push_back({10, 30, of_version});
  if (format == 7) items.push_back({11, 6, of_version});
  if (format == 8 || format == 10) items.push_back({12, 8, of_version});
  if (format >= 9) items.push_back({13, 29, of_version});
  if (extra > 0) items.push_back({14, size, of_version});
  return items;
}

inline std::unique_ptr<Item> pointwise(const ItemCode& item)
{
  const bool old = item.version == 1;
  switch (item.type) {
  case 6:
    return old ? std::unique_ptr<Item>(new Point10V1) : std::unique_ptr<Item>(new Point10V2);
  case 7:
    return old ? std::unique_ptr<Item>(new GpsTime11V1) : std::unique_ptr<Item>(new GpsTime11V2);
  case 8:
    return old ? std::unique_ptr<Item>(new Rgb12V1) : std::unique_ptr<Item>(new Rgb12V2);
  case 9:
    return std::make_unique<WavePacket13>();
  default:
    return old ? std::unique_ptr<Item>(new BytesV1(item.size)) : std::unique_ptr<Item>(new BytesV2(item.size));
  }
}

inline std::unique_ptr<LayeredItem> layered(const ItemCode& item)
{
  switch (item.type) {
  case 10:
    return std::make_unique<Point14>(item.version);
  case 11:
    return std::make_unique<Rgb14>(item.version, false);
  case 12:
    return std::make_unique<Rgb14>(item.version, true);
  case 13:
    return std::make_unique<WavePacket14>(item.version);
  default:
    return std::make_unique<Bytes14>(item.version, item.size);
  }
}

inline std::string pointwiseChunk(const std::vector<ItemCode>& codes, const std::vector<std::string>& records)
{
  std::vector<std::unique_ptr<Item>> items;
  for (const ItemCode& code : codes) items.push_back(pointwise(code));
  Coder out;
  for (const std::string& record : records) {
    std::size_t from = 0;
    for (std::size_t i = 0; i < items.size(); from += codes[i++].size) {
      const std::string item = record.substr(from, codes[i].size);
      if (&record == &records.front())
        items[i]->start(item);
      else
        items[i]->write(out, item);
    }
  }
  return records.front() + out.finish();
}

inline std::string layeredChunk(const std::vector<ItemCode>& codes, const std::vector<std::string>& records)
{
  std::vector<std::unique_ptr<LayeredItem>> items;
  for (const ItemCode& code : codes) items.push_back(layered(code));
  for (const std::string& record : records) {
    std::size_t from = 0;
    unsigned channel = 0;
    for (std::size_t i = 0; i < items.size(); from += codes[i++].size) {
      const std::string item = record.substr(from, codes[i].size);
      if (&record == &records.front())
        items[i]->start(item, channel);
      else
        items[i]->write(item, channel);
    }
  }
  std::string sizes, layers;
  put(sizes, 0, static_cast<std::uint32_t>(records.size()));
  for (const auto& item : items) {
    for (LayerCoder& layer : item->layers) {
      const std::string bytes = layer.changes ? layer.coder.finish() : std::string();
      put(sizes, sizes.size(), static_cast<std::uint32_t>(bytes.size()));
      layers += bytes;
    }
  }
  return records.front() + sizes + layers;
}

/// @param las a file of LasSample
inline std::string compressed(const std::string& las, const LazOptions& options = {})
{
  const unsigned format = byteAt(las, 104), minor = byteAt(las, 25);
  const std::size_t length = at<std::uint16_t>(las, 105), points_at = at<std::uint32_t>(las, 96);
  const std::size_t count = minor >= 4 ? at<std::uint64_t>(las, 247) : at<std::uint32_t>(las, 107);
  const bool in_layers = format >= 6;
  const unsigned version = options.version != 0 ? options.version : in_layers ? 3 : 2;
  const std::vector<ItemCode> items = itemsOf(format, length - LasSample::lengths[format], version);
  const bool differ = !options.chunks.empty();

  std::string scheme(34, '\0');
  put(scheme, 0, static_cast<std::uint16_t>(options.one_stream ? 1 : in_layers ? 3 : 2));
  put(scheme, 4, std::uint16_t{0x0403});
  put(scheme, 12, options.one_stream ? 0U : differ ? 0xffffffffU : options.chunk_points);
  put(scheme, 16, std::int64_t{-1});
  put(scheme, 24, std::int64_t{-1});
  put(scheme, 32, static_cast<std::uint16_t>(items.size()));
  for (const ItemCode& item : items)
    for (const std::uint16_t number : {item.type, item.size, item.version}) put(scheme, scheme.size(), number);
  const std::string record = LasSample::record("laszip encoded", 22204, scheme);

  // Before the padding, behind the other records.
  std::size_t records_end = at<std::uint16_t>(las, 94);
  for (std::uint32_t i = 0; i < at<std::uint32_t>(las, 100); ++i)
    records_end += 54 + at<std::uint16_t>(las, records_end + 20);
  std::string out = las.substr(0, records_end) + record + las.substr(records_end, points_at - records_end);
  put(out, 96, static_cast<std::uint32_t>(out.size()));
  put(out, 100, at<std::uint32_t>(las, 100) + 1);
  out[104] = static_cast<char>(format | 0x80U);

  const std::size_t first = out.size();
  if (!options.one_stream) out += std::string(8, '\0');
  std::vector<std::uint32_t> chunks = options.chunks, sizes;
  if (!differ) chunks.assign(count, options.one_stream ? static_cast<std::uint32_t>(count) : options.chunk_points);
  std::size_t done = 0;
  for (std::size_t i = 0; i < chunks.size() && done < count; ++i) {
    std::vector<std::string> records;
    for (; records.size() < chunks[i] && done < count; ++done)
      records.push_back(las.substr(points_at + done * length, length));
    const std::string chunk = records.empty() ? std::string()
                              : in_layers     ? layeredChunk(items, records)
                                              : pointwiseChunk(items, records);
    sizes.push_back(static_cast<std::uint32_t>(chunk.size()));
    out += chunk;
  }
  const std::uint64_t table_at = out.size();
  if (options.without_table) {
    put(out, first, ~std::uint64_t{0});
  }
  else if (!options.one_stream) {
    put(out, first, options.place_of_table_at_end ? ~std::uint64_t{0} : table_at);
    std::string head(8, '\0');
    put(head, 4, static_cast<std::uint32_t>(sizes.size()));
    Coder coder;
    Integers integers(32, 2);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const auto signed_at = [](const std::vector<std::uint32_t>& of, std::size_t k) {
        return static_cast<std::int32_t>(of[k]);
      };
      if (differ) integers.write(coder, i == 0 ? 0 : signed_at(chunks, i - 1), signed_at(chunks, i), 0);
      integers.write(coder, i == 0 ? 0 : signed_at(sizes, i - 1), signed_at(sizes, i), 1);
    }
    out += head + (sizes.empty() ? std::string() : coder.finish());
  }
  const std::size_t end = points_at + count * length;
  const auto move = [&](std::size_t number_at) {
    if (const auto place = at<std::uint64_t>(las, number_at); place != 0) put(out, number_at, place - end + out.size());
  };
  if (minor >= 3) move(227);
  if (minor >= 4) move(235);
  out += las.substr(end);
  if (options.place_of_table_at_end) put(out, out.size(), table_at);
  return out;
}

} // namespace pcl_bsh::io::laz_test

// SPDX-License-Identifier: BSD-3-Clause
// Rules of LAS and LAZ, besides those of every reader. A cloud written with the header that was read is equal; without
// it, it has as many points.
#pragma once

#include "read.h"

#include <pcl_bsh/io/clouds/las/las.h>
#include <pcl_bsh/io/clouds/las/notes.h>

namespace pcl_bsh::fuzz {

inline io::LasReader lasReaderOf(std::string_view file)
{
  return io::LasReader(std::make_unique<io::HeldBytes>(file));
}

/// @param growth bytes of points per byte of file at most
inline void readLasFile(const std::uint8_t* data, std::size_t size, std::size_t growth)
{
  const auto parse = [](std::string_view file) {
    io::LasReader reader = lasReaderOf(file);
    for (const char c : io::coordinateSystemOf(reader.lasHeader()))
      require(c >= ' ' && c <= '~', "a coordinate system's name that no report can show");
    io::remarksOn(reader.block(), file.size());
    return reader.readAll();
  };
  const auto parse_header = [](std::string_view file) { return lasReaderOf(file).header(); };
  const auto write = [&](std::ostream& out, const pcl::PCLPointCloud2& cloud) {
    const auto bare = written(
        cloud, [](std::ostream& bytes, const pcl::PCLPointCloud2& points) { io::writeLas(bytes, points, nullptr); });
    if (bare) require(lasReaderOf(*bare).size() == cloud.width, "other points when written without a header");
    const io::LasHeader header = lasReaderOf({reinterpret_cast<const char*>(data), size}).lasHeader();
    io::writeLas(out, cloud, &header);
  };
  readAny(data, size, parse, parse_header, write, growth);
}

/// Whether the file says that its points are compressed.
inline bool isCompressedLas(const std::uint8_t* data, std::size_t size)
{
  return size > io::las_at::format && (data[io::las_at::format] & 0x80U) != 0;
}

} // namespace pcl_bsh::fuzz

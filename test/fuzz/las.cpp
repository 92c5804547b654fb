// SPDX-License-Identifier: BSD-3-Clause
// Besides what holds of every reader: written with the header that was read, a cloud is the same; without it, it has as
// many points.
#include "read.h"

#include <pcl_bsh/filters/cloud_files/las.h>
#include <pcl_bsh/filters/cloud_files/las_notes.h>

namespace {

using namespace pcl_bsh;

io::LasReader readerOf(std::string_view file)
{
  return io::LasReader(std::make_unique<io::HeldBytes>(file));
}

pcl::PCLPointCloud2 parse(std::string_view file)
{
  io::LasReader reader = readerOf(file);
  for (const char c : io::coordinateSystemOf(reader.header()))
    fuzz::require(c >= ' ' && c <= '~', "a coordinate system's name that no report can show");
  io::remarksOn(reader.block(), file.size());
  return io::readLas(reader);
}

pcl::PCLPointCloud2 parseHeader(std::string_view file)
{
  return readerOf(file).cloudHeader();
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const std::string_view file(reinterpret_cast<const char*>(data), size);
  const auto write = [&](std::ostream& out, const pcl::PCLPointCloud2& cloud) {
    const auto bare = fuzz::written(
        cloud, [](std::ostream& bytes, const pcl::PCLPointCloud2& points) { io::writeLas(bytes, points, nullptr); });
    if (bare) fuzz::require(readerOf(*bare).size() == cloud.width, "other points when written without a header");
    const io::LasHeader header = readerOf(file).header();
    io::writeLas(out, cloud, &header);
  };
  fuzz::readAny(data, size, parse, parseHeader, write);
  return 0;
}

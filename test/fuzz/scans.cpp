// SPDX-License-Identifier: BSD-3-Clause
// Each input is read as PTS, as PTX (all scans, and the second alone), and as columns that are written as CSV.
#include "read.h"

#include <pcl_bsh/io/clouds/lines/scan_text.h>
#include <pcl_bsh/io/clouds/lines/text_clouds.h>

namespace {

using namespace pcl_bsh;

void writeNothing(std::ostream&, const pcl::PCLPointCloud2&)
{
  throw io::FormatError("scans are read only");
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const auto pts = [](std::string_view file) { return io::parsePts(file); };
  const auto pts_header = [](std::string_view file) { return io::parsePtsHeader(file); };
  fuzz::readAny(data, size, pts, pts_header, writeNothing);
  for (const std::optional<std::size_t> scan : {std::optional<std::size_t>(), std::optional<std::size_t>(1)}) {
    const auto parse = [&](std::string_view file) {
      io::Viewpoint viewpoint;
      return io::parsePtx(file, viewpoint, scan);
    };
    fuzz::readAny(
        data, size, parse, [&](std::string_view file) { return io::parsePtxHeader(file, scan); }, writeNothing);
  }
  const auto write = [](std::ostream& out, const pcl::PCLPointCloud2& cloud) { io::writeColumns(out, cloud, ','); };
  const auto parse = [](std::string_view file) { return io::parseColumns(file); };
  const auto parse_header = [](std::string_view file) { return io::parseColumnNames(file); };
  fuzz::readAny(data, size, parse, parse_header, write);
  return 0;
}

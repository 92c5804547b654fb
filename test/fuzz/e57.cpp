// SPDX-License-Identifier: BSD-3-Clause
// Each input is read as an E57 file, and as the content of one whose checksums are right. All scans, and the second
// alone.
#include "read.h"
#include "support/e57_sample.h"

#include <pcl_bsh/io/clouds/e57/reader.h>

namespace {

using namespace pcl_bsh;

void readE57File(std::string_view file)
{
  constexpr std::size_t growth = 512;
  const auto writeNothing = [](std::ostream&, const pcl::PCLPointCloud2&) { throw io::FormatError("is read only"); };
  for (const std::optional<std::size_t> scan : {std::optional<std::size_t>(), std::optional<std::size_t>(1)}) {
    const auto parse = [&](std::string_view bytes) {
      io::E57Reader reader(std::make_unique<io::HeldBytes>(bytes), scan, scan.has_value());
      reader.facts();
      return reader.readAll();
    };
    const auto parse_header = [&](std::string_view bytes) {
      return io::E57Reader(std::make_unique<io::HeldBytes>(bytes), scan, scan.has_value()).header();
    };
    fuzz::readAny(reinterpret_cast<const std::uint8_t*>(file.data()), file.size(), parse, parse_header, writeNothing,
                  growth);
  }
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const std::string_view content(reinterpret_cast<const char*>(data), size);
  readE57File(content);
  E57Sample sample;
  sample.page = 128;
  readE57File(sample.paged(std::string(content)));
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
// The three formats that are lines of text; each input is read as all of them, columns also with names that are given.
#include "read.h"

#include <pcl_bsh/io/clouds/lines/text_clouds.h>

#include <algorithm>

namespace {

using namespace pcl_bsh;

void writeColumns(std::ostream& out, const pcl::PCLPointCloud2& cloud)
{
  io::writeColumns(out, cloud);
}

/// With names that are given, for as many columns as the first line has blanks, and one of them not read.
void readNamed(const std::uint8_t* data, std::size_t size)
{
  const std::string_view file(reinterpret_cast<const char*>(data), size);
  const std::string_view line = file.substr(0, file.find('\n'));
  const io::ColumnNames all = {"_", "E", "n", "H", "r", "g", "b", "nx", "ny", "nz"};
  const auto columns =
      std::min<std::size_t>(static_cast<std::size_t>(std::count(line.begin(), line.end(), ' ')) + 1, all.size());
  const io::ColumnNames names(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(columns));
  fuzz::readAny(
      data, size,
      [&](std::string_view text) { return io::parseColumns(text, text == file ? names : io::ColumnNames()); },
      [&](std::string_view text) { return io::parseColumnNames(text, true, names); }, writeColumns);
}

void writeNothing(std::ostream&, const pcl::PCLPointCloud2&)
{
  throw io::FormatError("OFF is read only");
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const auto parse = [](std::string_view file) { return io::parseColumns(file); };
  const auto parse_header = [](std::string_view file) { return io::parseColumnNames(file); };
  fuzz::readAny(data, size, parse, parse_header, writeColumns);
  readNamed(data, size);
  const auto obj = [](std::string_view file) { return io::parseObj(file); };
  fuzz::readAny(data, size, obj, io::parseObjHeader, io::writeObj);
  fuzz::readAny(data, size, io::parseOff, io::parseOffHeader, writeNothing);
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
// The three formats that are lines of text; each input is read as all of them.
#include "read.h"

#include <pcl_bsh/filters/cloud_files/text_clouds.h>

namespace {

using namespace pcl_bsh;

void writeColumns(std::ostream& out, const pcl::PCLPointCloud2& cloud)
{
  io::writeColumns(out, cloud);
}

void writeNothing(std::ostream&, const pcl::PCLPointCloud2&)
{
  throw io::FormatError("OFF is read only");
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  fuzz::readAny(data, size, io::parseColumns, io::parseColumnNames, writeColumns);
  fuzz::readAny(data, size, io::parseObj, io::parseObjHeader, io::writeObj);
  fuzz::readAny(data, size, io::parseOff, io::parseOffHeader, writeNothing);
  return 0;
}

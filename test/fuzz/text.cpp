// SPDX-License-Identifier: BSD-3-Clause
// The three formats that are lines of text; each input is read as all of them.
#include "read.h"

#include <pcl_bsh/filters/io/text_clouds.h>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh;
  fuzz::readAny(data, size, io::parseColumns, io::parseColumnNames);
  fuzz::readAny(data, size, io::parseObj, io::parseObjHeader);
  fuzz::readAny(data, size, io::parseOff, io::parseOffHeader);
  return 0;
}

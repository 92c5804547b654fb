// SPDX-License-Identifier: BSD-3-Clause
// The three formats that are lines of text; each input is read as all of them.
#include "read.h"

#include <pcl_bsh/filters/io/text_clouds.h>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh;
  for (const auto parse : {io::parseColumns, io::parseObj, io::parseOff}) fuzz::readAny(data, size, parse);
  return 0;
}

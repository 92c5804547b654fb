// SPDX-License-Identifier: BSD-3-Clause
#include "read.h"

#include <pcl_bsh/filters/io/ply.h>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  pcl_bsh::fuzz::readAny(data, size, pcl_bsh::io::parsePly);
  return 0;
}

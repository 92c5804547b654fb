// SPDX-License-Identifier: BSD-3-Clause
#include "read.h"

#include <pcl_bsh/filters/io/ply.h>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const auto parse = [](std::string_view file) {
    pcl_bsh::io::Viewpoint viewpoint;
    return pcl_bsh::io::parsePly(file, viewpoint);
  };
  pcl_bsh::fuzz::readAny(data, size, parse, pcl_bsh::io::parsePlyHeader);
  return 0;
}

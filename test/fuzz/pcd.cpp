// SPDX-License-Identifier: BSD-3-Clause
#include "read.h"

#include <pcl_bsh/filters/io/pcd.h>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  const auto parse = [](std::string_view file) {
    pcl_bsh::io::Viewpoint viewpoint;
    return pcl_bsh::io::parsePcd(file, viewpoint);
  };
  pcl_bsh::fuzz::readAny(data, size, parse, pcl_bsh::io::parsePcdHeader);
  return 0;
}

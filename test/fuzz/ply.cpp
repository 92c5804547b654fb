// SPDX-License-Identifier: BSD-3-Clause
#include "read.h"

#include <pcl_bsh/io/clouds/ply/ply.h>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh;
  const auto parse = [](std::string_view file) {
    io::Viewpoint viewpoint;
    return io::parsePly(file, viewpoint);
  };
  const auto write = [](std::ostream& out, const pcl::PCLPointCloud2& cloud) {
    io::writePly(out, cloud, io::no_viewpoint);
  };
  fuzz::readAny(data, size, parse, io::parsePlyHeader, write);
  return 0;
}

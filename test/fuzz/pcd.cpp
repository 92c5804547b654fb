// SPDX-License-Identifier: BSD-3-Clause
#include "read.h"

#include <pcl_bsh/io/clouds/pcd/pcd.h>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh;
  const auto parse = [](std::string_view file) {
    io::Viewpoint viewpoint;
    return io::parsePcd(file, viewpoint);
  };
  const auto write = [](std::ostream& out, const pcl::PCLPointCloud2& cloud) {
    io::writePcd(out, cloud, io::no_viewpoint);
  };
  fuzz::readAny(data, size, parse, io::parsePcdHeader, write);
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
// In place of picture.cpp where librsvg is not found.
#include <pcl_bsh/io/reports/picture.h>

#include <stdexcept>

namespace pcl_bsh::io {

bool drawsPictures()
{
  return false;
}

std::string pngOf(const std::string&, double)
{
  throw std::logic_error("a picture was asked for without librsvg");
}

} // namespace pcl_bsh::io

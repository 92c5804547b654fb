// SPDX-License-Identifier: BSD-3-Clause
// In place of compressor.cpp where LASzip is not found.
#include <pcl_bsh/io/clouds/las/laz/compressor.h>
#include <pcl_bsh/io/text/format_error.h>

namespace pcl_bsh::io {

bool writesLaz()
{
  return false;
}

struct LazCompressor::Laszip {};

LazCompressor::LazCompressor(std::uint8_t, std::size_t)
{
  throw FormatError("cannot be compressed without LASzip", "build it where liblaszip-dev is installed");
}

void LazCompressor::add(std::string_view)
{
}

std::string LazCompressor::finish(std::uint64_t)
{
  return {};
}

LazCompressor::~LazCompressor() = default;

} // namespace pcl_bsh::io

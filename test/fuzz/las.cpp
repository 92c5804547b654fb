// SPDX-License-Identifier: BSD-3-Clause
#include "las_file.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh::fuzz;
  if (!isCompressedLas(data, size)) readLasFile(data, size, most_growth);
  return 0;
}

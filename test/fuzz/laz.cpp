// SPDX-License-Identifier: BSD-3-Clause
#include "las_file.h"

#include <pcl_bsh/io/clouds/las/laz/chunk_table.h>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh::fuzz;
  constexpr std::size_t most_of_record = 4; // bytes of a point of a cloud for each of its record
  if (isCompressedLas(data, size)) readLasFile(data, size, most_of_record * pcl_bsh::io::laz::most_laz_growth);
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
// Any sequence of changes and queries of clouds that are mostly of triangles, against brute force.
#include "sequence.h"
#include "target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  pcl_bsh::fuzz::Bytes bytes(data, size);
  pcl_bsh::fuzz::runSequence(bytes, true);
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
// Any sequence of changes and queries, against brute force.
#include "sequence.h"
#include "target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  pcl_bsh::fuzz::Bytes bytes(data, size);
  pcl_bsh::fuzz::runSequence(bytes);
  return 0;
}

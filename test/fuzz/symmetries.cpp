// SPDX-License-Identifier: BSD-3-Clause
// Any two clouds: what must not change an answer does not.
#include "symmetries/symmetries.h"

#include "target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace pcl_bsh;
  fuzz::Bytes bytes(data, size);
  test::Random random(bytes.take<std::uint64_t>());
  symmetries::requireSymmetric(symmetries::anyInstance(bytes, "an instance"), random);
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
// How often a bound is attacked.
#pragma once

#include <cstdlib>

namespace pcl_bsh::test {

/// PCL_BSH_ATTACKS in the environment, or `otherwise`.
inline long attacks(long otherwise)
{
  const char* const asked = std::getenv("PCL_BSH_ATTACKS");
  return asked ? std::atol(asked) : otherwise;
}

} // namespace pcl_bsh::test

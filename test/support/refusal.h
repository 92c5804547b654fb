// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace pcl_bsh::test {

/// What a call says of what it is given; empty where it takes it.
template <class Call>
std::string refusalOf(const Call& call)
{
  try {
    call();
  }
  catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

} // namespace pcl_bsh::test

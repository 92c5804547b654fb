// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace pcl_bsh::test {

/// The call's refusal; empty where it accepts.
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

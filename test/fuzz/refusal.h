// SPDX-License-Identifier: BSD-3-Clause
// Rules of every refusal of a document.
#pragma once

#include "target.h"

#include <exception>
#include <string_view>

namespace pcl_bsh::fuzz {

/// `place: what is wrong: what to do`, on one line.
inline void requireReason(const std::exception& error)
{
  const std::string_view line = error.what();
  require(line.size() > 10 && line.find(": ") != std::string_view::npos && line.find('\n') == std::string_view::npos,
          "a refusal without a reason of one line");
}

} // namespace pcl_bsh::fuzz

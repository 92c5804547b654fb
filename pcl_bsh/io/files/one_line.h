// SPDX-License-Identifier: BSD-3-Clause
// Messages that quote what others wrote.
#pragma once

#include <algorithm>
#include <string>

namespace pcl_bsh::files {

/// The message with '?' for each control character: names and damaged files that it quotes must neither steer the
/// terminal nor break the line.
inline std::string oneLine(std::string message)
{
  const auto steers = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  std::replace_if(message.begin(), message.end(), steers, '?');
  return message;
}

} // namespace pcl_bsh::files

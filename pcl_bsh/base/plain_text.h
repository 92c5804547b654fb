// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <locale>
#include <sstream>
#include <string>

namespace pcl_bsh {

/// The parts one after the other, numbers as the C locale writes them, whatever locale the program has set.
template <class... Parts>
std::string plainText(const Parts&... parts)
{
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  (stream << ... << parts);
  return stream.str();
}

} // namespace pcl_bsh

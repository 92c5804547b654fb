// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace pcl_bsh {

/// The noun that fits the count: `one` for 1; otherwise `many`, or `one` with an s where `many` is empty. Both may have
/// their verb with them ("point is", "points are").
inline std::string nounOf(std::uint64_t count, const std::string& one, const std::string& many = {})
{
  return count == 1 ? one : many.empty() ? one + 's' : many;
}

/// "1 point", "2 points".
inline std::string counted(std::uint64_t count, const std::string& one, const std::string& many = {})
{
  return std::to_string(count) + ' ' + nounOf(count, one, many);
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// Numbers as they stand in titles.
#pragma once

#include <pcl_bsh/base/counted.h>

#include <iomanip>
#include <sstream>
#include <string>

namespace pcl_bsh::viewer {

/// 1234567 as "1 234 567".
inline std::string grouped(std::size_t number)
{
  std::string text = std::to_string(number);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, " ");
  return text;
}

/// "1 234 567 points".
inline std::string groupedCount(std::size_t number, const std::string& one, const std::string& many = {})
{
  return grouped(number) + ' ' + nounOf(number, one, many);
}

/// A number in six digits at most.
inline std::string shortest(double value)
{
  std::ostringstream text;
  text << std::setprecision(6) << value;
  return text.str();
}

/// A length with its unit, where that is known.
inline std::string lengthOf(double value, const std::string& unit)
{
  return shortest(value) + (unit.empty() ? "" : " " + unit);
}

} // namespace pcl_bsh::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/clash_values.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace pcl_bsh::io {

std::string inWords(ClashStatus status)
{
  std::string name = nameOf(status);
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

Point3 pointFrom(const JsonReader& reader)
{
  constexpr double most = std::numeric_limits<double>::max();
  Point3 point{};
  const std::vector<JsonReader> numbers = reader.elements();
  if (numbers.size() != point.size()) reader.fail("has not three numbers", "give x, y and z");
  for (std::size_t k = 0; k < point.size(); ++k) point[k] = numbers[k].number(-most, most);
  return point;
}

Extent boxFrom(const JsonReader& box)
{
  const Extent extent{pointFrom(box.at("min")), pointFrom(box.at("max"))};
  for (std::size_t k = 0; k < 3; ++k)
    if (!(extent.low[k] <= extent.high[k])) box.fail("has a min above its max", "exchange them");
  return extent;
}

ClashStatus statusFrom(const JsonReader& status)
{
  std::vector<std::string> names;
  for (std::size_t i = 0; i < clash_statuses; ++i) names.emplace_back(nameOf(static_cast<ClashStatus>(i)));
  const std::string name = status.oneOf(names);
  return static_cast<ClashStatus>(std::find(names.begin(), names.end(), name) - names.begin());
}

} // namespace pcl_bsh::io

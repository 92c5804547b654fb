// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/json/nearest_name.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <numeric>

namespace pcl_bsh::io {
namespace {

bool alike(char a, char b)
{
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

/// The part of a name behind the last dot or colon.
std::string_view ownName(std::string_view name)
{
  const std::size_t prefix = name.find_last_of(".:");
  return prefix == std::string_view::npos ? name : name.substr(prefix + 1);
}

std::size_t distanceBetween(std::string_view name, std::string_view candidate)
{
  const std::size_t whole = editDistance(name, candidate);
  if (ownName(name) != name) return whole;
  const std::size_t own = std::min(whole, editDistance(name, ownName(candidate)));
  const bool part = name.size() > 2 && candidate.find(name) != std::string_view::npos;
  return part ? std::min<std::size_t>(own, 1) : own;
}

} // namespace

std::size_t editDistance(std::string_view a, std::string_view b)
{
  std::vector<std::size_t> row(b.size() + 1); // distances of a's first letters to each beginning of b
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (alike(a[i], b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string nearestName(std::string_view name, const std::vector<std::string>& valid)
{
  constexpr std::size_t longest = 64; // of a hostile name, the beginning is enough
  name = name.substr(0, longest);
  std::string nearest;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string& candidate : valid) {
    const std::size_t distance = distanceBetween(name, candidate);
    if (distance >= least) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& valid)
{
  if (valid.empty()) return "no name exists";
  return "did you mean '" + nearestName(name, valid) + "'?";
}

std::string listed(const std::vector<std::string>& names)
{
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

} // namespace pcl_bsh::io

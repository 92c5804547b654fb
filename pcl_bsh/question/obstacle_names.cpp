// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/obstacle_names.h>

#include <pcl_bsh/base/invalid_input.h>

#include <algorithm>
#include <cstddef>
#include <set>

namespace pcl_bsh {
namespace {

/// Whether a backslash takes the next letter's meaning away.
bool isEscape(const char* text)
{
  return *text == '\\' && (text[1] == ':' || text[1] == '*' || text[1] == '\\');
}

/// @param pattern where * stands for any letters, or for none
bool matches(const char* pattern, const char* name)
{
  if (*pattern == '\0') return *name == '\0';
  if (isEscape(pattern)) return pattern[1] == *name && matches(pattern + 2, name + 1);
  if (*pattern == '*') return matches(pattern + 1, name) || (*name != '\0' && matches(pattern, name + 1));
  return *pattern == *name && matches(pattern + 1, name + 1);
}

/// Where a text has its first colon that ends a name; npos: nowhere.
std::size_t colonOf(const std::string& text, std::size_t from)
{
  for (std::size_t i = from; i < text.size(); ++i) {
    if (isEscape(&text[i]))
      ++i;
    else if (text[i] == ':')
      return i;
  }
  return text.npos;
}

InvalidInput wrongName(const char* option, const std::string& wrong, const std::string& remedy)
{
  return {Input::points, option, wrong, remedy};
}

void requireMatch(const char* option, const std::string& pattern, const std::vector<std::string>& names,
                  const char* remedy)
{
  const auto fits = [&](const std::string& name) { return matches(pattern.c_str(), name.c_str()); };
  if (std::none_of(names.begin(), names.end(), fits))
    throw wrongName(option, "'" + pattern + "' matches no obstacle", remedy);
}

} // namespace

std::vector<bool> fittingNames(const char* option, const std::vector<std::string>& patterns,
                               const std::vector<std::string>& names)
{
  for (const std::string& pattern : patterns) requireMatch(option, pattern, names, "give one of their names");
  std::vector<bool> fitting;
  for (const std::string& name : names)
    fitting.push_back(std::any_of(patterns.begin(), patterns.end(),
                                  [&](const std::string& pattern) { return matches(pattern.c_str(), name.c_str()); }));
  return fitting;
}

void checkObstacleNames(const std::vector<std::string>& names)
{
  std::set<std::string> known;
  for (const std::string& name : names) {
    if (name.empty()) throw wrongName("obstacles", "one has no name", "give each its own");
    if (name == kInputName) throw wrongName("obstacles", "'input' is the input's own name", "give another");
    if (!known.insert(name).second)
      throw wrongName("obstacles", "two obstacles have the name '" + name + "'", "give each its own");
  }
}

IgnoredPairs::IgnoredPairs(const std::vector<std::string>& texts, const std::vector<std::string>& obstacles)
{
  std::vector<std::string> names = {kInputName};
  names.insert(names.end(), obstacles.begin(), obstacles.end());
  for (const std::string& text : texts) {
    const std::size_t colon = colonOf(text, 0);
    if (colon == text.npos || colon == 0 || colon + 1 == text.size() || colonOf(text, colon + 1) != text.npos)
      throw wrongName("ignore", "'" + text + "' is no pair of names",
                      "give FIRST:SECOND, where * is any letters and \\: a colon within a name");
    const std::pair two(text.substr(0, colon), text.substr(colon + 1));
    for (const std::string& pattern : {two.first, two.second})
      requireMatch("ignore", pattern, names, "give input, or one of their names");
    patterns_.push_back(two);
  }
}

bool IgnoredPairs::holds(const std::string& one, const std::string& other) const
{
  return std::any_of(patterns_.begin(), patterns_.end(), [&](const auto& pair) {
    const auto fits = [&](const std::string& first, const std::string& second) {
      return matches(pair.first.c_str(), first.c_str()) && matches(pair.second.c_str(), second.c_str());
    };
    return fits(one, other) || fits(other, one);
  });
}

} // namespace pcl_bsh

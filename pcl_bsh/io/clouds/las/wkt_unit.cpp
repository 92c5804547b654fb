// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/las/wkt_unit.h>
#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <string>
#include <vector>

namespace pcl_bsh::io {
namespace {

bool isAny(std::string_view word, std::initializer_list<std::string_view> words)
{
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The number behind the first comma, as in "metre",1
double factorOf(std::string_view text)
{
  text.remove_prefix(std::min(text.find(',') + 1, text.size()));
  text.remove_prefix(std::min(text.find_first_not_of(" \n\r\t"), text.size()));
  double factor = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), factor);
  return factor;
}

/// Whether a unit is that of places or of heights: it stands in the system itself, or in one of its axes.
bool isOf(std::initializer_list<std::string_view> systems, const std::vector<std::string>& around)
{
  const std::size_t depth = around.size();
  if (depth > 0 && isAny(around[depth - 1], systems)) return true;
  return depth > 1 && around[depth - 1] == "axis" && isAny(around[depth - 2], systems);
}

} // namespace

std::optional<LengthUnit> unitOfWkt(std::string_view text)
{
  std::vector<std::string> around; // keywords of the brackets that are open
  std::string word;
  double places = 0.0, heights = 0.0; // in metres; 0: not known
  bool quoted = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '[' || c == '(') {
      word = inSmallLetters(word);
      if (isAny(word, {"unit", "lengthunit"})) {
        if (isOf({"projcs", "projcrs", "projectedcrs"}, around)) places = factorOf(text.substr(at + 1));
        if (isOf({"vert_cs", "vertcs", "vertcrs", "verticalcrs"}, around)) heights = factorOf(text.substr(at + 1));
      }
      around.push_back(std::move(word));
      word.clear();
    }
    else if (c == ']' || c == ')') {
      if (!around.empty()) around.pop_back();
      word.clear();
    }
    else if (c == ',' || c == '"') {
      word.clear();
    }
    else if (std::string_view(" \n\r\t").find(c) == std::string_view::npos) {
      word += c;
    }
  }
  const auto unit = lengthUnitOfMetres(places);
  return heights == 0.0 || lengthUnitOfMetres(heights) == unit ? unit : std::nullopt;
}

} // namespace pcl_bsh::io

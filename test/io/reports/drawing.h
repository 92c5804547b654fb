// SPDX-License-Identifier: BSD-3-Clause
// Drawings of pages, read back as numbers.
#pragma once

#include <cstdlib>
#include <map>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// A tag of a drawing: its attributes, and what stands behind it, as in <text x="1">2</text>.
struct Tag {
  std::map<std::string, std::string> attributes;
  std::string text;

  /// Empty where it has none.
  std::string of(const std::string& name) const
  {
    const auto found = attributes.find(name);
    return found == attributes.end() ? std::string() : found->second;
  }

  double operator[](const std::string& name) const
  {
    const std::string value = of(name);
    return value.empty() ? -1e9 : std::strtod(value.c_str(), nullptr);
  }
};

/// The drawing number `which` of those that are described so.
inline std::string drawingOf(const std::string& page, const std::string& label, int which = 0)
{
  std::size_t at = 0;
  for (int i = 0; i <= which; ++i) {
    at = page.find("aria-label=\"" + label + '"', at);
    if (at == std::string::npos) return {};
    ++at;
  }
  std::size_t end = page.find("</svg>", at);
  for (std::size_t inner = page.find("<svg ", at); inner < end; inner = page.find("<svg ", inner + 1))
    end = page.find("</svg>", end + 1);
  return page.substr(at, end - at);
}

inline std::vector<Tag> tagsOf(const std::string& drawing, const std::string& name)
{
  std::vector<Tag> tags;
  const std::string begin = "<" + name + " ";
  for (std::size_t at = drawing.find(begin); at != std::string::npos; at = drawing.find(begin, at + 1)) {
    Tag tag;
    const std::size_t end = drawing.find('>', at);
    for (std::size_t i = at + begin.size(); i < end;) {
      const std::size_t equals = drawing.find("=\"", i);
      if (equals == std::string::npos || equals > end) break;
      const std::size_t close = drawing.find('"', equals + 2);
      tag.attributes[drawing.substr(i, equals - i)] = drawing.substr(equals + 2, close - equals - 2);
      i = drawing.find_first_not_of(' ', close + 1);
    }
    tag.text = drawing.substr(end + 1, drawing.find('<', end) - end - 1);
    tags.push_back(tag);
  }
  return tags;
}

/// Tags with this value of an attribute; empty: without it.
inline std::vector<Tag> with(const std::vector<Tag>& tags, const std::string& attribute, const std::string& value)
{
  std::vector<Tag> some;
  for (const Tag& tag : tags)
    if (tag.of(attribute) == value) some.push_back(tag);
  return some;
}

/// Red, green and blue of rgb(r,g,b).
inline std::vector<double> colourOf(const std::string& text)
{
  std::vector<double> colour;
  for (std::size_t at = text.find('('); at != std::string::npos; at = text.find(',', at + 1))
    colour.push_back(std::strtod(text.c_str() + at + 1, nullptr));
  return colour;
}

} // namespace pcl_bsh::io

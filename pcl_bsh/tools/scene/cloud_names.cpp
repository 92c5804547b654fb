// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_names.h"

#include <pcl_bsh/io/text/small_letters.h>

#include <algorithm>
#include <cctype>
#include <cstdio>

namespace pcl_bsh::cli {
namespace {

/// A name with '_' in place of odd letters, and its beginning if it is long: a file's name has 255 bytes at most.
std::string allowed(std::string text)
{
  constexpr std::size_t longest = 100;
  text.resize(std::min(text.size(), longest));
  const auto is_odd = [](unsigned char c) { return std::isalnum(c) == 0 && c != '-'; };
  std::replace_if(text.begin(), text.end(), is_odd, '_');
  return text;
}

} // namespace

CloudNames::CloudNames(const io::SceneFile& file)
{
  for (const io::ObjectEntry& object : file.objects) {
    names_.emplace_back();
    for (const io::PartEntry& part : object.parts) {
      const std::string wanted =
          allowed(object.name) + (object.parts.size() > 1 ? "_" + allowed(part.name) : std::string());
      std::string name = wanted;
      for (int number = 2; !taken_.insert(io::inSmallLetters(name)).second; ++number)
        name = wanted + "-" + std::to_string(number);
      names_.back().push_back(name);
    }
  }
}

std::string CloudNames::of(std::size_t object, std::size_t part, std::size_t step) const
{
  char number[24];
  std::snprintf(number, sizeof number, "_%06zu.pcd", step);
  return names_[object][part] + number;
}

bool CloudNames::mayBe(const std::string& file) const
{
  const std::size_t line = file.rfind('_');
  return line != std::string::npos && taken_.count(io::inSmallLetters(file.substr(0, line))) != 0;
}

} // namespace pcl_bsh::cli

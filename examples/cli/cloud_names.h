// SPDX-License-Identifier: BSD-3-Clause
// What the files of a scene's clouds are called.
#pragma once

#include <pcl_bsh/filters/scene_files/scene_file.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// OBJECT_000012.pcd or OBJECT_PART_000012.pcd, with only such letters as every disk allows. No two parts of a scene
/// share a name, not even where upper and lower case are one: where theirs would, the later ones get a number.
class CloudNames {
public:
  explicit CloudNames(const io::SceneFile& file)
  {
    for (const io::ObjectEntry& object : file.objects) {
      names_.emplace_back();
      for (const io::PartEntry& part : object.parts) {
        const std::string wanted =
            allowed(object.name) + (object.parts.size() > 1 ? "_" + allowed(part.name) : std::string());
        std::string name = wanted;
        for (int number = 2; !taken_.insert(lower(name)).second; ++number) name = wanted + "-" + std::to_string(number);
        names_.back().push_back(name);
      }
    }
  }

  std::string of(std::size_t object, std::size_t part, std::size_t step) const
  {
    char number[24];
    std::snprintf(number, sizeof number, "_%06zu.pcd", step);
    return names_[object][part] + number;
  }

  /// Whether some part at some step is called so, in upper or lower case.
  bool mayBe(const std::string& file) const
  {
    const std::size_t line = file.rfind('_');
    return line != std::string::npos && taken_.count(lower(file.substr(0, line))) != 0;
  }

private:
  /// Of long names the beginning: a file's name has 255 bytes at most.
  static std::string allowed(std::string text)
  {
    constexpr std::size_t longest = 100;
    text.resize(std::min(text.size(), longest));
    const auto is_odd = [](unsigned char c) { return std::isalnum(c) == 0 && c != '-'; };
    std::replace_if(text.begin(), text.end(), is_odd, '_');
    return text;
  }

  static std::string lower(std::string text)
  {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
  }

  std::vector<std::vector<std::string>> names_; ///< of each object's parts
  std::set<std::string> taken_;                 ///< in lower case
};

} // namespace pcl_bsh::cli

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/poses/pose_columns.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <algorithm>
#include <cctype>

namespace pcl_bsh::io {

namespace {

/// Parts of a name in small letters, without a unit in brackets.
std::vector<std::string> partsOf(std::string_view name)
{
  std::vector<std::string> parts(1);
  for (const char c : name.substr(0, name.find_first_of("[("))) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      parts.back() += c;
    else if (!parts.back().empty())
      parts.emplace_back();
  }
  if (parts.size() > 1 && parts.back().empty()) parts.pop_back();
  for (std::string& part : parts) part = inSmallLetters(part);
  return parts;
}

struct Meaning {
  bool rotation = false;
  std::size_t axis = 0; ///< of x y z w
};

std::optional<Meaning> meaningOf(const std::string& name)
{
  std::vector<std::string> parts = partsOf(name);
  if (parts.back().empty()) return std::nullopt;
  const std::size_t axis = std::string_view("xyzw").find(parts.back().back());
  parts.back().pop_back(); // tx is t and x
  if (parts.back().empty()) parts.pop_back();
  if (axis == std::string_view::npos) return std::nullopt;
  const auto has = [&](std::initializer_list<std::string_view> words) {
    return std::any_of(parts.begin(), parts.end(), [&](const std::string& part) {
      return std::find(words.begin(), words.end(), part) != words.end();
    });
  };
  const std::string first = parts.empty() ? "" : parts.front();
  const bool rotation = first == "q" || has({"quaternion", "quat", "orientation", "rotation", "rot"});
  const bool position = first.empty() || first == "t" || first == "p" || has({"position", "pos", "translation"});
  if (rotation) return Meaning{true, axis};
  return position && axis < 3 ? std::optional<Meaning>({false, axis}) : std::nullopt;
}

} // namespace

std::optional<PoseColumns> poseColumnsOf(const std::vector<std::string>& names)
{
  PoseColumns columns;
  columns.count = names.size();
  std::array<int, 7> found = {};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::optional<Meaning> meaning = meaningOf(names[i]);
    if (!meaning) continue;
    (meaning->rotation ? columns.quaternion[meaning->axis] : columns.position[meaning->axis]) = i;
    ++found[meaning->axis + (meaning->rotation ? 3 : 0)];
  }
  if (std::any_of(found.begin(), found.end(), [](int times) { return times != 1; })) return std::nullopt;
  return columns;
}

std::vector<std::string> wordsOfLine(TextCursor& line)
{
  line.separateBy(separatorOf(line.line()));
  std::vector<std::string> words;
  while (!line.line().empty()) words.emplace_back(line.word());
  return words;
}

} // namespace pcl_bsh::io

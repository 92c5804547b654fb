// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/robots/joint_values.h>

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <cmath>
#include <string_view>

namespace pcl_bsh::io {

namespace {

double finiteNumber(std::string_view word)
{
  const double value = parseNumber<double>(word);
  if (!std::isfinite(value)) throw FormatError("'" + std::string(word) + "' is not finite", "give a number");
  return value;
}

std::vector<JointValues> parseStates(std::string_view text)
{
  TextCursor lines(text, '#');
  if (!lines.nextLine()) throw FormatError("has no line of names", "begin with the names of the joints");
  lines.separateBy(separatorOf(lines.line()));
  std::vector<std::string> names;
  while (!lines.line().empty()) {
    names.emplace_back(lines.word());
    if (looksLikeNumber(names.back()) || names.back().empty())
      lines.fail("has '" + names.back() + "' where a name should be", "begin with the names of the joints");
  }
  std::vector<JointValues> states;
  while (lines.nextLine()) {
    JointValues values;
    for (const std::string& name : names) {
      if (!values.emplace(name, lines.parseWord(finiteNumber)).second)
        throw FormatError("names joint '" + name + "' twice", "let each have one column");
    }
    lines.requireEndOfLine();
    states.push_back(std::move(values));
  }
  if (states.empty()) throw FormatError("has no line of values", "give one for each frame");
  return states;
}

} // namespace

JointValues parseJointValues(const std::string& text)
{
  JointValues values;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const std::size_t equals = word.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw FormatError("'" + word + "' is no joint with a value", "give name=value,name=value");
    if (!values.emplace(word.substr(0, equals), finiteNumber(std::string_view(word).substr(equals + 1))).second)
      throw FormatError("names joint '" + word.substr(0, equals) + "' twice", "give each once");
    begin = end + 1;
  }
  return values;
}

std::vector<JointValues> readJointStates(const std::filesystem::path& path)
{
  const FileBytes bytes(path);
  return naming(path, [&] { return parseStates(bytes.view()); });
}

} // namespace pcl_bsh::io

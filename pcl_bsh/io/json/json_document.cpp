// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/json/json_document.h>

#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/text/format_error.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>
#include <vector>

namespace pcl_bsh::io {
namespace {

constexpr int deepest = 100;

/// The library's message without its own numbering: "line 3, column 5: ...".
std::string reasonOf(const Json::exception& error)
{
  const std::string message = error.what();
  for (const char* const begin : {"parse error at ", "parse error: ", "] "}) {
    const std::size_t found = message.find(begin);
    if (found != std::string::npos) return message.substr(found + std::string(begin).size());
  }
  return message;
}

} // namespace

Json parseJson(std::string_view text)
{
  std::vector<std::set<std::string>> keys; // of the objects that are open
  const auto inspect = [&keys](int depth, Json::parse_event_t event, Json& value) {
    if (depth > deepest) throw FormatError("nests deeper than " + std::to_string(deepest) + " levels", "flatten it");
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second) {
      throw FormatError("says the key " + shown(value) + " twice in one object", "remove one");
    }
    return true;
  };
  try {
    return Json::parse(text.begin(), text.end(), inspect, true, true);
  }
  catch (const Json::exception& error) {
    throw FormatError("is no JSON: " + reasonOf(error), "mend what stands there or just before");
  }
}

std::string shown(const Json& value)
{
  constexpr std::size_t longest = 60;
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > longest) text = text.substr(0, longest) + "...";
  return text;
}

Json orNull(double number)
{
  return std::isfinite(number) ? Json(number) : Json();
}

Json orNull(const std::string& text)
{
  return text.empty() ? Json() : Json(text);
}

std::string printed(const Json& json)
{
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void writeJson(const std::filesystem::path& file, const Json& json)
{
  files::replaceFile(file, [&](std::ostream& out) { out << printed(json); });
}

std::string validUtf8(std::string_view text)
{
  const std::string quoted = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
  return Json::parse(quoted).get<std::string>();
}

} // namespace pcl_bsh::io

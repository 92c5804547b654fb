// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/option_json.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/poses/pose_text.h>
#include <pcl_bsh/io/text/format_error.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pcl_bsh::pipeline {
namespace {

[[noreturn]] void refuse(const Json& json, const Option& option)
{
  throw std::invalid_argument("is " + io::shown(json) + ": give " + expectation(option));
}

/// A limit as people write it.
std::string plain(double number)
{
  return Json(number).dump().find_first_of("e") == std::string::npos && number == std::floor(number)
             ? std::to_string(static_cast<long long>(number))
             : Json(number).dump();
}

/// " above 0", " from 1 to 3", " of at least 1", and the unit.
std::string rangeOf(const Option& option)
{
  constexpr double untold = 1e9; // beyond, it is the type's limit
  const bool bounded_below = option.least >= -untold;
  const bool bounded_above = option.most < untold;
  std::string range;
  if (bounded_below && option.above_least) {
    range = " above " + plain(option.least) + (bounded_above ? " and up to " + plain(option.most) : "");
  }
  else if (bounded_below && bounded_above) {
    range = " from " + plain(option.least) + " to " + plain(option.most);
  }
  else if (bounded_below) {
    range = " of at least " + plain(option.least);
  }
  else if (bounded_above) {
    range = " of at most " + plain(option.most);
  }
  return range + (option.unit.empty() ? "" : ", in " + option.unit);
}

bool inRange(double number, const Option& option)
{
  return number >= option.least && number <= option.most && !(option.above_least && number == option.least);
}

double numberOf(const Json& json, const Json& whole, const Option& option)
{
  if (!json.is_number() || !std::isfinite(json.get<double>()) || !inRange(json.get<double>(), option)) {
    refuse(whole, option);
  }
  return json.get<double>();
}

std::int64_t integerOf(const Json& json, const Option& option)
{
  constexpr double exact = 9007199254740992; // 2^53: up to here, a double counts one by one
  constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  const double number = numberOf(json, json, option);
  if (json.is_number_integer()) {
    if (json.is_number_unsigned() && json.get<std::uint64_t>() > most) refuse(json, option);
    return json.get<std::int64_t>();
  }
  if (number != std::floor(number) || std::abs(number) > exact) refuse(json, option);
  return static_cast<std::int64_t>(number);
}

std::vector<double> numbersOf(const Json& json, std::size_t count, const Option& option)
{
  if (!json.is_array() || json.size() != count) refuse(json, option);
  std::vector<double> numbers;
  for (const Json& number : json) numbers.push_back(numberOf(number, json, option));
  return numbers;
}

Limit limitOf(const Json& json, const Json& whole, const Option& option)
{
  if (json.is_null()) return {};
  const double number = numberOf(json, whole, option);
  if (json.is_number_unsigned()) return json.get<std::uint64_t>();
  if (json.is_number_integer()) return json.get<std::int64_t>();
  return number;
}

Limits limitsOf(const Json& json, const Option& option)
{
  if (!json.is_array() || json.size() != 2) refuse(json, option);
  return {limitOf(json[0], json, option), limitOf(json[1], json, option)};
}

std::string textOf(const Json& json, const Option& option)
{
  if (!json.is_string()) refuse(json, option);
  const auto text = json.get<std::string>();
  if (!option.choices.empty() &&
      std::find(option.choices.begin(), option.choices.end(), text) == option.choices.end()) {
    refuse(json, option);
  }
  return text;
}

/// For files and clouds; a name with a zero byte would name another file than it says.
std::string nameOf(const Json& json, const Option& option)
{
  const std::string name = textOf(json, option);
  if (name.empty() || name.find('\0') != std::string::npos) refuse(json, option);
  return name;
}

Value poseOf(const Json& json, const Option& option)
{
  Pose pose;
  if (json.is_string()) {
    try {
      pose.matrix = io::readPose(nameOf(json, option)).matrix();
    }
    catch (const files::FileError& error) {
      throw std::invalid_argument(error.what());
    }
  }
  else {
    const bool counted = json.is_array() && (json.size() == 6 || json.size() == 12 || json.size() == 16);
    if (!counted) refuse(json, option);
    pose.matrix = io::poseFrom(numbersOf(json, json.size(), option)).matrix();
  }
  if (!pose.matrix.allFinite() || pose.matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw std::invalid_argument("is " + io::shown(json) + ": give finite numbers, and 0 0 0 1 as the last row");
  }
  return OptionType<Pose>::to(pose);
}

} // namespace

std::string expectation(const Option& option)
{
  switch (option.kind) {
  case Kind::boolean:
    return "true or false";
  case Kind::integer:
    return "an integer" + rangeOf(option);
  case Kind::number:
    return "a number" + rangeOf(option);
  case Kind::text: {
    if (option.choices.empty()) return "a text";
    std::string list = "one of";
    for (const std::string& choice : option.choices) list += (choice == option.choices[0] ? " " : ", ") + choice;
    return list;
  }
  case Kind::limits:
    return "[least, most], numbers or null" + rangeOf(option);
  case Kind::three_numbers:
    return "[x, y, z], numbers" + rangeOf(option);
  case Kind::size:
    return "a number or [x, y, z], each" + rangeOf(option);
  case Kind::pose:
    return "[x, y, z, roll, pitch, yaw] (angles in radians), the 12 or 16 numbers of a matrix, row by row, or the name "
           "of a file with these";
  case Kind::input_file:
    return "the name of a file";
  case Kind::output_file:
    return "the name of a file to write";
  case Kind::cloud:
    return "the tag of an earlier stage, or the name of a cloud file";
  case Kind::length_or_field:
    return "a number" + rangeOf(option) + ", or the name of a field";
  }
  return {};
}

Value valueOf(const Json& json, const Option& option)
{
  if (json.is_null() && option.nullable) return {};
  switch (option.kind) {
  case Kind::boolean:
    if (!json.is_boolean()) refuse(json, option);
    return json.get<bool>();
  case Kind::integer:
    return integerOf(json, option);
  case Kind::number:
    return numberOf(json, json, option);
  case Kind::text:
    return textOf(json, option);
  case Kind::limits:
    return limitsOf(json, option);
  case Kind::three_numbers:
    return numbersOf(json, 3, option);
  case Kind::size:
    if (json.is_number()) return std::vector<double>(3, numberOf(json, json, option));
    return numbersOf(json, 3, option);
  case Kind::pose:
    return poseOf(json, option);
  case Kind::input_file:
  case Kind::output_file:
  case Kind::cloud:
    return nameOf(json, option);
  case Kind::length_or_field:
    if (json.is_number()) return numberOf(json, json, option);
    return nameOf(json, option);
  }
  return {};
}

namespace {

Json jsonOf(const Limit& limit)
{
  return std::visit(
      [](const auto& number) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(number)>, std::monostate>) {
          return nullptr;
        }
        else {
          return number;
        }
      },
      limit);
}

} // namespace

Json jsonOf(const Value& value)
{
  return std::visit(
      [](const auto& held) -> Json {
        using Held = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<Held, std::monostate>) {
          return nullptr;
        }
        else if constexpr (std::is_same_v<Held, Limits>) {
          return Json::array({jsonOf(held.least), jsonOf(held.most)});
        }
        else {
          return held;
        }
      },
      value);
}

Json jsonOfText(const std::string& text, const Option& option)
{
  const bool is_name = option.kind == Kind::text || option.kind == Kind::input_file ||
                       option.kind == Kind::output_file || option.kind == Kind::cloud;
  if (is_name && !(option.nullable && text == "null")) return text;
  for (const std::string& json : {text, "[" + text + "]"}) {
    try {
      return io::parseJson(json);
    }
    catch (const io::FormatError&) {
      // A text, then: the name of a pose's file, or what valueOf() will refuse.
    }
  }
  return text;
}

} // namespace pcl_bsh::pipeline

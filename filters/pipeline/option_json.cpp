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

Limit limitOf(const Json& json, const Json& whole, const Option& option)
{
  if (json.is_null()) return {};
  const double number = numberOf(json, whole, option);
  if (json.is_number_unsigned()) return json.get<std::uint64_t>();
  if (json.is_number_integer()) return json.get<std::int64_t>();
  return number;
}

std::string textOf(const Json& json, const Option& option)
{
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
  const auto name = json.get<std::string>();
  if (name.empty() || name.find('\0') != std::string::npos) refuse(json, option);
  return name;
}

/// Reads JSON that fits a form.
Value read(const Form& form, const Json& json, const Option& option)
{
  switch (form.type) {
  case Form::Type::boolean:
    return json.get<bool>();
  case Form::Type::integer:
    return integerOf(json, option);
  case Form::Type::number:
    return numberOf(json, json, option);
  case Form::Type::text:
    return textOf(json, option);
  case Form::Type::name:
    return nameOf(json, option);
  case Form::Type::rows:
    return std::vector<Row>();
  case Form::Type::texts: {
    std::vector<std::string> texts;
    for (const Json& text : json) {
      if (!text.is_string()) refuse(json, option);
      texts.push_back(text.get<std::string>());
    }
    return texts;
  }
  case Form::Type::limits:
    return Limits{limitOf(json[0], json, option), limitOf(json[1], json, option)};
  case Form::Type::numbers:
    break;
  }
  std::vector<double> numbers;
  for (const Json& number : json) numbers.push_back(numberOf(number, json, option));
  return numbers;
}

/// @param given the name of a file, or numbers
Value poseOf(const Value& given, const Json& json)
{
  Pose pose;
  try {
    const auto* const file = std::get_if<std::string>(&given);
    pose.matrix = (file ? io::readPose(*file) : io::poseFrom(std::get<std::vector<double>>(given))).matrix();
  }
  catch (const files::FileError& error) {
    throw std::invalid_argument(error.what());
  }
  if (!pose.matrix.allFinite() || pose.matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw std::invalid_argument("is " + io::shown(json) + ": give finite numbers, and 0 0 0 1 as the last row");
  }
  return OptionType<Pose>::to(pose);
}

/// The words of messages for a kind, and its forms. In messages, a range stands between `phrase` and `rest`.
struct KindRow {
  Kind kind;
  const char* phrase;
  std::vector<Form> forms;
  const char* rest = "";
};

const KindRow& rowOf(Kind kind)
{
  using Type = Form::Type;
  static const std::vector<KindRow> rows = {
      {Kind::boolean, "true or false", {{Type::boolean}}},
      {Kind::integer, "an integer", {{Type::integer}}},
      {Kind::number, "a number", {{Type::number}}},
      {Kind::text, "a text", {{Type::text}}},
      {Kind::limits, "[least, most], numbers or null", {{Type::limits, 2}}},
      {Kind::three_numbers, "[x, y, z], numbers", {{Type::numbers, 3}}},
      {Kind::size, "a number or [x, y, z], each", {{Type::number}, {Type::numbers, 3}}},
      {Kind::pose,
       "[x, y, z, roll, pitch, yaw] (angles in radians), the 12 or 16 numbers of a matrix, row by row, or the name of "
       "a file with these",
       {{Type::numbers, 6}, {Type::numbers, 12}, {Type::numbers, 16}, {Type::name}}},
      {Kind::input_file, "the name of a file", {{Type::name}}},
      {Kind::output_file, "the name of a file to write", {{Type::name}}},
      {Kind::cloud, "the tag of an earlier stage, or the name of a cloud file", {{Type::name}}},
      {Kind::length_or_field, "a number", {{Type::number}, {Type::name}}, ", or the name of a field"},
      {Kind::texts, "a list of texts", {{Type::texts}}},
      {Kind::rows, "a list of objects", {{Type::rows}}}};
  return *std::find_if(rows.begin(), rows.end(), [&](const KindRow& row) { return row.kind == kind; });
}

} // namespace

bool Form::fits(const Json& json) const
{
  if (type == Type::boolean) return json.is_boolean();
  if (type == Type::integer || type == Type::number) return json.is_number();
  if (type == Type::text || type == Type::name) return json.is_string();
  if (type == Type::texts || type == Type::rows) return json.is_array();
  return json.is_array() && json.size() == count;
}

const std::vector<Form>& formsOf(Kind kind)
{
  return rowOf(kind).forms;
}

std::string expectation(const Option& option)
{
  if (option.kind == Kind::rows) {
    std::string list = rowOf(option.kind).phrase;
    for (const Option& one : option.of_rows)
      list += (&one == &option.of_rows.front() ? " with `" : ", `") + one.name + '`';
    return list;
  }
  if (option.choices.empty()) return rowOf(option.kind).phrase + rangeOf(option) + rowOf(option.kind).rest;
  std::string list = "one of";
  for (const std::string& choice : option.choices) list += (choice == option.choices[0] ? " " : ", ") + choice;
  return list;
}

Value valueOf(const Json& json, const Option& option)
{
  if (json.is_null() && option.nullable) return {};
  for (const Form& form : formsOf(option.kind)) {
    if (!form.fits(json)) continue;
    const Value value = read(form, json, option);
    if (option.kind == Kind::pose) return poseOf(value, json);
    const bool cube = option.kind == Kind::size && form.type == Form::Type::number;
    return cube ? std::vector<double>(3, std::get<double>(value)) : value;
  }
  refuse(json, option);
}

Json jsonOf(const Value& value)
{
  const auto written = [](const auto& held) -> Json {
    if constexpr (std::is_same_v<std::decay_t<decltype(held)>, std::monostate>)
      return nullptr;
    else
      return held;
  };
  if (const auto* const limits = std::get_if<Limits>(&value))
    return Json::array({std::visit(written, limits->least), std::visit(written, limits->most)});
  return std::visit(
      [&](const auto& held) -> Json {
        using T = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<T, Limits> || std::is_same_v<T, std::vector<Row>>)
          return nullptr; // limits are written above, rows by their options
        else
          return written(held);
      },
      value);
}

Json jsonOf(const Value& value, const Option& option)
{
  const auto* const rows = std::get_if<std::vector<Row>>(&value);
  if (!rows) return jsonOf(value);
  Json list = Json::array();
  for (const Row& row : *rows) {
    Json object = Json::object();
    for (std::size_t i = 0; i < row.values.size(); ++i)
      if (!std::holds_alternative<std::monostate>(row.values[i]))
        object[option.of_rows[i].name] = jsonOf(row.values[i], option.of_rows[i]);
    list.push_back(std::move(object));
  }
  return list;
}

Json jsonOfText(const std::string& text, const Option& option)
{
  const Form::Type first = formsOf(option.kind).front().type;
  const bool is_text = first == Form::Type::text || first == Form::Type::name;
  if (is_text && !(option.nullable && text == "null")) return text;
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

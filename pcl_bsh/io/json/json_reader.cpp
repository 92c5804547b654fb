// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/files/one_line.h>
#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/json/nearest_name.h>
#include <pcl_bsh/io/poses/pose_text.h>
#include <pcl_bsh/io/poses/rigid_pose.h>
#include <pcl_bsh/io/text/format_error.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/query/request_check.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::io {

JsonError::JsonError(const std::string& file, const std::string& place, const std::string& wrong,
                     const std::string& remedy)
: std::runtime_error(files::oneLine(file + ": " + (place.empty() ? "" : place + ": ") + wrong + ": " + remedy))
{
}

Json parseJson(std::string_view text, const std::string& file)
{
  try {
    return parseJson(text);
  }
  catch (const FormatError& error) {
    throw JsonError(file, "", error.what(), error.remedy());
  }
}

void JsonReader::fail(const std::string& wrong, const std::string& remedy) const
{
  throw JsonError(*file_, place_, wrong, remedy);
}

JsonReader JsonReader::child(const Json& json, const std::string& step) const
{
  JsonReader reader(json, *file_);
  reader.place_ = place_ + (place_.empty() || step.front() == '[' ? "" : ".") + step;
  return reader;
}

void JsonReader::requireKeys(const std::vector<std::string>& valid) const
{
  if (!json_->is_object()) fail(shown(*json_) + " is no object", "give { ... } with any of " + listed(valid));
  for (const auto& [key, value] : json_->items())
    if (std::find(valid.begin(), valid.end(), key) == valid.end())
      fail("key '" + key + "' is unknown", suggestion(key, valid));
}

JsonReader JsonReader::at(const char* key) const
{
  if (!has(key)) fail(std::string("'") + key + "' is missing", "add it");
  return child(json_->at(key), key);
}

std::vector<JsonReader> JsonReader::elements() const
{
  if (!json_->is_array()) fail(shown(*json_) + " is no list", "give [ ... ]");
  std::vector<JsonReader> list;
  for (std::size_t i = 0; i < json_->size(); ++i) list.push_back(child((*json_)[i], "[" + std::to_string(i) + "]"));
  return list;
}

std::vector<std::pair<std::string, JsonReader>> JsonReader::members() const
{
  if (!json_->is_object()) fail(shown(*json_) + " is no object", "give { ... }");
  std::vector<std::pair<std::string, JsonReader>> list;
  for (const auto& [key, value] : json_->items()) list.emplace_back(key, child(value, key));
  return list;
}

bool JsonReader::boolean() const
{
  if (!json_->is_boolean()) fail(shown(*json_) + " is neither true nor false", "give one of them");
  return json_->get<bool>();
}

std::string JsonReader::text() const
{
  if (!json_->is_string() || json_->get_ref<const std::string&>().empty())
    fail(shown(*json_) + " is no text", "give \"...\"");
  return json_->get<std::string>();
}

double JsonReader::number(double low, double high) const
{
  if (!json_->is_number()) fail(shown(*json_) + " is no number", "give one");
  const auto value = json_->get<double>();
  if (!(value >= low)) fail(shown(*json_) + " is too small", "give at least " + shown(Json(low)));
  if (!(value <= high)) fail(shown(*json_) + " is too large", "give at most " + shown(Json(high)));
  return value;
}

std::uint64_t JsonReader::whole(std::uint64_t low, std::uint64_t high) const
{
  const double value = number(static_cast<double>(low), static_cast<double>(high));
  if (value != std::floor(value)) fail(shown(*json_) + " is no whole number", "give one");
  return static_cast<std::uint64_t>(value);
}

std::string JsonReader::oneOf(const std::vector<std::string>& valid) const
{
  const std::string name = text();
  if (std::find(valid.begin(), valid.end(), name) == valid.end())
    fail("'" + name + "' is unknown", suggestion(name, valid));
  return name;
}

std::vector<double> JsonReader::numbers(std::size_t count) const
{
  if (!json_->is_array() || json_->size() != count)
    fail(shown(*json_) + " is no list of " + counted(count, "number"), "give [ ... ]");
  std::vector<double> list;
  for (const JsonReader& element : elements()) list.push_back(element.number());
  return list;
}

Eigen::Vector3d JsonReader::vector() const
{
  const std::vector<double> v = numbers(3);
  return {v[0], v[1], v[2]};
}

Eigen::Isometry3d JsonReader::pose(std::vector<std::string>& warnings) const
{
  const std::size_t count = json_->is_array() ? json_->size() : 0;
  if (count != 3 && count != 6 && count != 12 && count != 16)
    fail(shown(*json_) + " is no pose",
         "give [x, y, z], [x, y, z, roll, pitch, yaw] with radians, or the 12 or 16 numbers of a matrix, row by row");
  std::vector<double> n = numbers(count);
  if (count == 3) n.resize(6);
  const RigidPose rigid = nearestRigid(poseFrom(n));
  try {
    checkPose(place_, rigid.pose);
  }
  catch (const InvalidInput&) {
    fail("is no rigid transform", "give a rotation without scale or mirror, and 0 0 0 1 as last row");
  }
  if (const auto warning = warningOfAngles(n)) warnings.push_back(place_ + ": " + *warning);
  if (rigid.deviation > 0) warnings.push_back(place_ + ": " + nearestRotationWarning(rigid.deviation));
  return rigid.pose;
}

void read(const JsonReader& object, const char* key, double& value)
{
  if (object.has(key)) value = object.at(key).number();
}

void read(const JsonReader& object, const char* key, bool& value)
{
  if (object.has(key)) value = object.at(key).boolean();
}

void read(const JsonReader& object, const char* key, std::string& value)
{
  if (object.has(key)) value = object.at(key).text();
}

void read(const JsonReader& object, const char* key, Eigen::Vector3d& value)
{
  if (object.has(key)) value = object.at(key).vector();
}

std::vector<JsonReader> elementsOf(const JsonReader& object, const char* key)
{
  return object.has(key) ? object.at(key).elements() : std::vector<JsonReader>();
}

} // namespace pcl_bsh::io

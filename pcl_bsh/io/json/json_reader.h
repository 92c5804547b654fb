// SPDX-License-Identifier: BSD-3-Clause
// A JSON document read strictly: whatever is wrong is named with its place in the document.
#pragma once

#include <pcl_bsh/io/json/json_document.h>

#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// what() is one line: `file: place: what is wrong: what to do`.
class JsonError : public std::runtime_error {
public:
  JsonError(const std::string& file, const std::string& place, const std::string& wrong, const std::string& remedy);
};

/// parseJson() of what a file holds. @throws JsonError
Json parseJson(std::string_view text, const std::string& file);

/// A value of the document, and where it stands: `objects[3].motion`.
class JsonReader {
public:
  JsonReader(const Json& json, const std::string& file) : json_(&json), file_(&file) {}

  const Json& json() const { return *json_; }
  const std::string& place() const { return place_; }

  [[noreturn]] void fail(const std::string& wrong, const std::string& remedy) const;

  /// Fails unless this is an object that has no other keys.
  void requireKeys(const std::vector<std::string>& valid) const;

  bool has(const char* key) const { return json_->contains(key); }
  JsonReader at(const char* key) const;                            ///< fails where it is missing
  std::vector<JsonReader> elements() const;                        ///< fails unless an array
  std::vector<std::pair<std::string, JsonReader>> members() const; ///< fails unless an object

  bool boolean() const;
  std::string text() const; ///< not empty
  double number(double low = -1e300, double high = 1e300) const;
  std::uint64_t whole(std::uint64_t low, std::uint64_t high) const;
  std::string oneOf(const std::vector<std::string>& valid) const;
  std::vector<double> numbers(std::size_t count) const;
  Eigen::Vector3d vector() const;

  /// x y z roll pitch yaw (radians), or the 12 or 16 numbers of a matrix, row by row. The nearest rotation replaces a
  /// matrix with |R'R - I| from 1e-6 to 1e-4, as few printed digits leave it; `warnings` gets a line then.
  Eigen::Isometry3d pose(std::vector<std::string>& warnings) const;

private:
  JsonReader child(const Json& json, const std::string& step) const;

  const Json* json_;
  const std::string* file_;
  std::string place_;
};

// The member `key` of an object, where it has one; else the value stays as it is.
void read(const JsonReader& object, const char* key, double& value);
void read(const JsonReader& object, const char* key, bool& value);
void read(const JsonReader& object, const char* key, std::string& value);
void read(const JsonReader& object, const char* key, Eigen::Vector3d& value);

/// Reads a whole number within the range of its type, as a schema has checked.
template <typename Count>
void readCount(const JsonReader& object, const char* key, Count& value)
{
  if (object.has(key)) value = static_cast<Count>(object.at(key).number());
}

/// The elements of the list `key` of an object; none where it has no such member.
std::vector<JsonReader> elementsOf(const JsonReader& object, const char* key);

} // namespace pcl_bsh::io

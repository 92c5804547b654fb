// SPDX-License-Identifier: BSD-3-Clause
// The type of a stage's option: the C++ type of a member says how a document writes it.
//
//   bool, int and other integers, double, std::string   true, 3, 0.5, "x"
//   Limits                                               [0, null]
//   Numbers<3>                                           [0, 1.5, 2]
//   Size3                                                0.05 or [0.05, 0.05, 0.1]
//   Pose                                                 [x, y, z, roll, pitch, yaw], a matrix, or a file with one
//   InputFile, OutputFile                                "hall.pcd"
//   OtherCloud                                           the tag of an earlier stage, or "robot.pcd"
//   LengthOrField                                        0.005 or "sigma"
//   std::vector<std::string>                             ["press:mill"]
//   std::optional of any                                 the same; nothing unless the document says something
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/filters/pipeline/stage_cloud.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::pipeline {

/// A finite number as the document writes it: a whole one keeps all of its 64 bits. std::monostate: null, no limit.
using Limit = std::variant<std::monostate, std::int64_t, std::uint64_t, double>;

/// Both inclusive.
struct Limits {
  Limit least;
  Limit most;
};

struct Row;

/// A value of a document, checked to be of the option's kind. std::monostate: null.
using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string, std::vector<double>, Limits,
                           std::vector<std::string>, std::vector<Row>>;

/// An object of a list: a value for each option that it may have.
struct Row {
  std::vector<Value> values;
};

/// Which of these an option is.
enum class Kind : std::uint8_t {
  boolean,
  integer,
  number,
  text,
  limits,
  three_numbers,
  size,
  pose,
  input_file,
  output_file,
  cloud,
  length_or_field,
  texts,
  rows,
};

/// So many numbers.
template <std::size_t N>
using Numbers = std::array<double, N>;

/// Along x, y and z.
struct Size3 {
  Numbers<3> xyz = {0, 0, 0};
};

/// An affine map; whether it must be rigid is for the stage to say.
struct Pose {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
};

/// A file that a stage reads.
struct InputFile {
  std::string path;
};

/// A file that a stage writes.
struct OutputFile {
  std::string path;
};

/// Another cloud than the stage's input. The pipeline fills it in.
struct OtherCloud {
  std::string name;    ///< the tag of a stage, or a file
  CloudHeader header;  ///< when Stage::plan() is called
  StageCloudPtr cloud; ///< when Stage::run() is called
};

/// One length for all points, or the name of the field that holds one for each.
struct LengthOrField {
  double length = 0;
  std::string field; ///< empty: the length counts
};

/// The limits of the type itself.
template <typename T, typename = void>
struct NumberLimits {
  static constexpr double least = -std::numeric_limits<double>::infinity();
  static constexpr double most = std::numeric_limits<double>::infinity();
};

template <typename T>
struct NumberLimits<T, std::enable_if_t<std::is_integral_v<T> && !std::is_same_v<T, bool>>> {
  static constexpr double least = static_cast<double>(std::numeric_limits<T>::lowest());
  static constexpr double most = static_cast<double>(std::numeric_limits<T>::max());
};

template <typename T>
struct NumberLimits<std::optional<T>> : NumberLimits<T> {
};

/// How a member of type T is written: its kind, and the way from and to a Value of that kind.
template <typename T, typename = void>
struct OptionType;

namespace detail {

/// Conversion of a type that a Value holds as it is.
template <typename T, Kind K>
struct HeldType {
  static constexpr Kind kind = K;
  static T from(const Value& value) { return std::get<T>(value); }
  static Value to(const T& option) { return option; }
};

/// Conversion of a struct that is written as a name. @param name the member that holds it
template <typename T, std::string T::*name, Kind K>
struct NamedType {
  static constexpr Kind kind = K;
  static T from(const Value& value)
  {
    T option;
    option.*name = std::get<std::string>(value);
    return option;
  }
  static Value to(const T& option) { return option.*name; }
};

} // namespace detail

template <>
struct OptionType<bool> : detail::HeldType<bool, Kind::boolean> {
};
template <>
struct OptionType<double> : detail::HeldType<double, Kind::number> {
};
template <>
struct OptionType<std::string> : detail::HeldType<std::string, Kind::text> {
};
template <>
struct OptionType<std::vector<std::string>> : detail::HeldType<std::vector<std::string>, Kind::texts> {
};
template <>
struct OptionType<Limits> : detail::HeldType<Limits, Kind::limits> {
};
template <>
struct OptionType<InputFile> : detail::NamedType<InputFile, &InputFile::path, Kind::input_file> {
};
template <>
struct OptionType<OutputFile> : detail::NamedType<OutputFile, &OutputFile::path, Kind::output_file> {
};
template <>
struct OptionType<OtherCloud> : detail::NamedType<OtherCloud, &OtherCloud::name, Kind::cloud> {
};

template <typename T>
struct OptionType<T, std::enable_if_t<std::is_integral_v<T> && !std::is_same_v<T, bool>>> {
  static constexpr Kind kind = Kind::integer;
  static T from(const Value& value) { return static_cast<T>(std::get<std::int64_t>(value)); }
  static Value to(T option) { return static_cast<std::int64_t>(option); }
};

template <>
struct OptionType<Numbers<3>> {
  static constexpr Kind kind = Kind::three_numbers;
  static Numbers<3> from(const Value& value)
  {
    const auto& numbers = std::get<std::vector<double>>(value);
    return {numbers[0], numbers[1], numbers[2]};
  }
  static Value to(const Numbers<3>& option) { return std::vector<double>(option.begin(), option.end()); }
};

template <>
struct OptionType<Size3> {
  static constexpr Kind kind = Kind::size;
  static Size3 from(const Value& value) { return {OptionType<Numbers<3>>::from(value)}; }
  static Value to(const Size3& option) { return OptionType<Numbers<3>>::to(option.xyz); }
};

template <>
struct OptionType<Pose> {
  static constexpr Kind kind = Kind::pose;
  using RowMajor = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
  static Pose from(const Value& value)
  {
    return {Eigen::Map<const RowMajor>(std::get<std::vector<double>>(value).data())};
  }
  static Value to(const Pose& option)
  {
    const RowMajor rows = option.matrix;
    return std::vector<double>(rows.data(), rows.data() + rows.size());
  }
};

template <>
struct OptionType<LengthOrField> {
  static constexpr Kind kind = Kind::length_or_field;
  static LengthOrField from(const Value& value)
  {
    if (const auto* field = std::get_if<std::string>(&value)) return {0, *field};
    return {std::get<double>(value), {}};
  }
  static Value to(const LengthOrField& option)
  {
    return option.field.empty() ? Value(option.length) : Value(option.field);
  }
};

template <typename T>
struct OptionType<std::optional<T>> {
  static constexpr Kind kind = OptionType<T>::kind;
  static std::optional<T> from(const Value& value)
  {
    if (std::holds_alternative<std::monostate>(value)) return std::nullopt;
    return OptionType<T>::from(value);
  }
  static Value to(const std::optional<T>& option) { return option ? OptionType<T>::to(*option) : Value(); }
};

} // namespace pcl_bsh::pipeline
PCL_BSH_EXPORT_END

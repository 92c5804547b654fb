// SPDX-License-Identifier: BSD-3-Clause
// The types a cloud's field can have, and numbers of these types written as text.
#pragma once

#include <pcl_bsh/filters/cloud_files/cloud_file_error.h>

#include <pcl/PCLPointField.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace pcl_bsh::io {

/// Calls `use` with a zero of the C++ type that a PCLPointField datatype stands for; a BOOL is seen as its byte.
template <typename Use>
decltype(auto) withFieldType(std::uint8_t datatype, Use&& use)
{
  using Field = pcl::PCLPointField;
  switch (datatype) {
  case Field::INT8:
    return use(std::int8_t{});
  case Field::BOOL:
  case Field::UINT8:
    return use(std::uint8_t{});
  case Field::INT16:
    return use(std::int16_t{});
  case Field::UINT16:
    return use(std::uint16_t{});
  case Field::INT32:
    return use(std::int32_t{});
  case Field::UINT32:
    return use(std::uint32_t{});
  case Field::INT64:
    return use(std::int64_t{});
  case Field::UINT64:
    return use(std::uint64_t{});
  case Field::FLOAT32:
    return use(float{});
  case Field::FLOAT64:
    return use(double{});
  default:
    throw FormatError("a field has the unknown type " + std::to_string(datatype));
  }
}

/// Bytes of one value.
inline std::size_t sizeOf(std::uint8_t datatype)
{
  return withFieldType(datatype, [](auto zero) { return sizeof zero; });
}

/// Bytes of a field's values in one record; PCL takes a count of 0 as 1.
inline std::size_t sizeOf(const pcl::PCLPointField& field)
{
  return sizeOf(field.datatype) * (field.count == 0 ? 1 : field.count);
}

/// Whether decimal digits, which say a number that is too large or too small for its type, say one below 1. Not left to
/// the C library, for it reads a decimal comma where the program's language has one.
bool isBelowOne(std::string_view digits);

/// The number nearest to what the word says.
/// @throws FormatError when it says no number, or one that T cannot hold
template <typename T>
T parseNumber(std::string_view word)
{
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  T value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  if (error == std::errc::result_out_of_range && std::is_floating_point_v<T> && whole && isBelowOne(digits)) {
    return T{0}; // too large is an error; too small is zero
  }
  if (error != std::errc() || !whole) {
    const std::string wrong = "'" + std::string(word.substr(0, 40)) + "' is not ";
    const bool mixed = word.find_first_of(",; \t") != std::string_view::npos;
    throw FormatError(wrong + (std::is_floating_point_v<T> ? "a number" : "a whole number in the range of its type"),
                      mixed ? "write a decimal point, and one separator in all lines" : remedy_for_damage);
  }
  return value;
}

/// Whether the word says a number.
inline bool isNumber(std::string_view word)
{
  try {
    parseNumber<double>(word);
    return true;
  }
  catch (const FormatError&) {
    return false;
  }
}

/// Whether the word is a number or meant for one, as with a decimal comma: it cannot be a name.
bool looksLikeNumber(std::string_view word);

/// Writes the number that the word says to `out`, in the representation of `datatype`. Throws as parseNumber() does.
inline void parseNumber(std::string_view word, std::uint8_t datatype, std::uint8_t* out)
{
  withFieldType(datatype, [&](auto zero) {
    const auto value = parseNumber<decltype(zero)>(word);
    std::memcpy(out, &value, sizeof value);
  });
}

} // namespace pcl_bsh::io

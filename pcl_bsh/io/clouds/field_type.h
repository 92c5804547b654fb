// SPDX-License-Identifier: BSD-3-Clause
// The types a cloud's field can have.
#pragma once

#include <pcl_bsh/io/text/format_error.h>

#include <pcl/PCLPointField.h>

#include <cstddef>
#include <cstdint>
#include <string>

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

} // namespace pcl_bsh::io

// SPDX-License-Identifier: BSD-3-Clause
// PLY's names of types.
#pragma once

#include <pcl/PCLPointField.h>

#include <array>
#include <cstdint>
#include <string_view>

namespace pcl_bsh::io {

struct PlyType {
  std::string_view name;
  std::string_view sized_name; ///< what newer writers say
  std::uint8_t datatype;       ///< of PCLPointField
};

inline constexpr std::array<PlyType, 8> ply_types = {{
    {"char", "int8", pcl::PCLPointField::INT8},
    {"uchar", "uint8", pcl::PCLPointField::UINT8},
    {"short", "int16", pcl::PCLPointField::INT16},
    {"ushort", "uint16", pcl::PCLPointField::UINT16},
    {"int", "int32", pcl::PCLPointField::INT32},
    {"uint", "uint32", pcl::PCLPointField::UINT32},
    {"float", "float32", pcl::PCLPointField::FLOAT32},
    {"double", "float64", pcl::PCLPointField::FLOAT64},
}};

} // namespace pcl_bsh::io

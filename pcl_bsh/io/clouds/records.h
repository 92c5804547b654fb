// SPDX-License-Identifier: BSD-3-Clause
// The records of a pcl::PCLPointCloud2: laying them out, giving them room, taking their fields out again.
#pragma once

#include <pcl_bsh/io/clouds/field_type.h>

#include <pcl/PCLPointCloud2.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_bsh::io {

/// The most points of a cloud, so that pcl::Indices can name them.
inline constexpr std::uint64_t max_points = 0x7fffffff;

/// Appends a field right behind the last one. @throws FormatError when a record would grow beyond 4 GiB
void addField(pcl::PCLPointCloud2& cloud, const std::string& name, std::uint8_t datatype, std::uint64_t count = 1);

/// Adds that many bytes without a field to each record. Throws as addField() does.
void addPadding(pcl::PCLPointCloud2& cloud, std::uint64_t bytes);

/// @throws FormatError beyond max_points
void requirePoints(std::uint64_t points);

/// Refuses what a header claims but the rest of its file cannot hold. To be called before memory is asked for.
/// @param least_bytes what a point takes in the file at least
/// @throws FormatError saying how many points there can be at most, or beyond max_points
void requireBytes(std::uint64_t points, std::uint64_t least_bytes, std::uint64_t bytes_left);

/// Gives the cloud width x height records, all bytes zero.
void allocate(pcl::PCLPointCloud2& cloud, std::uint32_t width, std::uint32_t height = 1);

/// Resizes a cloud whose records are all written afterwards. Its bytes stay if the capacity of `data` is enough; else
/// all become zero.
void resizeRecords(pcl::PCLPointCloud2& cloud, std::uint32_t width);

/// Sets is_dense: no value of any floating-point field is NaN or infinite.
void setDense(pcl::PCLPointCloud2& cloud);

/// The fields that hold something: not those named "_", as PCL calls padding.
/// @throws FormatError when a name cannot stand in a header or a record does not hold its fields
std::vector<pcl::PCLPointField> namedFields(const pcl::PCLPointCloud2& cloud);

/// Whether a field with a count is led by that count, as an unsigned 32-bit number.
enum class Lists : std::uint8_t { bare, counted };

/// Hands out the records with only these fields, side by side, about a megabyte at a time.
void forEachPackedBlock(const pcl::PCLPointCloud2& cloud, const std::vector<pcl::PCLPointField>& fields, Lists lists,
                        const std::function<void(std::string_view)>& use);

} // namespace pcl_bsh::io

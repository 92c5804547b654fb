// SPDX-License-Identifier: BSD-3-Clause
// All that a PCL cloud holds, as values that can be compared.
#pragma once

#include <pcl/PCLPointCloud2.h>
#include <pcl/point_cloud.h>

#include <bit>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

namespace pcl_bsh::test {

/// NaN equals itself here.
inline std::vector<std::uint32_t> bitsOf(const std::vector<float>& values)
{
  std::vector<std::uint32_t> bits;
  for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
  return bits;
}
inline std::vector<std::uint64_t> bitsOf(const std::vector<double>& values)
{
  std::vector<std::uint64_t> bits;
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
  return bits;
}

template <typename PointT>
auto contentsOf(const pcl::PointCloud<PointT>& cloud)
{
  std::vector<std::uint32_t> bits;
  for (const PointT& p : cloud)
    for (const float value : {p.x, p.y, p.z}) bits.push_back(std::bit_cast<std::uint32_t>(value));
  return std::tuple(cloud.header.frame_id, cloud.width, cloud.height, cloud.is_dense, bits);
}

inline auto contentsOf(const pcl::PCLPointCloud2& cloud)
{
  std::vector<std::tuple<std::string, std::uint32_t, std::uint8_t>> fields;
  for (const pcl::PCLPointField& field : cloud.fields) fields.emplace_back(field.name, field.offset, field.datatype);
  return std::tuple(cloud.header.frame_id, cloud.width, cloud.height, cloud.is_dense, cloud.point_step, cloud.row_step,
                    fields, cloud.data);
}

} // namespace pcl_bsh::test

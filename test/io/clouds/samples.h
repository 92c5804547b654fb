// SPDX-License-Identifier: BSD-3-Clause
// Clouds and folders for the tests of files.
#pragma once

#include "io/text/defect.h"

#include <pcl_bsh/io/clouds/records.h>

#include <gtest/gtest.h>

#include <pcl/PCLPointCloud2.h>

#include <random>
#include <string>
#include <vector>

namespace pcl_bsh::io {

using Field = pcl::PCLPointField;

/// x y z and then a field of each of the types; every byte random (NaNs among them) but coordinates finite.
template <typename Coordinate>
pcl::PCLPointCloud2 randomCloud(std::uint32_t width, std::uint32_t height, const std::vector<std::uint8_t>& types)
{
  pcl::PCLPointCloud2 cloud;
  const std::uint8_t coordinate = sizeof(Coordinate) == 4 ? Field::FLOAT32 : Field::FLOAT64;
  for (const char* axis : {"x", "y", "z"}) addField(cloud, axis, coordinate);
  for (const std::uint8_t type : types) addField(cloud, "field_" + std::to_string(type), type);
  addField(cloud, "rgb", Field::FLOAT32);
  addField(cloud, "histogram", Field::FLOAT32, 5);
  allocate(cloud, width, height);
  cloud.is_dense = false;

  std::mt19937 random(7);
  for (std::uint8_t& byte : cloud.data) byte = static_cast<std::uint8_t>(random());
  for (std::size_t i = 0; i < std::size_t{width} * height; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Coordinate value = static_cast<Coordinate>(std::uniform_real_distribution<double>(-1e6, 1e6)(random));
      std::memcpy(&cloud.data[i * cloud.point_step + k * sizeof value], &value, sizeof value);
    }
  }
  return cloud;
}

inline const std::vector<std::uint8_t> ply_datatypes = {Field::INT8,  Field::UINT8,  Field::INT16,   Field::UINT16,
                                                        Field::INT32, Field::UINT32, Field::FLOAT32, Field::FLOAT64};
inline const std::vector<std::uint8_t> pcd_datatypes = {Field::BOOL,   Field::INT8,    Field::UINT8,  Field::INT16,
                                                        Field::UINT16, Field::INT32,   Field::UINT32, Field::INT64,
                                                        Field::UINT64, Field::FLOAT32, Field::FLOAT64};

/// Without what rgb has beside a colour: its fourth byte, which PCD alone keeps.
inline pcl::PCLPointCloud2 withoutOpacity(pcl::PCLPointCloud2 cloud)
{
  for (const Field& field : cloud.fields) {
    if (field.name != "rgb") continue;
    for (std::size_t i = 0; i < std::size_t{cloud.width} * cloud.height; ++i) {
      std::uint32_t colour;
      std::uint8_t* const bytes = &cloud.data[i * cloud.point_step + field.offset];
      std::memcpy(&colour, bytes, sizeof colour);
      colour &= 0xffffffU;
      std::memcpy(bytes, &colour, sizeof colour);
    }
  }
  return cloud;
}

/// The bits of a record's packed colour.
inline std::uint32_t colourOf(const pcl::PCLPointCloud2& cloud, std::size_t record, const std::string& name = "rgb")
{
  for (const Field& field : cloud.fields) {
    if (field.name != name) continue;
    std::uint32_t colour;
    std::memcpy(&colour, &cloud.data[record * cloud.point_step + field.offset], sizeof colour);
    return colour;
  }
  throw std::invalid_argument("no field " + name);
}

/// The names of the fields, a blank between them.
inline std::string namesOf(const pcl::PCLPointCloud2& cloud)
{
  std::string names;
  for (const Field& field : cloud.fields) names += (names.empty() ? "" : " ") + field.name;
  return names;
}

/// Same size, fields and bytes.
inline void expectSame(const pcl::PCLPointCloud2& actual, const pcl::PCLPointCloud2& expected)
{
  EXPECT_EQ(actual.width, expected.width);
  EXPECT_EQ(actual.height, expected.height);
  EXPECT_EQ(actual.point_step, expected.point_step);
  ASSERT_EQ(actual.fields.size(), expected.fields.size());
  for (std::size_t i = 0; i < actual.fields.size(); ++i) {
    EXPECT_EQ(actual.fields[i].name, expected.fields[i].name);
    EXPECT_EQ(actual.fields[i].datatype, expected.fields[i].datatype) << actual.fields[i].name;
    EXPECT_EQ(actual.fields[i].count, expected.fields[i].count) << actual.fields[i].name;
    EXPECT_EQ(actual.fields[i].offset, expected.fields[i].offset) << actual.fields[i].name;
  }
  EXPECT_TRUE(actual.data == expected.data);
}

/// The one value of a record's field, as double.
inline double valueOf(const pcl::PCLPointCloud2& cloud, std::size_t record, const std::string& name)
{
  for (const Field& field : cloud.fields) {
    if (field.name != name) continue;
    return withFieldType(field.datatype, [&](auto value) {
      std::memcpy(&value, &cloud.data[record * cloud.point_step + field.offset], sizeof value);
      return static_cast<double>(value);
    });
  }
  throw std::invalid_argument("no field " + name);
}

} // namespace pcl_bsh::io

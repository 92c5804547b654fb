// SPDX-License-Identifier: BSD-3-Clause
#include "samples.h"

#include <pcl_bsh/io/clouds/field_type.h>

namespace pcl_bsh::io {

TEST(FieldType, SizesAreThoseOfPcl)
{
  EXPECT_EQ(sizeOf(std::uint8_t{Field::INT8}), 1U);
  EXPECT_EQ(sizeOf(std::uint8_t{Field::UINT16}), 2U);
  EXPECT_EQ(sizeOf(std::uint8_t{Field::FLOAT32}), 4U);
  EXPECT_EQ(sizeOf(std::uint8_t{Field::INT64}), 8U);
  Field field;
  field.datatype = Field::FLOAT64;
  field.count = 0; // as old converters leave it
  EXPECT_EQ(sizeOf(field), 8U);
  field.count = 3;
  EXPECT_EQ(sizeOf(field), 24U);
  EXPECT_THROW(sizeOf(std::uint8_t{99}), FormatError);
}

} // namespace pcl_bsh::io

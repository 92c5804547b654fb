// SPDX-License-Identifier: BSD-3-Clause
#include "samples.h"

#include <pcl_bsh/filters/io/field_type.h>

#include <cmath>
#include <limits>

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

TEST(FieldType, NumbersRoundOnce)
{
  EXPECT_EQ(parseNumber<double>("596648.1234567891"), 596648.1234567891);
  EXPECT_EQ(parseNumber<double>("+1.5e3"), 1500);
  // Just above the middle of two floats: by way of a double it would round down.
  EXPECT_EQ(parseNumber<float>("1.00000005960464478"), std::nextafter(1.0F, 2.0F));
  EXPECT_EQ(parseNumber<float>("1e-46"), 0.0F);
  EXPECT_EQ(parseNumber<float>("1.4e-45"), std::numeric_limits<float>::denorm_min());
  EXPECT_TRUE(std::isnan(parseNumber<float>("nan")));
  EXPECT_TRUE(std::isnan(parseNumber<double>("-NaN")));
  EXPECT_EQ(parseNumber<float>("-inf"), -std::numeric_limits<float>::infinity());
  EXPECT_EQ(parseNumber<std::uint64_t>("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
}

TEST(FieldType, RefusesWhatIsNoNumberOfTheType)
{
  for (const char* word : {"", "+", "abc", "1.5x", "1,5", "--1", "0x10", "1e400"}) {
    EXPECT_THROW(parseNumber<double>(word), FormatError) << word;
  }
  for (const char* word : {"256", "-1", "1.0", "1e2"}) {
    EXPECT_THROW(parseNumber<std::uint8_t>(word), FormatError) << word;
  }
  EXPECT_THROW(parseNumber<float>("1e39"), FormatError);
  EXPECT_EQ(defectOf([] { parseNumber<double>("abc"); }), "'abc' is not a number");
}

} // namespace pcl_bsh::io

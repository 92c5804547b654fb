// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/length_unit.h>

#include <gmock/gmock.h>

namespace pcl_bsh::io {
namespace {

constexpr LengthUnit all_units[] = {LengthUnit::mm, LengthUnit::cm, LengthUnit::m, LengthUnit::ft, LengthUnit::us_ft};

TEST(LengthUnits, HaveNames)
{
  for (const LengthUnit unit : all_units) {
    EXPECT_EQ(lengthUnitOf(nameOf(unit)), unit);
    EXPECT_TRUE(LengthScale(unit, unit).isOne());
    EXPECT_EQ(LengthScale(unit, unit)(0.1), 0.1);
  }
  for (const char* wrong : {"", "MM", "inch", "us_ft", "metre", "m "}) {
    try {
      lengthUnitOf(wrong);
      ADD_FAILURE() << wrong;
    }
    catch (const FormatError& error) {
      EXPECT_EQ(error.what(), "'" + std::string(wrong) + "' is no unit");
      EXPECT_EQ(error.remedy(), "give mm, cm, m, ft or us-ft");
    }
  }
}

TEST(LengthUnits, AreToldByTheirMetres)
{
  EXPECT_EQ(lengthUnitOfMetres(1), LengthUnit::m);
  EXPECT_EQ(lengthUnitOfMetres(0.001), LengthUnit::mm);
  EXPECT_EQ(lengthUnitOfMetres(0.3048), LengthUnit::ft);
  EXPECT_EQ(lengthUnitOfMetres(0.3048006096012192), LengthUnit::us_ft);
  EXPECT_EQ(lengthUnitOfMetres(0.3048006), LengthUnit::us_ft);
  for (const double none : {0.0, -1.0, 0.0174532925199433, 1000.0, 0.30480033})
    EXPECT_FALSE(lengthUnitOfMetres(none)) << none;
}

/// Factors are whole numbers, so that the result is the nearest double where one of both is 1.
TEST(LengthUnits, AreConverted)
{
  const LengthScale to_m(LengthUnit::mm, LengthUnit::m), to_mm(LengthUnit::m, LengthUnit::mm);
  EXPECT_FALSE(to_m.isOne());
  for (int i = 1; i < 1000; ++i) EXPECT_EQ(to_m(i), i / 1000.0);
  EXPECT_EQ(to_m(1), 0.001);
  EXPECT_EQ(to_mm(1.5), 1500.0);
  EXPECT_EQ(LengthScale(LengthUnit::cm, LengthUnit::mm)(2.5), 25.0);
  EXPECT_EQ(LengthScale(LengthUnit::ft, LengthUnit::m)(1), 0.3048);
  EXPECT_EQ(LengthScale(LengthUnit::m, LengthUnit::us_ft)(1200), 3937.0);
  EXPECT_EQ(LengthScale(LengthUnit::us_ft, LengthUnit::mm)(3937), 1.2e6);
  for (const LengthUnit from : all_units)
    for (const LengthUnit to : all_units)
      EXPECT_DOUBLE_EQ(LengthScale(to, from)(LengthScale(from, to)(1234.5)), 1234.5);
}

} // namespace
} // namespace pcl_bsh::io

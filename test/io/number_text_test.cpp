// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/io/number_text.h>

#include <gtest/gtest.h>

#include <limits>

namespace pcl_bsh::io {

TEST(NumberText, HasTheDigitsItNeeds)
{
  EXPECT_EQ(numberText(0.1), "0.1");
  EXPECT_EQ(numberText(596648.1234567891), "596648.1234567891");
  EXPECT_EQ(numberText(1.0 / 3, std::chars_format::general, 4), "0.3333");
  EXPECT_EQ(numberText(-1e-7, std::chars_format::fixed, 3), "-0.000");
  EXPECT_EQ(numberText(std::numeric_limits<double>::max(), std::chars_format::fixed, 3).size(), 313U);
  EXPECT_EQ(numberText(std::numeric_limits<double>::quiet_NaN()), "nan");
}

TEST(NumberText, ReplacesWhatIsNoUtf8)
{
  EXPECT_EQ(validUtf8("h\xc3\xa4user \xe2\x82\xac"), "h\xc3\xa4user \xe2\x82\xac");
  EXPECT_EQ(validUtf8("a\xff"
                      "b\xc3"),
            "a\xef\xbf\xbd"
            "b\xef\xbf\xbd");
  EXPECT_EQ(validUtf8(std::string("a\0\n", 3)), std::string("a\0\n", 3));
}

TEST(NumberText, QuotesCells)
{
  EXPECT_EQ(csvText("C1_0_0#2"), "C1_0_0#2");
  EXPECT_EQ(csvText("a,\"b\"\nc"), "\"a,\"\"b\"\"\nc\"");
}

} // namespace pcl_bsh::io

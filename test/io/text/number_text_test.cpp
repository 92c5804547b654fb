// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/text/number_text.h>

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

TEST(NumberText, QuotesCells)
{
  EXPECT_EQ(csvText("C1_0_0#2"), "C1_0_0#2");
  EXPECT_EQ(csvText("a,\"b\"\nc"), "\"a,\"\"b\"\"\nc\"");
}

TEST(NumberText, QuotesEachCharacterThatCellsEndAt)
{
  for (const std::string end : {",", "\n", "\r"}) EXPECT_EQ(csvText("a" + end), "\"a" + end + "\"");
  EXPECT_EQ(csvText("\""), "\"\"\"\"");
  EXPECT_EQ(csvText("a;b c\td"), "a;b c\td");
  EXPECT_EQ(csvText(""), "");
}

} // namespace pcl_bsh::io

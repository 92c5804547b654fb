// SPDX-License-Identifier: BSD-3-Clause
#include "defect.h"

#include <pcl_bsh/io/text/parse_number.h>

#include <clocale>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace pcl_bsh::io {

TEST(ParseNumber, NumbersRoundOnce)
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

TEST(ParseNumber, KnowsWhatProgramsWriteForNaNAndInfinity)
{
  for (const char* nan : {"1.#QNAN", "-1.#IND",  "1.#SNAN",   "-1.#QNAN0", "1.#IND00", "+1.#QNAN",    "1.#NAN",
                          "1.#qnan", "nan(ind)", "-nan(ind)", "nan(snan)", "NaN(IND)", "nan(0x7ff8)", "NaNQ",
                          "NANS",    "-nanq",    "QNaN",      "1.#QO",     "1.#R",     "-1.#J"}) {
    EXPECT_TRUE(std::isnan(parseNumber<double>(nan))) << nan;
    EXPECT_TRUE(std::isnan(parseNumber<float>(nan))) << nan;
    EXPECT_TRUE(looksLikeNumber(nan)) << nan;
    EXPECT_THROW(parseNumber<std::int32_t>(nan), FormatError) << nan << " in a type that has no NaN";
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const char* positive : {"1.#INF", "1.#INF00", "+1.#INF", "1.#inf", "inf", "Infinity"})
    EXPECT_EQ(parseNumber<double>(positive), infinity) << positive;
  for (const char* negative : {"-1.#INF", "-1.#INF000", "-inf"})
    EXPECT_EQ(parseNumber<double>(negative), -infinity) << negative;
  for (const char* other :
       {"1.#", "1.#X", "1.#0", "2.#QNAN", "1#QNAN", "1.#QNAN5", "1.5#QNAN", "--1.#IND", "nan(ind", "nan)", "nan(i-d)"})
    EXPECT_THROW(parseNumber<double>(other), FormatError) << other;
  EXPECT_THROW(parseNumber<double>("1.#INF" + std::string(100'000, '0')), FormatError);
}

TEST(ParseNumber, TellsTooSmallFromTooLarge)
{
  for (const char* tiny : {"1e-400", "-1e-99999999999999999999", "0.5e-400", "123456e-5000", "0e99999999999999999999"})
    EXPECT_EQ(parseNumber<double>(tiny), 0) << tiny;
  EXPECT_EQ(parseNumber<double>("0." + std::string(5000, '0') + "1"), 0);
  EXPECT_EQ(parseNumber<double>("0." + std::string(5000, '0') + "1e5001"), 1);
  for (const std::string huge : {"1e400", "-1e99999999999999999999", "0.001e5000"})
    EXPECT_THROW(parseNumber<double>(huge), FormatError) << huge;
  EXPECT_THROW(parseNumber<double>(std::string(5000, '9')), FormatError);
  EXPECT_THROW(parseNumber<double>("1e-400x"), FormatError);
}

TEST(ParseNumber, TheHostsLanguageDoesNotMatter)
{
  // A language with decimal commas: of the system, or compiled for this test.
  const TemporaryFolder folder;
  const char* name = setlocale(LC_ALL, "de_DE.UTF-8");
  if (name == nullptr) {
    const std::string compile = "localedef -i de_DE -f UTF-8 '" + (folder / "de_DE.UTF-8").string() + "' 2>/dev/null";
    if (std::system(compile.c_str()) != 0) GTEST_SKIP() << "no language with decimal commas";
    setenv("LOCPATH", folder.path().c_str(), 1);
    name = setlocale(LC_ALL, "de_DE.UTF-8");
    unsetenv("LOCPATH");
  }
  if (name == nullptr) GTEST_SKIP() << "no language with decimal commas";
  const bool commas = *localeconv()->decimal_point == ',';
  const double read = parseNumber<double>("1.5"), tiny = parseNumber<double>("1.5e-400");
  const float small = parseNumber<float>("1.5e-60");
  setlocale(LC_ALL, "C");
  EXPECT_TRUE(commas);
  EXPECT_EQ(read, 1.5);
  EXPECT_EQ(tiny, 0);
  EXPECT_EQ(small, 0);
}

TEST(ParseNumber, TellsWhatIsMeantForANumber)
{
  for (const char* word : {"1", "-1.5", "1,5", "+.5x", "nan", "inf", "2nd", "--1"})
    EXPECT_TRUE(looksLikeNumber(word)) << word;
  for (const char* word : {"", "x", "column_4", "-", "a1"}) EXPECT_FALSE(looksLikeNumber(word)) << word;
}

TEST(ParseNumber, RefusesWhatIsNoNumberOfTheType)
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

TEST(ParseNumber, ExponentsMayHaveAPlus)
{
  EXPECT_EQ(parseNumber<double>("1e+3"), 1000);
  for (const char* huge : {"1e+400", "0.0001e+5000", "-0.001e+99999999999999999999"})
    EXPECT_THROW(parseNumber<double>(huge), FormatError) << huge;
  EXPECT_EQ(parseNumber<double>("0." + std::string(500, '0') + "1e+100"), 0);
}

TEST(ParseNumber, TellsWhatToDo)
{
  const auto remedyOf = [](const char* word) -> std::string {
    try {
      parseNumber<double>(word);
    }
    catch (const FormatError& error) {
      return error.remedy();
    }
    return "";
  };
  for (const char* mixed : {"1,5", "1;5", "1 5", "1\t5"})
    EXPECT_EQ(remedyOf(mixed), "write a decimal point, and one separator in all lines") << mixed;
  EXPECT_EQ(remedyOf("3#note"), "put a blank before a comment");
  for (const char* damaged : {"abc", "1.5x", "", "1e400"}) EXPECT_EQ(remedyOf(damaged), remedy_for_damage) << damaged;
}

TEST(ParseNumber, EachDigitLooksLikeANumber)
{
  for (char digit = '0'; digit <= '9'; ++digit) {
    EXPECT_TRUE(looksLikeNumber(std::string("-") + digit + "a")) << digit;
    EXPECT_TRUE(parseNumber<double>(std::string("0.") + digit + "e-400") == 0.0) << digit;
  }
  for (const char* word : {"/1", ":1", "-", "+.", "-x1"}) EXPECT_FALSE(looksLikeNumber(word)) << word;
}

TEST(ParseNumber, KnowsWhatIsBelowOne)
{
  for (const char* below : {"0", "0.0", "000", "0e9", ".0e99999999999999999999", "-0.5", "0.999", ".9", "0.1e0", "1e-1",
                            "10e-2", "99.9e-3", "0.0001e3", "-9e-99999999999999999999", "1E-1"})
    EXPECT_TRUE(isBelowOne(below)) << below;
  for (const char* above :
       {"1", "-1.0", "0.1e1", "1e0", "10e-1", "100.5e-2", "0.0001e4", "1e+0", "0.1e+99999999999999999999", "1E1", "01"})
    EXPECT_FALSE(isBelowOne(above)) << above;
}

} // namespace pcl_bsh::io

// SPDX-License-Identifier: BSD-3-Clause
#include "defect.h"

#include <pcl_bsh/io/text/number_line.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <array>
#include <cstring>

namespace pcl_bsh::io {

TEST(TextCursor, WalksWordsOfLinesOfAllSystems)
{
  TextCursor text("  one\ttwo \n\n \r\nthree\rfour # five\n# six\nseven", '#');
  std::vector<std::string> words;
  while (text.nextLine()) {
    while (!text.line().empty()) words.emplace_back(text.word());
    words.emplace_back("/");
  }
  EXPECT_EQ(words, (std::vector<std::string>{"one", "two", "/", "three", "/", "four", "/", "seven", "/"}));
  EXPECT_TRUE(text.word().empty());
}

TEST(TextCursor, ACommentBeginsBehindWhiteSpace)
{
  TextCursor text("1.#QNAN 2 # 3\n#4\n \t# 5\na#b#c\t#d e#f\n6 ## 7\n8#\n#", '#');
  std::string words;
  while (text.nextLine()) {
    while (!text.line().empty()) words += std::string(text.word()) + ' ';
    words += '/';
  }
  EXPECT_EQ(words, "1.#QNAN 2 /a#b#c /6 /8# /");
}

TEST(TextCursor, SkipsTheMarkOfUtf8AtItsBeginningAlone)
{
  TextCursor text("\xef\xbb\xbf"
                  "1 2\n\xef\xbb\xbf"
                  "3");
  ASSERT_TRUE(text.nextLine());
  EXPECT_EQ(text.number<int>(), 1);
  EXPECT_EQ(text.number<int>(), 2);
  ASSERT_TRUE(text.nextLine());
  EXPECT_THROW(text.number<int>(), FormatError);
  TextCursor nothing("\xef\xbb\xbf");
  EXPECT_FALSE(nothing.nextLine());
}

TEST(TextCursor, TakesOneSeparatorAndNoOther)
{
  TextCursor text("1 , 2,,x y,\n1;2\n , ,\n\t \n");
  text.separateBy(',');
  ASSERT_TRUE(text.nextLine());
  EXPECT_EQ(text.number<int>(), 1);
  EXPECT_EQ(text.number<double>(), 2);
  EXPECT_EQ(defectOf([&] { text.number<int>(); }), "line 1 has an empty value");
  EXPECT_EQ(text.word(), "x y");
  EXPECT_NO_THROW(text.requireEndOfLine()) << "one at the end separates nothing";
  ASSERT_TRUE(text.nextLine());
  EXPECT_EQ(defectOf([&] { text.number<double>(); }), "line 2 is damaged: '1;2' is not a number");
  ASSERT_TRUE(text.nextLine());
  EXPECT_EQ(text.word(), "");
  EXPECT_FALSE(text.line().empty());
  EXPECT_FALSE(text.nextLine()) << "blanks alone are no line";

  TextCursor tabs("1\t\t3 \t4");
  tabs.separateBy('\t');
  ASSERT_TRUE(tabs.nextLine());
  for (const char* word : {"1", "", "3", "4"}) EXPECT_EQ(tabs.word(), word);
}

TEST(TextCursor, TakesQuotesOffInPairs)
{
  TextCursor text("\"1\",\"2,3\",\"\n\"4,\"\"5\" , 6\",7\n\"8,9\n,\"1,2\"\n");
  text.separateBy(',');
  ASSERT_TRUE(text.nextLine());
  for (const char* word : {"1", "2,3", "\""}) EXPECT_EQ(text.word(), word);
  ASSERT_TRUE(text.nextLine());
  for (const char* word : {"4,\"\"5", "6\"", "7"}) EXPECT_EQ(text.word(), word);
  ASSERT_TRUE(text.nextLine());
  for (const char* word : {"\"8", "9"}) EXPECT_EQ(text.word(), word);
  ASSERT_TRUE(text.nextLine());
  for (const char* word : {"", "1,2"}) EXPECT_EQ(text.word(), word);
}

TEST(TextCursor, ALineIsFromItsFirstWordToItsLast)
{
  TextCursor text("  a b \t \r\n \t\n c #d", '#');
  ASSERT_TRUE(text.nextLine());
  EXPECT_EQ(text.line(), "a b");
  EXPECT_EQ(text.word(), "a");
  EXPECT_EQ(text.line(), "b");
  ASSERT_TRUE(text.nextLine());
  EXPECT_EQ(text.line(), "c");
}

TEST(TextCursor, TakesEmptyWordsAlone)
{
  TextCursor text("1,,\"\",4,\n5\n6,\n");
  text.separateBy(',');
  ASSERT_TRUE(text.nextLine());
  EXPECT_FALSE(text.takeEmptyWord());
  EXPECT_EQ(text.number<int>(), 1);
  EXPECT_TRUE(text.takeEmptyWord());
  EXPECT_TRUE(text.takeEmptyWord()) << "in quotes";
  EXPECT_FALSE(text.takeEmptyWord());
  EXPECT_EQ(text.number<int>(), 4);
  EXPECT_TRUE(text.takeEmptyWord()) << "behind the last separator";
  EXPECT_FALSE(text.takeEmptyWord()) << "once";
  ASSERT_TRUE(text.nextLine());
  EXPECT_EQ(text.number<int>(), 5);
  EXPECT_FALSE(text.takeEmptyWord()) << "no separator behind the last word";
  ASSERT_TRUE(text.nextLine());
  EXPECT_EQ(text.number<int>(), 6);
  EXPECT_FALSE(text.nextLine());
  EXPECT_FALSE(TextCursor("").takeEmptyWord());
  TextCursor blanks("1  2 ");
  ASSERT_TRUE(blanks.nextLine());
  EXPECT_EQ(blanks.number<int>(), 1);
  EXPECT_FALSE(blanks.takeEmptyWord());
}

TEST(TextCursor, ALineTellsItsSeparator)
{
  EXPECT_EQ(separatorOf("1,5;2,5"), ';');
  EXPECT_EQ(separatorOf("1, 2, 3"), ',');
  EXPECT_EQ(separatorOf("1\t2\t3"), '\t');
  EXPECT_EQ(separatorOf("1\t2 3"), ' ');
  EXPECT_EQ(separatorOf("1"), ' ');
}

TEST(TextCursor, SkipsAByteOrderMark)
{
  TextCursor text("\xef\xbb\xbf"
                  "1 2");
  ASSERT_TRUE(text.nextLine());
  EXPECT_EQ(text.number<int>(), 1);
  for (const char* mark : {"\xff\xfe", "\xfe\xff"})
    EXPECT_EQ(defectOf([&] { TextCursor(std::string(mark) + "1"); }), "is UTF-16 text");
}

TEST(TextCursor, RestBeginsBehindTheLine)
{
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    const std::string file = "header" + end + "\x01 body";
    TextCursor text(file);
    ASSERT_TRUE(text.nextLine());
    EXPECT_EQ(text.rest(), "\x01 body");
  }
}

TEST(TextCursor, LinesOfNumbersAreReadAsTheirWordsAre)
{
  const std::vector<std::string> lines = {
      "1 2 3",     " 1\t2 3 ",
      "1,2,3",     "1 , 2,\t3",
      "1;2;3",     "1\t2\t3",
      "1\t\t3",    "1e5 -.5 5.",
      "+1 2 3",    "1 2",
      "1 2 3 4",   "1 2 x",
      "1 2 3x",    "nan inf 1",
      "1e400 1 1", "1e-400 1 1",
      "1,2,",      "1,,3",
      "0x10 1 1",  "1 2 3#c",
      "",          "  ",
      "1 2,3",     "-nan 0 -0",
      "\"1\",2,3", "1.7976931348623157e308 4.9e-324 123456789012345678901234567890"};
  for (const char separator : {' ', ',', ';', '\t'}) {
    for (const std::string end : {"", "\n", "\r\n", "\r", "\n7 8 9", "\r7"}) {
      for (const std::string& line : lines) {
        const std::string text = line + end;
        TextCursor fast(text), slow(text);
        fast.separateBy(separator);
        slow.separateBy(separator);
        std::array<double, 3> values{};
        if (!fast.nextNumbers(values)) continue;
        ASSERT_TRUE(slow.nextLine()) << text;
        for (const double value : values) {
          const double word = slow.number<double>();
          EXPECT_EQ(std::memcmp(&word, &value, sizeof word), 0) << text;
        }
        slow.requireEndOfLine();
        EXPECT_EQ(fast.rest(), slow.rest()) << text;
      }
    }
  }
  std::array<double, 3> values{};
  TextCursor text("1 2 3\n4 5 6\nx\n");
  EXPECT_TRUE(text.nextNumbers(values) && text.nextNumbers(values));
  EXPECT_EQ(values[2], 6);
  EXPECT_FALSE(text.nextNumbers(values));
  ASSERT_TRUE(text.nextLine());
  EXPECT_EQ(text.line(), "x");
  EXPECT_EQ(defectOf([&] { text.number<int>(); }).find("line 3"), 0U);
  TextCursor begun("a b\n1 2 3\n");
  ASSERT_TRUE(begun.nextLine());
  EXPECT_EQ(begun.word(), "a");
  ASSERT_TRUE(begun.nextNumbers(values));
  EXPECT_EQ(begun.line(), "") << "what was left of the line before is gone";
}

TEST(TextCursor, ErrorsNameTheLine)
{
  TextCursor text("1 2\r\n\r\n3 x 5\n");
  text.nextLine();
  text.nextLine();
  EXPECT_EQ(text.number<int>(), 3);
  EXPECT_EQ(defectOf([&] { text.number<int>(); }),
            "line 3 is damaged: 'x' is not a whole number in the range of its type");
  EXPECT_EQ(defectOf([&] { text.requireEndOfLine(); }), "line 3 has more values than it should, from '5' on");
  EXPECT_EQ(text.number<int>(), 5);
  EXPECT_EQ(defectOf([&] { text.number<int>(); }), "line 3 has fewer values than it should");
}

/// Not by way of words: such lines are read at once.
TEST(NumberLine, IsReadWithItsEnd)
{
  std::array<double, 2> values{};
  const std::pair<const char*, std::size_t> blanks[] = {{"1 2", 3},     {"1 2\n3", 4}, {" 1\t2 \r\n", 7}, {"1 2\r3", 4},
                                                        {"1 2\r\n", 5}, {"1", 0},      {"1 2 3", 0},      {"1 x", 0},
                                                        {"", 0},        {"+1 2", 0},   {"1 1e400", 0},    {"1,2", 0}};
  for (const auto& [text, bytes] : blanks) EXPECT_EQ(readNumberLine(text, ' ', values), bytes) << text;
  const std::pair<const char*, std::size_t> commas[] = {{"1,2", 3},  {" 1 , 2 \n", 8}, {"1 2", 0},
                                                        {"1,,2", 0}, {"1,2,", 0},      {",1", 0}};
  for (const auto& [text, bytes] : commas) EXPECT_EQ(readNumberLine(text, ',', values), bytes) << text;
  EXPECT_EQ(readNumberLine("1\t2\n", '\t', values), 4U);
  EXPECT_EQ(readNumberLine("1\t\t2\n", '\t', values), 0U);
  EXPECT_EQ(readNumberLine("3 4\n", ' ', values), 4U);
  EXPECT_EQ(values, (std::array<double, 2>{3, 4}));
}

} // namespace pcl_bsh::io

// SPDX-License-Identifier: BSD-3-Clause
#include "samples.h"

#include <pcl_bsh/filters/io/text_cursor.h>

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

TEST(TextCursor, TakesOtherSeparators)
{
  TextCursor text("1,2;  3", 0, ",;");
  ASSERT_TRUE(text.nextLine());
  EXPECT_EQ(text.number<int>(), 1);
  EXPECT_EQ(text.number<double>(), 2);
  EXPECT_NO_THROW(text.number<int>());
  EXPECT_NO_THROW(text.requireEndOfLine());
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

} // namespace pcl_bsh::io

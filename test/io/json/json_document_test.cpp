// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/json/json_document.h>
#include <pcl_bsh/io/text/format_error.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pcl_bsh::io {

using testing::HasSubstr;
using testing::ThrowsMessage;

auto refusedWith(const std::string& text)
{
  return ThrowsMessage<FormatError>(HasSubstr(text));
}

TEST(JsonDocument, CommentsAreIgnored)
{
  EXPECT_EQ(parseJson("// one\n[1, /* two */ 2]").dump(), "[1,2]");
}

TEST(JsonDocument, SkipsAByteOrderMark)
{
  EXPECT_EQ(parseJson("\xef\xbb\xbf[1]").dump(), "[1]");
}

TEST(JsonDocument, RefusesWhatIsNoJson)
{
  EXPECT_THAT([] { parseJson("{\"a\": 1,\n \"b\" 2}"); }, refusedWith("is no JSON: line 2, column 6: "));
  EXPECT_THAT([] { parseJson(""); }, refusedWith("is no JSON: "));
  EXPECT_THAT([] { parseJson("[1] []"); }, refusedWith("is no JSON: "));
  EXPECT_THAT([] { parseJson("[1e999]"); }, refusedWith("is no JSON: "));
  EXPECT_THAT([] { parseJson("[\"\xff\"]"); }, refusedWith("is no JSON: "));
}

TEST(JsonDocument, RefusesAKeySaidTwice)
{
  EXPECT_THAT([] { parseJson(R"({"a": 1, "a": 2})"); }, refusedWith("says the key \"a\" twice in one object"));
  EXPECT_EQ(parseJson(R"([{"a": 1}, {"a": {"a": 2}}])").size(), 2U);
}

TEST(JsonDocument, RefusesEndlessNesting)
{
  EXPECT_THAT([] { parseJson(std::string(1000000, '[')); }, refusedWith("nests deeper than 100 levels"));
  EXPECT_EQ(parseJson(std::string(100, '[') + std::string(100, ']')).size(), 1U);
}

TEST(JsonDocument, ShowsValuesOnOneShortLine)
{
  EXPECT_EQ(shown(Json("a\nb")), "\"a\\nb\"");
  EXPECT_EQ(shown(Json("\xff")).find('\xff'), std::string::npos);
  EXPECT_LT(shown(Json(std::string(1000, 'a'))).size(), 70U);
}

TEST(JsonDocument, ReplacesWhatIsNoUtf8)
{
  EXPECT_EQ(validUtf8("h\xc3\xa4user \xe2\x82\xac"), "h\xc3\xa4user \xe2\x82\xac");
  EXPECT_EQ(validUtf8("a\xff"
                      "b\xc3"),
            "a\xef\xbf\xbd"
            "b\xef\xbf\xbd");
  EXPECT_EQ(validUtf8(std::string("a\0\n", 3)), std::string("a\0\n", 3));
}

TEST(JsonDocument, ShowsUpToSixtyCharactersWhole)
{
  const std::string longest(58, 'a'); // and two quotes
  EXPECT_EQ(shown(Json(longest)), "\"" + longest + "\"");
  EXPECT_EQ(shown(Json(longest + "a")), "\"" + longest + "a...");
}

TEST(JsonDocument, IsPrintedWithLinesAndLettersAsTheyAre)
{
  EXPECT_EQ(printed(Json{{"a", "\xc3\xa4"}}), "{\n  \"a\": \"\xc3\xa4\"\n}\n");
  EXPECT_EQ(shown(Json("\xc3\xa4")), "\"\\u00e4\"") << "messages are for any terminal";
}

TEST(JsonDocument, KeysOfObjectsThatWereClosedDoNotCount)
{
  EXPECT_EQ(parseJson(R"({"a": {"b": 1}, "c": {"b": 2}, "b": 3})").size(), 3U);
  EXPECT_THAT([] { parseJson(R"({"a": {"b": 1}, "c": 1, "a": 3})"); }, refusedWith("the key \"a\" twice"));
  EXPECT_EQ(parseJson(std::string(101, '[') + std::string(101, ']')).size(), 1U);
  EXPECT_THAT([] { parseJson(std::string(102, '[') + std::string(102, ']')); }, refusedWith("nests deeper than 100"));
}

} // namespace pcl_bsh::io

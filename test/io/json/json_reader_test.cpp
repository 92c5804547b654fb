// SPDX-License-Identifier: BSD-3-Clause
// Values that are read of a document, and the place, the fault and the remedy of a refusal.
#include <pcl_bsh/io/json/json_reader.h>

#include <gmock/gmock.h>

#include <functional>

namespace pcl_bsh::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class JsonReaderTest : public testing::Test {
protected:
  JsonReader of(const std::string& text)
  {
    json = parseJson(text);
    return {json, name};
  }

  static std::string faultOf(const std::function<void()>& read)
  {
    try {
      read();
    }
    catch (const JsonError& error) {
      return error.what();
    }
    return "";
  }

  Json json;
  std::string name = "d.json";
  std::vector<std::string> warnings;
};

TEST_F(JsonReaderTest, NamesTheFileThePlaceTheFaultAndTheRemedyOnOneLine)
{
  const JsonReader document = of(R"({"a": [{"b": 1}, {"b": [2, "x"]}]})");
  EXPECT_EQ(document.place(), "");
  const JsonReader word = document.at("a").elements()[1].at("b").elements()[1];
  EXPECT_EQ(word.place(), "a[1].b[1]");
  EXPECT_EQ(faultOf([&] { word.number(); }), "d.json: a[1].b[1]: \"x\" is no number: give one");
  EXPECT_EQ(faultOf([&] { document.fail("is\nwrong", "mend it"); }).find('\n'), std::string::npos);
  EXPECT_EQ(faultOf([] { parseJson("[", "e.json"); }).find("e.json: is no JSON: "), 0U);
}

TEST_F(JsonReaderTest, KeysAreThoseOfAList)
{
  const JsonReader document = of(R"({"first": 1, "second": 2})");
  document.requireKeys({"second", "third", "first"});
  EXPECT_EQ(faultOf([&] {
              document.requireKeys({"first", "seconds"});
            }),
            "d.json: key 'second' is unknown: did you mean 'seconds'?");
  EXPECT_EQ(faultOf([&] {
              of("[]").requireKeys({"a", "b"});
            }),
            "d.json: [] is no object: give { ... } with any of a, b");
  EXPECT_EQ(faultOf([&] { of(R"({"a": 1})").at("b"); }), "d.json: 'b' is missing: add it");
  EXPECT_EQ(faultOf([&] { of("7").at("b"); }), "d.json: 'b' is missing: add it");
  EXPECT_TRUE(of(R"({"a": null})").has("a"));
  EXPECT_FALSE(of(R"({"a": null})").has("b"));
}

TEST_F(JsonReaderTest, MembersAndElementsKnowTheirPlaces)
{
  const auto members = of(R"({"a": {"c": 1}, "b": 2})").members();
  ASSERT_EQ(members.size(), 2U);
  EXPECT_EQ(members[0].first, "a");
  EXPECT_EQ(members[0].second.at("c").place(), "a.c");
  EXPECT_EQ(members[1].second.number(), 2.0);
  EXPECT_EQ(faultOf([&] { of("[]").members(); }), "d.json: [] is no object: give { ... }");
  EXPECT_EQ(faultOf([&] { of("{}").elements(); }), "d.json: {} is no list: give [ ... ]");
  EXPECT_EQ(elementsOf(of(R"({"a": [1, 2]})"), "a").size(), 2U);
  EXPECT_THAT(elementsOf(of(R"({"a": [1, 2]})"), "b"), IsEmpty());
}

TEST_F(JsonReaderTest, NumbersHaveLimitsInclusive)
{
  EXPECT_EQ(of("1.5").number(1.5, 1.5), 1.5);
  EXPECT_EQ(faultOf([&] { of("1.5").number(1.75, 2); }), "d.json: 1.5 is too small: give at least 1.75");
  EXPECT_EQ(faultOf([&] { of("1.5").number(1, 1.25); }), "d.json: 1.5 is too large: give at most 1.25");
  EXPECT_EQ(of("-1e300").number(), -1e300);
  EXPECT_THAT(faultOf([&] { of("-1.1e300").number(); }), HasSubstr("too small"));
  EXPECT_THAT(faultOf([&] { of("1.1e300").number(); }), HasSubstr("too large"));
  EXPECT_EQ(of("3.0").whole(3, 3), 3U);
  EXPECT_EQ(faultOf([&] { of("3.5").whole(3, 4); }), "d.json: 3.5 is no whole number: give one");
  EXPECT_THAT(faultOf([&] { of("2").whole(3, 4); }), HasSubstr("too small"));
  EXPECT_THAT(faultOf([&] { of("5").whole(3, 4); }), HasSubstr("too large"));
  EXPECT_EQ(faultOf([&] { of("true").number(); }), "d.json: true is no number: give one");
}

TEST_F(JsonReaderTest, WordsAndTruthsAreOfTheirType)
{
  EXPECT_TRUE(of("true").boolean());
  EXPECT_FALSE(of("false").boolean());
  EXPECT_EQ(faultOf([&] { of("0").boolean(); }), "d.json: 0 is neither true nor false: give one of them");
  EXPECT_EQ(of(R"("a b")").text(), "a b");
  EXPECT_EQ(faultOf([&] { of(R"("")").text(); }), R"(d.json: "" is no text: give "...")");
  EXPECT_EQ(faultOf([&] { of("1").text(); }), R"(d.json: 1 is no text: give "...")");
  EXPECT_EQ(of(R"("left")").oneOf({"right", "left"}), "left");
  EXPECT_EQ(faultOf([&] {
              of(R"("lift")").oneOf({"right", "left"});
            }),
            "d.json: 'lift' is unknown: did you mean 'left'?");
}

TEST_F(JsonReaderTest, ListsOfNumbersAreAsLongAsAskedFor)
{
  EXPECT_THAT(of("[1, -2.5]").numbers(2), ElementsAre(1.0, -2.5));
  EXPECT_EQ(faultOf([&] { of("[1]").numbers(2); }), "d.json: [1] is no list of 2 numbers: give [ ... ]");
  EXPECT_EQ(faultOf([&] { of("[1, 2]").numbers(1); }), "d.json: [1,2] is no list of 1 number: give [ ... ]");
  EXPECT_EQ(faultOf([&] { of("1").numbers(1); }), "d.json: 1 is no list of 1 number: give [ ... ]");
  EXPECT_EQ(faultOf([&] { of("[1, null]").numbers(2); }), "d.json: [1]: null is no number: give one");
  EXPECT_EQ(of("[1, 2, 3]").vector(), Eigen::Vector3d(1, 2, 3));
}

TEST_F(JsonReaderTest, MembersThatAreThereReplaceDefaults)
{
  double number = 7;
  bool truth = true;
  std::string text = "old";
  Eigen::Vector3d vector(1, 1, 1);
  unsigned count = 3;
  const JsonReader nothing = of("{}");
  read(nothing, "n", number), read(nothing, "b", truth), read(nothing, "t", text), read(nothing, "v", vector);
  readCount(nothing, "c", count);
  EXPECT_EQ(number, 7);
  EXPECT_TRUE(truth);
  EXPECT_EQ(text, "old");
  EXPECT_EQ(vector, Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(count, 3U);
  const JsonReader all = of(R"({"n": 1.5, "b": false, "t": "new", "v": [1, 2, 3], "c": 9})");
  read(all, "n", number), read(all, "b", truth), read(all, "t", text), read(all, "v", vector);
  readCount(all, "c", count);
  EXPECT_EQ(number, 1.5);
  EXPECT_FALSE(truth);
  EXPECT_EQ(text, "new");
  EXPECT_EQ(vector, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(count, 9U);
}

TEST_F(JsonReaderTest, PosesAreOfThreeSixTwelveOrSixteenNumbers)
{
  const auto pose = [&](const std::string& text) { return of(text).pose(warnings); };
  Eigen::Isometry3d quarter = Eigen::Isometry3d::Identity();
  quarter.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  quarter.translation() = Eigen::Vector3d(1, 2, 3);
  EXPECT_EQ(pose("[1, 2, 3]").translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(pose("[1, 2, 3]").linear(), Eigen::Matrix3d::Identity());
  EXPECT_TRUE(pose("[1, 2, 3, 0, 0, 1.5707963267948966]").isApprox(quarter, 1e-15));
  EXPECT_EQ(pose("[0, -1, 0, 1,  1, 0, 0, 2,  0, 0, 1, 3]").matrix(), quarter.matrix());
  EXPECT_EQ(pose("[0, -1, 0, 1,  1, 0, 0, 2,  0, 0, 1, 3,  0, 0, 0, 1]").matrix(), quarter.matrix());
  EXPECT_THAT(warnings, IsEmpty());
  for (const char* text : {"[]", "[1, 2]", "[1, 2, 3, 4]", "[1, 2, 3, 4, 5, 6, 7]", "7", "{}"})
    EXPECT_THAT(faultOf([&] { pose(text); }), HasSubstr("is no pose: give [x, y, z], ")) << text;
  EXPECT_EQ(faultOf([&] { pose("[2, 0, 0, 0,  0, 1, 0, 0,  0, 0, 1, 0]"); }),
            "d.json: is no rigid transform: give a rotation without scale or mirror, and 0 0 0 1 as last row");
  EXPECT_THAT(faultOf([&] { pose("[1, 0, 0, 0,  0, 1, 0, 0,  0, 0, 1, 0,  0, 0, 0, 2]"); }), HasSubstr("no rigid"));
}

TEST_F(JsonReaderTest, PosesTellWhatIsOddOfThem)
{
  of(R"({"at": [0, 0, 0, 0, 0, 90]})").at("at").pose(warnings);
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].find("at: "), 0U) << warnings[0];
  of(R"({"at": [1, 1e-5, 0, 0,  0, 1, 0, 0,  0, 0, 1, 0]})").at("at").pose(warnings);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_THAT(warnings[1], testing::AllOf(testing::StartsWith("at: "), HasSubstr("|R'R - I| is ")));
}

} // namespace
} // namespace pcl_bsh::io

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/option_json.h>

#include "io/clouds/samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace pcl_bsh::pipeline {
namespace {

using testing::HasSubstr;

/// An option of each kind.
struct Everything : Stage {
  bool flag = true;
  int integer = -3;
  unsigned natural = 3;
  double length = 0.5;
  std::string text = "a";
  std::string choice = "free";
  Limits limits = {{}, 2.0};
  std::int64_t stamp = 0;
  Numbers<3> place = {1, 2, 3};
  Size3 size;
  Pose pose;
  InputFile in;
  OutputFile out;
  std::optional<OutputFile> also;
  double share = 0.25, slope = 1, angle = 0, far = 0, high = 0;
  OtherCloud other;
  std::optional<double> maybe;
  LengthOrField sigma;

  StageCloudPtr run(StageClouds&& inputs) override { return inputs[0]; }
};

const StageType& everything()
{
  static const StageType type = describe<Everything>("filters.everything", "All kinds of options.")
                                    .option(&Everything::flag, "flag", "")
                                    .option(&Everything::integer, "integer", "")
                                    .atMost(10)
                                    .option(&Everything::natural, "natural", "")
                                    .option(&Everything::length, "length", "")
                                    .unit("m")
                                    .above(0)
                                    .option(&Everything::text, "text", "")
                                    .option(&Everything::choice, "choice", "")
                                    .choices({"free", "colliding"})
                                    .option(&Everything::limits, "limits", "")
                                    .option(&Everything::place, "place", "")
                                    .option(&Everything::size, "size", "")
                                    .above(0)
                                    .option(&Everything::pose, "pose", "")
                                    .option(&Everything::in, "in", "")
                                    .option(&Everything::out, "out", "")
                                    .option(&Everything::also, "also", "")
                                    .option(&Everything::share, "share", "")
                                    .above(0)
                                    .atMost(0.5)
                                    .option(&Everything::slope, "slope", "")
                                    .atLeast(1e-7)
                                    .option(&Everything::angle, "angle", "")
                                    .atLeast(-2)
                                    .atMost(3)
                                    .option(&Everything::far, "far", "")
                                    .atLeast(-1e9)
                                    .option(&Everything::high, "high", "")
                                    .atMost(1e9)
                                    .option(&Everything::other, "other", "")
                                    .option(&Everything::maybe, "maybe", "")
                                    .option(&Everything::sigma, "sigma", "")
                                    .atLeast(0)
                                    .option(&Everything::stamp, "stamp", "");
  return type;
}

/// Sets the option and reads it back.
std::string through(const std::string& name, const std::string& json)
{
  const Option& option = *everything().findOption(name);
  Everything stage;
  option.set(stage, valueOf(io::parseJson(json), option));
  return jsonOf(option.get(stage)).dump();
}

std::string refusal(const std::string& name, const std::string& json)
{
  try {
    valueOf(io::parseJson(json), *everything().findOption(name));
  }
  catch (const std::invalid_argument& error) {
    return error.what();
  }
  ADD_FAILURE() << name << " " << json << " was accepted";
  return {};
}

TEST(OptionJson, EachKindGoesInAndOut)
{
  for (const auto& [name, json] :
       std::vector<std::pair<std::string, std::string>>{{"flag", "false"},
                                                        {"integer", "-7"},
                                                        {"natural", "4000000000"},
                                                        {"length", "0.1"},
                                                        {"text", "\"any\""},
                                                        {"choice", "\"colliding\""},
                                                        {"limits", "[null,0.5]"},
                                                        {"limits", "[-9007199254740993,18446744073709551615]"},
                                                        {"stamp", "1700000000000000001"},
                                                        {"stamp", "-9223372036854775808"},
                                                        {"share", "0.5"},
                                                        {"slope", "1e-07"},
                                                        {"angle", "-2.0"},
                                                        {"angle", "3.0"},
                                                        {"also", "null"},
                                                        {"also", "\"null\""},
                                                        {"place", "[0.1,-2.0,1e-300]"},
                                                        {"size", "[0.1,0.2,0.3]"},
                                                        {"in", "\"a.pcd\""},
                                                        {"out", "\"b.pcd\""},
                                                        {"other", "\"tag\""},
                                                        {"sigma", "0.25"},
                                                        {"sigma", "\"sigma\""},
                                                        {"maybe", "null"},
                                                        {"maybe", "0.25"}}) {
    EXPECT_EQ(through(name, json), json) << name;
  }
  EXPECT_EQ(through("size", "0.25"), "[0.25,0.25,0.25]");
  EXPECT_EQ(through("integer", "3.0"), "3");
  EXPECT_EQ(through("stamp", "-9007199254740992.0"), "-9007199254740992") << "-2^53";
  EXPECT_EQ(through("pose", "[1, 2, 3, 0, 0, 0]"), "[1.0,0.0,0.0,1.0,0.0,1.0,0.0,2.0,0.0,0.0,1.0,3.0,0.0,0.0,0.0,1.0]");
  EXPECT_EQ(through("pose", "[1, 0, 0, 4, 0, 1, 0, 5, 0, 0, 1, 6]"),
            "[1.0,0.0,0.0,4.0,0.0,1.0,0.0,5.0,0.0,0.0,1.0,6.0,0.0,0.0,0.0,1.0]");
}

TEST(OptionJson, DefaultsAreTheMembers)
{
  EXPECT_EQ(jsonOf(everything().findOption("integer")->standard).dump(), "-3");
  EXPECT_EQ(jsonOf(everything().findOption("limits")->standard).dump(), "[null,2.0]");
  EXPECT_EQ(jsonOf(everything().findOption("maybe")->standard).dump(), "null");
}

TEST(OptionJson, RefusesWrongValuesAndSaysWhatIsRight)
{
  EXPECT_EQ(refusal("flag", "1"), "is 1: give true or false");
  EXPECT_EQ(refusal("integer", "\"3\""), "is \"3\": give an integer of at most 10");
  EXPECT_EQ(refusal("integer", "11"), "is 11: give an integer of at most 10");
  EXPECT_EQ(refusal("integer", "1.5"), "is 1.5: give an integer of at most 10");
  EXPECT_EQ(refusal("natural", "-1"), "is -1: give an integer of at least 0");
  EXPECT_EQ(refusal("natural", "4294967296"), "is 4294967296: give an integer of at least 0");
  EXPECT_EQ(refusal("integer", "-3000000000"), "is -3000000000: give an integer of at most 10");
  EXPECT_THAT(refusal("stamp", "9223372036854775808"), HasSubstr("is 9223372036854775808: give an integer"));
  EXPECT_EQ(refusal("length", "0"), "is 0: give a number above 0, in m");
  EXPECT_EQ(refusal("length", "null"), "is null: give a number above 0, in m");
  EXPECT_EQ(refusal("text", "[]"), "is []: give a text");
  EXPECT_EQ(refusal("choice", "\"some\""), "is \"some\": give one of free, colliding");
  EXPECT_EQ(refusal("limits", "[1]"), "is [1]: give [least, most], numbers or null");
  EXPECT_EQ(refusal("place", "[1, 2, \"3\"]"), "is [1,2,\"3\"]: give [x, y, z], numbers");
  EXPECT_EQ(refusal("place", "[1, 2, null]"), "is [1,2,null]: give [x, y, z], numbers");
  EXPECT_EQ(refusal("size", "[1, 2, 0]"), "is [1,2,0]: give a number or [x, y, z], each above 0");
  EXPECT_THAT(refusal("pose", "[1, 2]"), HasSubstr("is [1,2]: give [x, y, z, roll, pitch, yaw]"));
  EXPECT_THAT(refusal("pose", "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]"), HasSubstr("and 0 0 0 1 as the last row"));
  EXPECT_EQ(refusal("pose", "\"none.txt\""), "none.txt: no such file: check the name");
  EXPECT_EQ(refusal("sigma", "-1"), "is -1: give a number of at least 0, or the name of a field");
  EXPECT_EQ(refusal("sigma", "\"\""), "is \"\": give a number of at least 0, or the name of a field");
  EXPECT_EQ(refusal("in", "\"\""), "is \"\": give the name of a file");
  EXPECT_EQ(refusal("in", "\"a\\u0000.pcd\""), "is \"a\\u0000.pcd\": give the name of a file");
}

TEST(OptionJson, SaysRangesAsPeopleWriteThem)
{
  for (const char* const number : {"0", "0.75"})
    EXPECT_EQ(refusal("share", number), "is " + std::string(number) + ": give a number above 0 and up to 0.5");
  EXPECT_EQ(refusal("slope", "0"), "is 0: give a number of at least 1e-07");
  for (const char* const number : {"-3", "4"})
    EXPECT_EQ(refusal("angle", number), "is " + std::string(number) + ": give a number from -2 to 3");
  EXPECT_EQ(refusal("far", "-2e9"), "is -2000000000.0: give a number of at least -1000000000");
  EXPECT_EQ(refusal("high", "2e9"), "is 2000000000.0: give a number") << "as good as none";
}

/// Numbers of programs: documents have none.
TEST(OptionJson, RefusesNumbersThatAreNotFinite)
{
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double number : {infinite, -infinite, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(valueOf(Json(number), *everything().findOption("maybe")), std::invalid_argument) << number;
    EXPECT_THROW(valueOf(Json{1, number, 2}, *everything().findOption("place")), std::invalid_argument) << number;
  }
}

TEST(OptionJson, RefusesWholeNumbersThatDoublesDoNotTellApart)
{
  for (const char* const number : {"9007199254740994.0", "-9007199254740994.0", "1e300"})
    EXPECT_THAT(refusal("stamp", number), HasSubstr("give an integer")) << number;
}

TEST(OptionJson, PosesMayBeFiles)
{
  const io::TemporaryFolder folder;
  const std::string file = folder.write("pose.txt", "1 0 0 4\n0 1 0 5\n0 0 1 6\n").string();
  EXPECT_EQ(through("pose", Json(file).dump()), through("pose", "[4, 5, 6, 0, 0, 0]"));
  folder.write("pose.txt", "1 0 0 4\n0 nan 0 5\n0 0 1 6\n");
  EXPECT_THAT(refusal("pose", Json(file).dump()), HasSubstr("pose.txt"));
}

TEST(OptionJson, TextOfACommandLine)
{
  const auto given = [](const std::string& name, const std::string& text) {
    return jsonOfText(text, *everything().findOption(name)).dump();
  };
  EXPECT_EQ(given("length", "0.5"), "0.5");
  EXPECT_EQ(given("length", "wide"), "\"wide\"") << "for valueOf() to refuse";
  EXPECT_EQ(given("text", "12"), "\"12\"");
  EXPECT_EQ(given("in", "a b.pcd"), "\"a b.pcd\"");
  EXPECT_EQ(given("place", "1,2,3"), "[1,2,3]");
  EXPECT_EQ(given("place", "[1,2,3]"), "[1,2,3]");
  EXPECT_EQ(given("pose", "pose.txt"), "\"pose.txt\"");
  EXPECT_EQ(given("flag", "true"), "true");
  EXPECT_EQ(given("maybe", "null"), "null");
  EXPECT_EQ(given("also", "null"), "null");
  EXPECT_EQ(given("also", "a.csv"), "\"a.csv\"");
  EXPECT_EQ(given("out", "null"), "\"null\"") << "the name of a file";
}

} // namespace
} // namespace pcl_bsh::pipeline

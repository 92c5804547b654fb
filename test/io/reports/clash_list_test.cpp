// SPDX-License-Identifier: BSD-3-Clause
#include "one_list.h"

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/json/json_reader.h>
#include <pcl_bsh/io/reports/clash_list.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/question/options.h>

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <set>

namespace pcl_bsh::io {

using testing::ElementsAre;
using testing::HasSubstr;

namespace {

std::vector<Eigen::Isometry3d> posesAt(const std::vector<double>& stations)
{
  std::vector<Eigen::Isometry3d> poses(stations.size(), Eigen::Isometry3d::Identity());
  for (std::size_t i = 0; i < stations.size(); ++i) poses[i].translation().x() = stations[i];
  return poses;
}

const std::string old_list = R"({"input": "a", "obstacle": "b", "clearance": 1, "swept": null, "clashes": [
  {"id": "A", "status": "new", "points": 3, "box": {"min": [0, 0, 0], "max": [2, 2, 2]}, "distance": 0.5,
   "first_pose": 0, "closest_pose": 0, "closest_pair": {"input": {"point": 7, "at": [0, 1, 2]}}},
  {"id": "B", "status": "resolved", "points": 3, "box": {"min": [4, 0, 0], "max": [6, 2, 2]}, "distance": 0.5,
   "first_pose": 0, "closest_pose": 0}]})";

std::string oldListWith(const std::string& members)
{
  return "{" + members + "," + old_list.substr(1);
}

std::string refusal(const std::string& list)
{
  try {
    parseClashes(list, "old.json");
  }
  catch (const JsonError& error) {
    return error.what();
  }
  ADD_FAILURE() << list << " was read";
  return {};
}

} // namespace

TEST(ClashLists, ScansOfEachWeekAreComparedWithoutAWarning)
{
  ClashList earlier;
  earlier.question.clearance = 0.3;
  earlier.question.obstacle = "wagon_1.ply";
  earlier.survey.emplace();
  const auto warnings = [&](const char* was, const char* is, const char* obstacle = "wagon_1.ply") {
    earlier.question.input = was;
    ClashQuestion now = earlier.question;
    now.input = is;
    now.obstacle = obstacle;
    return requireComparable("old.json", earlier, now);
  };
  for (const auto& [was, is] : {std::pair{"hall_2026-11-20.las", "hall_2026-11-27.las"},
                                {"20261120_hall.ply", "20261127_hall.ply"},
                                {"week 7/scan.pcd", "week 8/scan.pcd"},
                                {"hall_w47.ptx", "hall_w48.ptx"},
                                {"hall.las", "hall_2.las"},
                                {"hall (9).las", "hall (10).las"},
                                {"halle_süd_20.Nov.2026.las", "halle_süd_4.Dec.2026.las"},
                                {"Hall-March-26.las", "Hall-april-2.las"},
                                {"monday.ply", "Tuesday.ply"},
                                {"scan_Mon.pcd", "scan_thu_2.pcd"},
                                {"2026-11-20T10:15:00Z.pcd", "2026-11-27T09:00:01Z.pcd"}})
    EXPECT_THAT(warnings(was, is), testing::IsEmpty()) << was << ' ' << is;
  for (const auto& [was, is] : {std::pair{"hall_1.las", "yard_1.las"},
                                {"north_2026-11-20.las", "south_2026-11-20.las"},
                                {"hall_1.las", "hall_1.ply"},
                                {"hall_a_1.las", "hall_b_1.las"},
                                {"maybe.las", "juneau.las"},
                                {"sunny.las", "monolith.las"},
                                {"1_süd.las", "1_nörd.las"}})
    EXPECT_THAT(warnings(was, is), testing::ElementsAre(HasSubstr("lists clashes of the input"))) << was << ' ' << is;
  EXPECT_THAT(warnings("hall_1.las", "hall_2.las", "wagon_2.ply"),
              testing::ElementsAre(HasSubstr("lists clashes of the obstacle 'wagon_1.ply', now it is 'wagon_2.ply'")))
      << "which may be another wagon";
}

TEST(ClashLists, ListsOfOtherQuestionsAreNotCompared)
{
  ClashList earlier;
  earlier.question.input = "scans/north.ply";
  earlier.question.obstacle = "wagon.ply";
  earlier.question.clearance = 0.3;
  earlier.survey.emplace();
  ClashQuestion now = earlier.question;
  now.input = "/elsewhere/north.ply";
  EXPECT_THAT(requireComparable("old.json", earlier, now), testing::IsEmpty()) << "the same name in another folder";
  now.input = "south.ply";
  now.obstacle = "lorry.ply";
  now.swept = 0.01;
  const std::vector<std::string> warnings = requireComparable("old.json", earlier, now);
  ASSERT_EQ(warnings.size(), 3U);
  EXPECT_THAT(warnings[0], HasSubstr("old.json: lists clashes of the input 'north.ply', now it is 'south.ply': "));
  EXPECT_THAT(warnings[1], HasSubstr("of the obstacle 'wagon.ply', now it is 'lorry.ply': "));
  EXPECT_THAT(warnings[2], HasSubstr("at poses alone, now swept motion is asked"));
  now.clearance = 0.25;
  try {
    requireComparable("old.json", earlier, now);
    ADD_FAILURE() << "was compared";
  }
  catch (const files::FileError& error) {
    EXPECT_STREQ(error.what(),
                 "old.json: lists clashes with clearance 0.3, now it is 0.25: ask with the same clearance, "
                 "or compare with another list");
  }
}

/// As another clearance: what lies between the two would seem new or resolved.
TEST(ClashLists, OfOtherOptionsThatTellWhatCollidesAreNotCompared)
{
  const auto refused = [&](const std::string& option, const std::string& before, const std::string& is) -> std::string {
    ClashList earlier;
    earlier.question.clearance = 0.3;
    earlier.survey.emplace();
    ClashQuestion now = earlier.question;
    setOption(earlier.question, option, before);
    setOption(now, option, is);
    EXPECT_TRUE(requireComparable("old.json", earlier, earlier.question).empty()) << option;
    try {
      requireComparable("old.json", earlier, now);
    }
    catch (const files::FileError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused("uncertainty", "sigma", "0.01"),
            "old.json: lists clashes with uncertainty sigma, now it is 0.01: ask with the same uncertainty, or compare "
            "with another list");
  EXPECT_THAT(refused("solid", "true", "false"), HasSubstr("with solid true, now it is not given"));
  const std::set<std::string> not_clashes = {"swept",       "seen",         "origin", "seen_angle",
                                             "seen_beyond", "max_distance", "threads"};
  for (const QuestionOption& option : questionOptions()) {
    const bool is_switch = std::holds_alternative<bool Question::*>(option.member);
    const bool ignores = std::holds_alternative<IgnoredPoints Question::*>(option.member);
    const std::string before = is_switch                                ? "true"
                               : ignores                                ? "classification=2"
                               : option.name == std::string("accuracy") ? "tolerance=0.01"
                               : option.name == std::string("origin")   ? "1,2,3"
                                                                        : "1";
    const std::string is = is_switch                                ? "false"
                           : ignores                                ? "classification=2,9"
                           : option.name == std::string("accuracy") ? "exact"
                           : option.name == std::string("origin")   ? "3,2,1"
                                                                    : "2";
    EXPECT_EQ(refused(option.name, before, is) == "", not_clashes.count(option.name) == 1) << option.name;
  }
}

/// Every option of a list that was written is there when it is read: none but threads is forgotten.
TEST(ClashLists, KeepAllOptions)
{
  ClashQuestion asked;
  asked.input = "a";
  asked.obstacle = "b";
  const std::map<std::string, std::string> texts = {{"accuracy", "tolerance=0.125"},
                                                    {"uncertainty", "sigma"},
                                                    {"pose_uncertainty", "0.01,0.002,1,2,3"},
                                                    {"origin", "source:0=1,2,3;1=4,5,6"},
                                                    {"ignore_points", "classification=2,9;box=0,0,0,1,1,1"},
                                                    {"obstacle_ignore_points", "plane=0,0,1,0.5,0.1"},
                                                    {"threads", "3"}};
  for (const QuestionOption& option : questionOptions()) {
    const auto text = texts.find(option.name);
    const bool is_switch = std::holds_alternative<bool Question::*>(option.member);
    setOption(asked, option.name, text != texts.end() ? text->second : is_switch ? "true" : "0.1");
  }
  const std::string options = R"("options": )" + optionsJson(asked).dump();
  const ClashList read = parseClashes(oldListWith(options), "list.json");
  EXPECT_TRUE(read.states_options);
  EXPECT_EQ(givenOptions(read.question), givenOptions(asked));
  EXPECT_EQ(givenOptions(asked).size() + 1, questionOptions().size());
  EXPECT_THAT(refusal(oldListWith(R"("options": {"clearence": "1"})")),
              HasSubstr("old.json: is no list of clashes: options.clearence: "));
  EXPECT_THAT(refusal(oldListWith(R"("options": {"accuracy": "good"})")), HasSubstr("options.accuracy: "));
  EXPECT_THAT(refusal(oldListWith(R"("options": {"uncertainty": "-1"})")), HasSubstr("options.uncertainty: "));
}

TEST(ClashLists, OfEarlierVersionsAreReadWithAWarning)
{
  const ClashList list = parseClashes(old_list, "old.json");
  EXPECT_FALSE(list.states_options);
  EXPECT_FALSE(list.survey);
  ASSERT_EQ(list.clashes.size(), 2U);
  EXPECT_EQ(list.clashes[0].certain_points, 3U);
  EXPECT_EQ(list.clashes[0].place, (Point3{0, 1, 2})) << "of its pair";
  EXPECT_EQ(list.clashes[1].place, (Point3{5, 1, 1})) << "the middle of its box";
  ClashQuestion now = list.question;
  now.uncertainty = 0.01;
  EXPECT_THAT(requireComparable("old.json", list, now), ElementsAre(HasSubstr("old.json: is of an earlier version")));
  EXPECT_TRUE(surveyWarnings("old.json", list, Survey(posesAt({0}), std::nullopt), 1).empty());
  const ClashList without_survey = parseClashes(oldListWith(R"("options": {})"), "old.json");
  EXPECT_TRUE(without_survey.states_options);
  EXPECT_THAT(requireComparable("old.json", without_survey, without_survey.question),
              ElementsAre(HasSubstr("old.json: is of an earlier version")));
}

TEST(ClashLists, RefuseQuestionsAndSurveysThatNoRunWrites)
{
  const std::string survey = R"("path": {"poses": 2, "checksum": "ab", "box": null}, "scan": {"box": null})";
  EXPECT_TRUE(parseClashes(oldListWith(survey), "old.json").survey);
  const std::string begin = "old.json: is no list of clashes: ";
  EXPECT_THAT(refusal(oldListWith(R"("path": {"poses": -2, "checksum": "ab", "box": null}, "scan": {"box": null})")),
              HasSubstr(begin + "path.poses: -2 is too small"));
  const std::string most = R"("path": {"poses": 2147483647, "checksum": "ab", "box": null}, "scan": {"box": null})";
  EXPECT_EQ(parseClashes(oldListWith(most), "old.json").survey->poses, 2147483647u);
  EXPECT_THAT(
      refusal(oldListWith(R"("path": {"poses": 2147483648, "checksum": "ab", "box": null}, "scan": {"box": null})")),
      HasSubstr(begin + "path.poses: 2147483648 is too large"));
  EXPECT_THAT(
      refusal(oldListWith(
          R"("path": {"poses": 2, "checksum": "ab", "box": null}, "scan": {"box": {"min": [0, 0], "max": []}})")),
      HasSubstr(begin + "scan.box.min: has not three numbers"));
}

TEST(ClashLists, WarnOfAnotherPathAndAnotherExtent)
{
  const Extent box{{0, 0, 0}, {100, 5, 5}};
  ClashList earlier;
  earlier.survey = Survey(posesAt({0, 50, 100}), box);
  const auto warnings = [&](const std::vector<double>& stations, const Extent& extent) {
    return surveyWarnings("old.json", earlier, Survey(posesAt(stations), extent), 0.5);
  };
  EXPECT_TRUE(warnings({0, 50, 100}, box).empty());
  EXPECT_TRUE(warnings({-0.0, 50, 100}, {{0.4, 0, 0}, {100, 5, 4.6}}).empty()) << "points differ from scan to scan";
  EXPECT_THAT(
      warnings({0, 50}, box),
      ElementsAre("old.json: lists clashes of another path (3 poses from (0, 0, 0) to (100, 0, 0), now 2 from (0, "
                  "0, 0) to (50, 0, 0)): what was where the path does not come any more is called not_visited, "
                  "and not resolved"));
  EXPECT_EQ(warnings({0, 50.001, 100}, box).size(), 1U);
  earlier.survey = Survey(posesAt({7}), box);
  EXPECT_THAT(warnings({0}, box), ElementsAre(HasSubstr("clashes of another path (1 pose from ")));
  earlier.survey = Survey(posesAt({0, 50, 100}), box);
  EXPECT_EQ(warnings({0, 100, 50}, box).size(), 1U);
  EXPECT_THAT(
      warnings({0, 50, 100}, {{0, 0, 0}, {60, 5, 5}}),
      ElementsAre(HasSubstr("old.json: lists clashes of a scan from (0, 0, 0) to (100, 5, 5), now it is from (0, "
                            "0, 0) to (60, 5, 5): ")));
  EXPECT_EQ(surveyWarnings("old.json", earlier, Survey(posesAt({0, 50, 100}), std::nullopt), 0.5).size(), 1U);
}

/// Lists of earlier runs have it: FNV-1a of the twelve numbers of each pose.
TEST(ClashLists, ThePathsChecksumStaysWhatItWas)
{
  EXPECT_EQ(Survey(posesAt({0, 50, 100}), std::nullopt).path_checksum, "c6f5c3991432a018");
  EXPECT_EQ(Survey({}, std::nullopt).path_checksum, "cbf29ce484222325");
}

TEST(ClashLists, WarnOfAnExtentThatDiffersOnAnySide)
{
  const Extent box{{0, 0, 0}, {100, 50, 5}};
  ClashList earlier;
  earlier.survey = Survey(posesAt({0}), box);
  for (std::size_t k = 0; k < 3; ++k)
    for (const double change : {-0.51, -0.49, 0.49, 0.51}) {
      Extent low = box, high = box;
      low.low[k] += change, high.high[k] += change;
      for (const Extent& now : {low, high})
        EXPECT_EQ(surveyWarnings("old.json", earlier, Survey(posesAt({0}), now), 0.5).size(),
                  std::abs(change) > 0.5 ? 1U : 0U)
            << k << ' ' << change;
    }
  ClashList nowhere;
  nowhere.survey = Survey({}, std::nullopt);
  EXPECT_TRUE(surveyWarnings("old.json", nowhere, Survey({}, std::nullopt), 0.5).empty());
  EXPECT_THAT(surveyWarnings("old.json", nowhere, Survey(posesAt({0}), box), 0.5),
              ElementsAre(HasSubstr("(0 poses nowhere, now 1 from (0, 0, 0) to (0, 0, 0))"),
                          HasSubstr("of a scan nowhere, now it is from (0, 0, 0) to (100, 50, 5)")));
}

TEST(ClashLists, ReadWhatOnlyLaterVersionsWrite)
{
  const std::string survey = R"("path": {"poses": 2, "checksum": "ab", "box": {"min": [0, 1, 2], "max": [3, 4, 5]}},
    "scan": {"box": {"min": [-1, -2, -3], "max": [0, 0, 0]}})";
  const ClashList list = parseClashes(oldListWith(survey), "old.json");
  ASSERT_TRUE(list.survey);
  EXPECT_EQ(list.survey->poses, 2U);
  EXPECT_EQ(list.survey->path->high, (Point3{3, 4, 5}));
  EXPECT_EQ(list.survey->scan->low, (Point3{-1, -2, -3}));
  EXPECT_FALSE(parseClashes(oldListWith(R"("scan": {"box": null})"), "old.json").survey) << "without a path";
  const std::string unseen = R"(", "status": "unseen", "points": 1, "box": {"min": [0, 0, 0], "max": [1, 1, 1]},
    "distance": null, "first_pose": 2147483647, "closest_pose": 1, "place": [7, 8, 9], "certain_points": 0}]})";
  std::string with_unseen = old_list;
  with_unseen.replace(with_unseen.rfind("]}"), 2, R"(, {"id": "C)" + unseen);
  const ClashList read = parseClashes(with_unseen, "old.json");
  ASSERT_EQ(read.clashes.size(), 3U);
  EXPECT_TRUE(std::isnan(read.clashes[2].distance));
  EXPECT_EQ(read.clashes[2].place, (Point3{7, 8, 9}));
  EXPECT_EQ(read.clashes[2].certain_points, 0U);
  EXPECT_EQ(read.clashes[2].first_pose, 2147483647);
}

TEST(ClashLists, WarnOfSweptMotionOnEitherSide)
{
  ClashList earlier;
  earlier.question.clearance = 0.3;
  earlier.question.swept = 0.01;
  earlier.survey.emplace();
  ClashQuestion now = earlier.question;
  now.swept = 0.02;
  EXPECT_THAT(requireComparable("old.json", earlier, now), testing::IsEmpty()) << "of another step";
  now.swept = 0.0;
  EXPECT_THAT(requireComparable("old.json", earlier, now),
              ElementsAre("old.json: lists clashes of swept motion, now poses alone are asked: clashes between poses "
                          "seem resolved"));
  std::swap(earlier.question.swept, now.swept);
  EXPECT_THAT(requireComparable("old.json", earlier, now),
              ElementsAre("old.json: lists clashes at poses alone, now swept motion is asked: clashes between poses "
                          "seem new"));
}

/// It is the one option that they tell.
TEST(ClashLists, OfEarlierVersionsHaveTheirClearance)
{
  const ClashList list = parseClashes(old_list, "old.json");
  ClashQuestion now = list.question;
  now.clearance = 0.5;
  EXPECT_THROW(requireComparable("old.json", list, now), files::FileError);
  const std::string path = R"("path": {"poses": 2, "checksum": "ab", "box": null})";
  EXPECT_FALSE(parseClashes(oldListWith(path), "old.json").survey) << "without a scan";
}

TEST(ClashLists, TellUncertaintiesInWords)
{
  EXPECT_EQ(uncertaintyText(0.25), "0.25");
  Uncertainty of_field("sigma", 2);
  EXPECT_EQ(uncertaintyText(of_field), "2 x field sigma");
  of_field.pose = {0.01, 0.002, {1, 2, 3}};
  EXPECT_EQ(uncertaintyText(of_field), "2 x field sigma and of poses 0.01,0.002,1,2,3");
}

/// Which did not say it among their options.
TEST(ClashLists, OfEarlierVersionsTellSweptMotion)
{
  std::string swept = old_list;
  swept.replace(swept.find("null"), 4, "0.25");
  EXPECT_EQ(parseClashes(swept, "old.json").question.swept, 0.25);
  EXPECT_EQ(parseClashes(old_list, "old.json").question.swept, 0.0);
}

} // namespace pcl_bsh::io

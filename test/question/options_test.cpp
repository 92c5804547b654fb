// SPDX-License-Identifier: BSD-3-Clause
#include "support/verdicts.h"

#include <pcl_bsh/question/options.h>

#include <gmock/gmock.h>

#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace pcl_bsh {
namespace {

using testing::HasSubstr;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The option that is refused, and why.
std::string refusalOf(const Question& question)
{
  try {
    checkOptions(question);
  }
  catch (const InvalidOption& error) {
    EXPECT_EQ(optionOf(error, question), error.option());
    return error.what();
  }
  return {};
}

TEST(GivenOptions, AreThoseThatSayOtherThanTheirDefaultAndNotHowManyThreads)
{
  Question question;
  question.threads = 4;
  EXPECT_TRUE(givenOptions(question).empty());
  question.clearance = 0.5;
  EXPECT_THAT(givenOptions(question), testing::ElementsAre(std::pair<std::string, std::string>("clearance", "0.5")));
}

/// Sets the number of an option; false where it has none.
bool setNumber(const QuestionOption& row, Question& question, double number)
{
  return std::visit(
      [&](const auto member) {
        using Value = std::decay_t<decltype(question.*member)>;
        if constexpr (std::is_same_v<Value, double> || std::is_same_v<Value, std::optional<double>> ||
                      std::is_same_v<Value, Uncertainty>) {
          question.*member = number;
          return true;
        }
        else {
          return false;
        }
      },
      row.member);
}

/// A value that is not the default, as text.
std::string exampleOf(const QuestionOption& row)
{
  if (std::holds_alternative<bool Question::*>(row.member)) return "true";
  if (std::holds_alternative<Accuracy Question::*>(row.member)) return "level=2";
  if (std::holds_alternative<ScanOrigins Question::*>(row.member)) return "1,2,3";
  if (std::holds_alternative<IgnoredPoints Question::*>(row.member)) return "class=2,9;box=0,0,0,1,1,1";
  if (std::holds_alternative<PoseUncertainty Question::*>(row.member)) return "0.05,0.1,1.5,0,0";
  return "7";
}

/// So that no other rule is broken.
Question consistent()
{
  Question question;
  question.path = {Eigen::Isometry3d::Identity()};
  question.uncertainty = Uncertainty("sigma", 1.0);
  return question;
}

TEST(QuestionOptions, HaveNamesOfTheirOwnAndOneSentence)
{
  std::set<std::string> names;
  for (const QuestionOption& row : questionOptions()) {
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
    EXPECT_EQ(questionOption(row.name), &row);
    EXPECT_EQ(std::string(row.name).find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string::npos) << row.name;
    const std::string doc = row.doc;
    EXPECT_GT(doc.size(), 20u) << row.name;
    EXPECT_NE(doc.back(), '.') << row.name;
    EXPECT_EQ(doc.find('\n'), std::string::npos) << row.name;
    EXPECT_EQ(doc.find(". "), std::string::npos) << row.name << ": one sentence";
    EXPECT_FALSE(std::isupper(static_cast<unsigned char>(doc[0]))) << row.name;
    EXPECT_EQ(row.value[0] == '\0', std::holds_alternative<bool Question::*>(row.member)) << row.name;
  }
  EXPECT_EQ(questionOption("none"), nullptr);
}

TEST(QuestionOptions, DefaultsAreAccepted)
{
  EXPECT_EQ(refusalOf(Question()), "");
  EXPECT_EQ(refusalOf(consistent()), "");
}

TEST(QuestionOptions, EachRefusesWhatIsOutsideItsLimits)
{
  int numbers = 0;
  for (const QuestionOption& row : questionOptions()) {
    Question question = consistent();
    if (!setNumber(row, question, 1.0)) continue;
    ++numbers;
    question.density = std::string(row.name) == "widest_gap";
    question.seen = std::string(row.name).starts_with("seen_");
    if (question.density) question.path.reset();
    EXPECT_EQ(refusalOf(question), "") << row.name;
    for (const double wrong : {-1.0, std::nan(""), -infinity}) {
      setNumber(row, question, wrong);
      EXPECT_THAT(refusalOf(question), testing::StartsWith(std::string(row.name) + ": ")) << wrong;
      EXPECT_THAT(refusalOf(question), HasSubstr(": " + row.remedy())) << wrong;
    }
    setNumber(row, question, 0.0);
    EXPECT_EQ(refusalOf(question).empty(), row.range != OptionRange::above_zero) << row.name;
    setNumber(row, question, infinity);
    EXPECT_EQ(refusalOf(question).empty(), row.range == OptionRange::from_zero_to_infinity) << row.name;
  }
  EXPECT_GE(numbers, 7);
  Question question;
  question.threads = 1025;
  EXPECT_EQ(refusalOf(question), "threads: 1025: give a number from 0 to 1024");
}

TEST(QuestionOptions, AreSetByText)
{
  const auto refusal = [](const std::string& name, const std::string& text) -> std::string {
    Question question;
    try {
      setOption(question, name, text);
    }
    catch (const InvalidInput& error) {
      return error.what();
    }
    return {};
  };
  for (const QuestionOption& row : questionOptions()) {
    SCOPED_TRACE(row.name);
    EXPECT_EQ(refusal(row.name, exampleOf(row)), "");
    EXPECT_NE(refusal(row.name, "1,"), "");
    Question asked;
    EXPECT_EQ(textOf(row, asked), "");
    setOption(asked, row.name, exampleOf(row));
    EXPECT_EQ(textOf(row, asked), exampleOf(row));
  }
  EXPECT_EQ(refusal("clearance", "-1"), "clearance: '-1': give a finite length >= 0");
  EXPECT_EQ(refusal("threads", "1.5"), "threads: '1.5': give a number from 0 to 1024");
  EXPECT_EQ(refusal("solid", "yes"), "solid: 'yes': give true or false");
  for (const char* wrong : {"-1", "0,5", "1e400", "+5mm", "-.5", "nan", "-inf"})
    EXPECT_THAT(refusal("uncertainty", wrong), HasSubstr("give a finite length >= 0, or the name of a field")) << wrong;
  EXPECT_THAT(refusal("clearances", "1"), HasSubstr("clearances: is no option"));
  Question question;
  setOption(question, "clearance", "0.25");
  setOption(question, "seen", "true");
  setOption(question, "threads", "3");
  setOption(question, "uncertainty", "sigma");
  setOption(question, "obstacle_uncertainty", "0.5");
  setOption(question, "accuracy", "pairs=7");
  EXPECT_EQ(question.clearance, 0.25);
  EXPECT_TRUE(question.seen);
  EXPECT_EQ(question.threads, 3u);
  EXPECT_EQ(question.uncertainty.field, "sigma");
  EXPECT_EQ(question.obstacle_uncertainty.length, 0.5);
  setOption(question, "obstacle_uncertainty", "-"); // the name of a field
  EXPECT_EQ(question.obstacle_uncertainty.field, "-");
  setOption(question, "obstacle_uncertainty", "");
  EXPECT_TRUE(question.obstacle_uncertainty.isZero());
  setOption(question, "seen", "false");
  EXPECT_FALSE(question.seen);
  EXPECT_EQ(question.accuracy.text(), "pairs=7");
}

TEST(QuestionOptions, WaitForTheirSwitch)
{
  Question question = {};
  question.widest_gap = 2.0;
  question.origin = ScanOrigins::parse("1,2,3");
  EXPECT_EQ(refusalOf(question), "widest_gap: is given, but not `density`: give `density`, too");
  question.density = true;
  EXPECT_EQ(refusalOf(question), "origin: is given, but not `seen`: give `seen`, too");
  leaveOutWaiting(question);
  EXPECT_EQ(refusalOf(question), "");
  EXPECT_EQ(question.widest_gap, 2.0);
  EXPECT_TRUE(question.origin.empty());
}

TEST(QuestionOptions, RefuseWhatDoesNotGoTogether)
{
  const auto refusal = [](const auto& change) {
    Question question;
    question.wanted.flags = true;
    change(question);
    return refusalOf(question);
  };
  const std::vector<Eigen::Isometry3d> path = {Eigen::Isometry3d::Identity()};
  EXPECT_THAT(refusal([](Question& q) { q.path.emplace(); }), HasSubstr("path: has no pose"));
  EXPECT_THAT(refusal([](Question& q) { q.swept = 1; }), HasSubstr("swept: is given, but nothing moves"));
  EXPECT_THAT(refusal([](Question& q) { q.sigmas = 2; }), HasSubstr("sigmas: is given, but no uncertainty is a field"));
  EXPECT_EQ(refusal([](Question& q) { q.sigmas = 2, q.obstacle_uncertainty = {"sigma", 1.0}; }), "");
  EXPECT_THAT(refusal([](Question& q) { q.widest_gap = 2; }), HasSubstr("widest_gap: is given, but not `density`"));
  const auto of_distances = [](Question& q) { q.wanted.flags = false, q.input_solid = q.wanted.distances = true; };
  EXPECT_THAT(refusal(of_distances), HasSubstr("input_solid: is about distances of the obstacle"));
  for (bool Wanted::*const beside : {&Wanted::both_ways, &Wanted::flags, &Wanted::closest})
    EXPECT_EQ(refusal([&](Question& q) { of_distances(q), q.wanted.*beside = true; }), "");
  EXPECT_THAT(refusal([&](Question& q) { q.density = true, q.path = path; }), HasSubstr("density: is about which"));
  for (bool Wanted::*const along : {&Wanted::contacts, &Wanted::poses, &Wanted::first_poses})
    EXPECT_THAT(refusal([&](Question& q) { q.density = q.wanted.*along = true; }),
                HasSubstr("density: is about which"));
  for (bool Wanted::*const list : {&Wanted::any, &Wanted::indices, &Wanted::obstacle_indices})
    EXPECT_THAT(refusal([&](Question& q) { q.density = q.wanted.*list = true; }),
                HasSubstr("density: is told by flags"));
  EXPECT_THAT(refusal([](Question& q) { q.density = q.wanted.obstacle_flags = true, q.wanted.flags = false; }),
              HasSubstr("density: is told by flags of the input alone"));
  EXPECT_EQ(refusal([](Question& q) { q.density = q.wanted.obstacle_flags = true; }), "");
  EXPECT_THAT(refusal([](Question& q) { q.accuracy = Accuracy::level(1), q.wanted.distances = true; }),
              HasSubstr("accuracy: level=1: leaves points without a distance: give exact or tolerance=LENGTH"));
  for (bool Wanted::*const of_one : {&Wanted::both_ways, &Wanted::obstacle_flags, &Wanted::within})
    EXPECT_THAT(refusal([&](Question& q) { q.path = path, q.wanted.*of_one = true; }), HasSubstr("path: has no dist"));
  const auto both = [&](Question& q) { q.path = path, q.max_distance = 1, q.wanted.distances = true; };
  EXPECT_THAT(refusal(both), HasSubstr("path: has either collisions or distances: ask twice"));
  for (bool Wanted::*const list : {&Wanted::any, &Wanted::indices, &Wanted::obstacle_indices})
    EXPECT_THAT(refusal([&](Question& q) { q.path = path, q.wanted.*list = true; }),
                HasSubstr("path: is given, and lists of what collides are asked for at one pose"));
  EXPECT_THAT(refusal([](Question& q) { q.limits = {2, 1}; }), HasSubstr("filter_limits: from 2 to 1: give"));
  EXPECT_THAT(refusal([](Question& q) {
                q.limits = {infinity, infinity};
              }),
              HasSubstr("filter_limits: from inf to inf"));
  EXPECT_EQ(refusal([](Question& q) { q.limits = {1, 1}; }), "");
  EXPECT_EQ(refusal([](Question& q) {
              q.limits = {-1, 1};
            }),
            "filter_limits: from -1 to 1: give a finite least >= 0, and a most that is not less");
  const auto of_solid = [&](double least, double most) {
    return refusal([&](Question& q) { q.solid = true, q.limits = {least, most}; });
  };
  EXPECT_EQ(of_solid(-1, 1), "") << "depths are negative";
  EXPECT_EQ(of_solid(-1, -2), "filter_limits: from -1 to -2: give a finite least, and a most that is not less");
}

std::string inSmallLetters(std::string text)
{
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// A file's text on one line, in small letters, without the beginnings of comments.
std::string wordsOf(const std::string& file)
{
  std::ifstream in(PCL_BSH_SOURCE_DIR "/pcl_bsh/" + file);
  std::string text, word;
  while (in >> word)
    if (word != "///") text += word + ' ';
  return inSmallLetters(text);
}

/// Except the tolerance of a surface: VTK's cloud is points, whatever its cells.
TEST(QuestionOptions, HaveTheSameWordsInVtkAndParaView)
{
  const std::string panels = wordsOf("paraview/BoundingSphereHierarchies/bounding_sphere_hierarchies.xml");
  for (const auto& [option, header] : {std::pair{"clearance", "CollisionFilter"},
                                       {"swept", "CollisionFilter"},
                                       {"max_distance", "DistanceFilter"},
                                       {"threads", "Filter"}}) {
    const std::string doc = inSmallLetters(questionOption(option)->doc);
    EXPECT_THAT(panels, HasSubstr(doc)) << option;
    EXPECT_THAT(wordsOf(std::string("vtk_filters/vtkBSH") + header + ".h"), HasSubstr(doc)) << option;
  }
}

TEST(QuestionOptions, AreKnownByTheCodesOfTheCore)
{
  const Question question;
  const auto named = [&](Input input) { return optionOf(InvalidInput(input, "something", "is wrong"), question); };
  EXPECT_EQ(named(Input::clearance), "clearance");
  EXPECT_EQ(named(Input::swept), "swept");
  EXPECT_EQ(named(Input::accuracy), "accuracy");
  EXPECT_EQ(named(Input::max_distance), "max_distance");
  EXPECT_EQ(named(Input::pose), "pose");
  EXPECT_EQ(named(Input::trajectory), "pose");
  Question along;
  along.path.emplace();
  for (const Input input : {Input::pose, Input::trajectory})
    EXPECT_EQ(optionOf(InvalidInput(input, "something", "is wrong"), along), "path");
  EXPECT_EQ(named(Input::uncertainty), "") << "of whom?";
  EXPECT_EQ(named(Input::points), "");
  EXPECT_EQ(named(Input::surface), "") << "of a mesh itself";
}

TEST(QuestionOptions, AreOfTheQuestionsThatShareTheirKind)
{
  using Kind = QuestionKind;
  EXPECT_TRUE(isOf(Kind::any, Kind::collisions));
  EXPECT_TRUE(isOf(Kind::any, Kind::distances));
  EXPECT_TRUE(isOf(Kind::collisions, Kind::any));
  EXPECT_FALSE(isOf(Kind::collisions, Kind::distances));
  EXPECT_FALSE(isOf(Kind::distances, Kind::collisions));
}

} // namespace
} // namespace pcl_bsh

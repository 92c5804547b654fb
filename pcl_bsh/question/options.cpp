// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/question/options.h>

#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/question/text_numbers.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace pcl_bsh {
namespace {

using Kind = QuestionKind;
using Range = OptionRange;
using OfSites = OptionOfSites;
using Q = Question;

std::vector<QuestionOption> table()
{
  return {
      {"clearance", &Q::clearance, Kind::collisions, "D", "m", Input::clearance,
       "greatest distance that counts as collision, touching included", Range::from_zero, true},
      {"swept", &Q::swept, Kind::collisions, "TOL", "m", Input::swept,
       "above 0, the motion between the poses of a path counts, too, to this tolerance: what comes within the "
       "clearance "
       "collides, what stays beyond clearance + tolerance does not; 0: the poses alone",
       Range::from_zero, false, nullptr, nullptr, OptionEffect::other_answers},
      {"accuracy", &Q::accuracy, Kind::any, "HOW", "", Input::accuracy,
       "how sure the answer is; less sure is faster: `exact`; `tolerance=LENGTH`: distances in (clearance, clearance "
       "+ LENGTH] may count, too, and distances are too great by LENGTH at most; `level=N`, `pairs=N` or "
       "`time=SECONDS`, of collisions alone, stop early: what stays undecided is not free; with swept motion `exact`"},
      {"uncertainty", &Q::uncertainty, Kind::collisions, "U", "m", Input::uncertainty,
       "greatest error of the input's points: a length, or the field of each point's sigma; a point that may collide, "
       "but need not, is undecided, not free; distances are those of the measured places"},
      {"obstacle_uncertainty", &Q::obstacle_uncertainty, Kind::collisions, "U", "m", Input::uncertainty,
       "greatest error of the obstacle's points, as `uncertainty` of the input's"},
      {"sigmas", &Q::sigmas, Kind::collisions, "K", "", Input::uncertainty,
       "by how many sigmas a point may be off, where an uncertainty is a field"},
      {"pose_uncertainty", &Q::pose_uncertainty, Kind::collisions, "T,W,X,Y,Z", "m", Input::uncertainty,
       "greatest error of the obstacle's pose, or of each pose of its path: a length, and an angle in radians about a "
       "place in the obstacle's frame, its origin without one; `covariance=SIGMAS:` and 36 numbers take it from a "
       "registration; a point moves by at most T + 2 sin(W / 2) times its distance from the place, and verdicts are "
       "those of uncertain points"},
      {"input_pose_uncertainty", &Q::input_pose_uncertainty, Kind::collisions, "T,W,X,Y,Z", "m", Input::uncertainty,
       "greatest error of the input's own pose, as `pose_uncertainty`: all of its points move together, about a place "
       "in its frame"},
      {"density", &Q::density, Kind::collisions, "", "", Input::density,
       "a point that is free, but no farther from a point of the obstacle than the clearance and half the spacing of "
       "the obstacle's points there, is undecided: not scanned densely enough; at one pose",
       Range::from_zero, false, nullptr, nullptr, OptionEffect::clashes, OfSites::none},
      {"widest_gap", &Q::widest_gap, Kind::collisions, "L", "m", Input::density,
       "with `density`: a wider gap in the obstacle is an opening, not a surface; without it, eight times the median "
       "distance between its neighbouring points, too little where lines of a scan are farther apart",
       Range::above_zero, false, nullptr, "density", OptionEffect::clashes, OfSites::none},
      {"seen", &Q::seen, Kind::collisions, "", "", std::nullopt,
       "free parts of the obstacle are unseen where no scanner saw that the clearance about them is empty; blind to "
       "glass, mixed pixels, and things thinner than the angle between beams; not with swept motion",
       Range::from_zero, false, nullptr, nullptr, OptionEffect::other_answers, OfSites::in_memory},
      {"origin", &Q::origin, Kind::collisions, "X,Y,Z", "m", std::nullopt,
       "with `seen`: where the scanner stood, in the input's frame, or FIELD:N=X,Y,Z;N=X,Y,Z of several scans by "
       "the field that numbers them; without it, what the input's file says",
       Range::from_zero, false, nullptr, "seen", OptionEffect::other_answers, OfSites::in_memory},
      {"seen_angle", &Q::seen_angle, Kind::collisions, "A", "rad", Input::seen,
       "with `seen`: a direction counts only between beams within this angle on all sides, never in a gap or beyond "
       "the outermost beam; from 0.0001 to 0.25; default: 1.5 times the measured angle between beams",
       Range::above_zero, false, nullptr, "seen", OptionEffect::other_answers, OfSites::in_memory},
      {"seen_beyond", &Q::seen_beyond, Kind::collisions, "R", "m", std::nullopt,
       "with `seen`: a beam of an .e57 without a return saw nothing up to this range of the scanner, which no file "
       "tells; without it, such a beam says nothing",
       Range::above_zero, false, nullptr, "seen", OptionEffect::other_answers, OfSites::none},
      {"max_distance", &Q::max_distance, Kind::distances, "M", "m", Input::max_distance,
       "greater distances are not told, but are NaN; less is faster; without it, no limit",
       Range::from_zero_to_infinity, false, nullptr, nullptr, OptionEffect::other_answers},
      {"solid", &Q::solid, Kind::any, "", "", std::nullopt,
       "the obstacle is a solid, whose faces must close: what is inside collides at any clearance, at a negative "
       "distance, the depth to the surface; without it, the obstacle is its surface alone, hollow",
       Range::from_zero, false, nullptr, nullptr, OptionEffect::clashes, OfSites::in_memory},
      {"input_solid", &Q::input_solid, Kind::not_one_way, "", "", std::nullopt,
       "the input is a solid, whose faces must close: parts of the obstacle inside it collide, and so do the "
       "triangles of each body that holds them",
       Range::from_zero, false, nullptr, nullptr, OptionEffect::clashes, OfSites::none},
      {"ignore_points", &Q::ignore_points, Kind::any, "WHICH", "", std::nullopt,
       "points of the input that do not count: FIELD=N,N by values, box=X0,Y0,Z0,X1,Y1,Z1, plane=NX,NY,NZ,D,TOL up to "
       "TOL from n p = D, mask=FILE of lines 0 or 1; joined by ; (their beams still count)",
       Range::from_zero, false, nullptr, nullptr, OptionEffect::clashes, OfSites::none},
      {"obstacle_ignore_points", &Q::obstacle_ignore_points, Kind::any, "WHICH", "", std::nullopt,
       "points of the obstacle that do not count, as `ignore_points` of the input", Range::from_zero, false, nullptr,
       nullptr, OptionEffect::clashes, OfSites::none},
      {"vertices_only", &Q::vertices_only, Kind::any, "", "", std::nullopt,
       "a mesh is its vertices alone; without it, an obstacle with faces is a surface, its triangles, and so is an "
       "input "
       "with faces, whose triangles are asked about"},
      {"threads", &Q::threads, Kind::any, "N", "", std::nullopt,
       "0: all of the machine's; the result is the same for any number", Range::from_zero, false, "number_of_threads",
       nullptr, OptionEffect::none},
  };
}

Input codeOf(const std::string& name)
{
  const QuestionOption* const option = questionOption(name);
  if (!option) return name == "filter_limits" ? Input::max_distance : Input::trajectory;
  return option->code.value_or(Input::accuracy); // of how it is computed
}

/// The number of an option, where it has one.
std::optional<double> numberOf(const QuestionOption& option, const Question& question)
{
  return std::visit(
      [&](const auto member) -> std::optional<double> {
        using Value = std::decay_t<decltype(question.*member)>;
        if constexpr (std::is_same_v<Value, std::optional<double>>)
          return question.*member;
        else if constexpr (std::is_same_v<Value, Uncertainty>)
          return (question.*member).length;
        else if constexpr (std::is_same_v<Value, bool> || is_text_option<Value>) // queries check these
          return std::nullopt;
        else
          return static_cast<double>(question.*member);
      },
      option.member);
}

/// Whether its switch is off.
bool isWaiting(const QuestionOption& option, const Question& question)
{
  return option.with && !(question.*std::get<bool Question::*>(questionOption(option.with)->member));
}

} // namespace

double QuestionOption::most() const
{
  if (std::holds_alternative<unsigned Question::*>(member)) return 1024.0;
  return range == OptionRange::from_zero_to_infinity ? std::numeric_limits<double>::infinity()
                                                     : std::numeric_limits<double>::max();
}

bool QuestionOption::accepts(double number) const
{
  return (range == OptionRange::above_zero ? number > 0.0 : number >= 0.0) && number <= most();
}

std::string QuestionOption::remedy() const
{
  const std::string what = unit[0] == 'm' ? "length" : "number";
  if (most() == 1024.0) return "give a number from 0 to 1024";
  return "give a " + std::string(std::isinf(most()) ? "" : "finite ") + what +
         (range == OptionRange::above_zero ? " > 0" : " >= 0");
}

const std::vector<QuestionOption>& questionOptions()
{
  static const std::vector<QuestionOption> options = table();
  return options;
}

const QuestionOption* questionOption(const std::string& name)
{
  const auto& all = questionOptions();
  const auto found = std::find_if(all.begin(), all.end(), [&](const QuestionOption& row) { return row.name == name; });
  return found == all.end() ? nullptr : &*found;
}

InvalidOption::InvalidOption(const std::string& name, std::string wrong, std::string remedy)
: InvalidInput(codeOf(name), name, std::move(wrong), std::move(remedy)),
  option_(name)
{
}

std::string optionOf(const InvalidInput& error, const Question& question)
{
  if (const auto* const named = dynamic_cast<const InvalidOption*>(&error)) return named->option();
  std::vector<std::string> names;
  for (const QuestionOption& option : questionOptions())
    if (option.code == error.input()) names.emplace_back(option.name);
  if (names.size() == 1) return names.front();
  if (error.input() == Input::pose || error.input() == Input::trajectory) return question.path ? "path" : "pose";
  return {};
}

void setOption(Question& question, const std::string& name, const std::string& text)
{
  const QuestionOption* const option = questionOption(name);
  if (!option) throw InvalidInput(Input::result, name, "is no option of a question", "see the table of options");
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  const bool accepted = is_number && option->accepts(number);
  const auto refuse = [&](const std::string& remedy) { throw InvalidOption(name, "'" + text + "'", remedy); };
  std::visit(
      [&](const auto member) {
        auto& value = question.*member;
        using Value = std::decay_t<decltype(value)>;
        if constexpr (is_text_option<Value>) {
          value = Value::parse(text);
        }
        else if constexpr (std::is_same_v<Value, bool>) {
          if (text != "true" && text != "false") refuse("give true or false");
          value = text == "true";
        }
        else if constexpr (std::is_same_v<Value, Uncertainty>) {
          const std::size_t at = text.find_first_not_of("+-.");
          const bool is_name =
              !is_number && (at == text.npos || std::isdigit(static_cast<unsigned char>(text[at])) == 0);
          if (!accepted && !is_name) refuse("give a finite length >= 0, or the name of a field");
          value = is_name ? Uncertainty(text, 1.0) : Uncertainty(number);
        }
        else {
          constexpr bool is_count = std::is_same_v<Value, unsigned>;
          if (!accepted || (is_count && number != std::floor(number))) refuse(option->remedy());
          value = static_cast<std::conditional_t<is_count, unsigned, double>>(number);
        }
      },
      option->member);
}

std::string textOf(const QuestionOption& option, const Question& question)
{
  const auto write = [](const auto& value) -> std::string {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (is_text_option<Value>)
      return value.text();
    else if constexpr (std::is_same_v<Value, bool>)
      return value ? "true" : "false";
    else if constexpr (std::is_same_v<Value, Uncertainty>)
      return value.field.empty() ? textOfNumbers(value.length) : value.field;
    else if constexpr (std::is_same_v<Value, std::optional<double>>)
      return value ? textOfNumbers(*value) : std::string();
    else
      return textOfNumbers(static_cast<double>(value));
  };
  return std::visit(
      [&](const auto member) {
        std::string text = write(question.*member);
        return text == write(Question().*member) ? std::string() : text;
      },
      option.member);
}

std::vector<std::pair<std::string, std::string>> givenOptions(const Question& question)
{
  std::vector<std::pair<std::string, std::string>> given;
  for (const QuestionOption& option : questionOptions()) {
    if (option.effect == OptionEffect::none) continue;
    if (std::string text = textOf(option, question); !text.empty()) given.emplace_back(option.name, std::move(text));
  }
  return given;
}

void leaveOutWaiting(Question& question)
{
  for (const QuestionOption& option : questionOptions())
    if (isWaiting(option, question))
      std::visit([&](const auto member) { question.*member = Question().*member; }, option.member);
}

void checkOptions(const Question& question)
{
  for (const QuestionOption& option : questionOptions()) {
    const std::optional<double> number = numberOf(option, question);
    if (number && !option.accepts(*number)) throw InvalidOption(option.name, plainText(*number), option.remedy());
    if (isWaiting(option, question) && !textOf(option, question).empty()) {
      const std::string with = std::string("`") + option.with + '`';
      throw InvalidOption(option.name, "is given, but not " + with, "give " + with + ", too");
    }
  }
  const auto refuse = [](const char* option, const std::string& wrong, const char* remedy) {
    throw InvalidOption(option, wrong, remedy);
  };
  const Wanted& wanted = question.wanted;
  if (question.path && question.path->empty()) refuse("path", "has no pose", "give one at least");
  if (question.swept > 0.0 && !question.path)
    refuse("swept", "is given, but nothing moves", "give a path of poses, too");
  if (question.accuracy.stopsEarly() && wanted.measures() && !wanted.intervals)
    refuse("accuracy", question.accuracy.text() + ": leaves points without a distance",
           "give exact or tolerance=LENGTH");
  if (question.sigmas != 1.0 && question.uncertainty.field.empty() && question.obstacle_uncertainty.field.empty())
    refuse("sigmas", "is given, but no uncertainty is a field", "give the length itself");
  if (question.density && (question.path || wanted.contacts || wanted.poses || wanted.first_poses))
    refuse("density", "is about which points collide at one pose",
           "leave out the path, the list of clashes, or `density`");
  if (question.density &&
      (wanted.any || wanted.indices || wanted.obstacle_indices || (wanted.obstacle_flags && !wanted.flags)))
    refuse("density", "is told by flags of the input alone", "ask for these alone, or leave it out");
  if (question.seen && question.swept > 0.0)
    refuse("seen", "is about poses, and the motion between them is asked about", "leave out `seen` or `swept`");
  for (const char* const option : {"solid", "input_solid"})
    if (question.vertices_only && (option[0] == 's' ? question.solid : question.input_solid))
      refuse(option, "is given, but `vertices_only`, too", "give one of them");
  if (question.input_solid && wanted.oneWay())
    refuse("input_solid", "is about distances of the obstacle, which are not asked for",
           "ask for both ways, or leave it out");
  if (question.path && (wanted.obstacle_flags || wanted.both_ways || wanted.within))
    refuse("path", "has no distances but the smallest", "give one pose");
  if (question.path && (wanted.any || wanted.indices || wanted.obstacle_indices))
    refuse("path", "is given, and lists of what collides are asked for at one pose", "ask for flags");
  if (question.path && wanted.distances && wanted.collisions())
    refuse("path", "has either collisions or distances", "ask twice");
  if (question.path && wanted.distances && !question.max_distance)
    refuse("max_distance", "is without limit", "give a finite one along a path");
  const auto [least, most] = question.limits;
  if (!((question.solid || 0.0 <= least) && least <= most && std::isfinite(least))) {
    throw InvalidOption("filter_limits", plainText("from ", least, " to ", most),
                        question.solid ? "give a finite least, and a most that is not less"
                                       : "give a finite least >= 0, and a most that is not less");
  }
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
// The options of a question, once: from this table come command lines and their help, options of pipeline stages, their
// schema and documents, and the checks of all of them.
#pragma once

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/export.h>
#include <pcl_bsh/question/question.h>

#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Which questions have an option. Distances in both directions have the options of `distances`, and those of
/// `not_one_way`, which are about the obstacle's own distances.
enum class QuestionKind : std::uint8_t { collisions = 1, distances = 2, any = 3, not_one_way = 5, both_ways = 6 };

/// Whether an option is one of a question.
constexpr bool isOf(QuestionKind option, QuestionKind question) noexcept
{
  return (static_cast<unsigned>(option) & static_cast<unsigned>(question)) != 0;
}

/// Whether parse() and text() of an option's type read and write it. Empty text is the default, except of an accuracy.
template <typename T>
inline constexpr bool is_text_option = std::is_same_v<T, Accuracy> || std::is_same_v<T, PoseUncertainty> ||
                                       std::is_same_v<T, ScanOrigins> || std::is_same_v<T, IgnoredPoints>;

/// The member that an option sets; its value in a new Question is the default.
using OptionMember = std::variant<double Question::*, std::optional<double> Question::*, bool Question::*,
                                  unsigned Question::*, Accuracy Question::*, Uncertainty Question::*,
                                  PoseUncertainty Question::*, ScanOrigins Question::*, IgnoredPoints Question::*>;

/// Which numbers an option accepts; counts go up to 1024.
enum class OptionRange : std::uint8_t { from_zero, above_zero, from_zero_to_infinity };

/// Which answers an option changes: the points that collide at a pose, and so the clashes; other answers alone; or
/// none.
enum class OptionEffect : std::uint8_t { clashes, other_answers, none };

/// Which questions about a site (pcl_bsh/site) have an option: all, those whose obstacle is in memory, or none.
enum class OptionOfSites : std::uint8_t { all, in_memory, none };

/// A row of the table.
struct QuestionOption {
  const char* name; ///< in pipelines and Python; with hyphens after -- on command lines
  OptionMember member;
  QuestionKind kind;
  const char* value;         ///< stands for the value in help texts; empty for a switch
  const char* unit;          ///< m: a length in the clouds' unit; or empty
  std::optional<Input> code; ///< of its errors; errors of the core with it are about this option if no other row has it
  const char* doc;           ///< one sentence, without a full stop
  OptionRange range = OptionRange::from_zero;
  bool required = false;                ///< of questions of its kind alone
  const char* name_of_stages = nullptr; ///< where pipelines call it as PCL does
  const char* with = nullptr;           ///< the switch without which it means nothing, and is refused
  OptionEffect effect = OptionEffect::clashes;
  OptionOfSites of_sites = OptionOfSites::all;

  bool accepts(double number) const; ///< whether it is in range
  double most() const;               ///< the greatest number that is accepted
  std::string remedy() const; ///< what to give instead of a number that is not accepted: "give a finite length >= 0"
};

/// All rows, in the order of help texts and documents.
const std::vector<QuestionOption>& questionOptions();

/// Returns the option of this name, or null.
const QuestionOption* questionOption(const std::string& name);

/// An error about an option of a question, by the table's name. Options that its text names are in `backticks`.
class InvalidOption : public InvalidInput {
public:
  InvalidOption(const std::string& name, std::string wrong, std::string remedy = {});
  const std::string& option() const noexcept { return option_; } ///< its name

private:
  std::string option_;
};

/// The option that an error is about, or `pose` or `path`; empty: none.
std::string optionOf(const InvalidInput& error, const Question& question);

/// Sets an option as text has it: numbers, true or false, or what the option's type parses. Faces whose users name
/// options set all of them by this function, without code for each.
/// @throws InvalidInput for an unknown name and for a text that is no value of the option
void setOption(Question& question, const std::string& name, const std::string& text);

/// Returns the text that setOption() reads, empty for the default. Reports state a question by it.
std::string textOf(const QuestionOption& option, const Question& question);

/// The options that were given and change answers, in the table's order, as text. Reports state them, and kept answers
/// are answers to them.
std::vector<std::pair<std::string, std::string>> givenOptions(const Question& question);

/// Sets options whose switch is off to their defaults, for callers that keep their values until it is on.
void leaveOutWaiting(Question& question);

/// Refuses numbers that their options do not accept, and options that do not go together. Poses are for queries to
/// refuse. @throws InvalidOption
void checkOptions(const Question& question);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

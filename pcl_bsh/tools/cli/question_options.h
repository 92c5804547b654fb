// SPDX-License-Identifier: BSD-3-Clause
// The options of questions, as command lines have them: by the core's table.
#pragma once

#include "program.h"

#include <pcl_bsh/question/options.h>

#include <CLI/CLI.hpp>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// The command line's --some-name for an option `some_name`.
std::string asOption(const std::string& name);

/// Breaks a text into lines of at most `width` characters; longer words stay whole.
std::string wrapped(const std::string& text, std::size_t width = 72);

/// Adds the options with these names; their defaults are the values in the question.
void addQuestionOptions(CLI::App& app, Question& question, const std::vector<std::string>& names);

/// Adds the options of a kind of question, except those in `without`, which a program adds in its own way.
void addQuestionOptions(CLI::App& app, Question& question, QuestionKind kind, const std::vector<std::string>& without);

/// @throws UsageError quoting the text when it is no accuracy
Accuracy parseAccuracy(const std::string& text);

/// The text of a refusal of the core, with the names that options have on the command line.
/// @param names_of_poses the options that give poses: of the first pose, then of those that follow
std::string advice(const InvalidInput& error, const Question& question, const std::vector<std::string>& names_of_poses);

/// Returns the result of `build`. @throws std::invalid_argument for refusals of the core, with command lines' names
template <typename Build>
decltype(auto) named(const Build& build, const Question& question = {},
                     const std::vector<std::string>& names_of_poses = {"--pose"})
{
  try {
    return build();
  }
  catch (const InvalidInput& error) {
    throw std::invalid_argument(advice(error, question, names_of_poses));
  }
}

/// Refuses questions that ask() would refuse for any clouds. @throws UsageError; std::invalid_argument for poses
/// @param refuse throws InvalidInput for them; null: as ask() does
void requireAccepted(const Question& question, const std::vector<std::string>& names_of_poses = {"--pose"},
                     const std::function<void()>& refuse = nullptr);

} // namespace pcl_bsh::cli

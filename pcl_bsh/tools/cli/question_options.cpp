// SPDX-License-Identifier: BSD-3-Clause
#include "question_options.h"

#include "command_line.h"

#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/question/ask.h>

#include <algorithm>
#include <sstream>
#include <type_traits>

namespace pcl_bsh::cli {
namespace {

void set(Question& question, const std::string& name, const std::string& text)
{
  try {
    setOption(question, name, text);
  }
  catch (const InvalidInput& error) {
    throw UsageError(asOption(name) + ": " + error.advice());
  }
}

/// `name` becomes --name, where it is an option.
std::string withOptions(std::string text)
{
  for (const QuestionOption& row : questionOptions()) {
    const std::string quoted = std::string("`") + row.name + '`';
    for (std::size_t at = text.find(quoted); at != std::string::npos; at = text.find(quoted))
      text.replace(at, quoted.size(), asOption(row.name));
  }
  return text;
}

void add(CLI::App& app, Question& question, const QuestionOption& row)
{
  const std::string option = asOption(row.name);
  std::visit(
      [&](const auto member) {
        auto& value = question.*member;
        using Value = std::decay_t<decltype(value)>;
        std::string doc = withOptions(row.doc) + (row.unit[0] == 'm' ? "; in the clouds' unit" : "");
        doc.erase(std::remove(doc.begin(), doc.end(), '`'), doc.end());
        if constexpr (std::is_arithmetic_v<Value> && !std::is_same_v<Value, bool>)
          doc += plainText(" (default: ", value, ")");
        doc = wrapped(doc);
        CLI::Option* added = nullptr;
        if constexpr (std::is_same_v<Value, bool>)
          added = app.add_flag(option, value, doc);
        else if constexpr (is_text_option<Value> || std::is_same_v<Value, Uncertainty>)
          added = app.add_option_function<std::string>(
              option, [&question, &row](const std::string& text) { set(question, row.name, text); }, doc);
        else if constexpr (std::is_same_v<Value, unsigned>)
          added = app.add_option(option, value, doc)->transform(number<unsigned>(row.remedy(), [&row](unsigned n) {
            return row.accepts(n);
          }));
        else
          added = app.add_option(option, value, doc)->transform(number<double>(row.remedy(), [&row](double number) {
            return row.accepts(number);
          }));
        if (row.value[0] != '\0') added->type_name(row.value);
      },
      row.member);
}

} // namespace

std::string asOption(const std::string& name)
{
  std::string option = "--" + name;
  std::replace(option.begin(), option.end(), '_', '-');
  return option;
}

std::string wrapped(const std::string& text, std::size_t width)
{
  std::istringstream words(text);
  std::string lines, word;
  std::size_t column = 0;
  while (words >> word) {
    const bool fits = column + 1 + word.size() <= width;
    if (column > 0) lines += fits ? ' ' : '\n';
    column = column > 0 && fits ? column + 1 + word.size() : word.size();
    lines += word;
  }
  return lines;
}

void addQuestionOptions(CLI::App& app, Question& question, const std::vector<std::string>& names)
{
  for (const std::string& name : names) add(app, question, *questionOption(name));
}

void addQuestionOptions(CLI::App& app, Question& question, QuestionKind kind, const std::vector<std::string>& without)
{
  for (const QuestionOption& row : questionOptions())
    if (isOf(row.kind, kind) && std::find(without.begin(), without.end(), row.name) == without.end())
      add(app, question, row);
}

Accuracy parseAccuracy(const std::string& text)
{
  Question question;
  set(question, "accuracy", text);
  return question.accuracy;
}

std::string advice(const InvalidInput& error, const Question& question, const std::vector<std::string>& names_of_poses)
{
  const std::string option = optionOf(error, question);
  if (option.empty()) return withOptions(error.what());
  const std::string& of_pose = error.index().value_or(0) > 0 ? names_of_poses.back() : names_of_poses.front();
  return (questionOption(option) ? asOption(option) : of_pose) + ": " + withOptions(error.advice());
}

void requireAccepted(const Question& question, const std::vector<std::string>& names_of_poses,
                     const std::function<void()>& refuse)
{
  try {
    refuse ? refuse() : check(question);
  }
  catch (const InvalidInput& error) {
    const std::string text = advice(error, question, names_of_poses);
    if (questionOption(optionOf(error, question))) throw UsageError(text);
    throw std::invalid_argument(text);
  }
}

} // namespace pcl_bsh::cli

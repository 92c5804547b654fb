// SPDX-License-Identifier: BSD-3-Clause
#include "obstacle_choice.h"

#include "command_line.h"
#include "path.h"

#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/question/options.h>
#include <pcl_bsh/question/text_numbers.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace pcl_bsh::cli {
namespace {

/// Sets an option of one obstacle, by the name that it has after ';'. @param label names the obstacle in errors
void set(ObstacleChoice& choice, const std::string& option, const std::string& value, const std::string& label,
         std::vector<std::string>& warnings)
{
  if (option == "pose") {
    choice.pose_text = value;
    choice.pose = parsePose(label + ": pose", value, warnings);
    return;
  }
  if (option == "unit") {
    try {
      choice.unit = io::lengthUnitOf(value);
    }
    catch (const io::FormatError& error) {
      throw UsageError(label + ": unit: " + error.what() + ": " + error.remedy());
    }
    return;
  }
  if (option == "parts") {
    if (value != "true" && value != "false") throw UsageError(label + ": parts: '" + value + "': give true or false");
    if (value == "true") choice.parts = std::make_shared<const io::MeshParts>(io::readMeshParts(choice.file));
    return;
  }
  const std::string name = option == "uncertainty" ? "obstacle_uncertainty" : option;
  if (name != "clearance" && name != "solid" && name != "obstacle_uncertainty")
    throw UsageError(label + ": '" + option +
                     "' is no option of an obstacle: give pose, unit, clearance, solid, uncertainty or parts");
  Question question;
  try {
    setOption(question, name, value);
  }
  catch (const InvalidInput& error) {
    throw UsageError(label + ": " + option + ": " + error.advice());
  }
  if (option == "clearance") choice.clearance = question.clearance;
  if (option == "solid") choice.solid = question.solid;
  if (option == "uncertainty") choice.uncertainty = question.obstacle_uncertainty;
}

ObstacleChoice parseObstacle(const std::string& text, std::vector<std::string>& warnings)
{
  ObstacleChoice choice;
  if (std::filesystem::exists(text)) {
    choice.file = text;
  }
  else {
    const std::vector<std::string_view> parts = partsOf(text, ';');
    const std::vector<std::string> words(parts.begin(), parts.end());
    const std::size_t equals = words.front().find('=');
    if (equals != text.npos) choice.name = words.front().substr(0, equals);
    choice.file = equals == text.npos ? words.front() : words.front().substr(equals + 1);
    if (choice.file.empty() || (equals != text.npos && choice.name.empty()))
      throw UsageError("--obstacle: '" + text + "' names no " + (choice.file.empty() ? "file" : "obstacle") +
                       ": give NAME=FILE");
    const std::string label = "--obstacle " + (choice.name.empty() ? choice.file.string() : choice.name);
    for (auto word = words.begin() + 1; word != words.end(); ++word) {
      const std::size_t of_option = word->find('=');
      if (of_option == word->npos)
        throw UsageError(label + ": '" + *word + "' has no value: give OPTION=VALUE after ';'");
      set(choice, word->substr(0, of_option), word->substr(of_option + 1), label, warnings);
    }
  }
  if (choice.name.empty() && !choice.parts) choice.name = choice.file.stem().string();
  return choice;
}

/// Appends an obstacle for each part of the file, or one for the whole file.
void addParts(const ObstacleChoice& choice, std::vector<ObstacleChoice>& choices, std::vector<std::string>& warnings)
{
  if (!choice.parts) return choices.push_back(choice);
  for (const std::string& remark : choice.parts->remarks) warnings.push_back(choice.file.string() + ": " + remark);
  for (std::size_t i = 0; i < choice.parts->names.size(); ++i) {
    choices.push_back(choice);
    choices.back().part = i;
    choices.back().name = choice.parts->nameOf(i, choice.name);
  }
}

} // namespace

std::vector<ObstacleChoice> parseObstacles(const std::vector<std::string>& texts, std::vector<std::string>& warnings)
{
  std::vector<ObstacleChoice> choices;
  std::vector<std::string> names;
  for (const std::string& text : texts) addParts(parseObstacle(text, warnings), choices, warnings);
  for (const ObstacleChoice& choice : choices) names.push_back(choice.name);
  try {
    checkObstacleNames(names);
  }
  catch (const InvalidInput& error) {
    throw UsageError("--obstacle: " + error.advice() + ", NAME=FILE");
  }
  return choices;
}

void SeveralObstacles::addObstaclesTo(CLI::App& app)
{
  app.add_option("--obstacle", texts_,
                 "one of several obstacles, beside one without a name or in its place; may\n"
                 "be given again and again. Its own options follow after ';':\n"
                 "\"NAME=FILE;pose=POSE;unit=mm\", and clearance=D, solid=true and\n"
                 "uncertainty=U alike; parts=true makes an obstacle of each object or\n"
                 "group of an .obj, or solid of an .stl, named PART or NAME/PART.\n"
                 "Without NAME= its name is the file's. A path moves all of them")
      ->type_name("NAME=FILE")
      ->allow_extra_args(false);
}

void SeveralObstacles::addTo(CLI::App& app)
{
  addObstaclesTo(app);
  app.add_flag("--between", between,
               "the obstacles are compared with each other, too, as they stand; where they\n"
               "are more than 32, pairs that are clear are not told");
  app.add_flag("--overlap", overlap,
               "with --between: the area of each surface inside another obstacle that\n"
               "is a solid, as an interval that holds it");
  app.add_option("--ignore", ignored,
                 "two names that are not compared, of obstacles or 'input'; * is any\n"
                 "letters, \\: a colon within a name; may be given again and again")
      ->type_name("FIRST:SECOND")
      ->allow_extra_args(false);
  app.add_option("--only", only,
                 "obstacles that are asked about, by name; * is any letters; may be given\n"
                 "again and again. The others are listed as --previous tells of them,\n"
                 "which must be of the same scan and question; OUTPUT, counts and\n"
                 "drawings leave them out")
      ->type_name("NAME")
      ->allow_extra_args(false);
}

void SeveralObstacles::readObstacles(const std::filesystem::path& first, std::vector<std::string>& warnings)
{
  std::vector<std::string> all = texts_;
  if (!first.empty()) all.insert(all.begin(), first.string());
  obstacles = parseObstacles(all, warnings);
  ignoredPairs(); // refuses wrong pairs now
  if (only.empty()) return;
  std::vector<bool> fitting;
  try {
    fitting = fittingNames("only", only, names());
  }
  catch (const InvalidInput& error) {
    throw UsageError("--only: " + error.advice());
  }
  for (std::size_t i = 0; i < obstacles.size(); ++i) obstacles[i].asked = fitting[i];
}

void SeveralObstacles::requireConsistent(bool solid, bool previous) const
{
  const auto refuse = [](const char* option, const char* wrong) {
    throw UsageError(std::string(option) + ": " + wrong);
  };
  if (obstacles.empty() && (between || !ignored.empty()))
    refuse(between ? "--between" : "--ignore", "there is one obstacle: give --obstacle NAME=FILE for each");
  if (obstacles.empty() && !only.empty()) refuse("--only", "there is one obstacle: give --obstacle NAME=FILE for each");
  if (!only.empty() && !previous) refuse("--only", "nothing tells of the other obstacles: give --previous FILE");
  const auto isSolid = [&](const ObstacleChoice& one) { return one.solid.value_or(solid); };
  if (overlap && !between) refuse("--overlap", "is of obstacles that are compared with each other: give --between");
  if (overlap && std::none_of(obstacles.begin(), obstacles.end(), isSolid))
    refuse("--overlap", "no obstacle is a solid: give --solid, or solid=true of one");
}

std::vector<std::string> SeveralObstacles::names() const
{
  std::vector<std::string> names;
  for (const ObstacleChoice& one : obstacles) names.push_back(one.name);
  return names;
}

IgnoredPairs SeveralObstacles::ignoredPairs() const
{
  try {
    return {ignored, names()};
  }
  catch (const InvalidInput& error) {
    throw UsageError("--ignore: " + error.advice());
  }
}

} // namespace pcl_bsh::cli

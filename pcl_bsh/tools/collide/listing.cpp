// SPDX-License-Identifier: BSD-3-Clause
#include "listing.h"

#include <pcl_bsh/tools/cli/step.h>

#include <algorithm>
#include <utility>

namespace pcl_bsh::cli {
namespace {

io::ClashQuestion clashQuestion(const CollideOptions& options, const Question& question,
                                const std::filesystem::path& obstacle)
{
  return {question, options.input.string(), obstacle.string()};
}

/// The clearance of all obstacles, the greatest where they have their own.
double greatestClearance(const CollideOptions& options)
{
  double greatest = options.question.clearance.value_or(0.0);
  for (const ObstacleChoice& one : options.obstacles) greatest = std::max(greatest, one.clearance.value_or(0.0));
  return greatest;
}

/// The question about an obstacle, as far as it is known before files are read.
Question questionOf(const Question& question, const ObstacleChoice& choice)
{
  return pcl_bsh::questionOf(question, {Shape(), choice.pose, choice.clearance, choice.solid, choice.uncertainty});
}

} // namespace

std::vector<io::ClashList> readEarlier(const CollideOptions& options, const Question& question,
                                       std::vector<std::string>& warnings)
{
  if (!options.previous) return {};
  std::vector<io::ClashList> lists = io::readClashLists(*options.previous);
  const auto compare = [&](const std::string& name, const Question& now, const std::filesystem::path& file) {
    const io::ClashQuestion asked = clashQuestion(options, now, file);
    if (const io::ClashList* const list = io::findList(lists, name, asked))
      for (std::string& warning : io::requireComparable(*options.previous, *list, asked))
        addOnce(std::move(warning), warnings);
  };
  if (options.obstacles.empty()) compare("", question, options.obstacle);
  for (const ObstacleChoice& one : options.obstacles) compare(one.name, questionOf(question, one), one.file);
  return lists;
}

std::string listClashes(const CollideOptions& options, const SphereHierarchy& a,
                        const std::vector<const SphereHierarchy*>& hierarchies,
                        const std::vector<io::ClashList>& earlier, CollisionReport& report)
{
  Step step("Listing clashes");
  const double distance =
      options.cluster_distance > 0
          ? options.cluster_distance
          : io::clusterDistanceFor(greatestClearance(options), report.answer.density.input.value_or(Spacing()));
  io::ClashLists lists;
  for (std::size_t i = 0; i < report.obstacles.size(); ++i) {
    ComparedObstacle& one = report.obstacles[i];
    one.poses = one.question.poses();
    const Answer& answer = one.name.empty() ? report.answer : one.answer;
    io::ClashReport list = io::clashesOf(clashQuestion(options, one.question, one.file), a, *hierarchies[i], one.poses,
                                         answer, distance, one.loaded.isSurface() ? &one.loaded : nullptr);
    list.unit = report.unit;
    list.coordinate_system = report.coordinate_system;
    list.name = one.name;
    if (!one.name.empty()) list.answer = &one.found;
    if (const io::ClashList* const before = io::findList(earlier, one.name, list.question))
      for (std::string& warning : io::compareWithList(list, *options.previous, *before, a, *hierarchies[i]))
        addOnce(std::move(warning), report.warnings);
    else if (options.previous)
      list.previous = options.previous->string();
    lists.obstacles.push_back(std::move(list));
  }
  lists.between = report.between;
  if (lists.haveNames() && options.previous)
    for (std::string& warning : io::warningsOfGone(lists, *options.previous, earlier))
      report.warnings.push_back(std::move(warning));
  for (const std::filesystem::path& file : options.clashes) io::writeClashes(file, lists);
  report.seconds.clashes = step.done(io::clashCounts(lists));
  return io::clashCounts(lists);
}

} // namespace pcl_bsh::cli

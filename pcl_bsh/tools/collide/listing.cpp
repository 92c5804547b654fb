// SPDX-License-Identifier: BSD-3-Clause
#include "listing.h"

#include <pcl_bsh/tools/cli/step.h>

#include <utility>

namespace pcl_bsh::cli {

io::ClashListing listingOf(const CollideOptions& options, const Question& question, std::vector<std::string>& warnings)
{
  io::ClashListing listing = {options.input.string()};
  if (options.cluster_distance > 0) listing.cluster_distance = options.cluster_distance;
  listing.previous = options.previous;
  std::vector<io::ComparedObstacle> obstacles;
  const auto add = [&](const std::string& name, const std::filesystem::path& file, const Question& asked) {
    obstacles.push_back({name, file.string()});
    obstacles.back().question = asked;
    return &obstacles.back();
  };
  if (options.obstacles.empty()) add("", options.obstacle, question);
  for (const ObstacleChoice& one : options.obstacles)
    add(one.name, one.file, questionOf(question, one.placed(Shape())))->asked = one.asked;
  listing.readEarlier(obstacles, warnings);
  return listing;
}

std::string listClashes(const CollideOptions& options, const SphereHierarchy& a,
                        const std::vector<const SphereHierarchy*>& hierarchies, io::ClashListing& listing,
                        CollisionReport& report)
{
  Step step("Listing clashes");
  listing.between = report.between;
  const io::ClashLists lists = listOf(listing, a, hierarchies, report.obstacles, report.answer, report.warnings);
  options.write(lists, report.warnings);
  report.seconds.clashes = step.done(io::clashCounts(lists));
  return io::clashCounts(lists);
}

} // namespace pcl_bsh::cli

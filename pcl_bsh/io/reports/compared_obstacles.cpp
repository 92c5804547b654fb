// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/compared_obstacles.h>

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/question/warnings/warnings.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace pcl_bsh::io {
namespace {

void addEachOnce(std::vector<std::string>&& more, std::vector<std::string>& warnings)
{
  for (std::string& one : more) addOnce(std::move(one), warnings);
}

} // namespace

std::string summaryOf(const std::vector<ComparedObstacle>& obstacles, const std::vector<BetweenObstacles>& between,
                      const char* part)
{
  std::ostringstream out;
  const auto tell_distance = [&](const DistanceResult& closest) {
    if (!closest.pair) return;
    out << ", smallest distance " << closest.distance;
    if (closest.distance < 0.0) out << " (" << -closest.distance << " deep)";
  };
  for (const ComparedObstacle& one : obstacles) {
    out << one.name << ": " << nameOfState(one.found);
    if (one.found.colliding > 0) out << " of " << counted(one.found.colliding, part);
    if (one.found.unseen > 0) out << ", " << counted(one.found.unseen, one.partName()) << " unseen";
    tell_distance(one.found.closest);
    if (one.found.closest_pose >= 0) out << " at pose " << one.found.closest_pose;
    out << '\n';
  }
  for (const BetweenObstacles& two : between) {
    out << two.first << " and " << two.second << ": " << nameOfState(two.pair.verdict);
    tell_distance(two.pair.closest);
    if (two.pair.closest_pose >= 0) out << " at pose " << two.pair.closest_pose;
    if (two.pair.first_pose >= 0) out << ", first at pose " << two.pair.first_pose;
    for (const auto& [name, area] :
         {std::pair{&two.first, &two.pair.first_within}, {&two.second, &two.pair.second_within}})
      if (*area && (*area)->upper > 0.0) out << ", area of " << *name << " inside " << areaText(*area);
    out << '\n';
  }
  return out.str();
}

Json obstacleJson(const ComparedObstacle& one, const std::string& input, const std::optional<SourcePoint>& nearest)
{
  const ClashQuestion question = {one.question, input, one.file};
  if (!one.kept) {
    const Obstacle* const surface = one.loaded.isSurface() ? &one.loaded : nullptr;
    return obstacleJson(one.name, question, surfaceJson(surface, question.solid), one.found, nearest);
  }
  const auto& pair = one.found.closest.pair;
  const bool has_source = pair && !one.kept->sources.empty();
  return obstacleJson(one.name, question, one.kept->surface, one.found,
                      has_source ? std::optional(one.kept->sources[pair->a]) : std::nullopt);
}

double greatestClearance(const std::vector<ComparedObstacle>& obstacles)
{
  double greatest = 0.0;
  for (const ComparedObstacle& one : obstacles) greatest = std::max(greatest, one.question.clearance.value_or(0.0));
  return greatest;
}

ObstaclesAnswer askAbout(const Question& question, Shape& input, std::vector<PlacedShape>& shapes,
                         std::vector<ComparedObstacle>& obstacles)
{
  ObstaclesAnswer found;
  if (obstacles.front().name.empty()) {
    found.all = ask(question, input, shapes.front().shape);
    return found;
  }
  const bool keep = question.wanted.collisions();
  found = ask(question, input, shapes, [&](std::size_t i, const Question& asked, Answer& answer) {
    if (!keep) return;
    obstacles[i].question = asked;
    obstacles[i].question.progress = nullptr;
    obstacles[i].colliding = CollidingRecords(answer.collisions);
    answer.collisions = {}; // which has an entry for each record
    obstacles[i].answer = std::move(answer);
  });
  if (!keep) return found;
  for (std::size_t i = 0; i < obstacles.size(); ++i)
    if (obstacles[i].asked) obstacles[i].found = found.each[i];
  return found;
}

std::vector<BetweenObstacles> askBetween(const Question& question, std::vector<PlacedShape>& shapes,
                                         const std::vector<ComparedObstacle>& obstacles, const IgnoredPairs& ignored)
{
  std::vector<BetweenObstacles> between;
  const auto wanted = [&](std::uint32_t i, std::uint32_t k) {
    return !ignored.holds(obstacles[i].name, obstacles[k].name);
  };
  for (const ObstaclePair& pair : pcl_bsh::askBetween(question, shapes, wanted))
    between.push_back({obstacles[pair.first].name, obstacles[pair.second].name, pair});
  return between;
}

void ClashListing::readEarlier(const std::vector<ComparedObstacle>& obstacles, std::vector<std::string>& warnings)
{
  if (!previous) return;
  const ListText text = readListText(*previous);
  earlier = listsOf(text);
  std::vector<std::string> names;
  for (const ComparedObstacle& one : obstacles)
    if (!one.asked) names.push_back(one.name);
  if (!names.empty()) {
    kept = keptObstacles(*previous, text, earlier, names);
    if (cluster_distance.value_or(kept->cluster_distance) != kept->cluster_distance)
      throw files::FileError(*previous, "has the cluster distance " + numberText(kept->cluster_distance),
                             "give the same, or ask about all obstacles");
    cluster_distance = kept->cluster_distance;
  }
  for (const ComparedObstacle& one : obstacles) {
    if (!one.asked) continue; // keep() compares more
    const ClashQuestion asked = {one.question, input, one.file};
    if (const ClashList* const list = findList(earlier, one.name, asked))
      addEachOnce(requireComparable(*previous, *list, asked), warnings);
  }
}

void ClashListing::keep(std::vector<ComparedObstacle>& obstacles, const IgnoredPairs& ignored,
                        const std::optional<Extent>& scan, std::vector<std::string>& warnings) const
{
  for (ComparedObstacle& one : obstacles) {
    if (one.asked) continue;
    kept->requireSame(one.name, {one.question, input, one.file}, ignored.holds(kInputName, one.name),
                      {one.question.poses(), scan}, unit, coordinate_system);
    one.kept = &kept->by_name.at(one.name);
    one.found = one.kept->answer;
  }
  warnings.push_back(previous->string() + ": tells of " + counted(kept->by_name.size(), "obstacle") +
                     ": the others alone are asked about and counted");
}

ClashReport ClashListing::keptReport(ComparedObstacle& one, double distance, const std::optional<Extent>& scan) const
{
  static const PointsView nothing;
  const KeptObstacle& obstacle = *one.kept;
  one.poses = one.question.poses();
  ClashReport report{.question = {one.question, input, one.file},
                     .cluster_distance = distance,
                     .clashes = obstacle.list.clashes,
                     .scan = nothing,
                     .model = nothing,
                     .poses = one.poses,
                     .found = obstacle.counts,
                     .survey = {one.poses, scan},
                     .unit = unit,
                     .coordinate_system = coordinate_system,
                     .previous = previous->string(),
                     .topics = obstacle.list.topics,
                     .name = one.name,
                     .answer = &one.found,
                     .kept = &obstacle};
  if (!obstacle.sources.empty()) report.source_of = [&obstacle](std::uint32_t i) { return obstacle.sources.at(i); };
  return report;
}

void ClashListing::compare(ClashReport& list, const std::function<std::vector<std::string>(const ClashList&)>& compared,
                           std::vector<std::string>& warnings) const
{
  if (const ClashList* const before = findList(earlier, list.name, list.question))
    addEachOnce(compared(*before), warnings);
  else if (previous)
    list.previous = previous->string();
}

void ClashListing::complete(ClashLists& lists, std::vector<std::string>& warnings) const
{
  lists.between = between;
  if (lists.haveNames() && previous) addEachOnce(warningsOfGone(lists, *previous, earlier), warnings);
}

ClashLists listOf(const ClashListing& listing, const SphereHierarchy& scan,
                  const std::vector<const SphereHierarchy*>& hierarchies, std::vector<ComparedObstacle>& obstacles,
                  const Answer& alone, std::vector<std::string>& warnings)
{
  const double distance = listing.cluster_distance ? *listing.cluster_distance
                                                   : clusterDistanceFor(greatestClearance(obstacles),
                                                                        alone.density.input.value_or(Spacing()));
  const std::optional<Extent> box = extentOf(scan.view());
  ClashLists lists;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    ComparedObstacle& one = obstacles[i];
    if (one.kept) {
      lists.obstacles.push_back(listing.keptReport(one, distance, box));
      continue;
    }
    one.poses = one.question.poses();
    const bool has_name = !one.name.empty();
    ClashReport list{.question = {one.question, listing.input, one.file},
                     .cluster_distance = distance,
                     .clashes = has_name ? findClashes(scan.view(), one.colliding, distance)
                                         : findClashes(scan.view(), alone.collisions, distance),
                     .scan = scan.view(),
                     .model = hierarchies[i]->view(),
                     .poses = one.poses,
                     .found = has_name ? one.colliding.found : alone.collisions,
                     .survey = {one.poses, box},
                     .unit = listing.unit,
                     .coordinate_system = listing.coordinate_system,
                     .surface = one.loaded.isSurface() ? &one.loaded : nullptr,
                     .name = one.name,
                     .answer = has_name ? &one.found : nullptr};
    if (one.question.seen) list.unseen = has_name ? &one.answer.unseen : &alone.unseen;
    listUnseen(list);
    const auto compared = [&](const ClashList& before) {
      return compareWithList(list, *listing.previous, before, scan, *hierarchies[i]);
    };
    listing.compare(list, compared, warnings);
    lists.obstacles.push_back(std::move(list));
  }
  listing.complete(lists, warnings);
  return lists;
}

} // namespace pcl_bsh::io

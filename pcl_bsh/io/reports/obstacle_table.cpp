// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/obstacle_table.h>

namespace pcl_bsh::io {
namespace {

/// In the input's frame.
std::string placeOf(const ClashReport& report, std::uint32_t record)
{
  const Point3 p = report.scan.point(record);
  return coordinate(p[0]) + ", " + coordinate(p[1]) + ", " + coordinate(p[2]);
}

std::string distanceOf(const DistanceResult& closest)
{
  return closest.pair ? distanceText(closest.distance) : std::string();
}

std::string poseText(std::int32_t pose)
{
  return pose < 0 ? std::string() : std::to_string(pose);
}

} // namespace

Data obstacleTable(const ClashLists& lists)
{
  if (!lists.haveNames()) return false;
  List rows, between;
  bool has_areas = false, have_paths = false;
  for (const ClashReport& report : lists.obstacles) {
    const ObstacleAnswer& found = *report.answer;
    rows.push_back(
        Object{{"name", plain(report.name)},
               {"file", plain(report.question.obstacle)},
               {"state", nameOfState(found)},
               {"clearance", number(*report.question.clearance)},
               {"clashes", std::to_string(report.present())},
               {"points", std::to_string(found.colliding)},
               {"distance", distanceOf(found.closest)},
               {"place", found.closest.pair && !report.kept ? placeOf(report, found.closest.pair->a) : std::string()},
               {"pose", poseText(found.closest_pose)}});
  }
  for (const BetweenObstacles& two : lists.between) {
    has_areas = has_areas || two.pair.first_within || two.pair.second_within;
    have_paths = have_paths || two.pair.closest_pose >= 0;
    between.push_back(Object{{"first", plain(two.first)},
                             {"second", plain(two.second)},
                             {"state", nameOfState(two.pair.verdict)},
                             {"clearance", number(two.pair.clearance)},
                             {"distance", distanceOf(two.pair.closest)},
                             {"pose", poseText(two.pair.closest_pose)},
                             {"first_pose", poseText(two.pair.first_pose)},
                             {"first_within", areaText(two.pair.first_within)},
                             {"second_within", areaText(two.pair.second_within)}});
  }
  const Data pairs = between.empty()
                         ? Data(false)
                         : Data(Object{{"rows", between}, {"areas", Data(has_areas)}, {"paths", Data(have_paths)}});
  return Object{{"rows", rows}, {"between", pairs}};
}

} // namespace pcl_bsh::io

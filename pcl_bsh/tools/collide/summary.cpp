// SPDX-License-Identifier: BSD-3-Clause
#include "collide_report.h"

#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/tools/cli/program.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace pcl_bsh::cli {
namespace {

/// The smallest distance, with how sure it is.
std::string distanceText(const CollisionReport& report)
{
  std::ostringstream text;
  const DistanceResult& closest = report.answer.closest;
  const Accuracy& accuracy = report.question.accuracy;
  text << closest.distance;
  if (closest.distance < 0.0) text << " (" << -closest.distance << " deep)";
  if (accuracy.isExact()) return text.str();
  if (report.question.path) return text.str() + " within the tolerance";
  text << " or less, certainly in [" << closest.interval.lower << ", " << closest.interval.upper << "]";
  return text.str();
}

/// How many are unseen at single poses: also those that collide at another pose, which are not among the unseen ones of
/// the whole path.
std::string posesOfUnseen(const Answer::Unseen& unseen)
{
  const auto most = std::max_element(unseen.at_poses.begin(), unseen.at_poses.end());
  std::ostringstream text;
  text << " and collide at no pose; of all, " << unseen.at_poses[*unseen.first_pose] << " at pose "
       << *unseen.first_pose << ", the first with any, and " << *most << " at pose " << most - unseen.at_poses.begin()
       << ", the first with the most";
  return text.str();
}

/// The statistics of distances, with the unit where it is known.
std::string distanceSummary(const io::DistanceReport& report)
{
  const auto length = [&](double value) {
    std::ostringstream text;
    if (std::isnan(value)) return std::string("unknown");
    text << value << (report.question.unit.empty() ? "" : " ") << report.question.unit;
    return text.str();
  };
  const DistanceStatistics& statistics = report.input.statistics;
  const bool of_triangles = report.input.part == std::string("triangle");
  const Interval& interval = report.hausdorff_interval;
  const std::string certainly = report.isHausdorffAnInterval()
                                    ? ", certainly from " + length(interval.lower) + " to " + length(interval.upper)
                                    : "";
  return "; distances of " + counted(statistics.count, report.input.part) +
         (of_triangles ? ", each of its nearest place" : "") + ": mean " + length(statistics.mean) + ", RMS " +
         length(statistics.rms) + ", median " + length(statistics.median) + ", greatest " + length(statistics.maximum) +
         "; Hausdorff distance " + length(report.hausdorff) + certainly;
}

/// The word for a record of the closest pair's obstacle: "point" or "triangle".
const char* partOf(const CollisionReport& report)
{
  if (report.haveNames()) return report.obstacles[report.closest_obstacle].loaded.partName();
  return report.surface ? report.surface->partName() : "point";
}

std::string nameOf(const CollisionReport& report)
{
  return report.haveNames() ? report.obstacles[report.closest_obstacle].name : "the obstacle";
}

} // namespace

void summarise(const CollideOptions& options, const CollisionReport& report, const std::string& clashes,
               const std::optional<io::DistanceReport>& distances)
{
  warn(collide_program, report.warnings);
  std::ostream& out = options.files.summary();
  const Answer& answer = report.answer;
  if (report.haveNames())
    out << io::summaryOf(report.obstacles, report.between, report.input_is_surface ? "triangle" : "point");
  out << answer.collisions.colliding << " of "
      << counted(report.input.points, report.input_is_surface ? "triangle" : "point")
      << (report.input.points == 1 ? " collides" : " collide");
  if (report.mayLeaveUndecided()) out << ", " << answer.collisions.undecided << " are undecided";
  if (answer.widest_gap > 0) out << ", " << answer.sparse << " are not scanned densely enough";
  if (report.question.seen && !report.haveNames()) {
    out << "; of the obstacle, "
        << counted(answer.unseen.count, report.surface ? "triangle is" : "point is",
                   report.surface ? "triangles are" : "points are")
        << " unseen";
    if (answer.unseen.count > 0)
      out << " (" << answer.unseen.in_shadow << " in shadow, " << answer.unseen.inSkin() << " in the skin)";
    if (report.question.path && answer.unseen.first_pose) out << posesOfUnseen(answer.unseen);
  }
  if (const auto& pair = answer.closest.pair) {
    const std::vector<std::int32_t>& poses = answer.collisions.closest_pose;
    out << "; smallest distance " << distanceText(report);
    if (report.question.path && pair->a < poses.size() && poses[pair->a] >= 0) out << " at pose " << poses[pair->a];
    out << ", between " << (report.input_is_surface ? "triangle " : "point ") << pair->a << " of the input and "
        << partOf(report) << ' ' << pair->b << " of " << nameOf(report);
  }
  if (report.question.path) out << "; " << counted(report.question.path->size(), "pose");
  if (const auto& first = answer.collisions.first_contact)
    out << "; first contact at pose " << static_cast<double>(first->pose) + first->fraction;
  if (!clashes.empty()) out << "; " << clashes;
  if (distances) out << distanceSummary(*distances);
  if (report.surface) out << "; " << io::promiseOf(*report.surface, report.question.solid);
  out << "; wrote " << options.output.string() << '\n';
}

} // namespace pcl_bsh::cli

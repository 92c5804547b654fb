// SPDX-License-Identifier: BSD-3-Clause
#include "collide_report.h"

#include <pcl_bsh/tools/cli/json_output.h>

#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/question/options.h>

#include <cmath>
#include <tuple>
#include <utility>

namespace pcl_bsh::cli {
namespace {

nlohmann::ordered_json toJson(const CloudReport& cloud)
{
  nlohmann::ordered_json json = {{"file", cloud.file}, {"points", cloud.points}, {"finite", cloud.finite}};
  if (cloud.ignored > 0) json["ignored"] = cloud.ignored;
  return json;
}

nlohmann::ordered_json toJson(const Spacing& spacing)
{
  return {{"median", spacing.median}, {"nine_of_ten", spacing.wide}, {"sampled_points", spacing.samples}};
}

nlohmann::ordered_json pathJson(const Question& question, const Answer& answer)
{
  const TrajectoryResult& found = answer.collisions;
  nlohmann::ordered_json json;
  json["poses"] = question.path->size();
  json["swept"] = question.swept > 0.0 ? nlohmann::ordered_json(question.swept) : nlohmann::ordered_json();
  json["first_contact"] = nullptr;
  if (found.first_contact) {
    json["first_contact"] = {{"pose", found.first_contact->pose}, {"fraction", found.first_contact->fraction}};
  }
  json["table"] = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < found.poses.size(); ++k) {
    const PoseSummary& pose = found.poses[k];
    json["table"].push_back({{"pose", k},
                             {"colliding", pose.colliding_points},
                             {"undecided", pose.undecided_points},
                             {"distance", io::orNull(pose.distance)},
                             {"closest_pair", nullptr}});
    if (answer.pose_pairs.empty()) continue; // of several obstacles
    if (const auto& pair = answer.pose_pairs.at(k)) json["table"].back()["closest_pair"] = {pair->a, pair->b};
  }
  return json;
}

} // namespace

nlohmann::ordered_json toJson(const CollisionReport& report)
{
  const auto& [question, answer] = std::tie(report.question, report.answer);
  const DistanceResult& closest = answer.closest;
  const std::size_t colliding = answer.collisions.colliding, undecided = answer.collisions.undecided;
  const double clearance = question.clearance.value_or(0.0);
  nlohmann::ordered_json json;
  json["input"] = toJson(report.input);
  if (!report.haveNames()) json["obstacle"] = toJson(report.obstacle);
  json["input_surface"] =
      report.input_is_surface ? nlohmann::ordered_json{{"triangles", report.input.points}} : nullptr;
  json["surface"] = io::surfaceJson(report.surface ? &*report.surface : nullptr, question.solid);
  if (report.haveNames()) {
    json["obstacles"] = json["between"] = nlohmann::ordered_json::array();
    for (const io::ComparedObstacle& one : report.obstacles)
      json["obstacles"].push_back(io::obstacleJson(one, report.input.file));
    for (const io::BetweenObstacles& two : report.between) json["between"].push_back(io::betweenJson(two));
  }
  json["unit"] = report.unit.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(report.unit);
  json["clearance"] = clearance;
  json["colliding"] = colliding;
  json["undecided"] = undecided;
  json["sparse"] = answer.sparse;
  json["free"] = report.input.finite - colliding - undecided - answer.sparse;
  if (!answer.obstacle_flags.empty()) {
    json["colliding_of_obstacle"] = countOf(answer.obstacle_flags, Verdict::colliding);
    json["undecided_of_obstacle"] = countOf(answer.obstacle_flags, Verdict::undecided);
  }
  json["unseen"] = nullptr;
  if (question.seen) json["unseen"] = io::unseenJson(answer.unseen);
  json["options"] = io::optionsJson(question);
  json["uncertainty"] = {{"input", io::uncertaintyJson(question.uncertaintyOfInput())},
                         {"obstacle", io::uncertaintyJson(question.uncertaintyOfObstacle())}};
  json["distance"] = nullptr;
  json["closest_pair"] = nullptr;
  if (closest.pair) {
    json["distance"] = closest.distance;
    json["closest_pair"] = {closest.pair->a, closest.pair->b};
    if (report.haveNames()) json["closest_obstacle"] = report.obstacles[report.closest_obstacle].name;
  }
  json["distance_interval"] = nullptr;
  if (!question.path || std::isfinite(closest.interval.lower))
    json["distance_interval"] = {io::orNull(closest.interval.lower), io::orNull(closest.interval.upper)};
  json["accuracy"] = question.swept > 0.0 ? "swept" : question.accuracy.text();
  json["density"] = {{"input", toJson(answer.density.input.value_or(Spacing()))},
                     {"obstacle", answer.density.obstacle ? toJson(*answer.density.obstacle) : nullptr},
                     {"blind", answer.density.blind()},
                     {"widest_gap", answer.widest_gap > 0 ? nlohmann::ordered_json(answer.widest_gap) : nullptr},
                     {"could_hide_collisions", answer.density.couldHide(clearance)}};
  if (question.path) json["path"] = pathJson(question, answer);
  if (report.distances) json["distances"] = *report.distances;
  json["work"] = workJson(answer.work);
  json["work"]["voxels_total"] = report.voxels_total;
  json["seconds"] = {{"load", report.seconds.load},       {"build", report.seconds.build},
                     {"query", report.seconds.query},     {"distances", report.seconds.distances},
                     {"clashes", report.seconds.clashes}, {"write", report.seconds.write}};
  json["warnings"] = report.warnings;
  return json;
}

} // namespace pcl_bsh::cli

// SPDX-License-Identifier: BSD-3-Clause
#include "report.h"

#include <pcl_bsh/tools/cli/json_output.h>

#include <pcl_bsh/io/reports/clash_report.h>

namespace pcl_bsh::cli {
namespace {

/// A finite number, or null.
nlohmann::ordered_json orNull(double number)
{
  return std::isfinite(number) ? nlohmann::ordered_json(number) : nlohmann::ordered_json();
}

nlohmann::ordered_json toJson(const CloudReport& cloud)
{
  return {{"file", cloud.file}, {"points", cloud.points}, {"finite", cloud.finite}};
}

nlohmann::ordered_json toJson(const Spacing& spacing)
{
  return {{"median", spacing.median}, {"nine_of_ten", spacing.wide}, {"sampled_points", spacing.samples}};
}

nlohmann::ordered_json toJson(const PathReport& path)
{
  nlohmann::ordered_json json;
  json["poses"] = path.poses;
  json["swept"] = path.swept ? nlohmann::ordered_json(*path.swept) : nlohmann::ordered_json();
  json["first_contact"] = nullptr;
  if (path.first_contact) {
    json["first_contact"] = {{"pose", path.first_contact->pose}, {"fraction", path.first_contact->fraction}};
  }
  json["table"] = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < path.table.size(); ++k) {
    const PoseSummary& pose = path.table[k];
    json["table"].push_back({{"pose", k}, {"colliding", pose.colliding_points}, {"distance", orNull(pose.distance)}});
  }
  return json;
}

} // namespace

nlohmann::ordered_json toJson(const CollisionReport& report)
{
  nlohmann::ordered_json json;
  json["input"] = toJson(report.input);
  json["obstacle"] = toJson(report.obstacle);
  json["input_surface"] = report.input_surface ? nlohmann::ordered_json{{"tolerance", *report.input_surface}} : nullptr;
  json["surface"] = io::surfaceJson(report.surface ? &*report.surface : nullptr, report.besideSurface());
  json["clearance"] = report.clearance;
  json["colliding"] = report.colliding;
  json["undecided"] = report.undecided;
  json["not_scanned_densely_enough"] = report.sparse;
  json["free"] = report.input.finite - report.colliding - report.undecided - report.sparse;
  json["uncertainty"] = {{"input", io::uncertaintyJson(report.input_uncertainty)},
                         {"obstacle", io::uncertaintyJson(report.obstacle_uncertainty)}};
  json["distance"] = nullptr;
  json["closest_pair"] = nullptr;
  if (report.closest.pair) {
    json["distance"] = report.closest.distance;
    json["closest_pair"] = {report.closest.pair->a, report.closest.pair->b};
  }
  json["distance_interval"] = nullptr;
  if (!report.path) {
    json["distance_interval"] = {orNull(report.closest.interval.lower), orNull(report.closest.interval.upper)};
  }
  json["accuracy"] = report.path && report.path->swept ? "swept" : report.accuracy.text();
  json["density"] = {{"input", toJson(report.density.input.value_or(Spacing()))},
                     {"obstacle", report.density.obstacle ? toJson(*report.density.obstacle) : nullptr},
                     {"blind", report.density.blind()},
                     {"widest_gap", report.widest_gap > 0 ? nlohmann::ordered_json(report.widest_gap) : nullptr},
                     {"could_hide_collisions", report.density.couldHide(report.clearance)}};
  if (report.path) json["path"] = toJson(*report.path);
  if (report.distances) json["distances"] = *report.distances;
  json["work"] = {{"node_pairs", report.work.node_pairs},
                  {"volumes_carried", report.work.volumes_carried},
                  {"volumes_built", report.work.volumes_built},
                  {"leaf_pairs", report.work.leaf_pairs},
                  {"exact_decisions", report.work.exact_decisions},
                  {"voxels_built", report.work.voxels_built},
                  {"voxels_total", report.voxels_total}};
  json["seconds"] = {{"load", report.seconds.load},       {"build", report.seconds.build},
                     {"query", report.seconds.query},     {"distances", report.seconds.distances},
                     {"clashes", report.seconds.clashes}, {"write", report.seconds.write}};
  json["warnings"] = report.warnings;
  return json;
}

void writeReport(const std::filesystem::path& path, const CollisionReport& report)
{
  writeJson(path, toJson(report));
}

} // namespace pcl_bsh::cli

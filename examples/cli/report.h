// SPDX-License-Identifier: BSD-3-Clause
// What a comparison of two clouds found and cost, for people and for programs.
#pragma once

#include <pcl_bsh/files/replace_file.h>
#include <pcl_bsh/neighbors/spacing.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

struct CloudReport {
  std::string file;
  std::size_t points = 0;
  std::size_t finite = 0;
};

/// How wide the holes are that a collision may hide in.
struct Density {
  Spacing input, obstacle;

  /// Half a hole each: where two surfaces touch, a point of one may be this far from the nearest of the other.
  double blind() const { return (input.median + obstacle.median) / std::sqrt(2.0); }

  /// Clouds of less than a hundred points are no scans, and have no density.
  bool couldHide(double clearance) const
  {
    return std::min(input.samples, obstacle.samples) >= 100 && blind() > clearance;
  }
};

/// What is known only along a path.
struct PathReport {
  std::size_t poses = 0;
  std::optional<double> swept;
  std::vector<PoseSummary> table;            ///< one per pose; none when swept
  std::optional<FirstContact> first_contact; ///< swept only
};

struct Seconds {
  double load = 0;
  double build = 0; ///< sorting into voxels; their trees are built by the query that visits them
  double query = 0;
  double clashes = 0;
  double write = 0;
};

struct CollisionReport {
  CloudReport input;
  CloudReport obstacle;
  double clearance = 0;
  Accuracy accuracy;
  std::size_t colliding = 0; ///< points of the input
  std::size_t undecided = 0; ///< likewise
  DistanceResult closest;    ///< a: the input, b: the obstacle; along a path within the clearance only
  Density density;
  std::optional<PathReport> path;
  Work work; ///< of all queries
  std::size_t voxels_total = 0;
  Seconds seconds;
  std::vector<std::string> warnings;
};

inline nlohmann::ordered_json toJson(const CloudReport& cloud)
{
  return {{"file", cloud.file}, {"points", cloud.points}, {"finite", cloud.finite}};
}

inline nlohmann::ordered_json toJson(const Spacing& spacing)
{
  return {{"median", spacing.median}, {"nine_of_ten", spacing.wide}, {"sampled_points", spacing.samples}};
}

/// A finite number, or null.
inline nlohmann::ordered_json orNull(double number)
{
  return std::isfinite(number) ? nlohmann::ordered_json(number) : nlohmann::ordered_json();
}

inline nlohmann::ordered_json toJson(const PathReport& path)
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

/// `distance` and `closest_pair` are null when a cloud has no finite point, or nothing collides along a path;
/// `distance_interval` along a path, and each of its ends where it is not known.
inline nlohmann::ordered_json toJson(const CollisionReport& report)
{
  nlohmann::ordered_json json;
  json["input"] = toJson(report.input);
  json["obstacle"] = toJson(report.obstacle);
  json["clearance"] = report.clearance;
  json["colliding"] = report.colliding;
  json["undecided"] = report.undecided;
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
  json["proven"] = report.accuracy.isProven();
  json["density"] = {{"input", toJson(report.density.input)},
                     {"obstacle", toJson(report.density.obstacle)},
                     {"blind", report.density.blind()},
                     {"could_hide_collisions", report.density.couldHide(report.clearance)}};
  if (report.path) json["path"] = toJson(*report.path);
  json["work"] = {{"node_pairs", report.work.node_pairs},
                  {"volumes_carried", report.work.volumes_carried},
                  {"volumes_built", report.work.volumes_built},
                  {"leaf_pairs", report.work.leaf_pairs},
                  {"exact_decisions", report.work.exact_decisions},
                  {"voxels_built", report.work.voxels_built},
                  {"voxels_total", report.voxels_total}};
  json["seconds"] = {{"load", report.seconds.load},
                     {"build", report.seconds.build},
                     {"query", report.seconds.query},
                     {"clashes", report.seconds.clashes},
                     {"write", report.seconds.write}};
  json["warnings"] = report.warnings;
  return json;
}

/// @throws io::CloudFileError
inline void writeReport(const std::filesystem::path& path, const CollisionReport& report)
{
  using Json = nlohmann::ordered_json;
  // A file name need not be UTF-8, JSON must.
  const std::string text = toJson(report).dump(2, ' ', false, Json::error_handler_t::replace);
  files::replaceFile(path, [&](std::ostream& out) { out << text << '\n'; });
}

} // namespace pcl_bsh::cli

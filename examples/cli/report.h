// SPDX-License-Identifier: BSD-3-Clause
// What a comparison of two clouds found and cost, for people and for programs.
#pragma once

#include <pcl_bsh/filters/io/replace_file.h>
#include <pcl_bsh/query/result.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

struct CloudReport {
  std::string file;
  std::size_t points = 0;
  std::size_t finite = 0;
};

struct Seconds {
  double load = 0;
  double build = 0; ///< sorting into voxels; their trees are built by the query that visits them
  double query = 0;
  double write = 0;
};

struct CollisionReport {
  CloudReport input;
  CloudReport obstacle;
  double clearance = 0;
  std::size_t colliding = 0; ///< points of the input
  DistanceResult closest;    ///< a: the input, b: the obstacle
  Work work;                 ///< of all queries
  std::size_t voxels_total = 0;
  Seconds seconds;
  std::vector<std::string> warnings;
};

inline nlohmann::ordered_json toJson(const CloudReport& cloud)
{
  return {{"file", cloud.file}, {"points", cloud.points}, {"finite", cloud.finite}};
}

/// `distance` and `closest_pair` are null when a cloud has no finite point.
inline nlohmann::ordered_json toJson(const CollisionReport& report)
{
  nlohmann::ordered_json json;
  json["input"] = toJson(report.input);
  json["obstacle"] = toJson(report.obstacle);
  json["clearance"] = report.clearance;
  json["colliding"] = report.colliding;
  json["distance"] = nullptr;
  json["closest_pair"] = nullptr;
  if (report.closest.pair) {
    json["distance"] = report.closest.distance;
    json["closest_pair"] = {report.closest.pair->a, report.closest.pair->b};
  }
  json["accuracy"] = "exact";
  json["work"] = {{"node_pairs", report.work.node_pairs},
                  {"leaf_pairs", report.work.leaf_pairs},
                  {"exact_decisions", report.work.exact_decisions},
                  {"voxels_built", report.work.voxels_built},
                  {"voxels_total", report.voxels_total}};
  json["seconds"] = {{"load", report.seconds.load},
                     {"build", report.seconds.build},
                     {"query", report.seconds.query},
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
  io::replaceFile(path, [&](std::ostream& out) { out << text << '\n'; });
}

} // namespace pcl_bsh::cli

// SPDX-License-Identifier: BSD-3-Clause
// Clashes as a list for programs (.json, .csv), and read back to compare with.
#pragma once

#include <pcl_bsh/filters/io/cloud_file_error.h>
#include <pcl_bsh/filters/io/file_bytes.h>
#include <pcl_bsh/query/clashes.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace pcl_bsh::cli {

/// All that a list of clashes tells, in the frame of the input. Clouds and result are borrowed.
struct ClashReport {
  std::string input, obstacle; ///< file names
  double clearance = 0;
  double cluster_distance = 0;
  std::optional<std::string> previous; ///< file name
  std::vector<Clash> clashes;
  const PointsView& scan;
  const PointsView& model;
  const std::vector<Eigen::Isometry3d>& poses;
  const TrajectoryResult& found;
  std::optional<double> swept;

  std::size_t count(ClashStatus status) const
  {
    return static_cast<std::size_t>(
        std::count_if(clashes.begin(), clashes.end(), [&](const Clash& clash) { return clash.status == status; }));
  }

  Eigen::Vector3d scanPoint(const Clash& clash) const { return vectorOf(scan.point(clash.scan_point)); }

  /// Where the obstacle's point of the closest pair is at the closest pose (swept: when the motion from there begins).
  Eigen::Vector3d modelPoint(const Clash& clash) const
  {
    return poses[static_cast<std::size_t>(clash.closest_pose)] * vectorOf(model.point(clash.model_point));
  }

  static Eigen::Vector3d vectorOf(const Point3& p) { return {p[0], p[1], p[2]}; }
};

inline constexpr std::array<std::pair<ClashStatus, const char*>, 3> status_names = {
    {{ClashStatus::fresh, "new"}, {ClashStatus::persisting, "persisting"}, {ClashStatus::resolved, "resolved"}}};

inline const char* nameOf(ClashStatus status)
{
  return status_names[static_cast<std::size_t>(status)].second;
}

inline nlohmann::ordered_json toJson(const ClashReport& report, const Clash& clash)
{
  nlohmann::ordered_json json = {{"id", clash.id},
                                 {"status", nameOf(clash.status)},
                                 {"points", clash.points},
                                 {"box", {{"min", clash.low}, {"max", clash.high}}},
                                 {"distance", clash.distance},
                                 {"first_pose", clash.first_pose},
                                 {"closest_pose", clash.closest_pose}};
  if (clash.status == ClashStatus::resolved) return json;
  const auto side = [](std::uint32_t point, const Eigen::Vector3d& at) {
    return nlohmann::ordered_json{{"point", point}, {"at", {at.x(), at.y(), at.z()}}};
  };
  json["closest_pair"] = {{"input", side(clash.scan_point, report.scanPoint(clash))},
                          {"obstacle", side(clash.model_point, report.modelPoint(clash))}};
  return json;
}

inline std::string clashJson(const ClashReport& report)
{
  using Json = nlohmann::ordered_json;
  Json json = {{"input", report.input},
               {"obstacle", report.obstacle},
               {"clearance", report.clearance},
               {"cluster_distance", report.cluster_distance},
               {"poses", report.poses.size()},
               {"swept", report.swept ? Json(*report.swept) : Json()},
               {"previous", report.previous ? Json(*report.previous) : Json()},
               {"clashes", Json::array()}};
  for (const Clash& clash : report.clashes) json["clashes"].push_back(toJson(report, clash));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

/// One clash a line, lengths in the clouds' unit. A resolved one has no pair.
inline std::string clashCsv(const ClashReport& report)
{
  std::ostringstream csv;
  csv.precision(std::numeric_limits<double>::max_digits10);
  csv << "id,status,points,distance,first_pose,closest_pose,min_x,min_y,min_z,max_x,max_y,max_z,"
         "input_point,input_x,input_y,input_z,obstacle_point,obstacle_x,obstacle_y,obstacle_z\n";
  for (const Clash& clash : report.clashes) {
    csv << clash.id << ',' << nameOf(clash.status) << ',' << clash.points << ',' << clash.distance << ','
        << clash.first_pose << ',' << clash.closest_pose;
    for (const Point3& corner : {clash.low, clash.high}) {
      for (const double coordinate : corner) csv << ',' << coordinate;
    }
    if (clash.status == ClashStatus::resolved) {
      csv << ",,,,,,,,\n";
      continue;
    }
    const Eigen::IOFormat row(Eigen::StreamPrecision, Eigen::DontAlignCols, ",", ",");
    csv << ',' << clash.scan_point << ',' << report.scanPoint(clash).format(row) << ',' << clash.model_point << ','
        << report.modelPoint(clash).format(row) << '\n';
  }
  return csv.str();
}

/// What an earlier run listed, for compareWithEarlier(): without points and pairs.
/// @throws io::CloudFileError when it is no such list
inline std::vector<Clash> readClashes(const std::filesystem::path& path)
{
  const io::FileBytes file(path);
  try {
    const nlohmann::json list = nlohmann::json::parse(file.view());
    std::vector<Clash> clashes;
    for (const nlohmann::json& entry : list.at("clashes")) {
      Clash clash;
      clash.id = entry.at("id").get<std::string>();
      const auto status = entry.at("status").get<std::string>();
      const auto* const named =
          std::find_if(status_names.begin(), status_names.end(), [&](const auto& s) { return s.second == status; });
      if (named == status_names.end()) throw std::runtime_error("unknown status '" + status + "'");
      clash.status = named->first;
      clash.points = entry.at("points").get<std::size_t>();
      clash.low = entry.at("box").at("min").get<Point3>();
      clash.high = entry.at("box").at("max").get<Point3>();
      clash.distance = entry.at("distance").get<double>();
      clash.first_pose = entry.at("first_pose").get<std::int32_t>();
      clash.closest_pose = entry.at("closest_pose").get<std::int32_t>();
      clashes.push_back(clash);
    }
    return clashes;
  }
  catch (const std::exception& error) {
    throw io::CloudFileError(path, std::string("is no list of clashes (") + error.what() + ")",
                             "give a .json file that --clashes wrote");
  }
}

} // namespace pcl_bsh::cli

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/io/clash_report.h>
#include <pcl_bsh/filters/io/cloud_file_error.h>
#include <pcl_bsh/filters/io/file_bytes.h>
#include <pcl_bsh/filters/io/replace_file.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace pcl_bsh::io {
namespace {

nlohmann::ordered_json toJson(const ClashReport& report, const Clash& clash)
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

using Format = std::string (*)(const ClashReport&);

Format formatOf(const std::filesystem::path& path)
{
  const std::string extension = path.extension().string();
  if (extension == ".json") return clashJson;
  if (extension == ".csv") return clashCsv;
  if (extension == ".html") return clashPage;
  throw CloudFileError(path, "unknown extension '" + extension + "'", "give a .json, .csv or .html file");
}

} // namespace

std::string clashJson(const ClashReport& report)
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

std::string clashCsv(const ClashReport& report)
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

std::vector<Clash> readClashes(const std::filesystem::path& path)
{
  const FileBytes file(path);
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
    throw CloudFileError(path, std::string("is no list of clashes (") + error.what() + ")",
                         "give a .json list that an earlier run wrote");
  }
}

double clusterDistanceFor(double clearance, const Spacing& scan)
{
  const double least = std::max(clearance, 4 * scan.median);
  return least > 0 ? std::exp2(std::ceil(std::log2(least))) : 1.0;
}

void writeClashes(const std::filesystem::path& path, const ClashReport& report)
{
  const std::string text = formatOf(path)(report);
  replaceFile(path, [&](std::ostream& out) { out << text; });
}

void requireClashFormat(const std::filesystem::path& path)
{
  formatOf(path);
}

} // namespace pcl_bsh::io

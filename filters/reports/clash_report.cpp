// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/files/file_error.h>
#include <pcl_bsh/files/replace_file.h>
#include <pcl_bsh/filters/cloud_files/records.h>
#include <pcl_bsh/filters/json/json_reader.h>
#include <pcl_bsh/filters/reports/clash_report.h>
#include <pcl_bsh/filters/text_files/file_bytes.h>
#include <pcl_bsh/filters/text_files/number_text.h>

#include <cmath>
#include <limits>
#include <set>

namespace pcl_bsh::io {
namespace {

Json sourceJson(const SourcePoint& point)
{
  return {{"source", point.file}, {"record", point.record}};
}

Json toJson(const ClashReport& report, const Clash& clash)
{
  Json json = {{"id", clash.id},
               {"status", nameOf(clash.status)},
               {"points", clash.points},
               {"box", {{"min", clash.low}, {"max", clash.high}}},
               {"distance", clash.distance},
               {"first_pose", clash.first_pose},
               {"closest_pose", clash.closest_pose}};
  if (clash.status == ClashStatus::resolved) return json;
  const auto side = [](Json named, const Eigen::Vector3d& at) {
    named["at"] = {at.x(), at.y(), at.z()};
    return named;
  };
  Json input = {{"point", clash.scan_point}};
  if (report.source_of) input = sourceJson(report.source_of(clash.scan_point));
  Json obstacle = {{report.partName(), report.modelPart(clash)}};
  if (report.model_source_of) obstacle = sourceJson(report.model_source_of(clash.model_point));
  json["closest_pair"] = {{"input", side(input, report.scanPoint(clash))},
                          {"obstacle", side(obstacle, report.modelPoint(clash))}};
  return json;
}

/// A clash as toJson() made it. Corners and distances may be any finite numbers; all else is within its range.
Clash clashFrom(const JsonReader& entry)
{
  constexpr double largest = std::numeric_limits<double>::max();
  constexpr std::uint64_t last_pose = std::numeric_limits<std::int32_t>::max();
  Clash clash;
  clash.id = entry.at("id").text();
  std::vector<std::string> names;
  for (const auto& [status, name] : status_names) names.emplace_back(name);
  const std::string status = entry.at("status").oneOf(names);
  clash.status =
      status_names[static_cast<std::size_t>(std::find(names.begin(), names.end(), status) - names.begin())].first;
  clash.points = static_cast<std::size_t>(entry.at("points").whole(1, max_points));
  const JsonReader box = entry.at("box");
  const auto corner = [&](const char* key) {
    Point3 point{};
    const std::vector<JsonReader> numbers = box.at(key).elements();
    if (numbers.size() != point.size()) box.at(key).fail("has not three numbers", "give x, y and z");
    for (std::size_t k = 0; k < point.size(); ++k) point[k] = numbers[k].number(-largest, largest);
    return point;
  };
  clash.low = corner("min");
  clash.high = corner("max");
  for (std::size_t k = 0; k < clash.low.size(); ++k)
    if (!(clash.low[k] <= clash.high[k])) box.fail("has a min above its max", "exchange them");
  clash.distance = entry.at("distance").number(-largest, largest);
  clash.first_pose = static_cast<std::int32_t>(entry.at("first_pose").whole(0, last_pose));
  clash.closest_pose = static_cast<std::int32_t>(entry.at("closest_pose").whole(0, last_pose));
  return clash;
}

using Format = std::string (*)(const ClashReport&);

Format formatOf(const std::filesystem::path& path)
{
  const std::string extension = path.extension().string();
  if (extension == ".json") return clashJson;
  if (extension == ".csv") return clashCsv;
  if (extension == ".html") return clashPage;
  throw files::FileError(path, "unknown extension '" + extension + "'", "give a .json, .csv or .html file");
}

} // namespace

Json surfaceJson(const Obstacle* surface, const std::string& beside)
{
  if (surface == nullptr) return nullptr;
  return {{"triangles", surface->triangles()->size()},
          {"balls", surface->cover()->centers.size()},
          {"tolerance", surface->tolerance()},
          {"promise", promiseOf(*surface, beside)}};
}

std::string clashJson(const ClashReport& report)
{
  Json json = {{"input", report.input},
               {"obstacle", report.obstacle},
               {"surface", surfaceJson(report.surface, report.swept ? "swept motion" : "")},
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
  std::string csv =
      "id,status,points,distance,first_pose,closest_pose,min_x,min_y,min_z,max_x,max_y,max_z,"
      "input_" +
      std::string(report.source_of ? "source,input_record" : "point") + ",input_x,input_y,input_z,obstacle_" +
      (report.model_source_of ? "source,obstacle_record" : report.partName()) + ",obstacle_x,obstacle_y,obstacle_z\n";
  const auto cell = [&](const std::string& text) { csv += (csv.back() == '\n' ? "" : ",") + text; };
  for (const Clash& clash : report.clashes) {
    cell(csvText(clash.id));
    cell(nameOf(clash.status));
    cell(std::to_string(clash.points));
    cell(numberText(clash.distance));
    cell(std::to_string(clash.first_pose));
    cell(std::to_string(clash.closest_pose));
    for (const Point3& corner : {clash.low, clash.high})
      for (const double coordinate : corner) cell(numberText(coordinate));
    if (clash.status == ClashStatus::resolved) {
      csv += std::string(8U + (report.source_of ? 1U : 0U) + (report.model_source_of ? 1U : 0U), ',') + '\n';
      continue;
    }
    const auto cell_of = [&](const auto& source_of, std::uint32_t number, std::uint32_t part) {
      if (!source_of) return cell(std::to_string(part));
      const SourcePoint point = source_of(number);
      cell(csvText(point.file));
      cell(std::to_string(point.record));
    };
    cell_of(report.source_of, clash.scan_point, clash.scan_point);
    for (const double coordinate : report.scanPoint(clash)) cell(numberText(coordinate));
    cell_of(report.model_source_of, clash.model_point, report.modelPart(clash));
    for (const double coordinate : report.modelPoint(clash)) cell(numberText(coordinate));
    csv += '\n';
  }
  return csv;
}

ClashList readClashes(const std::filesystem::path& path)
{
  const FileBytes file(path);
  return parseClashes(file.view(), path.string());
}

ClashList parseClashes(std::string_view text, const std::string& name)
{
  const std::string beginning = name + ": is no list of clashes"; // which JsonReader refers to
  const Json json = parseJson(text, beginning);
  const JsonReader reader(json, beginning);
  ClashList list;
  const auto name_of = [&](const char* key) { // which may be empty
    const JsonReader cloud = reader.at(key);
    return cloud.json().is_string() ? cloud.json().get<std::string>() : cloud.text();
  };
  list.input = name_of("input");
  list.obstacle = name_of("obstacle");
  constexpr double largest = std::numeric_limits<double>::max();
  list.clearance = reader.at("clearance").number(0, largest);
  if (!reader.at("swept").json().is_null()) list.swept = reader.at("swept").number(0, largest);
  std::set<std::string> ids;
  for (const JsonReader& entry : reader.at("clashes").elements()) {
    list.clashes.push_back(clashFrom(entry));
    if (!ids.insert(list.clashes.back().id).second)
      entry.at("id").fail("is the id of another clash, too", "remove one");
  }
  return list;
}

std::vector<std::string> requireComparable(const std::filesystem::path& path, const ClashList& earlier,
                                           const ClashList& now)
{
  if (earlier.clearance != now.clearance) {
    throw files::FileError(path,
                           "lists clashes of a clearance of " + numberText(earlier.clearance) + ", not of " +
                               numberText(now.clearance) + " as asked now",
                           "ask for the same clearance, or compare with another list");
  }
  std::vector<std::string> warnings;
  const auto warn = [&](const std::string& wrong) { warnings.push_back(path.string() + ": " + wrong); };
  const auto fileName = [](const std::string& name) { return std::filesystem::path(name).filename().string(); };
  const auto compare = [&](const char* what, const std::string& before, const std::string& name) {
    if (fileName(before) == fileName(name)) return;
    warn(std::string("lists clashes of the ") + what + " '" + fileName(before) + "', now it is '" + fileName(name) +
         "': unless both show one place, what is called new or resolved means nothing");
  };
  compare("input", earlier.input, now.input);
  compare("obstacle", earlier.obstacle, now.obstacle);
  if (earlier.swept.has_value() != now.swept.has_value()) {
    warn(std::string("lists clashes ") +
         (earlier.swept ? "of swept motion, now poses alone are asked" : "at poses alone, now swept motion is asked") +
         ": clashes between poses seem " + (earlier.swept ? "resolved" : "new"));
  }
  return warnings;
}

double clusterDistanceFor(double clearance, const Spacing& scan)
{
  const double least = std::max(clearance, 4 * scan.median);
  return least > 0 ? std::exp2(std::ceil(std::log2(least))) : 1.0;
}

void writeClashes(const std::filesystem::path& path, const ClashReport& report)
{
  const std::string text = formatOf(path)(report);
  files::replaceFile(path, [&](std::ostream& out) { out << text; });
}

void requireClashFormat(const std::filesystem::path& path)
{
  formatOf(path);
}

} // namespace pcl_bsh::io

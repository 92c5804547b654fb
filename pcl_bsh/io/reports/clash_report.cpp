// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/geometry/triangle/nearest_point.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/reports/report_origin.h>
#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/question/options.h>

#include <cmath>
#include <utility>

namespace pcl_bsh::io {
namespace {

Json sourceJson(const SourcePoint& point)
{
  return {{"source", point.file}, {"record", point.record}};
}

Json toJson(const std::optional<Extent>& box)
{
  return box ? Json{{"min", box->low}, {"max", box->high}} : Json();
}

/// Where a solid makes the distance negative, or may.
Json intervalOf(const Clash& clash)
{
  if (std::isnan(clash.interval.lower)) return nullptr;
  return {clash.interval.lower, clash.interval.upper};
}

const char* certaintyOf(const Clash& clash)
{
  if (clash.wasNoClash()) return "unseen";
  return clash.isCertain() ? "certain" : "perhaps";
}

Json textOrNull(const std::string& text)
{
  return text.empty() ? Json() : Json(text);
}

Json toJson(const ClashReport& report, const Clash& clash)
{
  Json json = {{"id", clash.id},
               {"status", nameOf(clash.status)},
               {"certainty", certaintyOf(clash)},
               {"points", clash.points},
               {"certain_points", clash.certain_points},
               {"points_in_shadow", clash.wasNoClash() ? Json(clash.points_in_shadow) : Json()},
               {"box", toJson(Extent{clash.low, clash.high})},
               {"place", clash.place},
               {"distance", clash.wasNoClash() ? Json() : Json(clash.distance)},
               {"distance_interval", intervalOf(clash)},
               {"first_pose", clash.first_pose},
               {"closest_pose", clash.closest_pose}};
  if (!isPresent(clash.status)) return json;
  const auto side = [](Json named, const Eigen::Vector3d& at) {
    named["at"] = {at.x(), at.y(), at.z()};
    return named;
  };
  Json input = {{"point", clash.scan_point}};
  if (report.source_of) input = sourceJson(report.source_of(clash.scan_point));
  Json obstacle = {{report.partName(), clash.model_point}};
  if (report.model_source_of) obstacle = sourceJson(report.model_source_of(clash.model_point));
  json["closest_pair"] = {{"input", side(input, report.scanPoint(clash))},
                          {"obstacle", side(obstacle, report.modelPoint(clash))}};
  return json;
}

std::string formatOf(const std::filesystem::path& path)
{
  return io::formatOf(path, {".json", ".csv", ".html"});
}

} // namespace

Eigen::Vector3d ClashReport::modelPoint(const Clash& clash) const
{
  const Eigen::Isometry3d& pose = poses[static_cast<std::size_t>(clash.closest_pose)];
  if (!model.triangles) return pose * vectorOf(model.point(clash.model_point));
  const Eigen::Vector3d seen = pose.inverse() * scanPoint(clash);
  const Point3 nearest = nearestPoint({seen.x(), seen.y(), seen.z()}, model.triangles->triangle(clash.model_point));
  return pose * vectorOf(nearest);
}

Json optionsJson(const Question& question)
{
  Json json = Json::object();
  for (const auto& [name, text] : givenOptions(question)) json[name] = text;
  return json;
}

Json surfaceJson(const Obstacle* surface, bool solid)
{
  if (surface == nullptr) return nullptr;
  return {{"triangles", surface->triangles()->size()}, {"promise", promiseOf(*surface, solid)}};
}

Json unseenJson(const Answer::Unseen& unseen)
{
  return {{"obstacle_points", unseen.count},
          {"in_shadow", unseen.in_shadow},
          {"in_skin", unseen.inSkin()},
          {"at_poses", unseen.at_poses},
          {"in_shadow_at_poses", unseen.shadow_at_poses},
          {"first_pose", unseen.first_pose ? Json(*unseen.first_pose) : Json()},
          {"angles_of_scans", unseen.angles},
          {"inside", unseen.inside.empty() ? Json() : Json(unseen.inside)}};
}

std::string clashJson(const ClashReport& report)
{
  const ClashQuestion& question = report.question;
  const Survey& survey = report.survey;
  Json json = {{"program", reportProgram()},
               {"date", reportDate()},
               {"input", question.input},
               {"obstacle", question.obstacle},
               {"unit", textOrNull(report.unit)},
               {"coordinate_system", textOrNull(report.coordinate_system)},
               {"surface", surfaceJson(report.surface, question.solid)},
               {"clearance", *question.clearance},
               {"options", optionsJson(question)},
               {"uncertainty",
                {{"input", uncertaintyJson(question.uncertaintyOfInput())},
                 {"obstacle", uncertaintyJson(question.uncertaintyOfObstacle())}}},
               {"accuracy", question.accuracy.text()},
               {"cluster_distance", report.cluster_distance},
               {"poses", report.poses.size()},
               {"swept", question.swept > 0.0 ? Json(question.swept) : Json()},
               {"path", {{"poses", survey.poses}, {"checksum", survey.path_checksum}, {"box", toJson(survey.path)}}},
               {"scan", {{"box", toJson(survey.scan)}}},
               {"previous", report.previous ? Json(*report.previous) : Json()},
               {"clashes", Json::array()}};
  for (const Clash& clash : report.clashes) json["clashes"].push_back(toJson(report, clash));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string clashCsv(const ClashReport& report)
{
  std::string csv = "id,status,points,distance,first_pose,closest_pose,min_x,min_y,min_z,max_x,max_y,max_z,"
                    "input_" +
                    std::string(report.source_of ? "source,input_record" : "point") +
                    ",input_x,input_y,input_z,obstacle_" +
                    (report.model_source_of ? "source,obstacle_record" : report.partName()) +
                    ",obstacle_x,obstacle_y,obstacle_z,"
                    "certainty,certain_points,clearance,input_uncertainty,obstacle_uncertainty,sigmas,accuracy,unit,"
                    "coordinate_system,pose_uncertainty,distance_lower,distance_upper\n";
  const ClashQuestion& question = report.question;
  const auto cell = [&](const std::string& text) { csv += (csv.back() == '\n' ? "" : ",") + text; };
  for (const Clash& clash : report.clashes) {
    cell(csvText(clash.id));
    cell(nameOf(clash.status));
    cell(std::to_string(clash.points));
    cell(clash.wasNoClash() ? "" : numberText(clash.distance));
    cell(std::to_string(clash.first_pose));
    cell(std::to_string(clash.closest_pose));
    for (const Point3& corner : {clash.low, clash.high})
      for (const double coordinate : corner) cell(numberText(coordinate));
    const auto cell_of = [&](const auto& source_of, std::uint32_t number, std::uint32_t part) {
      if (!source_of) return cell(std::to_string(part));
      const SourcePoint point = source_of(number);
      cell(csvText(point.file));
      cell(std::to_string(point.record));
    };
    if (isPresent(clash.status)) {
      cell_of(report.source_of, clash.scan_point, clash.scan_point);
      for (const double coordinate : report.scanPoint(clash)) cell(numberText(coordinate));
      cell_of(report.model_source_of, clash.model_point, clash.model_point);
      for (const double coordinate : report.modelPoint(clash)) cell(numberText(coordinate));
    }
    else {
      csv += std::string(8U + (report.source_of ? 1U : 0U) + (report.model_source_of ? 1U : 0U), ',');
    }
    cell(certaintyOf(clash));
    cell(std::to_string(clash.certain_points));
    cell(numberText(*question.clearance));
    std::string sigmas;
    for (const Uncertainty& uncertainty : {question.uncertaintyOfInput(), question.uncertaintyOfObstacle()}) {
      cell(uncertainty.field.empty() ? numberText(uncertainty.length) : csvText(uncertainty.field));
      if (!uncertainty.field.empty()) sigmas = numberText(uncertainty.sigmas);
    }
    cell(sigmas);
    cell(question.accuracy.text());
    cell(csvText(report.unit));
    cell(csvText(report.coordinate_system));
    cell(csvText(question.pose_uncertainty.text()));
    for (const double end : {clash.interval.lower, clash.interval.upper}) cell(std::isnan(end) ? "" : numberText(end));
    csv += '\n';
  }
  return csv;
}

std::string clashCounts(const ClashReport& report)
{
  const std::size_t present = report.present(), perhaps = report.perhaps();
  std::string text = counted(present - perhaps, "clash", "clashes");
  if (report.question.isUncertain()) text += ", " + std::to_string(perhaps) + " perhaps";
  if (report.unseen) text += ", " + std::to_string(report.count(ClashStatus::unseen)) + " unseen";
  if (!report.previous) return text;
  for (const auto& [status, name] : {std::pair{ClashStatus::resolved, "resolved"},
                                     {ClashStatus::not_visited, "not visited"},
                                     {ClashStatus::not_scanned, "not scanned"}}) {
    const std::size_t count = report.count(status);
    if (count > 0 || status == ClashStatus::resolved) text += ", " + std::to_string(count) + ' ' + name;
  }
  return text;
}

ClashReport clashesOf(ClashQuestion question, const SphereHierarchy& scan, const SphereHierarchy& model,
                      const std::vector<Eigen::Isometry3d>& poses, const Answer& answer, double cluster_distance,
                      const Obstacle* surface)
{
  const bool seen = question.seen;
  ClashReport report{.question = std::move(question),
                     .cluster_distance = cluster_distance,
                     .clashes = findClashes(scan.view(), answer.collisions, cluster_distance),
                     .scan = scan.view(),
                     .model = model.view(),
                     .poses = poses,
                     .found = answer.collisions,
                     .survey = {poses, extentOf(scan.view())},
                     .surface = surface,
                     .unseen = seen ? &answer.unseen : nullptr};
  listUnseen(report);
  return report;
}

void listUnseen(ClashReport& report)
{
  if (!report.unseen) return;
  for (Clash& place : findUnseenPlaces({report.model, report.poses, report.unseen->where, &report.unseen->kinds},
                                       report.cluster_distance))
    report.clashes.push_back(std::move(place));
}

std::vector<std::string> compareWithList(ClashReport& report, const std::filesystem::path& file,
                                         const ClashList& earlier, const std::function<void(FormerPlaces&)>& look)
{
  report.previous = file.string();
  compareWithEarlier(report.clashes, earlier.clashes, report.cluster_distance);
  FormerPlaces former(report.clashes, *report.question.clearance, report.cluster_distance);
  if (!former.empty()) {
    look(former);
    if (report.unseen) tellUnseen(former, {report.model, report.poses, report.unseen->where, &report.unseen->kinds});
    former.judge();
  }
  return surveyWarnings(file, earlier, report.survey, *report.question.clearance + report.cluster_distance);
}

std::vector<std::string> compareWithList(ClashReport& report, const std::filesystem::path& file,
                                         const ClashList& earlier, const SphereHierarchy& scan,
                                         const SphereHierarchy& model)
{
  TrajectoryRequest motion;
  motion.swept = report.question.sweptTolerance();
  motion.threads = report.question.threads;
  return compareWithList(report, file, earlier, [&](FormerPlaces& former) {
    former.visit(model, report.poses, motion);
    former.scan(scan.view());
  });
}

double clusterDistanceFor(double clearance, const Spacing& scan)
{
  const double least = std::max(clearance, 4 * scan.median);
  return least > 0 ? std::exp2(std::ceil(std::log2(least))) : 1.0;
}

void writeClashes(const std::filesystem::path& path, const ClashReport& report)
{
  const std::string format = formatOf(path);
  const std::string text = format == ".json"  ? clashJson(report)
                           : format == ".csv" ? clashCsv(report)
                                              : clashPage(report);
  files::replaceFile(path, [&](std::ostream& out) { out << text; });
}

void requireClashFormat(const std::filesystem::path& path)
{
  formatOf(path);
}

} // namespace pcl_bsh::io

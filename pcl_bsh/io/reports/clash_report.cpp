// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/geometry/triangle/nearest_point.h>
#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/reports/picture.h>
#include <pcl_bsh/io/reports/report_origin.h>
#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/question/options.h>

#include <algorithm>
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

/// The interval of the distance where a solid makes this negative, or may; else null.
Json intervalOf(const Clash& clash)
{
  if (std::isnan(clash.interval.lower)) return nullptr;
  return {clash.interval.lower, clash.interval.upper};
}

Json toJson(const ClashReport& report, const Clash& clash)
{
  Json json = {{"id", report.idOf(clash)}};
  if (!report.name.empty()) json["obstacle_name"] = report.name;
  json.update({{"status", nameOf(clash.status)},
               {"certainty", certaintyOf(clash)},
               {"points", clash.points},
               {"certain_points", clash.certain_points},
               {"points_in_shadow", clash.wasNoClash() ? Json(clash.points_in_shadow) : Json()},
               {"box", toJson(Extent{clash.low, clash.high})},
               {"place", clash.place},
               {"distance", clash.wasNoClash() ? Json() : Json(clash.distance)},
               {"distance_interval", intervalOf(clash)},
               {"first_pose", clash.first_pose},
               {"closest_pose", clash.closest_pose}});
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

Json surfaceOf(const ClashReport& report)
{
  return report.kept ? report.kept->surface : surfaceJson(report.surface, report.question.solid);
}

/// The question about an obstacle.
Json askedJson(const ClashQuestion& question, Json surface)
{
  return {{"surface", std::move(surface)},
          {"clearance", *question.clearance},
          {"options", optionsJson(question)},
          {"uncertainty",
           {{"input", uncertaintyJson(question.uncertaintyOfInput())},
            {"obstacle", uncertaintyJson(question.uncertaintyOfObstacle())}}}};
}

Json pathJson(const Survey& survey)
{
  return {{"poses", survey.poses}, {"checksum", survey.path_checksum}, {"box", toJson(survey.path)}};
}

/// The smallest distance; null where there is no pair.
Json closestJson(const DistanceResult& closest)
{
  return closest.pair ? Json(closest.distance) : Json();
}

std::string formatOf(const std::filesystem::path& path)
{
  return io::formatOf(path, {".json", ".csv", ".html", ".bcf", ".bcfzip"});
}

} // namespace

Json pairJson(const std::optional<PointPair>& pair)
{
  return pair ? Json{pair->a, pair->b} : Json();
}

const char* certaintyOf(const Clash& clash)
{
  if (clash.wasNoClash()) return "unseen";
  return clash.isCertain() ? "certain" : "perhaps";
}

Eigen::Vector3d ClashReport::modelPoint(const Clash& clash) const
{
  if (kept != nullptr) return vectorOf(kept->places.at(clash.id));
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

std::vector<std::pair<const ClashReport*, const Clash*>> ClashLists::bySeverity() const
{
  std::vector<std::pair<const ClashReport*, const Clash*>> all;
  for (const ClashReport& report : obstacles)
    for (const Clash& clash : report.clashes) all.emplace_back(&report, &clash);
  if (obstacles.size() > 1)
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
      const bool gone_a = !isPresent(a.second->status), gone_b = !isPresent(b.second->status);
      return gone_a != gone_b ? gone_b : isMoreSevere(*a.second, *b.second);
    });
  return all;
}

std::size_t ClashLists::sum(std::size_t (ClashReport::*of)() const) const
{
  std::size_t all = 0;
  for (const ClashReport& report : obstacles) all += (report.*of)();
  return all;
}

std::size_t ClashLists::count(ClashStatus status) const
{
  std::size_t all = 0;
  for (const ClashReport& report : obstacles) all += report.count(status);
  return all;
}

const char* nameOfState(const ObstacleAnswer& found)
{
  return found.asked ? nameOfState(found.verdict) : "ignored";
}

const char* nameOfState(Verdict verdict)
{
  switch (verdict) {
  case Verdict::colliding:
    return "clash";
  case Verdict::undecided:
    return "perhaps";
  case Verdict::sparse:
    return "sparse";
  case Verdict::unseen:
    return "unseen";
  case Verdict::free:
    break;
  }
  return "clear";
}

Json obstacleJson(const std::string& name, const ClashQuestion& question, Json surface, const ObstacleAnswer& found,
                  const std::optional<SourcePoint>& nearest)
{
  Json json = {{"name", name}, {"file", question.obstacle}};
  json.update(askedJson(question, std::move(surface)));
  json.update({{"state", nameOfState(found)},
               {"colliding", found.colliding},
               {"undecided", found.undecided},
               {"sparse", found.sparse},
               {"unseen", found.unseen},
               {"distance", closestJson(found.closest)},
               {"closest_pose", found.closest_pose < 0 ? Json() : Json(found.closest_pose)},
               {"closest_pair", pairJson(found.closest.pair)}});
  if (nearest && found.closest.pair) json["closest_pair"][0] = sourceJson(*nearest);
  return json;
}

Json betweenJson(const BetweenObstacles& two)
{
  Json json = {{"first", two.first},
               {"second", two.second},
               {"clearance", two.pair.clearance},
               {"state", nameOfState(two.pair.verdict)},
               {"distance", closestJson(two.pair.closest)},
               {"closest_pair", pairJson(two.pair.closest.pair)}};
  for (const auto& [name, pose] :
       {std::pair{"first_pose", two.pair.first_pose}, {"closest_pose", two.pair.closest_pose}})
    if (pose >= 0) json[name] = pose;
  for (const auto& [name, area] :
       {std::pair{"area_of_first_within", &two.pair.first_within}, {"area_of_second_within", &two.pair.second_within}})
    if (*area) json[name] = {(*area)->lower, (*area)->upper};
  return json;
}

std::string areaText(const std::optional<Interval>& area)
{
  if (!area) return {};
  const auto digits = [](double end) { return numberText(end, std::chars_format::general, 4); };
  const std::string lower = digits(area->lower), upper = digits(area->upper);
  return lower == upper ? lower : lower + " to " + upper;
}

std::string clashJson(const ClashLists& lists)
{
  const ClashReport& first = lists.obstacles.front();
  const ClashQuestion& question = first.question;
  Json json = {{"program", reportProgram()}, {"date", reportDate()}, {"input", question.input}};
  if (!lists.haveNames()) json["obstacle"] = question.obstacle;
  json.update({{"unit", orNull(first.unit)}, {"coordinate_system", orNull(first.coordinate_system)}});
  if (!lists.haveNames()) json.update(askedJson(question, surfaceOf(first)));
  json.update({{"accuracy", question.accuracy.text()},
               {"cluster_distance", first.cluster_distance},
               {"poses", first.poses.size()},
               {"swept", question.swept > 0.0 ? Json(question.swept) : Json()}});
  if (!lists.haveNames()) json["path"] = pathJson(first.survey);
  json.update(
      {{"scan", {{"box", toJson(first.survey.scan)}}}, {"previous", first.previous ? Json(*first.previous) : Json()}});
  if (lists.haveNames()) {
    json["obstacles"] = json["between"] = Json::array();
    for (const ClashReport& report : lists.obstacles) {
      std::optional<SourcePoint> nearest;
      if (const auto& pair = report.answer->closest.pair; pair && report.source_of) nearest = report.source_of(pair->a);
      json["obstacles"].push_back(
          obstacleJson(report.name, report.question, surfaceOf(report), *report.answer, nearest));
      json["obstacles"].back().update({{"clashes", report.present()}, {"path", pathJson(report.survey)}});
    }
    for (const BetweenObstacles& two : lists.between) json["between"].push_back(betweenJson(two));
  }
  json["clashes"] = Json::array();
  for (const auto& [report, clash] : lists.bySeverity()) json["clashes"].push_back(toJson(*report, *clash));
  return printed(json);
}

std::string clashCounts(const ClashLists& lists)
{
  const auto any = [&](const auto& holds) {
    return std::any_of(lists.obstacles.begin(), lists.obstacles.end(), holds);
  };
  const std::size_t present = lists.present(), perhaps = lists.perhaps();
  std::string text = counted(present - perhaps, "clash", "clashes");
  if (any([](const ClashReport& report) { return report.question.isUncertain(); }))
    text += ", " + std::to_string(perhaps) + " perhaps";
  if (any([](const ClashReport& report) { return report.unseen != nullptr; }))
    text += ", " + std::to_string(lists.count(ClashStatus::unseen)) + " unseen";
  if (!lists.obstacles.front().previous) return text;
  for (const auto& [status, name] : {std::pair{ClashStatus::resolved, "resolved"},
                                     {ClashStatus::not_visited, "not visited"},
                                     {ClashStatus::not_scanned, "not scanned"}}) {
    const std::size_t count = lists.count(status);
    if (count > 0 || status == ClashStatus::resolved) text += ", " + std::to_string(count) + ' ' + name;
  }
  return text;
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
  report.topics = earlier.topics;
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

std::vector<std::string> warningsOfGone(const ClashLists& lists, const std::filesystem::path& file,
                                        const std::vector<ClashList>& earlier)
{
  std::vector<std::string> warnings;
  for (const ClashList& list : earlier) {
    const auto same = [&](const ClashReport& report) { return report.name == list.name; };
    if (std::any_of(lists.obstacles.begin(), lists.obstacles.end(), same)) continue;
    warnings.push_back(file.string() + ": lists clashes of '" + list.name +
                       "', which is no obstacle now: its clashes are left out");
  }
  return warnings;
}

std::vector<std::string> writeClashes(const std::filesystem::path& path, const ClashLists& lists)
{
  const std::string format = formatOf(path);
  const std::string text = format == ".json"        ? clashJson(lists)
                           : format == ".csv"       ? clashCsv(lists)
                           : isBcfExtension(format) ? clashBcf(lists, format == ".bcf")
                                                    : clashPage(lists);
  files::replaceFile(path, [&](std::ostream& out) { out << text; });
  if (!isBcfExtension(format) || drawsPictures() || lists.present() == 0) return {};
  return {path.string() + ": has no pictures, for this was built without librsvg (librsvg2-dev)"};
}

void requireClashFormat(const std::filesystem::path& path)
{
  formatOf(path);
}

} // namespace pcl_bsh::io

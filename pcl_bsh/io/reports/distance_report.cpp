// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/distance_report.h>

#include <pcl_bsh/io/files/replace_file.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/reports/report_origin.h>

#include <cmath>
#include <string>

namespace pcl_bsh::io {
namespace {

DistanceSide sideOf(const std::string& name, const Placed& cloud, const PointDistances& found,
                    const std::optional<double>& beyond)
{
  const PointsView points = middlesOf(cloud.hierarchy().view());
  DistanceSide side{name,       points, cloud.hierarchy().view().triangles ? "triangle" : "point",
                    cloud.pose, found,  cloud.hierarchy().size(),
                    {},         0.0,    {}};
  side.statistics = statisticsOf(found.distance);
  const double usual = side.statistics.percentiles[3];
  side.beyond = beyond.value_or(usual < 0.0 ? 0.0 : usual);       // what is inside of a solid is not far
  const double far = std::isnan(side.beyond) ? 0.0 : side.beyond; // then every point is farther than all that was asked
  side.places = findFarPlaces(side.cloud, found, far, clusterDistanceFor(0.0, spacingOf(SphereHierarchy(points))));
  return side;
}

Json toJson(const DistanceSide& side, bool is_input)
{
  const DistanceStatistics& statistics = side.statistics;
  Json percentiles;
  for (std::size_t i = 0; i < statistics.percents.size(); ++i)
    percentiles[std::to_string(statistics.percents[i])] = orNull(statistics.percentiles[i]);
  std::optional<PointPair> farthest = side.found.greatest_pair;
  if (farthest && !is_input) farthest = PointPair{farthest->b, farthest->a};
  Json json = {{"points", side.points},
               {"statistics_of", side.meaning()},
               {"count", statistics.count},
               {"farther", side.farther()},
               {"mean", orNull(statistics.mean)},
               {"rms", orNull(statistics.rms)},
               {"median", orNull(statistics.median)},
               {"percentiles", percentiles},
               {"maximum", orNull(statistics.maximum)},
               {"farthest_pair", pairJson(farthest)},
               {"places_beyond", orNull(side.beyond)},
               {"places", Json::array()}};
  for (std::size_t i = 0; i < std::min(side.places.size(), most_far_places); ++i) {
    const FarPlace& place = side.places[i];
    const Eigen::Vector3d at = side.placeOf(place.point);
    const bool known = place.closest_point != kNothing;
    json["places"].push_back({{"points", place.records.size()},
                              {"distance", orNull(place.distance)},
                              {side.part, place.point},
                              {"closest_point", known ? Json(place.closest_point) : Json()},
                              {"at", {orNull(at.x()), orNull(at.y()), orNull(at.z())}}});
  }
  return json;
}

} // namespace

const char* DistanceSide::meaning() const
{
  return std::string(part) == "triangle" ? "triangles: the distance of each one's nearest place"
                                         : "points: the distance of each one";
}

bool DistanceReport::isHausdorffAnInterval() const
{
  return hausdorff_interval.upper - hausdorff_interval.lower > 0x1p-40 * std::abs(hausdorff_interval.upper);
}

Json DistanceQuestion::surfaceToTell() const
{
  Json json = surfaceJson(surface, solid);
  if (surface != nullptr)
    json["promise"] = json["promise"].get<std::string>() + "; the distance of a triangle is that of its nearest point";
  return json;
}

DistanceReport reportOf(const DistanceQuestion& question, const Placed& input, const Placed& obstacle,
                        const SymmetricDistances& found)
{
  return {question,
          sideOf(question.input, input, found.a, question.beyond),
          sideOf(question.obstacle, obstacle, found.b, question.beyond),
          found.hausdorff,
          found.hausdorff_pair,
          found.hausdorff_interval};
}

Json distanceJson(const DistanceReport& report)
{
  const DistanceQuestion& question = report.question;
  return {{"program", reportProgram()},
          {"date", reportDate()},
          {"input", question.input},
          {"obstacle", question.obstacle},
          {"coordinate_system", orNull(question.coordinate_system)},
          {"surface", question.surfaceToTell()},
          {"unit", orNull(question.unit)},
          {"max_distance", orNull(question.request.max_distance)},
          {"accuracy", question.request.accuracy.text()},
          {"input_to_obstacle", toJson(report.input, true)},
          {"obstacle_to_input", toJson(report.obstacle, false)},
          {"hausdorff", orNull(report.hausdorff)},
          {"hausdorff_pair", pairJson(report.hausdorff_pair)},
          {"hausdorff_interval", {orNull(report.hausdorff_interval.lower), orNull(report.hausdorff_interval.upper)}}};
}

void writeDistances(const std::filesystem::path& path, const DistanceReport& report)
{
  const bool is_page = formatOf(path, {".json", ".html"}) == ".html";
  const std::string text = is_page ? distancePage(report) : printed(distanceJson(report));
  files::replaceFile(path, [&](std::ostream& out) { out << text; });
}

void requireDistanceFormat(const std::filesystem::path& path)
{
  formatOf(path, {".json", ".html"});
}

} // namespace pcl_bsh::io

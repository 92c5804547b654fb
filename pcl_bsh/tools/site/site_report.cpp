// SPDX-License-Identifier: BSD-3-Clause
#ifdef PCL_BSH_SITE_QUERIES
#include "site_report.h"

#include <pcl_bsh/io/reports/clash_report.h>

namespace pcl_bsh::cli {

namespace {

/// Adds the numbers of points that collide and that are undecided. @param of put behind the keys
void putCounts(Json& report, const std::string& of, std::uint64_t colliding, std::uint64_t undecided)
{
  report["colliding" + of] = colliding;
  report["undecided" + of] = undecided;
}

/// A point of a site, by the file of its source and its record there.
Json named(const site::Site& site, const site::SitePoint& point)
{
  return {{"source", site.sources.at(point.source).file}, {"record", point.record}};
}

void putFlags(Json& report, const site::SiteAnswer& found)
{
  putCounts(report, "", found.collisions.colliding, found.collisions.undecided);
}

void putPath(Json& report, const site::SiteAnswer& found, const Question& question)
{
  report["poses"] = question.poses().size();
  putCounts(report, "", found.collisions.colliding, found.collisions.undecided);
  report["distance"] = io::orNull(found.closest.distance);
  report["first_pose"] = found.first_pose ? Json(*found.first_pose) : Json(nullptr);
  if (question.swept > 0.0) report["swept"] = question.swept;
  const auto put_contact = [&](const char* key, const std::optional<FirstContact>& contact) {
    if (contact) report[key] = {{"pose", contact->pose}, {"fraction", contact->fraction}};
  };
  put_contact("first_contact", found.collisions.first_contact);
  put_contact("certain_contact", found.collisions.certain_contact);
}

} // namespace

Json beginReport(const site::Site& site, const SiteOptions& options)
{
  Json report = {{"site", options.site.string()}};
  if (options.obstacles.empty()) report["obstacle"] = options.obstacle.string();
  report["points"] = site.points;
  if (options.question.clearance) report["clearance"] = *options.question.clearance;
  report["accuracy"] = options.question.accuracy.text();
  report["options"] = io::optionsJson(options.question);
  return report;
}

void putTiles(Json& report, const char* key, const site::TilesRead& tiles)
{
  report[key] = {{"all", tiles.tiles}, {"needed", tiles.needed}, {"read", tiles.read}};
}

void putAnswer(Json& report, const site::Site& site, const site::Site* other, const std::string& part,
               const SiteOptions& options, const site::SiteAnswer& found)
{
  const Question& question = options.question;
  const Wanted& wanted = question.wanted;
  const bool several = !options.obstacles.empty(); // putObstacles() tells their smallest distance
  if (wanted.any) {
    report["collides"] = found.any.verdict == Verdict::colliding;
    report["undecided"] = found.any.verdict == Verdict::undecided;
  }
  else if (wanted.closest && !several) {
    report["distance"] = io::orNull(found.closest.distance);
    report["distance_interval"] = {io::orNull(found.closest.interval.lower), io::orNull(found.closest.interval.upper)};
    if (found.pair) {
      report["point"] = named(site, found.pair->a);
      report[part + "_of_obstacle"] = other ? named(*other, found.pair->b) : Json(found.pair->b.record);
    }
  }
  else if (wanted.distances) {
    report["max_distance"] = question.max_distance ? io::orNull(*question.max_distance) : Json(nullptr);
    report["measured"] = found.distances.a.measured;
    report["greatest"] = io::orNull(found.distances.a.greatest);
  }
  else if (options.alongPath()) {
    putPath(report, found, question);
  }
  else {
    putFlags(report, found);
  }
  if (question.seen) {
    if (!several) report["unseen"] = io::unseenJson(found.unseen);
    report["unseen"]["beams"] = found.beams_kept;
    putTiles(report, "tiles_of_beams", found.beam_tiles);
  }
  if (wanted.obstacle_flags) putCounts(report, "_of_obstacle", found.obstacle_colliding, found.obstacle_undecided);
}

void putObstacles(Json& report, const site::Site& site, const ObstacleFiles& obstacles,
                  const site::SiteObstaclesAnswer& found, const std::vector<io::BetweenObstacles>& between)
{
  report["distance"] = io::orNull(found.all.closest.distance);
  if (found.closest != kNothing) report["closest_obstacle"] = obstacles.all[found.closest].name;
  report["obstacles"] = report["between"] = Json::array();
  for (std::size_t i = 0; i < found.each.size(); ++i) {
    std::optional<io::SourcePoint> nearest;
    if (const auto& pair = found.each[i].pair)
      nearest = io::SourcePoint{site.sources.at(pair->a.source).file, pair->a.record};
    report["obstacles"].push_back(io::obstacleJson(obstacles.all[i], site.folder.string(), nearest));
  }
  for (const io::BetweenObstacles& two : between) report["between"].push_back(io::betweenJson(two));
}

void putPlan(Json& report, const std::vector<unsigned>& ranks, const MeasuredRun& run)
{
  Json& costs = report["costs"] = {
      {"ranks", run.ranks}, {"seconds", run.seconds}, {"copying", run.copying}, {"tiles", Json::array()}};
  for (const site::TileCost& cost : run.tiles)
    costs["tiles"].push_back({{"tile", cost.tile}, {"reading", cost.reading}, {"asking", cost.asking}});
  for (const unsigned n : ranks) {
    const RunPlan plan = planRun(run, n);
    report["plan"].push_back({{"ranks", plan.ranks},
                              {"seconds", plan.seconds},
                              {"limit", plan.limit},
                              {"on_all", plan.on_all},
                              {"copying", plan.copying},
                              {"busiest", plan.busiest},
                              {"even", plan.even},
                              {"reading", plan.reading}});
  }
}

} // namespace pcl_bsh::cli
#endif

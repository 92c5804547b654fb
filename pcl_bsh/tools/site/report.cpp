// SPDX-License-Identifier: BSD-3-Clause
#ifdef PCL_BSH_SITE_QUERIES
#include "report.h"

#include <pcl_bsh/geometry/coordinate_spacing.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/site/site_clashes.h>

namespace pcl_bsh::cli {

site::SiteRequest requestOf(const SiteOptions& options, Step* step)
{
  site::SiteRequest request;
  const Question& question = options.question;
  request.clearance = question.clearance.value_or(0.0);
  request.threads = question.threads;
  request.memory = options.memory;
  request.accuracy = question.accuracy;
  request.uncertainty = question.uncertaintyOfInput();
  request.swept = question.sweptTolerance();
  if (step != nullptr) {
    request.progress = [step](double done) {
      step->share(done);
      return true;
    };
  }
  return request;
}

Json beginReport(const site::Site& site, const SiteOptions& options)
{
  Json report = {{"site", options.site.string()}, {"obstacle", options.obstacle.string()}, {"points", site.points}};
  if (options.question.clearance) report["clearance"] = *options.question.clearance;
  report["accuracy"] = options.question.accuracy.text();
  report["options"] = io::optionsJson(options.question);
  return report;
}

void putTiles(Json& report, const char* key, const site::TilesRead& tiles)
{
  report[key] = {{"all", tiles.tiles}, {"needed", tiles.needed}, {"read", tiles.read}};
}

void putPassage(Json& report, const site::SitePassage& found, const Question& question)
{
  report["poses"] = question.poses().size();
  report["colliding"] = found.colliding;
  report["undecided"] = found.undecided;
  report["distance"] = io::orNull(double{found.distance});
  report["first_pose"] = found.first_pose < 0 ? Json(nullptr) : Json(found.first_pose);
  if (question.swept > 0.0) report["swept"] = question.swept;
  const auto put_contact = [&](const char* key, const std::optional<FirstContact>& contact) {
    if (contact) report[key] = {{"pose", contact->pose}, {"fraction", contact->fraction}};
  };
  put_contact("first_contact", found.first_contact);
  put_contact("certain_contact", found.certain_contact);
}

Json named(const site::Site& site, const site::SitePoint& point)
{
  return {{"source", site.sources.at(point.source).file}, {"record", point.record}};
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

NamedCloud namedSite(const site::Site& site)
{
  NamedCloud cloud;
  cloud.name = site.folder.string();
  cloud.points = site.points;
  for (const site::Tile& tile : site.tiles)
    if (tile.bounds) cloud.finite += tile.points; // points that are not finite have tiles of their own
  cloud.spacing.emplace();
  cloud.spacing->samples = cloud.finite;
  cloud.spacing->median = site::spacingOf(site);
  if (!site.bounds) return cloud;
  cloud.box = Eigen::AlignedBox3d(Eigen::Vector3d::Map(site.bounds->low.data()),
                                  Eigen::Vector3d::Map(site.bounds->high.data()));
  for (const pcl::PCLPointField& field : site.fields) {
    if (field.name != "x" || field.datatype != pcl::PCLPointField::FLOAT32) continue;
    cloud.coordinate_spacing =
        float32Spacing(cloud.box.min().cwiseAbs().cwiseMax(cloud.box.max().cwiseAbs()).maxCoeff());
  }
  return cloud;
}

} // namespace pcl_bsh::cli
#endif

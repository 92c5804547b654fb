// SPDX-License-Identifier: BSD-3-Clause
// The numbers of the page; clash_page.html has the page itself.
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/reports/clash_drawings.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/reports/clash_values.h>
#include <pcl_bsh/io/reports/page_text.h>

#include "clash_page.html.h"

#include <limits>
#include <utility>

namespace pcl_bsh::io {
namespace {

constexpr Area path_area{54, 12, 1010, 130};

/// The longest side of its box.
double longestSide(const Clash& clash)
{
  double size = 0;
  for (std::size_t k = 0; k < 3; ++k) size = std::max(size, clash.high[k] - clash.low[k]);
  return size;
}

std::string distanceOf(const DistanceResult& closest)
{
  return closest.pair ? distanceText(closest.distance) : std::string();
}

std::string poseText(std::int32_t pose)
{
  return pose < 0 ? std::string() : std::to_string(pose);
}

/// The tables of a page about several obstacles: a row for each, then one for each two that were compared with each
/// other; false where there is one obstacle without a name.
Data obstacleTable(const ClashLists& lists)
{
  if (!lists.haveNames()) return false;
  List rows, between;
  bool has_areas = false, have_paths = false;
  for (const ClashReport& report : lists.obstacles) {
    const ObstacleAnswer& found = *report.answer;
    const bool has_place = found.closest.pair && !report.kept;
    rows.push_back(Object{{"name", plain(report.name)},
                          {"file", plain(report.question.obstacle)},
                          {"state", nameOfState(found)},
                          {"clearance", number(*report.question.clearance)},
                          {"clashes", std::to_string(report.present())},
                          {"points", std::to_string(found.colliding)},
                          {"distance", distanceOf(found.closest)},
                          {"place", has_place ? coordinates(report.scan.point(found.closest.pair->a)) : std::string()},
                          {"pose", poseText(found.closest_pose)}});
  }
  for (const BetweenObstacles& two : lists.between) {
    has_areas = has_areas || two.pair.first_within || two.pair.second_within;
    have_paths = have_paths || two.pair.closest_pose >= 0;
    between.push_back(Object{{"first", plain(two.first)},
                             {"second", plain(two.second)},
                             {"state", nameOfState(two.pair.verdict)},
                             {"clearance", number(two.pair.clearance)},
                             {"distance", distanceOf(two.pair.closest)},
                             {"pose", poseText(two.pair.closest_pose)},
                             {"first_pose", poseText(two.pair.first_pose)},
                             {"first_within", areaText(two.pair.first_within)},
                             {"second_within", areaText(two.pair.second_within)}});
  }
  const Data pairs = between.empty()
                         ? Data(false)
                         : Data(Object{{"rows", between}, {"areas", Data(has_areas)}, {"paths", Data(have_paths)}});
  return Object{{"rows", rows}, {"between", pairs}};
}

class ClashPage {
public:
  explicit ClashPage(const ClashLists& lists)
  : lists_(lists),
    first_(lists.obstacles.front()),
    all_(lists.bySeverity()),
    drawings_(lists)
  {
  }

  std::string html() const { return rendered("clash_page.html", clash_page_html, contents()); }

private:
  template <typename Holds>
  bool any(const Holds& holds) const
  {
    return std::any_of(lists_.obstacles.begin(), lists_.obstacles.end(), holds);
  }

  bool isUncertain() const
  {
    return any([](const ClashReport& report) { return report.question.isUncertain(); });
  }

  /// How many clashes there are, the certain ones first.
  std::string headline() const
  {
    const std::size_t perhaps = isUncertain() ? lists_.perhaps() : 0;
    std::string line = counted(lists_.present() - perhaps, "clash", "clashes");
    if (isUncertain()) line += ", " + std::to_string(perhaps) + " perhaps";
    if (any([](const ClashReport& report) { return report.unseen != nullptr; }))
      line += ", " + std::to_string(lists_.count(ClashStatus::unseen)) + " unseen";
    return line;
  }

  /// The uncertainties of both sides; false where there are no uncertainties.
  Data uncertainty() const
  {
    const ClashQuestion& question = first_.question;
    if (!isUncertain()) return false;
    return Object{{"input_uncertainty", plain(uncertaintyText(question.uncertaintyOfInput()))},
                  {"obstacle_uncertainty", plain(uncertaintyText(question.uncertaintyOfObstacle()))},
                  {"undecided", std::to_string(sum(&TrajectoryResult::undecided))}};
  }

  std::size_t sum(std::size_t TrajectoryResult::*count) const
  {
    std::size_t all = 0;
    for (const ClashReport& report : lists_.obstacles) all += report.found.*count;
    return all;
  }

  Data contents() const
  {
    const ClashQuestion& question = first_.question;
    std::string promise = first_.surface != nullptr ? promiseOf(*first_.surface, question.solid) : "";
    if (lists_.haveNames()) promise.clear();
    const auto& reports = lists_.obstacles;
    const auto kept = static_cast<std::size_t>(
        std::count_if(reports.begin(), reports.end(), [](const auto& report) { return report.kept != nullptr; }));
    Object page = pageAbout(question, first_.coordinate_system, question.accuracy.text(), promise);
    if (lists_.haveNames()) page["obstacle"] = counted(lists_.obstacles.size(), "obstacle");
    page.insert(
        {{"headline", headline()},
         {"unit", textOrNone(first_.unit)},
         {"in", first_.unit.empty() ? std::string() : " [" + plain(first_.unit) + "]"},
         {"uncertainty", uncertainty()},
         {"poses", counted(first_.poses.size(), "pose")},
         {"clearance", number(drawings_.clearance())},
         {"colliding", std::to_string(sum(&TrajectoryResult::colliding))},
         {"closest", std::isfinite(drawings_.closest()) ? Data(distanceText(drawings_.closest())) : Data(false)},
         {"swept", question.swept > 0.0 ? Data(number(question.swept)) : Data(false)},
         {"cluster_distance", number(first_.cluster_distance)},
         {"compared", false},
         {"kept", kept > 0 ? Data(counted(kept, "obstacle")) : Data(false)},
         {"previous", false},
         {"obstacles", obstacleTable(lists_)},
         {"path", path()},
         {"nothing", all_.empty()},
         {"tables", tables()},
         {"one_by_one", cards()}});
    if (first_.previous) {
      page["previous"] = plain(*first_.previous);
      List compared;
      for (std::size_t i = 0; i < clash_statuses; ++i) {
        const auto status = static_cast<ClashStatus>(i);
        if (lists_.count(status) == 0 && i > static_cast<std::size_t>(ClashStatus::resolved)) continue; // rare ones
        compared.push_back(Object{{"count", std::to_string(lists_.count(status))}, {"status", inWords(status)}});
      }
      page["compared"] = compared;
    }
    return page;
  }

  /// The smallest distance at each pose, infinity where nothing collides. Swept, it is known of each point's closest
  /// pose only.
  std::vector<double> nearestAtPoses() const
  {
    std::vector<double> nearest(first_.poses.size(), std::numeric_limits<double>::infinity());
    for (const ClashReport& report : lists_.obstacles) {
      for (std::size_t k = 0; k < report.found.poses.size(); ++k)
        nearest[k] = std::min(nearest[k], report.found.poses[k].distance);
      for (const Clash& clash : report.clashes) {
        for (std::size_t i = 0; i < clash.records.size(); ++i) {
          double& at_pose = nearest[static_cast<std::size_t>(clash.closest_poses[i])];
          at_pose = std::min(at_pose, static_cast<double>(clash.distances[i]));
        }
      }
    }
    return nearest;
  }

  /// A bar for each pose where something collides, or for a few poses that cannot be told apart.
  Data path() const
  {
    const std::vector<double> poses = nearestAtPoses();
    if (poses.size() < 2) return false;
    const std::size_t columns = std::min<std::size_t>(poses.size(), 1000);
    const double width = path_area.width / static_cast<double>(columns);
    List bars;
    for (std::size_t c = 0; c < columns; ++c) {
      const auto first = poses.begin() + static_cast<std::ptrdiff_t>(c * poses.size() / columns);
      const auto last = poses.begin() + static_cast<std::ptrdiff_t>((c + 1) * poses.size() / columns);
      const double nearest = *std::min_element(first, last);
      if (!std::isfinite(nearest)) continue;
      bars.push_back(Object{{"x", coordinate(path_area.left + static_cast<double>(c) * width)},
                            {"width", coordinate(std::max(width, 1.0))},
                            {"height", coordinate(std::max(2.0, path_area.height * (1 - drawings_.shareOf(nearest))))},
                            {"color", drawings_.colorOf(nearest)}});
    }
    return Object{{"bars", bars},
                  {"limit", number(drawings_.clearance(), 3)},
                  {"lowest", number(drawings_.lowest(), 3)},
                  {"last", std::to_string(poses.size() - 1)}};
  }

  /// The text has both ends of the interval where they differ as written: of triangles and of swept motion.
  static std::string distanceOf(const Clash& clash)
  {
    const std::string told = distanceText(clash.distance), least = number(-clash.interval.upper),
                      most = number(-clash.interval.lower);
    if (!clash.isDeep() || std::isnan(clash.interval.lower) || least == most) return told;
    return least + " to " + most + " deep";
  }

  static Object factsOf(const ClashReport& report, const Clash& clash)
  {
    return {{"id", plain(report.idOf(clash))},
            {"class", nameOf(clash.status)},
            {"status", inWords(clash.status)},
            {"perhaps", !clash.isCertain()},
            {"distance", clash.wasNoClash() ? std::string() : distanceOf(clash)},
            {"at_the", clash.isDeep() ? std::string("deepest") : std::string("closest")},
            {"points", std::to_string(clash.points)},
            {"points_noun", nounOf(clash.points, "point")},
            {"first_pose", std::to_string(clash.first_pose)},
            {"closest_pose", std::to_string(clash.closest_pose)}};
  }

  enum class Table { certain, perhaps, unseen }; ///< each kind of clash has its own

  static Table tableOf(const Clash& clash)
  {
    if (clash.wasNoClash()) return Table::unseen;
    return clash.isCertain() ? Table::certain : Table::perhaps;
  }

  Data rowsOf(Table table) const
  {
    List rows;
    std::size_t cards = 0;
    for (const auto& [report, one] : all_) {
      const Clash& clash = *one;
      const bool has_card = report->draws(clash) && cards++ < most_clash_pictures;
      if (tableOf(clash) != table) continue;
      Object row = factsOf(*report, clash);
      row["size"] = number(longestSide(clash), 3);
      row["linked"] = has_card;
      row["unseen"] = table == Table::unseen;
      row["in_shadow"] = std::to_string(clash.points_in_shadow);
      rows.push_back(std::move(row));
    }
    return rows.empty() ? Data(false) : Data(rows);
  }

  List tables() const
  {
    List tables;
    for (const auto& [table, title] :
         {std::pair{Table::certain, "By severity"}, {Table::perhaps, "Perhaps"}, {Table::unseen, "Unseen"}}) {
      Data rows = rowsOf(table);
      if (rows.is_false()) continue;
      tables.push_back(Object{{"title", title},
                              {"perhaps_only", table == Table::perhaps},
                              {"unseen_only", table == Table::unseen},
                              {"rows", rows}});
    }
    return tables;
  }

  Data cards() const
  {
    List cards;
    bool all = true;
    for (const auto& [report, clash] : all_) {
      if (!report->draws(*clash)) continue;
      all = cards.size() < most_clash_pictures;
      if (!all) break;
      cards.push_back(card(*report, *clash));
    }
    if (cards.empty()) return false;
    return Object{{"cards", cards}, {"most_pictures", all ? Data(false) : Data(std::to_string(most_clash_pictures))}};
  }

  static std::string nameOfPart(const std::function<SourcePoint(std::uint32_t)>& source_of, std::uint32_t number,
                                std::uint32_t part)
  {
    if (!source_of) return std::to_string(part);
    const SourcePoint point = source_of(number);
    return std::to_string(point.record) + " of " + plain(point.file);
  }

  Data card(const ClashReport& report, const Clash& clash) const
  {
    Object card = factsOf(report, clash);
    card["scan_point"] = nameOfPart(report.source_of, clash.scan_point, clash.scan_point);
    card["scan_place"] = coordinates(report.scanPoint(clash));
    card["model_part"] =
        report.partName() + (' ' + nameOfPart(report.model_source_of, clash.model_point, clash.model_point));
    card["model_name"] = report.name.empty() ? std::string("the obstacle") : plain(report.name);
    card["top_view"] = drawings_.topView(report, clash);
    card["approach"] = drawings_.approach(report, clash);
    return card;
  }

  const ClashLists& lists_;
  const ClashReport& first_;
  const std::vector<std::pair<const ClashReport*, const Clash*>> all_;
  const ClashDrawings drawings_;
};

} // namespace

std::string clashPage(const ClashLists& lists)
{
  return ClashPage(lists).html();
}

} // namespace pcl_bsh::io

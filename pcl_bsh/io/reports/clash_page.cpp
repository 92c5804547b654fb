// SPDX-License-Identifier: BSD-3-Clause
// The numbers of the page; clash_page.html has the page itself.
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/reports/clash_report.h>
#include <pcl_bsh/io/reports/clash_values.h>
#include <pcl_bsh/io/reports/obstacle_table.h>
#include <pcl_bsh/io/reports/page_text.h>

#include "clash_page.html.h"

#include <limits>
#include <utility>

namespace pcl_bsh::io {
namespace {

constexpr std::size_t most_pictures = 200; ///< beyond so many clashes there is only the table
constexpr std::size_t most_dots = 500;     ///< of a clash in a picture

constexpr Area path_area{54, 12, 1010, 130}, top_view_area{6, 6, 508, 268}, approach_area{54, 10, 456, 236};

/// The longest side of its box.
double longestSide(const Clash& clash)
{
  double size = 0;
  for (std::size_t k = 0; k < 3; ++k) size = std::max(size, clash.high[k] - clash.low[k]);
  return size;
}

class ClashPage {
public:
  explicit ClashPage(const ClashLists& lists)
  : lists_(lists),
    first_(lists.obstacles.front()),
    all_(lists.bySeverity()),
    clearance_(greatestClearance(lists)),
    closest_(closestOf(lists)),
    lowest_(std::isfinite(closest_) ? std::min(0.0, closest_) : 0.0),
    range_(clearance_ - lowest_)
  {
  }

  std::string html() const { return rendered("clash_page.html", clash_page_html, contents()); }

private:
  static double greatestClearance(const ClashLists& lists)
  {
    double greatest = 0.0;
    for (const ClashReport& report : lists.obstacles) greatest = std::max(greatest, *report.question.clearance);
    return greatest;
  }

  /// The smallest distance of all that are there now, infinity without clashes.
  static double closestOf(const ClashLists& lists)
  {
    double closest = std::numeric_limits<double>::infinity();
    for (const ClashReport& report : lists.obstacles)
      for (const Clash& clash : report.clashes)
        if (isPresent(clash.status)) closest = std::min(closest, clash.distance);
    return closest;
  }

  template <typename Holds>
  bool any(const Holds& holds) const
  {
    return std::any_of(lists_.obstacles.begin(), lists_.obstacles.end(), holds);
  }

  bool isUncertain() const
  {
    return any([](const ClashReport& report) { return report.question.isUncertain(); });
  }

  /// Certain ones first.
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
    Object page = pageAbout(question, first_.coordinate_system, question.accuracy.text(), promise);
    if (lists_.haveNames()) page["obstacle"] = counted(lists_.obstacles.size(), "obstacle");
    page.insert({{"headline", headline()},
                 {"unit", textOrNone(first_.unit)},
                 {"in", first_.unit.empty() ? std::string() : " [" + plain(first_.unit) + "]"},
                 {"uncertainty", uncertainty()},
                 {"poses", counted(first_.poses.size(), "pose")},
                 {"clearance", number(clearance_)},
                 {"colliding", std::to_string(sum(&TrajectoryResult::colliding))},
                 {"closest", std::isfinite(closest_) ? Data(distanceText(closest_)) : Data(false)},
                 {"swept", question.swept > 0.0 ? Data(number(question.swept)) : Data(false)},
                 {"cluster_distance", number(first_.cluster_distance)},
                 {"compared", false},
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

  /// From deep red where clouds touch to pale yellow at the clearance.
  std::string colorOf(double distance) const
  {
    const double share = clearance_ > 0 ? std::clamp(distance / clearance_, 0.0, 1.0) : 0.0;
    const auto mix = [&](int from, int to) { return std::to_string(static_cast<int>(from + share * (to - from))); };
    return "rgb(" + mix(150, 245) + ',' + mix(10, 190) + ',' + mix(40, 66) + ')';
  }

  /// A scale from the clearance (1) down to the lowest distance (0), which is negative where radii overlap.
  double shareOf(double distance) const
  {
    return range_ > 0 ? std::clamp((distance - lowest_) / range_, 0.0, 1.0) : 0.0;
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
                            {"height", coordinate(std::max(2.0, path_area.height * (1 - shareOf(nearest))))},
                            {"color", colorOf(nearest)}});
    }
    return Object{{"bars", bars},
                  {"limit", number(clearance_, 3)},
                  {"lowest", number(lowest_, 3)},
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
      const bool has_card = isPresent(clash.status) && cards++ < most_pictures;
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
      if (!isPresent(clash->status)) continue;
      all = cards.size() < most_pictures;
      if (!all) break;
      cards.push_back(card(*report, *clash));
    }
    if (cards.empty()) return false;
    return Object{{"cards", cards}, {"most_pictures", all ? Data(false) : Data(std::to_string(most_pictures))}};
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
    const Eigen::Vector3d p = report.scanPoint(clash);
    Object card = factsOf(report, clash);
    card["scan_point"] = nameOfPart(report.source_of, clash.scan_point, clash.scan_point);
    card["scan_place"] = coordinate(p.x()) + ", " + coordinate(p.y()) + ", " + coordinate(p.z());
    card["model_part"] =
        report.partName() + (' ' + nameOfPart(report.model_source_of, clash.model_point, clash.model_point));
    card["model_name"] = report.name.empty() ? std::string("the obstacle") : plain(report.name);
    card["top_view"] = topView(report, clash);
    card["approach"] = approach(report, clash);
    return card;
  }

  /// Some of its points, evenly picked, as circles. These are too many to be data of the template.
  /// @param x, y where the clash's record of a number lies in the drawing
  template <typename X, typename Y>
  std::string dotsOf(const Clash& clash, const X& x, const Y& y) const
  {
    std::string dots;
    const std::size_t count = std::min(clash.records.size(), most_dots);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = k * clash.records.size() / count;
      dots += "<circle cx=\"" + coordinate(x(i)) + "\" cy=\"" + coordinate(y(i)) + "\" r=\"2\" fill=\"" +
              colorOf(static_cast<double>(clash.distances[i])) + "\"/>";
    }
    return dots;
  }

  Data topView(const ClashReport& report, const Clash& clash) const
  {
    const Eigen::Vector3d scan = report.scanPoint(clash), model = report.modelPoint(clash);
    Eigen::AlignedBox2d box(Eigen::Vector2d(clash.low[0], clash.low[1]), Eigen::Vector2d(clash.high[0], clash.high[1]));
    box.extend(model.head<2>());
    const double least = std::max({box.sizes().maxCoeff() * 0.1, report.cluster_distance, 1e-9});
    const Eigen::Vector2d size = box.sizes().array() + least;
    const ViewFromAbove seen{top_view_area, box.center(), size};
    return Object{{"dots", dotsOf(
                               clash, [&](std::size_t i) { return seen.x(report.scan.point(clash.records[i])[0]); },
                               [&](std::size_t i) { return seen.y(report.scan.point(clash.records[i])[1]); })},
                  {"scan_x", coordinate(seen.x(scan.x()))},
                  {"scan_y", coordinate(seen.y(scan.y()))},
                  {"model_x", coordinate(seen.x(model.x()))},
                  {"model_y", coordinate(seen.y(model.y()))},
                  {"scale_width", coordinate(seen.bar * seen.scale)},
                  {"scale_end", number(top_view_area.left + 10 + seen.bar * seen.scale + 6, 6)},
                  {"scale_length", number(seen.bar)}};
  }

  /// Poses across, distances up.
  Data approach(const ClashReport& report, const Clash& clash) const
  {
    constexpr const Area& area = approach_area;
    std::int32_t first = clash.closest_pose, last = clash.closest_pose;
    for (const std::int32_t pose : clash.closest_poses) {
      first = std::min(first, pose);
      last = std::max(last, pose);
    }
    const auto x = [&](std::int32_t pose) {
      if (first == last) return area.left + area.width / 2;
      return area.left + 6 + (area.width - 12) * static_cast<double>(pose - first) / (last - first);
    };
    const auto y = [&](double distance) { return area.top + area.height - 4 - (area.height - 12) * shareOf(distance); };
    const double limit_y = y(*report.question.clearance);
    return Object{{"dots", dotsOf(
                               clash, [&](std::size_t i) { return x(clash.closest_poses[i]); },
                               [&](std::size_t i) { return y(static_cast<double>(clash.distances[i])); })},
                  {"limit", number(*report.question.clearance, 3)},
                  {"limit_y", number(limit_y, 6)},
                  {"limit_text_y", number(limit_y + 4, 6)},
                  {"lowest", number(lowest_, 3)},
                  {"lowest_text_y", number(y(lowest_) + 2, 6)},
                  {"closest_x", coordinate(x(clash.closest_pose))},
                  {"closest_y", coordinate(y(clash.distance))},
                  {"only", first == last ? Data(std::to_string(first)) : Data(false)},
                  {"first", std::to_string(first)},
                  {"last", std::to_string(last)}};
  }

  const ClashLists& lists_;
  const ClashReport& first_;
  const std::vector<std::pair<const ClashReport*, const Clash*>> all_;
  const double clearance_; ///< the greatest of all obstacles
  const double closest_;
  const double lowest_; ///< where the scale of distances ends
  const double range_;  ///< from there to the clearance
};

} // namespace

std::string clashPage(const ClashLists& lists)
{
  return ClashPage(lists).html();
}

} // namespace pcl_bsh::io

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/clash_drawings.h>
#include <pcl_bsh/io/reports/page_text.h>

#include "clash_approach.svg.h"
#include "clash_picture.svg.h"
#include "clash_top_view.svg.h"

#include <array>
#include <limits>

namespace pcl_bsh::io {
namespace {

constexpr std::size_t most_dots = 500;               ///< of a clash in a drawing
constexpr std::size_t most_parts = 300;              ///< of the obstacle in a drawing
constexpr std::size_t most_parts_looked_at = 500000; ///< for a drawing: of more, every second, or third ...
constexpr Area top_view_area{6, 6, 508, 268}, approach_area{54, 10, 456, 236};

double greatestClearance(const ClashLists& lists)
{
  double greatest = 0.0;
  for (const ClashReport& report : lists.obstacles) greatest = std::max(greatest, *report.question.clearance);
  return greatest;
}

/// The smallest distance of all that are there now, infinity without clashes.
double closestOf(const ClashLists& lists)
{
  double closest = std::numeric_limits<double>::infinity();
  for (const ClashReport& report : lists.obstacles)
    for (const Clash& clash : report.clashes)
      if (isPresent(clash.status)) closest = std::min(closest, clash.distance);
  return closest;
}

/// The obstacle's points or triangles about the clash as a path, some of many, at the pose of the closest pair.
/// @param around how far above and below the clash they may be
std::string obstacleAbout(const ClashReport& report, const Clash& clash, const ViewFromAbove& seen, double around)
{
  const PointsView& model = report.model;
  const Eigen::Isometry3d& pose = report.poses[static_cast<std::size_t>(clash.closest_pose)];
  const double half_x = seen.area.width / 2 / seen.scale, half_y = seen.area.height / 2 / seen.scale;
  const Eigen::AlignedBox3d box(
      Eigen::Vector3d(seen.middle.x() - half_x, seen.middle.y() - half_y, clash.low[2] - around),
      Eigen::Vector3d(seen.middle.x() + half_x, seen.middle.y() + half_y, clash.high[2] + around));
  const Eigen::AlignedBox3d box_of_obstacle = box.transformed(pose.inverse());
  std::vector<std::uint32_t> parts;
  for (std::size_t i = 0; i < model.size(); i += model.size() / most_parts_looked_at + 1) {
    const std::uint32_t record = model.record(i);
    const double away = box_of_obstacle.exteriorDistance(ClashReport::vectorOf(model.point(record)));
    if (away <= model.radius(record)) parts.push_back(record); // not if it is NaN
  }
  const auto posed = [&](const Point3& p) { return Eigen::Vector3d(pose * ClashReport::vectorOf(p)); };
  const auto drawn = [&](const Eigen::Vector3d& at) {
    return coordinate(seen.x(at.x())) + ' ' + coordinate(seen.y(at.y()));
  };
  std::string path;
  const std::size_t count = std::min(parts.size(), most_parts);
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t record = parts[k * parts.size() / count];
    if (model.triangles) {
      const std::array<Point3, 3> corners = model.triangles->triangle(record);
      const Eigen::Vector3d a = posed(corners[0]), b = posed(corners[1]), c = posed(corners[2]);
      const bool turns_left = (b - a).cross(c - a).z() >= 0; // all wind alike, so that overlapping triangles fill
      path += 'M' + drawn(a) + 'L' + drawn(turns_left ? b : c) + 'L' + drawn(turns_left ? c : b) + 'z';
    }
    else {
      path += 'M' + drawn(posed(model.point(record))) + "h1v1h-1z";
    }
  }
  return path;
}

} // namespace

ClashDrawings::ClashDrawings(const ClashLists& lists)
: clearance_(greatestClearance(lists)),
  closest_(closestOf(lists)),
  lowest_(std::isfinite(closest_) ? std::min(0.0, closest_) : 0.0),
  range_(clearance_ - lowest_)
{
}

std::string ClashDrawings::colorOf(double distance) const
{
  const double share = clearance_ > 0 ? std::clamp(distance / clearance_, 0.0, 1.0) : 0.0;
  constexpr std::array<std::array<double, 3>, 2> ends = {{{150, 10, 40}, {245, 190, 66}}};
  return colorBetween(ends, share);
}

double ClashDrawings::shareOf(double distance) const
{
  return range_ > 0 ? std::clamp((distance - lowest_) / range_, 0.0, 1.0) : 0.0;
}

/// Some of its points, evenly picked, as circles. These are too many to be data of the template.
/// @param x, y give the place in the drawing of a record of the clash, by its index in `records`
template <typename X, typename Y>
std::string ClashDrawings::dotsOf(const Clash& clash, const X& x, const Y& y) const
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

std::string ClashDrawings::topView(const ClashReport& report, const Clash& clash) const
{
  const Eigen::Vector3d scan = report.scanPoint(clash), model = report.modelPoint(clash);
  Eigen::AlignedBox2d box(Eigen::Vector2d(clash.low[0], clash.low[1]), Eigen::Vector2d(clash.high[0], clash.high[1]));
  box.extend(model.head<2>());
  const double least = std::max({box.sizes().maxCoeff() * 0.1, report.cluster_distance, 1e-9});
  const Eigen::Vector2d size = box.sizes().array() + least;
  const ViewFromAbove seen{top_view_area, box.center(), size};
  return rendered(
      "clash_top_view.svg", clash_top_view_svg,
      Object{{"dots", dotsOf(
                          clash, [&](std::size_t i) { return seen.x(report.scan.point(clash.records[i])[0]); },
                          [&](std::size_t i) { return seen.y(report.scan.point(clash.records[i])[1]); })},
             {"obstacle", obstacleAbout(report, clash, seen, least)},
             {"scan_x", coordinate(seen.x(scan.x()))},
             {"scan_y", coordinate(seen.y(scan.y()))},
             {"model_x", coordinate(seen.x(model.x()))},
             {"model_y", coordinate(seen.y(model.y()))},
             {"scale_width", coordinate(seen.bar * seen.scale)},
             {"scale_end", number(top_view_area.left + 10 + seen.bar * seen.scale + 6, 6)},
             {"scale_length", number(seen.bar)}});
}

std::string ClashDrawings::approach(const ClashReport& report, const Clash& clash) const
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
  return rendered("clash_approach.svg", clash_approach_svg,
                  Object{{"dots", dotsOf(
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
                         {"last", std::to_string(last)}});
}

std::string ClashDrawings::picture(const ClashReport& report, const Clash& clash, const std::string& title) const
{
  return rendered("clash_picture.svg", clash_picture_svg,
                  Object{{"style", std::string(drawing_style_css)},
                         {"title", plain(title)},
                         {"top_view", topView(report, clash)},
                         {"approach", approach(report, clash)}});
}

} // namespace pcl_bsh::io

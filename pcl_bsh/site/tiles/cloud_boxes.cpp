// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/site/tiles/cloud_boxes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl_bsh::site {

namespace {

constexpr double cells_of_longest = 8;   ///< of the grid, along the longest side of all points
constexpr double some_roundings = 1e-14; ///< relative: above what some ten operations in double err by
/// The share by which boxes grow. A pose is rigid only within 1e-6: it may shrink the places of centres, but the balls
/// about them keep their radii.
constexpr double pose_stretch = 4e-6;
constexpr double all_of_space = std::numeric_limits<double>::infinity();

/// At least the largest coordinate.
double largest(const Bounds& box)
{
  double value = 0.0;
  for (std::size_t k = 0; k < 3; ++k) value = std::max({value, std::abs(box.low[k]), std::abs(box.high[k])});
  return value;
}

} // namespace

Bounds moved(const Bounds& box, const Eigen::Isometry3d& pose, double reach)
{
  Bounds result;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    double center = pose.translation()[row], half = reach, terms = std::abs(center) + reach;
    for (std::size_t j = 0; j < 3; ++j) {
      const double factor = pose.linear()(row, static_cast<Eigen::Index>(j));
      center += factor * (box.low[j] / 2 + box.high[j] / 2);
      half += std::abs(factor) * (box.high[j] / 2 - box.low[j] / 2);
      terms += std::abs(factor) * std::max(std::abs(box.low[j]), std::abs(box.high[j]));
    }
    half *= 1.0 + pose_stretch;
    half += terms * some_roundings + std::numeric_limits<double>::min();
    result.low[k] = center - half;
    result.high[k] = center + half;
    if (!std::isfinite(result.low[k])) result.low[k] = -all_of_space; // NaN, too
    if (!std::isfinite(result.high[k])) result.high[k] = all_of_space;
  }
  return result;
}

bool overlap(const Bounds& a, const Bounds& b)
{
  for (std::size_t k = 0; k < 3; ++k)
    if (a.low[k] > b.high[k] || b.low[k] > a.high[k]) return false;
  return true;
}

double leastDistance(const Bounds& a, const Bounds& b)
{
  Point3 gap;
  for (std::size_t k = 0; k < 3; ++k) gap[k] = std::max({0.0, a.low[k] - b.high[k], b.low[k] - a.high[k]});
  const double distance = std::hypot(gap[0], gap[1], gap[2]);
  return distance * (1.0 - some_roundings);
}

Bounds joined(const Bounds& a, const Bounds& b)
{
  Bounds both = a;
  both.add(b.low);
  both.add(b.high);
  return both;
}

PointsNear::PointsNear(const Bounds& box, double distance, const Bounds& points, const Eigen::Isometry3d& pose)
: grown_(moved(box, Eigen::Isometry3d::Identity(), distance))
{
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    double terms = std::abs(pose.translation()[row]);
    for (std::size_t j = 0; j < 3; ++j) {
      rows_[k][j] = pose.linear()(row, static_cast<Eigen::Index>(j));
      terms += std::abs(rows_[k][j]) * std::max(std::abs(points.low[j]), std::abs(points.high[j]));
    }
    rows_[k][3] = pose.translation()[row];
    const double rounding = terms * some_roundings + std::numeric_limits<double>::min();
    grown_.low[k] -= rounding;
    grown_.high[k] += rounding;
    if (std::isfinite(rounding)) continue; // places may overflow: any may be near
    rows_[k] = {0, 0, 0, 0};
    grown_.low[k] = -all_of_space;
    grown_.high[k] = all_of_space;
  }
}

CloudBoxes::CloudBoxes(const PointsView& points)
{
  const auto forEach = [&](const auto& use) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::uint32_t record = points.record(i);
      const Point3 p = points.point(record);
      if (isFinite(p)) use(record, p);
    }
  };
  std::optional<Bounds> centers;
  forEach([&](std::uint32_t, const Point3& p) { extend(centers, p); });
  if (!centers) return;

  Point3 side;
  std::array<std::size_t, 3> cells = {1, 1, 1};
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, side[k] = centers->high[k] - centers->low[k]);
  for (std::size_t k = 0; k < 3; ++k)
    if (std::isfinite(longest) && longest > 0.0)
      cells[k] = std::max(std::size_t{1}, static_cast<std::size_t>(std::ceil(cells_of_longest * (side[k] / longest))));
  std::vector<std::optional<Bounds>> in_cells(cells[0] * cells[1] * cells[2]);
  forEach([&](std::uint32_t record, const Point3& p) {
    std::size_t cell = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double place = cells[k] == 1 ? 0.0 : (p[k] - centers->low[k]) / side[k] * static_cast<double>(cells[k]);
      cell = cell * cells[k] + std::min(static_cast<std::size_t>(place), cells[k] - 1);
    }
    const double radius = points.radius(record);
    const double reach = radius + points.uncertainty + points.ownUncertainty(record);
    largest_radius_ = std::max(largest_radius_, radius);
    for (const double way : {-reach, reach}) extend(in_cells[cell], {p[0] + way, p[1] + way, p[2] + way});
  });
  for (std::optional<Bounds>& part : in_cells) {
    if (!part) continue;
    const double rounding = largest(*part) * some_roundings;
    for (std::size_t k = 0; k < 3; ++k) part->low[k] -= rounding, part->high[k] += rounding;
    parts_.push_back(*part);
    whole_ = whole_ ? joined(*whole_, *part) : *part;
  }
}

} // namespace pcl_bsh::site

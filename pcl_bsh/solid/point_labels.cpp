// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/solid/point_labels.h>

#include <pcl_bsh/geometry/exact/long_number.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/solid/clip.h>
#include <pcl_bsh/solid/upward_ray.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh {
namespace {

constexpr double kFrameError = 1024 * kDoubleUnit;
constexpr std::uint64_t kManyExact = 64; ///< exact decisions for a place; from so many on, the gap about it is kept
constexpr std::size_t kMostGaps = 8;     ///< that are kept

/// How a ray from the origin crosses a triangle.
enum class Crossing : std::uint8_t { none, front, back, unknown };

/// Decides by double arithmetic, for corners that are off by `error` per axis. The ray goes along the last axis.
///
/// Error bound. m is the largest coordinate across the ray, M of all, and E the error. A product of two coordinates
/// errs by less than m (2.25 E + 4 v m) where 4 E <= m; where E is larger, nothing is sure. A side errs by less than m
/// (4.5 E + 9 v m). The volume is three products of a side, at most 2 m^2, and a height: it errs by less than M m (20 E
/// + 48 v m). Twice these are taken.
Crossing meet(const Triangle3& t, double error, bool above)
{
  const auto side = [&](std::size_t i, std::size_t j) { return t[i][0] * t[j][1] - t[i][1] * t[j][0]; };
  const double sides[3] = {side(0, 1), side(1, 2), side(2, 0)};
  const double across = std::max({std::abs(t[0][0]), std::abs(t[0][1]), std::abs(t[1][0]), std::abs(t[1][1]),
                                  std::abs(t[2][0]), std::abs(t[2][1])});
  const double doubt = across * (9.0 * error + 18.0 * kDoubleUnit * across) + 0x1p-1000;
  const bool left = sides[0] > doubt || sides[1] > doubt || sides[2] > doubt;
  const bool right = sides[0] < -doubt || sides[1] < -doubt || sides[2] < -doubt;
  if (left && right) return Crossing::none;
  const bool all_left = sides[0] > doubt && sides[1] > doubt && sides[2] > doubt;
  const bool all_right = sides[0] < -doubt && sides[1] < -doubt && sides[2] < -doubt;
  if (!all_left && !all_right) return Crossing::unknown;
  const Crossing met = all_left ? Crossing::front : Crossing::back;
  if (above) return met;
  const double volume = t[0][2] * sides[1] + t[1][2] * sides[2] + t[2][2] * sides[0];
  const double most = std::max({across, std::abs(t[0][2]), std::abs(t[1][2]), std::abs(t[2][2])});
  const double volume_doubt = most * across * (40.0 * error + 96.0 * kDoubleUnit * across) + 0x1p-1000;
  if (volume > volume_doubt) return all_left ? met : Crossing::none;
  if (volume < -volume_doubt) return all_right ? met : Crossing::none;
  return Crossing::unknown;
}

} // namespace

PointLabels::PointLabels(const Eigen::Isometry3d& pose_a, const PlacedSolid& b)
: columns_(b.solid->columns()),
  triangles_(b.solid->triangles()),
  winding_(pose_a, b.pose, static_cast<int>(columns_.axes()[2])),
  pose_a_(pose_a),
  pose_b_(b.pose)
{
  const auto a = [&](std::size_t i, std::size_t j) {
    return pose_a_.linear()(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  };
  const auto of_b = [&](std::size_t i, std::size_t j) {
    return pose_b_.linear()(static_cast<Eigen::Index>(i % 3), static_cast<Eigen::Index>(j % 3));
  };
  double determinant = 0.0;
  for (std::size_t k = 0; k < 3; ++k)
    determinant += of_b(k, 0) * (of_b(k + 1, 1) * of_b(k + 2, 2) - of_b(k + 2, 1) * of_b(k + 1, 2));
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t row = columns_.axes()[k];
    for (std::size_t j = 0; j < 3; ++j)
      inverse_[k][j] =
          (of_b(j + 1, row + 1) * of_b(j + 2, row + 2) - of_b(j + 2, row + 1) * of_b(j + 1, row + 2)) / determinant;
    for (std::size_t j = 0; j < 3; ++j)
      rotation_[k][j] = inverse_[k][0] * a(0, j) + inverse_[k][1] * a(1, j) + inverse_[k][2] * a(2, j);
  }
}

PointLabels::Frame PointLabels::frameAt(const Point3& origin, double reach) const
{
  Point3 shift;
  double largest = 0.0, error = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    LongNumber sum = LongNumber(pose_a_.translation()[row]) - LongNumber(pose_b_.translation()[row]);
    for (std::size_t j = 0; j < 3; ++j) {
      const auto column = static_cast<Eigen::Index>(j);
      sum += LongNumber(pose_a_.linear()(row, column)) * LongNumber(origin[j]);
      sum += LongNumber(-pose_b_.linear()(row, column)) * LongNumber(columns_.origin()[j]);
    }
    shift[k] = sum.value();
    largest = std::max(largest, std::abs(sum.value()));
    error = std::max(error, sum.error() + std::abs(sum.tail()));
  }
  Frame frame{origin, {}, kFrameError * (reach + largest) + 4.0 * error + columns_.error() + 0x1p-1000};
  if (!std::isfinite(frame.error)) frame.error = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k)
    frame.shift[k] = inverse_[k][0] * shift[0] + inverse_[k][1] * shift[1] + inverse_[k][2] * shift[2];
  return frame;
}

/// How often the surface winds round a place. @param decide called with each triangle that double arithmetic cannot
/// decide: returns its turns, or nothing, which is then the result
template <class Decide>
std::optional<int> PointLabels::turnsAt(const Point3& at, double error, const Decide& decide)
{
  if (columns_.isBeyond(at, error)) return 0;
  const UpwardRay ray(at, error);
  Columns::Range above = columns_.above(at, error, several_);
  pulse_.count(above.bundles);
  int turns = above.turns;
  for (const std::uint32_t i : above) {
    const FloatBox& box = columns_.box(i);
    if (ray.misses(box)) continue;
    pulse_.count(1);
    Triangle3 t = columns_.seenTriangle(i);
    for (Point3& corner : t)
      for (std::size_t k = 0; k < 3; ++k) corner[k] -= at[k];
    const Crossing met = meet(t, error, ray.beginsBelow(box));
    if (met == Crossing::unknown) {
      const std::optional<int> decided = decide(i);
      if (!decided) return std::nullopt;
      turns += *decided;
    }
    else {
      turns += met == Crossing::front ? 1 : met == Crossing::back ? -1 : 0;
    }
  }
  return turns;
}

const PointLabels::Gap* PointLabels::gapAt(const Point3& at, double error)
{
  const auto gap = std::find_if(gaps_.begin(), gaps_.end(), [&](const Gap& g) { return g.holds(at, error); });
  if (gap == gaps_.end()) return nullptr;
  ++gaps_met_;
  return &*gap;
}

/// Keeps the gap between the triangles that are next above and below a place, within a little of its ray. Where a ray
/// passes by many edges and corners, as on the axis of a round shape, other points are often on it, too. Where gaps
/// turn out to serve no other points, none are kept.
void PointLabels::addGap(const Point3& at, double error, Label label)
{
  if (label == Label::surface || gaps_made_ > gaps_met_ + kMostGaps) return;
  if (!(error < 0x1p900)) return; // nothing below leaves the range of double
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  // The error exceeds a rounding of any coordinate, and 64 times it the roundings of clipped coordinates.
  const double off = 65.0 * error, aside = 2.0 * off, clipped = 2.0 * aside;
  Gap gap{{at[0] - aside, at[1] - aside, -kEndless}, {at[0] + aside, at[1] + aside, kEndless}, label};
  const UpwardRay line({at[0], at[1], -std::numeric_limits<double>::max()}, clipped);
  for (const std::uint32_t i : columns_.along(at, clipped, several_)) {
    if (line.misses(columns_.box(i))) continue;
    pulse_.count(1);
    const Triangle3 t = columns_.seenTriangle(i);
    std::array<Point3, 9> part;
    std::size_t corners = 0;
    forEachCorner(t.data(), 3, 0, at[0] - clipped, at[0] + clipped, [&](const Point3& p) { part[corners++] = p; });
    double least = kEndless, most = -kEndless;
    forEachCorner(part.data(), corners, 1, at[1] - clipped, at[1] + clipped,
                  [&](const Point3& p) { least = std::min(least, p[2]), most = std::max(most, p[2]); });
    if (least > most) continue;
    gap.low[2] = most + off < at[2] ? std::max(gap.low[2], most + off) : gap.low[2];
    gap.high[2] = most + off < at[2] ? gap.high[2] : std::min(gap.high[2], least - off);
  }
  if (!gap.holds(at, error)) return;
  if (gaps_.size() == kMostGaps) gaps_.erase(gaps_.begin());
  gaps_.push_back(gap);
  ++gaps_made_;
}

std::optional<Label> PointLabels::labelAround(const Point3& at, double error)
{
  if (!std::isfinite(at[0] + at[1] + at[2] + error)) return std::nullopt;
  if (const Gap* const gap = gapAt(at, error)) return gap->label;
  // A ray so close to a gap's ray would pass by as many edges.
  if (std::any_of(gaps_.begin(), gaps_.end(), [&](const Gap& gap) { return gap.touches(at, error); }))
    return std::nullopt;
  const std::optional<int> turns = turnsAt(at, error, [](std::uint32_t) { return std::nullopt; });
  if (!turns) return std::nullopt;
  return *turns != 0 ? Label::inside : Label::outside;
}

Label PointLabels::label(const Frame& frame, const Point3& p, std::uint64_t& exact_decisions)
{
  const Point3 at = seen(frame, {p[0] - frame.origin[0], p[1] - frame.origin[1], p[2] - frame.origin[2]});
  const std::uint64_t before = exact_decisions;
  std::optional<int> turns;
  const bool is_seen = std::isfinite(at[0] + at[1] + at[2] + frame.error);
  if (is_seen) {
    if (const Gap* const gap = gapAt(at, frame.error)) return gap->label;
    turns = turnsAt(at, frame.error, [&](std::uint32_t i) -> std::optional<int> {
      ++exact_decisions;
      const Winding::Crossing exact = winding_.crossing(p, triangles_.triangle(i));
      if (exact.on_surface) return std::nullopt;
      return exact.turns;
    });
  }
  else { // out of range: all triangles, exactly
    exact_decisions += triangles_.count;
    turns = winding_.number(p, triangles_.count,
                            [&](std::size_t i) { return triangles_.triangle(static_cast<std::uint32_t>(i)); });
  }
  const Label label = !turns ? Label::surface : *turns != 0 ? Label::inside : Label::outside;
  if (is_seen && exact_decisions - before >= kManyExact) addGap(at, frame.error, label);
  return label;
}

} // namespace pcl_bsh

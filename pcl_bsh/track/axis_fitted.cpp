// SPDX-License-Identifier: BSD-3-Clause
// An axis near measured points: as few pairs of arcs as a greedy search finds.
#include <pcl_bsh/track/biarc.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pcl_bsh {
namespace {

/// A place that arcs may begin at, and their direction there.
struct FittedPlace {
  Plan at, direction;
};

/// Points of a window are within this share of the tolerance of their parabola, so that arcs between fitted places keep
/// to the tolerance, too.
constexpr double kShareOfTolerance = 0.7;
constexpr std::size_t kSamples = 128; ///< most points of a window that are fitted, evenly spaced

/// The parabola of least squares through the points from `first` to `last`, along their chord. `place` is where it
/// passes point `of`; `residual` is how far it is from points, at most.
struct Parabola {
  FittedPlace place;
  double residual = 0.0;

  Parabola(const std::vector<Plan>& points, std::size_t first, std::size_t last, std::size_t of)
  {
    const Plan along = (points[last] - points[first]).normalized(), left(-along.y(), along.x());
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    const double scale = (points[last] - points[first]).norm();
    const std::size_t step = 1 + (last - first) / kSamples;
    const auto rowOf = [&](std::size_t i) {
      const double x = along.dot(points[i] - points[of]) / scale;
      return Eigen::Vector3d(1.0, x, x * x);
    };
    for (std::size_t i = first; i <= last; i += step) {
      normal += rowOf(i) * rowOf(i).transpose();
      right += rowOf(i) * left.dot(points[i] - points[of]);
    }
    const Eigen::Vector3d fit = normal.ldlt().solve(right);
    for (std::size_t i = first; i <= last; i += step)
      residual = std::max(residual, std::abs(rowOf(i).dot(fit) - left.dot(points[i] - points[of])));
    place = {points[of] + fit[0] * left, (along + fit[1] / scale * left).normalized()};
  }
};

/// The place and direction at a point, by the widest window about it whose points are near one parabola.
FittedPlace fittedAt(const std::vector<Plan>& points, std::size_t i, double tolerance)
{
  const auto windowOf = [&](std::size_t half) {
    return Parabola(points, i - std::min(i, half), std::min(points.size() - 1, i + half), i);
  };
  if (points.size() == 2) return {points[i], (points[1] - points[0]).normalized()};
  FittedPlace fitted = windowOf(1).place;
  for (std::size_t half = 2; half < 2 * points.size() && points.size() > 3; half *= 2) {
    const Parabola parabola = windowOf(half);
    if (!(parabola.residual <= kShareOfTolerance * tolerance)) break;
    fitted = parabola.place;
  }
  return fitted;
}

/// Whether all points between two are within the tolerance of arcs from one to the other.
bool reaches(const std::vector<Plan>& points, const std::vector<FittedPlace>& places, std::size_t from, std::size_t to,
             double tolerance)
{
  const FittedPlace &a = places[from], &b = places[to];
  if (a.direction.dot(b.direction) < 0.5) return false; // up to a sixth of a turn
  const Biarc arcs(a.at, a.direction, b.at, b.direction);
  for (std::size_t i = from; i <= to; ++i)
    if (!(std::abs(arcs.beside(points[i]).left) <= tolerance)) return false;
  return true;
}

/// The last point that arcs reach: by longer and longer steps, then by halving the last one.
std::size_t farthestFrom(const std::vector<Plan>& points, const std::vector<FittedPlace>& places, std::size_t from,
                         double tolerance)
{
  std::size_t reached = from + 1, step = 1;
  while (reached + step < points.size() && reaches(points, places, from, reached + step, tolerance)) {
    reached += step;
    step *= 2;
  }
  while ((step /= 2) > 0)
    if (reached + step < points.size() && reaches(points, places, from, reached + step, tolerance)) reached += step;
  return reached;
}

} // namespace

Axis Axis::fitted(const std::vector<AxisPoint>& points, double tolerance, AxisDescription rest, double most_turn)
{
  if (!(std::isfinite(tolerance) && tolerance > 0.0))
    throw InvalidInput(Input::trajectory, "tolerance", plainText("is ", tolerance), "give a finite length > 0");
  Plan origin;
  const std::vector<Plan> plan = planOf(points, 4.0, origin); // > pi: noise may turn near neighbours by any angle
  for (std::size_t i = 1; i + 1 < plan.size(); ++i)           // no parabola goes there, and back
    if (plan[i - 1] == plan[i + 1]) refusePoint(i, "its two neighbours lie at one place", "leave one of the three out");
  std::vector<FittedPlace> places;
  for (std::size_t i = 0; i < plan.size(); ++i) places.push_back(fittedAt(plan, i, tolerance));
  for (std::size_t i = 1; i < plan.size(); ++i) {
    const Plan &before = places[i - 1].direction, &at = places[i].direction;
    const double turn = std::abs(std::atan2(crossOf(before, at), before.dot(at)));
    if (turn > most_turn) refuseTurn(i, turn, points[i].chainage, most_turn);
  }
  const auto hold = [&](double distance, const AxisPoint& point) {
    if (!rest.heights.empty() && !(distance > rest.heights.back().at)) return; // noise put it before its neighbour
    rest.heights.push_back({distance, point.at[2]});
    rest.cants.push_back({distance, point.cant});
    rest.chainages.push_back({distance, point.chainage});
  };
  hold(0.0, points.front());
  double length = 0.0, deviation = 0.0, stretch = 0.0;
  for (std::size_t from = 0; from + 1 < plan.size();) {
    const std::size_t to = farthestFrom(plan, places, from, tolerance);
    const Biarc arcs(places[from].at, places[from].direction, places[to].at, places[to].direction);
    append(arcs, origin, rest.plan);
    if (from > 0) rest.plan[rest.plan.size() - 2].start.reset();
    for (std::size_t i = from; i <= to; ++i) {
      const BesideArc at = arcs.beside(plan[i]);
      deviation = std::max(deviation, std::abs(at.left));
      if (i > from && i < to && at.along < arcs.length()) hold(length + at.along, points[i]);
    }
    stretch = std::max(stretch, std::abs(arcs.length() / (points[to].chainage - points[from].chainage) - 1.0));
    length += arcs.length();
    hold(length, points[to]);
    from = to;
  }
  Axis axis(rest);
  axis.fit_.deviation = deviation;
  axis.fit_.stretch = stretch;
  return axis;
}

} // namespace pcl_bsh

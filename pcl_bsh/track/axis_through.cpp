// SPDX-License-Identifier: BSD-3-Clause
// An axis through measured points: two arcs from each to the next.
#include <pcl_bsh/track/axis.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

using Plan = Eigen::Vector2d;

double crossOf(const Plan& a, const Plan& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

/// At each point the direction of the circle through it and its neighbours; at the ends that of their neighbours'
/// circle.
std::vector<Plan> directionsAt(const std::vector<Plan>& points)
{
  const std::size_t count = points.size();
  std::vector<Plan> directions(count);
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const Plan before = points[i] - points[i - 1], after = points[i + 1] - points[i];
    directions[i] = (before / before.squaredNorm() + after / after.squaredNorm()).normalized();
  }
  const auto mirrored = [](const Plan& direction, const Plan& chord) {
    const Plan along = chord.normalized();
    return Plan(2.0 * direction.dot(along) * along - direction);
  };
  const Plan first = points[1] - points[0], last = points[count - 1] - points[count - 2];
  directions.front() = count > 2 ? mirrored(directions[1], first) : first.normalized();
  directions.back() = count > 2 ? mirrored(directions[count - 2], last) : first.normalized();
  return directions;
}

/// The arc from a place, in a direction there, to another place.
PlanElement arcOf(const Plan& from, const Plan& direction, const Plan& to, const Plan& origin)
{
  const Plan chord = to - from;
  const double length = chord.norm();
  const double half_turn = std::atan2(crossOf(direction, chord), direction.dot(chord)); // to the left
  PlanElement arc;
  arc.length = std::abs(half_turn) < 1e-9 ? length : length * half_turn / std::sin(half_turn);
  arc.curvature_begin = arc.curvature_end = -2.0 * std::sin(half_turn) / length;
  arc.start = AxisStart{from.x() + origin.x(), from.y() + origin.y(), std::atan2(direction.y(), direction.x())};
  return arc;
}

/// How far the axis is from a chord: at most in the middle of one of its arcs, or where they meet.
double awayFrom(const Plan& from, const Plan& to, const Plan& joint, const PlanElement& a, const PlanElement& b)
{
  const Plan along = (to - from).normalized();
  double most = std::abs(crossOf(along, joint - from));
  const auto bulge = [&](const PlanElement& arc, const Plan& p, const Plan& q) {
    return std::abs(crossOf(along, 0.5 * (p + q) - from)) +
           std::abs(arc.curvature_begin) * arc.length * arc.length / 8.0;
  };
  return std::max({most, bulge(a, from, joint), bulge(b, joint, to)});
}

} // namespace

Axis Axis::through(const std::vector<AxisPoint>& points, AxisDescription rest, double most_turn)
{
  const auto refuse = [](std::size_t i, const std::string& wrong, const std::string& remedy) {
    throw InvalidInput(Input::trajectory, plainText("axis point ", i), wrong, remedy).withIndex(i);
  };
  if (points.size() < 2)
    throw InvalidInput(Input::trajectory, "axis", plainText("has ", points.size(), " points"), "give two at least");
  std::vector<Plan> plan;
  const Plan origin(std::round(points[0].at[0]), std::round(points[0].at[1]));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const AxisPoint& point = points[i];
    if (!isFinite(point.at) || !std::isfinite(point.chainage) || !std::isfinite(point.cant))
      refuse(i, "has a value that is not finite", "correct it, or leave the point out");
    plan.emplace_back(point.at[0] - origin.x(), point.at[1] - origin.y());
    if (i == 0) continue;
    if (!(point.chainage > points[i - 1].chainage))
      refuse(i, plainText("its chainage ", point.chainage, " does not exceed the one before, ", points[i - 1].chainage),
             "list points in the order of rising chainages");
    if (plan[i] == plan[i - 1]) refuse(i, "lies where the one before lies", "leave it out");
    if (i == 1) continue;
    const Plan before = plan[i - 1] - plan[i - 2], after = plan[i] - plan[i - 1];
    const double turn = std::abs(std::atan2(crossOf(before, after), before.dot(after)));
    if (turn > most_turn)
      refuse(i - 1, plainText("the axis turns by ", turn, " radians at chainage ", points[i - 1].chainage),
             plainText("give more points there; up to ", most_turn, " is taken for a curve"));
  }
  const std::vector<Plan> directions = directionsAt(plan);
  double length = 0.0, deviation = 0.0, stretch = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    rest.heights.push_back({length, points[i].at[2]});
    rest.cants.push_back({length, points[i].cant});
    rest.chainages.push_back({length, points[i].chainage});
    if (i + 1 == points.size()) break;
    const Plan chord = plan[i + 1] - plan[i], sum = directions[i] + directions[i + 1];
    const double across = chord.dot(sum), bend = 2.0 * (1.0 - directions[i].dot(directions[i + 1]));
    // Both arcs' tangents are as long: bend d^2 + 2 across d = |chord|^2, solved without cancellation.
    const double square = chord.squaredNorm();
    const double tangent = square / (across + std::sqrt(across * across + bend * square));
    const Plan joint = 0.5 * (plan[i] + plan[i + 1] + tangent * (directions[i] - directions[i + 1]));
    const Plan half = joint - plan[i];
    const PlanElement a = arcOf(plan[i], directions[i], joint, origin);
    const Plan at_joint = 2.0 * directions[i].dot(half) / half.squaredNorm() * half - directions[i];
    PlanElement b = arcOf(joint, at_joint, plan[i + 1], origin);
    b.start.reset(); // a joint is no given place: rounded to the given ones' last digit, it would be off
    rest.plan.push_back(a);
    rest.plan.push_back(b);
    deviation = std::max(deviation, awayFrom(plan[i], plan[i + 1], joint, a, b));
    const double advance = points[i + 1].chainage - points[i].chainage;
    stretch = std::max(stretch, std::abs((a.length + b.length) / advance - 1.0));
    length += a.length;
    length += b.length;
  }
  Axis axis(rest);
  axis.fit_.deviation = deviation;
  axis.fit_.stretch = stretch;
  return axis;
}

} // namespace pcl_bsh

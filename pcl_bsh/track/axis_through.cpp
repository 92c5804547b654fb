// SPDX-License-Identifier: BSD-3-Clause
// An axis through measured points: two arcs from each to the next.
#include <pcl_bsh/track/biarc.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {
namespace {

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

/// At most how far two arcs are from their chord: in the middle of one of them, or where they meet.
double awayFrom(const Plan& from, const Plan& to, const Biarc& arcs)
{
  const Plan along = (to - from).normalized();
  double most = std::abs(crossOf(along, arcs.joint - from));
  const auto bulge = [&](const PlanArc& arc, const Plan& p, const Plan& q) {
    return std::abs(crossOf(along, 0.5 * (p + q) - from)) + std::abs(arc.curvature) * arc.length * arc.length / 8.0;
  };
  return std::max({most, bulge(arcs.first, from, arcs.joint), bulge(arcs.second, arcs.joint, to)});
}

} // namespace

Axis Axis::through(const std::vector<AxisPoint>& points, AxisDescription rest, double most_turn)
{
  Plan origin;
  const std::vector<Plan> plan = planOf(points, most_turn, origin);
  const std::vector<Plan> directions = directionsAt(plan);
  double length = 0.0, deviation = 0.0, stretch = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    rest.heights.push_back({length, points[i].at[2]});
    rest.cants.push_back({length, points[i].cant});
    rest.chainages.push_back({length, points[i].chainage});
    if (i + 1 == points.size()) break;
    const Biarc arcs(plan[i], directions[i], plan[i + 1], directions[i + 1]);
    append(arcs, origin, rest.plan);
    deviation = std::max(deviation, awayFrom(plan[i], plan[i + 1], arcs));
    const double advance = points[i + 1].chainage - points[i].chainage;
    stretch = std::max(stretch, std::abs(arcs.length() / advance - 1.0));
    length += arcs.first.length;
    length += arcs.second.length;
  }
  Axis axis(rest);
  axis.fit_.deviation = deviation;
  axis.fit_.stretch = stretch;
  return axis;
}

} // namespace pcl_bsh

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/track/biarc.h>

#include <pcl_bsh/base/invalid_input.h>
#include <pcl_bsh/base/plain_text.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh {

PlanArc::PlanArc(const Plan& begin, const Plan& at_begin, const Plan& to) : from(begin), direction(at_begin)
{
  const Plan chord = to - from;
  const double straight = chord.norm();
  const double half_turn = std::atan2(crossOf(direction, chord), direction.dot(chord)); // to the left
  length = std::abs(half_turn) < 1e-9 ? straight : straight * half_turn / std::sin(half_turn);
  curvature = 2.0 * std::sin(half_turn) / straight;
}

BesideArc PlanArc::beside(const Plan& place) const
{
  const Plan way = place - from;
  const double x = direction.dot(way), y = crossOf(direction, way), k = curvature;
  const double turned = std::atan2(k * x, 1.0 - k * y); // the angle at the circle's centre
  const double along = std::abs(turned) < 1e-9 ? x / (1.0 - k * y) : turned / k;
  return {along, (2.0 * y - k * (x * x + y * y)) / (1.0 + std::hypot(k * x, 1.0 - k * y))};
}

PlanElement PlanArc::element(const Plan& origin) const
{
  PlanElement arc;
  arc.length = length;
  arc.curvature_begin = arc.curvature_end = -curvature;
  arc.start = AxisStart{from.x() + origin.x(), from.y() + origin.y(), std::atan2(direction.y(), direction.x())};
  return arc;
}

Biarc::Biarc(const Plan& from, const Plan& at_from, const Plan& to, const Plan& at_to)
: joint(jointOf(from, at_from, to, at_to)),
  first(from, at_from, joint),
  second(joint, atJoint(from, at_from), to)
{
}

Plan Biarc::jointOf(const Plan& from, const Plan& at_from, const Plan& to, const Plan& at_to)
{
  const Plan chord = to - from, sum = at_from + at_to;
  const double across = chord.dot(sum), bend = 2.0 * (1.0 - at_from.dot(at_to));
  // bend d^2 + 2 across d = |chord|^2 for the tangents' length d, solved without cancellation.
  const double square = chord.squaredNorm();
  const double tangent = square / (across + std::sqrt(across * across + bend * square));
  return 0.5 * (from + to + tangent * (at_from - at_to));
}

Plan Biarc::atJoint(const Plan& from, const Plan& at_from) const
{
  const Plan half = joint - from;
  return 2.0 * at_from.dot(half) / half.squaredNorm() * half - at_from;
}

BesideArc Biarc::beside(const Plan& place) const
{
  const BesideArc at_first = first.beside(place);
  if (at_first.along <= first.length) return at_first;
  BesideArc at_second = second.beside(place);
  at_second.along = first.length + std::max(0.0, at_second.along);
  return at_second;
}

void append(const Biarc& biarc, const Plan& origin, std::vector<PlanElement>& plan)
{
  plan.push_back(biarc.first.element(origin));
  plan.push_back(biarc.second.element(origin));
  plan.back().start.reset(); // it begins exactly at the joint, which coordinates from far away would round
}

void refusePoint(std::size_t point, const std::string& wrong, const std::string& remedy)
{
  throw InvalidInput(Input::trajectory, plainText("axis point ", point), wrong, remedy).withIndex(point);
}

void refuseTurn(std::size_t point, double turn, double chainage, double most_turn)
{
  refusePoint(point, plainText("the axis turns by ", turn, " radians at chainage ", chainage),
              plainText("give more points there; up to ", most_turn, " is taken for a curve"));
}

std::vector<Plan> planOf(const std::vector<AxisPoint>& points, double most_turn, Plan& origin)
{
  if (points.size() < 2)
    throw InvalidInput(Input::trajectory, "axis", plainText("has ", points.size(), " points"), "give two at least");
  std::vector<Plan> plan;
  origin = Plan(std::round(points[0].at[0]), std::round(points[0].at[1]));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const AxisPoint& point = points[i];
    if (!isFinite(point.at) || !std::isfinite(point.chainage) || !std::isfinite(point.cant))
      refusePoint(i, "has a value that is not finite", "correct it, or leave the point out");
    plan.emplace_back(point.at[0] - origin.x(), point.at[1] - origin.y());
    if (i == 0) continue;
    if (!(point.chainage > points[i - 1].chainage))
      refusePoint(
          i, plainText("its chainage ", point.chainage, " does not exceed the one before, ", points[i - 1].chainage),
          "list points in the order of rising chainages");
    if (plan[i] == plan[i - 1]) refusePoint(i, "lies where the one before lies", "leave it out");
    if (i == 1) continue;
    const Plan before = plan[i - 1] - plan[i - 2], after = plan[i] - plan[i - 1];
    const double turn = std::abs(std::atan2(crossOf(before, after), before.dot(after)));
    if (turn > most_turn) refuseTurn(i - 1, turn, points[i - 1].chainage, most_turn);
  }
  return plan;
}

} // namespace pcl_bsh

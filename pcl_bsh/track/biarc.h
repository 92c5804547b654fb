// SPDX-License-Identifier: BSD-3-Clause
// Two arcs in plan from a place to another, without a kink, that begin and end in given directions.
#pragma once

#include <pcl_bsh/track/axis.h>

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace pcl_bsh {

using Plan = Eigen::Vector2d;

inline double crossOf(const Plan& a, const Plan& b)
{
  return a.x() * b.y() - a.y() * b.x();
}

/// Where a place is beside a line: its distance along it, and to the left of it.
struct BesideArc {
  double along = 0.0, left = 0.0;
};

/// An arc, or a straight.
struct PlanArc {
  Plan from, direction;
  double length = 0.0;
  double curvature = 0.0; ///< positive where it turns to the left

  /// @param direction of length 1, where it begins
  PlanArc(const Plan& from, const Plan& direction, const Plan& to);

  /// Where a place is beside the whole circle, or straight line, that the arc is a part of.
  BesideArc beside(const Plan& place) const;

  /// The arc as an element of an axis. @param origin added to its coordinates
  PlanElement element(const Plan& origin) const;
};

struct Biarc {
  Plan joint;
  PlanArc first, second;

  /// Chooses the joint at which the tangents of both arcs are equally long.
  /// @param at_from, at_to directions of length 1
  Biarc(const Plan& from, const Plan& at_from, const Plan& to, const Plan& at_to);

  double length() const { return first.length + second.length; }

  /// Where a place is beside the first arc or, past its end, beside the second.
  BesideArc beside(const Plan& place) const;

private:
  static Plan jointOf(const Plan& from, const Plan& at_from, const Plan& to, const Plan& at_to);
  Plan atJoint(const Plan& from, const Plan& at_from) const;
};

/// Adds both arcs to a plan. @param origin added to their coordinates
void append(const Biarc& biarc, const Plan& origin, std::vector<PlanElement>& plan);

/// @throws InvalidInput, with the point's number as its index
[[noreturn]] void refusePoint(std::size_t point, const std::string& wrong, const std::string& remedy);
[[noreturn]] void refuseTurn(std::size_t point, double turn, double chainage, double most_turn);

/// Points of an axis in plan, relative to a place near the first. @param origin gets that place
/// @throws InvalidInput naming the point that is wrong
std::vector<Plan> planOf(const std::vector<AxisPoint>& points, double most_turn, Plan& origin);

} // namespace pcl_bsh

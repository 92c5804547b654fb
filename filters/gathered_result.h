// SPDX-License-Identifier: BSD-3-Clause
// Gathers results about triangles into results about their polygons, or their vertices.
#pragma once

#include <pcl_bsh/query/result.h>
#include <pcl_bsh/trajectory/trajectory.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>

namespace pcl_bsh {

/// Gives each group the gravest result of its triangles: colliding before undecided before free, the smallest distance
/// with its pose and nearest point, the first pose. A group of no triangle is free. Parts that the result does not have
/// stay empty; summaries of poses, which count triangles, are left out.
/// @param groupsOf called with the index of a triangle, returns a range of the indices of its groups, each below
///   `groups`
template <typename GroupsOf>
TrajectoryResult gatheredResult(const TrajectoryResult& found, std::size_t groups, const GroupsOf& groupsOf)
{
  TrajectoryResult gathered;
  const auto sizeAs = [groups](const auto& values, auto& own, auto none) {
    if (!values.empty()) own.assign(groups, none);
  };
  sizeAs(found.flags, gathered.flags, Verdict::free);
  sizeAs(found.distance, gathered.distance, std::numeric_limits<float>::quiet_NaN());
  sizeAs(found.first_pose, gathered.first_pose, -1);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  sizeAs(found.interval, gathered.interval, Interval{unknown, unknown});
  sizeAs(found.certain_pose, gathered.certain_pose, -1);
  sizeAs(found.closest_pose, gathered.closest_pose, -1);
  sizeAs(found.closest_point, gathered.closest_point, kNothing);
  const auto takeFirst = [](std::int32_t pose, std::int32_t& first) {
    if (pose >= 0 && (first < 0 || pose < first)) first = pose;
  };
  const std::size_t triangles = std::max(found.flags.size(), found.distance.size());
  for (std::size_t t = 0; t < triangles; ++t) {
    for (const std::size_t group : groupsOf(t)) {
      if (!found.flags.empty()) gathered.flags[group] = graver(gathered.flags[group], found.flags[t]);
      if (!found.first_pose.empty()) takeFirst(found.first_pose[t], gathered.first_pose[group]);
      if (!found.certain_pose.empty()) takeFirst(found.certain_pose[t], gathered.certain_pose[group]);
      if (!found.interval.empty()) { // fmin() leaves out ends that are NaN
        Interval& interval = gathered.interval[group];
        interval.lower = std::fmin(interval.lower, found.interval[t].lower);
        interval.upper = std::fmin(interval.upper, found.interval[t].upper);
      }
      if (found.distance.empty() || std::isnan(found.distance[t])) continue; // NaN: none; a depth is less than 0
      const bool has_poses = !found.closest_pose.empty();
      const auto rank = [has_poses](const TrajectoryResult& of, std::size_t i) {
        return std::tuple(of.distance[i], has_poses ? of.closest_pose[i] : 0);
      };
      const bool is_first = std::isnan(gathered.distance[group]);
      if (!is_first && !(rank(found, t) < rank(gathered, group))) continue;
      gathered.distance[group] = found.distance[t];
      if (has_poses) gathered.closest_pose[group] = found.closest_pose[t];
      if (!found.closest_point.empty()) gathered.closest_point[group] = found.closest_point[t];
    }
  }
  gathered.colliding = countOf(gathered.flags, Verdict::colliding);
  gathered.undecided = countOf(gathered.flags, Verdict::undecided);
  gathered.first_contact = found.first_contact;
  gathered.certain_contact = found.certain_contact;
  gathered.work = found.work;
  return gathered;
}

} // namespace pcl_bsh

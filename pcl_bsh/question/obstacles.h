// SPDX-License-Identifier: BSD-3-Clause
// One question about several obstacles: each has its own pose and, where it is given, its own clearance, solidity and
// uncertainty.
//
//   std::vector<PlacedShape> machines = {{press, T_hall_press}, {mill, T_hall_mill}};
//   machines[1].clearance = 0.1;
//   const ObstaclesAnswer answer = ask(question, hall, machines);
//   if (answer.each[0].verdict == Verdict::colliding) ...
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/question/ask.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// An obstacle of several. Members without a value are those of the question.
struct PlacedShape {
  Shape shape;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_obstacles_shape; applied before the question's pose
  std::optional<double> clearance = {};
  std::optional<bool> solid = {};
  std::optional<Uncertainty> uncertainty = {}; ///< of its points and, where that is not 0, of its pose
  bool ignores_input = false;                  ///< it is compared with other obstacles alone
  /// Its poses, one after another, in place of `pose` and of the question's. All obstacles have as many, or none has
  /// any.
  std::optional<std::vector<Eigen::Isometry3d>> path = {};
};

/// The question about one of several obstacles. A product of two poses that both move is rounded in double.
Question questionOf(const Question& question, const PlacedShape& obstacle);

/// The answer about one obstacle.
struct ObstacleAnswer {
  bool asked = true; ///< false: it ignores the input, and the rest says nothing
  /// The gravest of the input's records as to this obstacle, and of its own that are unseen.
  Verdict verdict = Verdict::free;
  std::size_t colliding = 0; ///< records of the input
  std::size_t undecided = 0; ///< records of the input
  std::size_t sparse = 0;    ///< records of the input
  std::size_t unseen = 0;    ///< records of the obstacle
  /// With Wanted::closest: the smallest distance. Along a path it is that of records that collide. Where nothing
  /// collides with the obstacle, it is the smallest at any pose, however great.
  DistanceResult closest;
  std::int32_t closest_pose = -1; ///< the pose of the path that has `closest`; -1: there is no path
};

/// The answer about all obstacles, together and one by one.
struct ObstaclesAnswer {
  /// The answer about all obstacles together. Flags are the gravest; distances, poses and intervals those of the
  /// nearest obstacle, of several the first. Counts at the poses of a path add up: a record that collides with two
  /// obstacles counts twice. It tells nothing of the obstacles' own records, and nothing of unseen places.
  Answer all;
  std::vector<std::uint32_t> closest_obstacle; ///< with contacts, distances along a path, or distances: per record the
                                               ///< obstacle of `closest_point`; kNothing where there is no such point
  std::uint32_t closest = kNothing;            ///< the obstacle of `all.closest`
  std::vector<ObstacleAnswer> each;            ///< in the order of the obstacles
};

/// Called for each obstacle in turn, with the question about it and its answer. Flags, contacts and poses may be empty
/// where nothing collides with the obstacle.
using AnswerOf = std::function<void(std::size_t obstacle, const Question& question, Answer& answer)>;

/// Asks about each obstacle. All obstacles share the hierarchy of the input. Among several obstacles at one pose, one
/// that anyCollision() finds free costs no more than that query and its smallest distance.
/// @throws InvalidInput for no obstacle, and for paths that are not all as long; as ask() of one does
ObstaclesAnswer ask(const Question& question, Shape& input, std::vector<PlacedShape>& obstacles,
                    const AnswerOf& told = nullptr);

/// The answer about two obstacles, which are given by their numbers.
struct ObstaclePair {
  std::uint32_t first = 0, second = 0;
  double clearance = 0.0; ///< the greater of theirs
  Verdict verdict = Verdict::free;
  DistanceResult closest;         ///< records of the first and of the second
  std::int32_t first_pose = -1;   ///< the first pose of their paths with the verdict; -1: no paths, or it is free
  std::int32_t closest_pose = -1; ///< the pose of their paths at which they are closest; -1: no paths
  /// With Wanted::overlap, areaWithin() of the first's surface in the second; none where the second is no solid or the
  /// first no surface.
  std::optional<Interval> first_within = {};
  std::optional<Interval> second_within = {}; ///< of the second's surface in the first
};

/// Where obstacles are more than this, askBetween() leaves out pairs that are free.
inline constexpr std::size_t most_obstacles_with_free_pairs = 32;

/// Asks about obstacles against each other, at their poses. A path of the question moves all of them together, so that
/// it does not count. Paths of the obstacles' own count: both stand at their k-th poses at once, the gravest verdict
/// counts, and areas are those of the closest pose. Pairs are shared out among the threads. With more than
/// `most_obstacles_with_free_pairs`, only pairs whose boxes come within the clearance are asked about, and only pairs
/// that are not free are told.
/// @param wanted whether a pair counts, by its numbers; called in the caller's thread, before any pair is asked about
/// @throws as ask() does
std::vector<ObstaclePair> askBetween(const Question& question, const std::vector<PlacedShape>& obstacles,
                                     const std::function<bool(std::uint32_t, std::uint32_t)>& wanted);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

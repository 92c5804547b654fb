// SPDX-License-Identifier: BSD-3-Clause
// Answers of all public queries about an instance, in a form that symmetries carry over.
#pragma once

#include "instance.h"

#include <pcl_bsh/pairs/contacts.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pcl_bsh::symmetries {

/// Which of several alike (the smallest record) is told by names, which depend on the order of records.
struct Answers {
  // At the two poses.
  std::uint8_t any = 0;
  std::vector<std::uint8_t> flags_a, flags_b;
  std::vector<std::int32_t> indices_a, indices_b; ///< of collidingIndices()
  double closest = 0.0;
  std::vector<std::pair<PointPair, double>> contacts; ///< by pair; with the distance
  std::vector<double> distances_a, distances_b;
  std::vector<double> limited_a; ///< within the clearance
  double hausdorff = 0.0;
  struct Names {
    std::optional<PointPair> closest, hausdorff;
    std::vector<std::uint32_t> nearest_a, nearest_b, closest_point;
  } names;

  // Neighbours of a alone.
  struct Near {
    std::vector<std::pair<std::int32_t, float>> within; ///< by record: those within the clearance
    std::vector<float> nearest;                         ///< squared distances of the five nearest
    bool any = false;
  };
  std::vector<Near> near; ///< of each query
  std::vector<std::int32_t> box;
  std::vector<std::int32_t> clusters; ///< of each record, the smallest of its cluster; -1: none

  // Along the path.
  std::vector<std::uint8_t> path_flags;
  std::vector<float> path_distances;
  std::vector<std::int32_t> first_poses, closest_poses;
  std::vector<std::size_t> colliding_at; ///< of each pose: points of a, and those undecided
  std::vector<double> distance_at;       ///< of what collides
  std::vector<std::uint8_t> any_at;
  std::vector<double> closest_at;
  /// Verdicts of the motion, in doubt between clearance and clearance + tolerance. An entry is 1 where the motion is
  /// free, collides, or is free at a clearance larger by the tolerance.
  struct Motion {
    std::vector<std::uint8_t> free, hit, free_farther;
  } swept, motions; ///< of each record; of each motion from one pose to the next

  // Answers of ask().
  std::vector<std::uint8_t> asked_flags, asked_obstacle_flags, asked_within, asked_path_flags;
  std::vector<float> asked_distances;
  std::vector<double> asked_both_ways;
  double asked_closest = 0.0;

  /// Answers of ask(), where faces of b are the obstacle, or the input.
  struct Surface {
    std::vector<std::uint8_t> flags, path_flags; ///< of the points of a
    std::vector<float> distances;                ///< of the points of a; for a shell, negative inside
    std::vector<std::uint8_t> face_flags;        ///< of the faces, against the points of a
    std::vector<float> face_distances;
    double closest = 0.0;
  } surface, shell;
};

/// Asks all of them, of hierarchies built for this.
Answers answersOf(const Instance& instance);

/// Asks some of the questions, or asks them through a program; the other members stay as a new Answers has them.
using Ask = std::function<Answers(const Instance&)>;

/// Which answers a symmetry keeps.
struct Kept {
  bool names = true;
  bool own = true;      ///< those of a alone
  bool nearest = true;  ///< of these, the five nearest, and clusters
  bool along = true;    ///< along the path
  bool question = true; ///< of ask()
  bool surface = true;  ///< of ask() about faces
  bool motions = false; ///< verdicts of motions, also in doubt
};

/// The first difference, or nothing.
std::string firstDifference(const Answers& expected, const Answers& found, const Kept& kept);

} // namespace pcl_bsh::symmetries

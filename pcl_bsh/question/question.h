// SPDX-License-Identifier: BSD-3-Clause
// A user's question about two things, an input and an obstacle, as plain data. ask.h answers it; options.h names its
// members as users write them.
//
//   Question question;
//   question.pose = T_scan_robot;
//   question.clearance = 0.05;
//   question.wanted.flags = true;
//   const Answer answer = ask(question, scan, robot);
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/query/effort.h>
#include <pcl_bsh/question/ignored_points.h>
#include <pcl_bsh/question/scan_origins.h>
#include <pcl_bsh/question/uncertainty.h>

#include <Eigen/Geometry>

#include <limits>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Which answers are computed. Where the input is a surface, its triangles take the place of points.
struct Wanted {
  bool flags = false;            ///< which points of the input collide
  bool obstacle_flags = false;   ///< which points of the obstacle do, at one pose
  bool any = false;              ///< whether anything collides, at one pose
  bool indices = false;          ///< which points of the input collide, as a list, at one pose
  bool obstacle_indices = false; ///< which points of the obstacle collide, as a list, at one pose
  bool contacts = false;         ///< of each that collides: its smallest distance, the first pose and the closest
  bool poses = false;         ///< of each pose: how many points collide, the smallest distance and its pair; swept, of
                              ///< the motion from each pose to the next
  bool first_poses = false;   ///< of each that collides: the first pose alone
  bool closest = false;       ///< the smallest distance and its pair; with contacts, or on a path, of colliding points
  bool distances = false;     ///< of each point of the input to the obstacle; along a path the smallest
  bool both_ways = false;     ///< distances also of the obstacle's points, at one pose
  bool within = false;        ///< which points of the input have a distance within the limits, at one pose
  bool intervals = false;     ///< distances that an early stop leaves open are answers, too: their intervals tell
  bool unseen_places = false; ///< with `seen`: which records of the obstacle are unseen at each pose
  bool overlap = false;       ///< of askBetween(): how much of each surface lies within the other, a solid
  bool spacings = false;      ///< how far points are apart, for the warning of holes: builds a few voxels

  bool collisions() const
  {
    return flags || obstacle_flags || any || indices || obstacle_indices || contacts || poses || first_poses;
  }                                                     ///< whether a clearance counts
  bool measures() const { return distances || within; } ///< whether the distance of each record is wanted
  bool oneWay() const
  {
    return measures() && !both_ways && !collisions() && !closest;
  } ///< whether all that is asked is how far records of the input are from the obstacle
};

/// Limits of distances, both inclusive, and compared exactly.
struct DistanceLimits {
  double least = 0.0;
  double most = std::numeric_limits<double>::infinity();
};

/// Lengths are in the clouds' own unit. Which values are allowed, options.h says. Progress is that of all its queries
/// together.
struct Question : Effort {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity(); ///< T_input_obstacle; rigid within 1e-6
  /// T_world_input, where `pose` and `path` are those of the obstacle in a world: no product of poses is rounded.
  Eigen::Isometry3d pose_of_input = Eigen::Isometry3d::Identity();
  std::optional<std::vector<Eigen::Isometry3d>> path = {}; ///< in place of `pose`: such poses, in order; not empty
  double swept = 0.0; ///< > 0: the motion between the poses of the path counts, too, to this tolerance
  std::optional<double> clearance = {}; ///< points collide up to it, inclusive; none: 0, and no warning speaks of it
  Uncertainty uncertainty = {}, obstacle_uncertainty = {};
  PoseUncertainty pose_uncertainty = {};       ///< of every pose, in the obstacle's frame
  PoseUncertainty input_pose_uncertainty = {}; ///< of the input's own, in its frame
  double sigmas = 1.0;                         ///< multiplies `sigmas` of both uncertainties, where they are fields
  bool density = false;                        ///< the density guard (FlagsRequest::spacings_of_b)
  std::optional<double> widest_gap = {};       ///< of the guard; none: usualGap()
  bool seen = false;                           ///< free records of the obstacle may be unseen (Answer::unseen)
  ScanOrigins origin = {};                     ///< where the input was scanned from
  std::optional<double> seen_angle = {};       ///< SeenOptions::angle
  std::optional<double> seen_beyond = {};      ///< ScanBeams::misses_beyond; none: beams without a return say nothing
  std::optional<double> max_distance = {};     ///< greater distances are not told
  DistanceLimits limits = {};
  bool solid = false;       ///< the obstacle counts with what its faces enclose: they must close
  bool input_solid = false; ///< the input counts with what its faces enclose: they must close
  IgnoredPoints ignore_points = {}, obstacle_ignore_points = {}; ///< points of the two that do not count
  bool vertices_only = false; ///< for callers that make shapes of meshes: a mesh is its vertices alone
  Wanted wanted = {};

  /// Returns the poses of the path, or the only pose.
  std::vector<Eigen::Isometry3d> poses() const { return path ? *path : std::vector{pose}; }
  /// Returns the tolerance of swept motion, or nothing where the poses alone count.
  std::optional<double> sweptTolerance() const { return swept > 0.0 ? std::optional(swept) : std::nullopt; }
  /// Returns `uncertainty` with `sigmas` and with the uncertainty of the input's pose.
  Uncertainty uncertaintyOfInput() const { return scaled(uncertainty, input_pose_uncertainty); }
  /// Returns `obstacle_uncertainty` with `sigmas` and with the uncertainty of the obstacle's pose.
  Uncertainty uncertaintyOfObstacle() const { return scaled(obstacle_uncertainty, pose_uncertainty); }

  /// Whether a point may be elsewhere than it is given.
  bool isUncertain() const { return !uncertaintyOfInput().isZero() || !uncertaintyOfObstacle().isZero(); }

private:
  Uncertainty scaled(Uncertainty one, const PoseUncertainty& pose_of_it) const
  {
    one.sigmas *= sigmas;
    one.pose = pose_of_it;
    return one;
  }
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

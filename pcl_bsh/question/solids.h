// SPDX-License-Identifier: BSD-3-Clause
// Adds the contents of solids to answers about surfaces: records inside collide, and their distances are negative.
#pragma once

#include <pcl_bsh/depths/depths.h>
#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/solid/enclosure.h>

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace pcl_bsh {

/// The part of ask() about an obstacle or an input that is a solid, both as they are placed. A record collides with a
/// solid if one of its places is inside or on the surface: a point, or a corner of a triangle. A triangle of the solid
/// collides if its body holds such a place in its inside (solid/bodies.h).
class Solids {
public:
  /// @throws InvalidOption where a solid has no faces, InvalidInput where these do not close
  Solids(const Question& question, Shape& input, Shape& obstacle, const Placed& a, const Placed& b);

  bool none() const { return pairings_.empty(); } ///< nothing is solid

  /// Returns the request about the surfaces that addTo() needs: where places are uncertain, it asks for the flags of
  /// both.
  FlagsRequest request(FlagsRequest request) const;

  /// Adds enclosed records at one pose. Records that are undecided because places are uncertain stay so.
  /// @param found the result of such a request
  void addTo(FlagsResult& found);
  void addTo(AnyResult& found) { addTo(found, b_.pose); }

  /// With the obstacle at some pose.
  void addTo(AnyResult& found, const Eigen::Isometry3d& pose);

  /// Adds enclosed records along the path. A record that is inside at a pose collides there. Its distance is the depth
  /// where it is deepest: at a pose or, swept, on the motion between poses. @param pivot of that motion
  void addToPath(TrajectoryResult& found, Work& work, const Point3& pivot = {0, 0, 0}) const;

  /// Turns the distances of records inside into negative ones, however deep they are. Triangles get intervals.
  void turn(SymmetricDistances& found, bool both_ways) const;

  /// Turns the smallest distance into that of the deepest record, where anything is inside.
  void turn(DistanceResult& closest) const { turn(closest, b_.pose); }

  /// With the obstacle at some pose.
  void turn(DistanceResult& closest, const Eigen::Isometry3d& pose) const;

private:
  using Records = std::vector<std::uint32_t>;

  /// A solid, and the thing that may be in it.
  struct Pairing {
    bool of_obstacle; ///< the obstacle is the solid
    const SolidBodies& solid;
    const QueriedRecords& queried;
    std::optional<Records> enclosed; ///< at the one pose, once asked for
  };

  /// For each record of the input, the first pose at which it is enclosed, or its body holds something; or kNothing.
  struct FirstPoses {
    std::vector<std::uint32_t> possible, certain; ///< certain: wherever places truly are
  };

  /// Returns the pose of the solid. A path moves the obstacle alone.
  Eigen::Isometry3d poseOfSolid(const Pairing& pair, const Eigen::Isometry3d& pose) const
  {
    return pair.of_obstacle ? pose : a_.pose;
  }
  Eigen::Isometry3d poseOfQueried(const Pairing& pair, const Eigen::Isometry3d& pose) const
  {
    return pair.of_obstacle ? a_.pose : pose;
  }

  const Records& enclosed(Pairing& pair, Work& work);
  Records enclosedAt(const Pairing& pair, const Eigen::Isometry3d& pose, Work& work) const;
  void add(const Pairing& pair, const Eigen::Isometry3d& pose, const Records& enclosed, FlagsResult& found) const;
  using PoseRecord = std::pair<std::uint32_t, std::uint32_t>; ///< numbers of a pose, and of a record
  void findOthers(const Pairing& pair, std::vector<PoseRecord> at, const std::vector<Eigen::Isometry3d>& poses,
                  std::vector<std::uint32_t>& others, Work& work) const;
  FirstPoses firstPoses(const Pairing& pair, Work& work) const;
  FlagsResult flagsOfQueried(const Pairing& pair, const Eigen::Isometry3d& pose) const;
  void addToSummary(PoseSummary& summary, const Eigen::Isometry3d& pose, double depth, Work& work) const;

  /// The solid of a pair, at a pose of the obstacle.
  DeepSolid deepSolid(const Pairing& pair, const Eigen::Isometry3d& pose) const;
  Records mayBeDeep(const Pairing& pair, const FirstPoses& first, const TrajectoryResult& found) const;
  void addDepths(const Pairing& pair, const FirstPoses& first, const std::vector<Eigen::Isometry3d>& poses,
                 const Point3& pivot, TrajectoryResult& found, std::vector<double>& at_poses, Work& work) const;
  void turn(const Pairing& pair, PointDistances& found) const;

  const Question& question_;
  const Placed &a_, &b_;
  const bool uncertain_;
  std::vector<Pairing> pairings_;
};

} // namespace pcl_bsh

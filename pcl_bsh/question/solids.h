// SPDX-License-Identifier: BSD-3-Clause
// What solids enclose collides, and its distance is negative: added to what is found of surfaces.
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

/// What ask() adds where the obstacle, or the input, is a solid; both as they are placed. Of what a solid holds,
/// records collide that have a place inside: a point, or a corner of a triangle; on the surface counts. Of the solid
/// those triangles do whose body holds such a place in its inside (solid/bodies.h).
class Solids {
public:
  /// @throws InvalidOption where what is to be solid has no faces, InvalidInput where these do not close
  Solids(const Question& question, Shape& input, Shape& obstacle, const Placed& a, const Placed& b);

  bool none() const { return pairings_.empty(); } ///< nothing is solid

  /// What addTo() needs of the surfaces beside what is asked for: where places are uncertain, the flags of both.
  FlagsRequest request(FlagsRequest request) const;

  /// At one pose. What is undecided for want of certain places stays so. @param found by such a request
  void addTo(FlagsResult& found);
  void addTo(AnyResult& found) { addTo(found, b_.pose); }

  /// With the obstacle at some pose.
  void addTo(AnyResult& found, const Eigen::Isometry3d& pose);

  /// Along the path: what is inside at a pose collides there, and is as deep as where it is deepest; swept, also on the
  /// motion between poses. @param pivot of that motion
  void addToPath(TrajectoryResult& found, Work& work, const Point3& pivot = {0, 0, 0}) const;

  /// Distances of what is inside become negative, and are measured however deep. Triangles get intervals.
  void turn(SymmetricDistances& found, bool both_ways) const;

  /// The deepest, where anything is inside.
  void turn(DistanceResult& closest) const { turn(closest, b_.pose); }

  /// With the obstacle at some pose.
  void turn(DistanceResult& closest, const Eigen::Isometry3d& pose) const;

private:
  using Records = std::vector<std::uint32_t>;

  /// One of the two that is solid, and the other.
  struct Pairing {
    bool of_obstacle; ///< it is the solid
    const SolidBodies& solid;
    const Content& content;
    std::optional<Records> held; ///< at the one pose, once asked for
  };

  /// For each record of the input, the first pose at which it is held, or its body holds something; or kNothing.
  struct FirstPoses {
    std::vector<std::uint32_t> possible, certain; ///< certain: wherever places truly are
  };

  /// A path moves the obstacle.
  Eigen::Isometry3d poseOfSolid(const Pairing& pair, const Eigen::Isometry3d& pose) const
  {
    return pair.of_obstacle ? pose : a_.pose;
  }
  Eigen::Isometry3d poseOfContent(const Pairing& pair, const Eigen::Isometry3d& pose) const
  {
    return pair.of_obstacle ? a_.pose : pose;
  }

  const Records& held(Pairing& pair, Work& work);
  Records heldAt(const Pairing& pair, const Eigen::Isometry3d& pose, Work& work) const;
  void add(const Pairing& pair, const Eigen::Isometry3d& pose, const Records& held, FlagsResult& found) const;
  using PoseRecord = std::pair<std::uint32_t, std::uint32_t>; ///< numbers of a pose, and of a record
  void findOthers(const Pairing& pair, std::vector<PoseRecord> at, const std::vector<Eigen::Isometry3d>& poses,
                  std::vector<std::uint32_t>& others, Work& work) const;
  FirstPoses firstPoses(const Pairing& pair, Work& work) const;
  FlagsResult flagsOfContent(const Pairing& pair, const Eigen::Isometry3d& pose) const;
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

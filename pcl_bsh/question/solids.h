// SPDX-License-Identifier: BSD-3-Clause
// What an obstacle that is a solid encloses collides, and its distance is negative: added to what is found of its
// surface.
#pragma once

#include <pcl_bsh/question/ask.h>

namespace pcl_bsh {

/// What ask() adds where the obstacle is a solid, of the input a and the obstacle b, as they are placed. A part of the
/// input is inside where a point is, or a corner of a triangle; on the surface counts.
class SolidObstacle {
public:
  /// @throws InvalidOption where the obstacle has no faces, InvalidInput where these do not close
  SolidObstacle(const Question& question, Shape& obstacle, const Placed& a, const Placed& b);

  /// At one pose: what is inside collides. What is undecided for want of certain places stays so.
  void addTo(TrajectoryResult& flags, Work& work);

  /// Along the path: what is inside at a pose collides there, at a distance of 0.
  void addToPath(TrajectoryResult& found, Work& work) const;

  /// Distances of what is inside become negative, and are measured however deep.
  void turn(PointDistances& found);

  /// The deepest, where anything is inside.
  void turn(DistanceResult& closest);

private:
  std::vector<std::uint8_t> labels(const Eigen::Isometry3d& pose, Work* work) const;
  const std::vector<std::uint32_t>& inside(Work* work); ///< records at the one pose; labelled once
  PointDistances depths(const std::vector<std::uint32_t>& records) const;

  const Question& question_;
  const Solid& solid_;
  const Placed &a_, &b_;
  std::optional<std::vector<std::uint32_t>> inside_;
};

} // namespace pcl_bsh

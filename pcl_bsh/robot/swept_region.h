// SPDX-License-Identifier: BSD-3-Clause
// Which points of a frame may a motion come near? All others are left out before anything is built of them.
//
//   const SweptRegion region(world.sweptBalls(now, next), 0.05, T_world_camera);
//   region.recordsInside(frame, records);  // all that are within 5 cm of the robot at some instant, and some more
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/robot/robot_world.h>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh::robots {

/// Cubes in the frame of a cloud, and which of them balls come near.
class SweptRegion {
public:
  /// @param margin m: points count that are no farther from a ball
  /// @param T_world_cloud rigid within 1e-6
  /// @throws InvalidInput for a margin that is not finite and >= 0, and for a pose that is not rigid
  SweptRegion(const std::vector<SweptBall>& balls, double margin, const Eigen::Isometry3d& T_world_cloud);

  /// The records of all points that are near enough, and of some that are a cube's diagonal farther, in their order.
  /// Radii and uncertainties of points are not looked at: let the margin hold them. Points at exactly 0 0 0 are left
  /// out: they are beams of a sensor that had no return.
  void recordsInside(const PointsView& cloud, std::vector<std::int32_t>& records) const;

private:
  void mark(const Eigen::Vector3d& center, double radius);
  /// @tparam T of the coordinates. @param offset of these in the point
  template <class T>
  bool isNear(const unsigned char* point, const std::array<std::size_t, 3>& offset) const;

  Eigen::Array3f low_ = Eigen::Array3f::Zero(); ///< corner, m
  float cubes_per_m_ = 0.0f;
  std::array<std::size_t, 3> count_ = {0, 0, 0}; ///< of cubes along the axes
  std::vector<std::uint8_t> near_;
};

} // namespace pcl_bsh::robots
PCL_BSH_EXPORT_END

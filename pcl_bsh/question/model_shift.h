// SPDX-License-Identifier: BSD-3-Clause
// A scan with an uncertain pose moves together with its scanners and beams: relative to them, a model moves the other
// way.
#pragma once

#include <pcl_bsh/geometry/ball_about_box.h>
#include <pcl_bsh/hierarchy/record_corners.h>
#include <pcl_bsh/question/pose_uncertainty.h>

#include <Eigen/Geometry>

namespace pcl_bsh {

/// A box about the corners of all records.
struct CornerBox {
  explicit CornerBox(const PointsView& view)
  {
    for (std::size_t i = 0; i < view.size(); ++i) {
      const std::uint32_t record = view.record(i);
      if (!isFinite(view.point(record))) continue;
      const Corners corners = cornersOf(view, record);
      for (std::uint32_t c = 0; c < corners.count; ++c) box.extend(Eigen::Vector3d(corners.at[c].data()));
    }
    if (!box.isEmpty())
      ball = ballAboutBox({box.min().x(), box.min().y(), box.min().z()}, {box.max().x(), box.max().y(), box.max().z()});
  }
  Eigen::AlignedBox3d box;
  BoxBall ball = {{0, 0, 0}, 0.0}; ///< about it
};

/// Returns how far any point of the model may move relative to the scan. @param of_scan in the scan's frame
inline double shiftOf(const PoseUncertainty& of_scan, const CornerBox& model, const Eigen::Isometry3d& T_scan_model)
{
  if (of_scan.isZero() || model.box.isEmpty()) return 0.0;
  const Eigen::Vector3d at = T_scan_model * Eigen::Vector3d(model.ball.center.data());
  return (of_scan.length + of_scan.turned({at.x(), at.y(), at.z()}, model.ball.radius)) * (1.0 + 0x1p-40);
}

} // namespace pcl_bsh

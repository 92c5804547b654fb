// SPDX-License-Identifier: BSD-3-Clause
// A scan whose pose is uncertain, its scanners and its beams move together: among them a model moves, the other way.
#pragma once

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
    if (!box.isEmpty()) radius = 0.5 * box.diagonal().norm() * (1.0 + 0x1p-40);
  }
  Eigen::AlignedBox3d box;
  double radius = 0.0; ///< of a ball about its centre that holds it
};

/// By how much any point of the model, at most. @param of_scan in the scan's frame
inline double strayOf(const PoseUncertainty& of_scan, const CornerBox& model, const Eigen::Isometry3d& T_scan_model)
{
  if (of_scan.isZero() || model.box.isEmpty()) return 0.0;
  const Eigen::Vector3d at = T_scan_model * model.box.center();
  return (of_scan.length + of_scan.turned({at.x(), at.y(), at.z()}, model.radius)) * (1.0 + 0x1p-40);
}

} // namespace pcl_bsh

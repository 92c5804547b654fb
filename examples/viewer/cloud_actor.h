// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "options.h"
#include "palette.h"
#include "point_layer.h"
#include "viewed_cloud.h"

#include <pcl_bsh/hierarchy/points_view.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh::view {

/// A cloud as points, with those that collide once more, larger. A surface is drawn as such, with the balls of its
/// cover that collide.
class CloudActor {
public:
  CloudActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color, const Color& marked);

  /// Takes the points as they are now; paint and mark them anew. For points that move in their own frame.
  void setPoints(const PointsView& points);

  /// @param colors one per record
  void paint(const std::vector<Color>& colors);

  /// One colour, darker for lower points: a cloud all of one would look flat.
  void paint(const Color& color);

  /// Draws points with flags[record] != 0 larger: in the mark's colour, or in `colors` where that is not empty.
  /// @param flags empty: none
  void mark(const std::vector<std::uint8_t>& flags, const std::vector<Color>& colors = {});
  void place(const Eigen::Isometry3d& pose);
  void setMoving(bool moving);
  void cut(const Cut& plane); ///< in the world frame; nothing is drawn on the side of its normal

  vtkPolyData& data() const { return points_.data(); } ///< what is drawn
  vtkPolyData& all() const { return *all_; }           ///< with what withoutFarPoints() leaves out
  vtkIdType leftOut() const { return all_->GetNumberOfPoints() - data().GetNumberOfPoints(); }
  vtkPolyData& marked() const { return marks_.data(); }

  /// The record that a picked prop and point id are; none when they are not of this cloud.
  std::optional<std::uint32_t> recordOf(const vtkProp* prop, vtkIdType id) const;

private:
  vtkSmartPointer<vtkPolyData> all_;
  PointLayer points_, marks_;
  vtkSmartPointer<vtkActor> surface_; ///< null where the cloud is points
};

} // namespace pcl_bsh::view

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "options.h"
#include "palette.h"
#include "point_layer.h"
#include "triangle_layer.h"
#include "viewed_cloud.h"

#include <pcl_bsh/hierarchy/points_view.h>

#include <vtkPicker.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh::view {

/// A cloud as points, with those that collide once more, larger. A surface is drawn as such: with colours of its
/// triangles where these are asked about, else with the balls of its cover that collide.
class CloudActor {
public:
  CloudActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color, const Color& marked);

  /// Takes the points as they are now; paint and mark them anew. For points that move in their own frame.
  void setPoints(const PointsView& points);

  /// @param colors one per part
  void paint(const std::vector<Color>& colors);

  /// One colour, darker for lower points: a cloud all of one would look flat.
  void paint(const Color& color);

  /// Draws points with flags[record] != 0 larger, or triangles with flags[part] != 0: in the mark's colour, or in
  /// `colors` where that is not empty.
  /// @param flags empty: none
  void mark(const std::vector<std::uint8_t>& flags, const std::vector<Color>& colors = {});
  void place(const Eigen::Isometry3d& pose);
  void setMoving(bool moving);
  void cut(const Cut& plane); ///< in the world frame; nothing is drawn on the side of its normal

  bool hasTriangles() const { return triangles_.has_value(); }
  vtkPolyData& data() const { return triangles_ ? triangles_->data() : points_.data(); } ///< what is drawn
  vtkPolyData& all() const { return triangles_ ? data() : *all_; } ///< with what withoutFarPoints() leaves out
  vtkIdType leftOut() const { return all().GetNumberOfPoints() - data().GetNumberOfPoints(); }
  vtkPolyData& marked() const { return triangles_ ? triangles_->marked() : marks_.data(); }

  /// Lets the pickers find what this cloud is asked about: its points or its triangles.
  void offerTo(vtkPicker& points, vtkPicker& triangles) const;

  /// The part that a picked prop and the id of a point, or of a triangle's cell, are; none when they are not of this
  /// cloud.
  std::optional<std::uint32_t> partOf(const vtkProp* prop, vtkIdType id) const;

private:
  vtkSmartPointer<vtkPolyData> all_;
  PointLayer points_, marks_;
  vtkSmartPointer<vtkActor> surface_;      ///< null where the cloud is points or triangles
  std::optional<TriangleLayer> triangles_; ///< where these are asked about
};

} // namespace pcl_bsh::view

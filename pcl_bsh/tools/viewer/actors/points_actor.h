// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud_actor.h"
#include "point_layer.h"

#include <vtkActor.h>
#include <vtkSmartPointer.h>

namespace pcl_bsh::viewer {

/// A cloud as points; marks are drawn once more, larger. A surface of whose triangles nothing is asked is drawn as
/// such, with the balls of its cover that are marked.
class PointsActor : public CloudActor {
public:
  PointsActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color, const Color& marked);

  void setPoints(const PointsView& points) override;
  void paint(const std::vector<Color>& colors) override;
  void paint(const Color& color, const ColorRange* heights) override;
  void mark(const std::vector<std::uint8_t>& flags, const std::vector<Color>& colors) override;
  void place(const Eigen::Isometry3d& pose) override;
  void setMoving(bool moving) override;
  void setVisible(bool visible) override;
  void remove(vtkRenderer& renderer) override;
  void cut(const Cut& plane) override;
  vtkPolyData& data() const override { return points_.data(); }
  vtkPolyData& all() const override { return *all_; }
  vtkPolyData& marked() const override { return marks_.data(); }
  void offerTo(vtkPicker& points, vtkPicker& triangles) const override;
  std::optional<std::uint32_t> partOf(const vtkProp* prop, vtkIdType id) const override;

private:
  vtkSmartPointer<vtkPolyData> all_;
  PointLayer points_, marks_;
  vtkSmartPointer<vtkActor> surface_; ///< null where the cloud is points
};

} // namespace pcl_bsh::viewer

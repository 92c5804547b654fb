// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cloud_actor.h"

#include <vtkActor.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh::viewer {

/// A surface whose triangles have colours of their own. What is marked is outlined, too: small triangles are seen from
/// afar.
class TrianglesActor : public CloudActor {
public:
  /// @pre viewed.hasTriangles()
  TrianglesActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color, const Color& marked);

  void setPoints(const PointsView& /*points*/) override {} ///< surfaces do not deform
  void paint(const std::vector<Color>& colors) override;
  void paint(const Color& color, const ColorRange* heights) override;
  void mark(const std::vector<std::uint8_t>& flags, const std::vector<Color>& colors) override;
  void place(const Eigen::Isometry3d& pose) override;
  void setMoving(bool /*moving*/) override {}
  void setVisible(bool visible) override;
  void remove(vtkRenderer& renderer) override;
  void cut(const Cut& plane) override;
  vtkPolyData& data() const override { return *data_; } ///< a cell per triangle
  vtkPolyData& all() const override { return *data_; }
  vtkPolyData& marked() const override { return *marked_; } ///< with points of its own
  void offerTo(vtkPicker& points, vtkPicker& triangles) const override;
  std::optional<std::uint32_t> partOf(const vtkProp* prop, vtkIdType id) const override;

private:
  void show();

  vtkSmartPointer<vtkPolyData> data_, marked_;
  vtkSmartPointer<vtkActor> faces_, outlines_;
  Color marked_color_;
  std::vector<Color> colors_, marked_colors_;
  std::vector<std::uint8_t> flags_;
};

} // namespace pcl_bsh::viewer

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "options.h"
#include "palette.h"
#include "viewed_cloud.h"

#include <Eigen/Geometry>
#include <vtkActor.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace pcl_bsh::view {

/// A surface whose triangles have colours of their own. What is marked is outlined, too: small triangles are seen from
/// afar.
class TriangleLayer {
public:
  /// @pre viewed.hasTriangles()
  TriangleLayer(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color, const Color& marked);

  void paint(const std::vector<Color>& colors); ///< one per triangle
  void paint(const Color& color);

  /// Colours triangles with flags[triangle] != 0: the marks' colour, or those of `colors` where that is not empty.
  /// @param flags empty: none
  void mark(const std::vector<std::uint8_t>& flags, const std::vector<Color>& colors);

  void place(const Eigen::Isometry3d& pose);
  void cut(const Cut& plane);

  vtkPolyData& data() const { return *data_; }     ///< a cell per triangle
  vtkPolyData& marked() const { return *marked_; } ///< with points of its own
  vtkActor& actor() const { return *faces_; }

  /// The triangle that a picked prop and cell id are.
  std::optional<std::uint32_t> triangleOf(const vtkProp* prop, vtkIdType id) const;

private:
  void show();

  vtkSmartPointer<vtkPolyData> data_, marked_;
  vtkSmartPointer<vtkActor> faces_, outlines_;
  Color marked_color_;
  std::vector<Color> colors_, marked_colors_;
  std::vector<std::uint8_t> flags_;
};

} // namespace pcl_bsh::view

// SPDX-License-Identifier: BSD-3-Clause
// Data as actors: placed, coloured, and several that come and go together.
#pragma once

#include "palette.h"
#include <pcl_bsh/tools/viewer/options.h>

#include <Eigen/Geometry>
#include <vtkActor.h>
#include <vtkMatrix4x4.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <string>
#include <vector>

namespace pcl_bsh::viewer {

vtkSmartPointer<vtkMatrix4x4> matrixOf(const Eigen::Isometry3d& pose);

/// Without lighting: colours are seen as they are.
vtkSmartPointer<vtkActor> actorOf(vtkPolyData* data);
void setColor(vtkActor& actor, const Color& color);

/// A colour of its own for each point, by record where the data has record numbers.
void setColors(vtkPolyData& data, const std::vector<Color>& colors);

/// Nothing of the actor is drawn on the side of the plane's normal.
void cut(vtkActor& actor, const Cut& plane);

/// The data in another frame; itself where that is the same.
vtkSmartPointer<vtkPolyData> posed(vtkPolyData* data, const Eigen::Isometry3d& pose);

/// What is drawn beside the clouds, and cannot be picked.
class PropGroup {
public:
  explicit PropGroup(vtkRenderer& renderer) : renderer_(renderer) {}

  void add(const vtkSmartPointer<vtkProp>& prop);
  void clear();

private:
  vtkRenderer& renderer_;
  std::vector<vtkSmartPointer<vtkProp>> props_;
};

} // namespace pcl_bsh::viewer

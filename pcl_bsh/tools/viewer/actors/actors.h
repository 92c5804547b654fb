// SPDX-License-Identifier: BSD-3-Clause
// Data as actors: placed, coloured, and several that come and go together.
#pragma once

#include "palette.h"
#include <pcl_bsh/tools/viewer/content/viewed_cloud.h>

#include <Eigen/Geometry>
#include <vtkActor.h>
#include <vtkDataSetAttributes.h>
#include <vtkMatrix4x4.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include <vector>

namespace pcl_bsh::viewer {

vtkSmartPointer<vtkMatrix4x4> matrixOf(const Eigen::Isometry3d& pose);

/// An actor of data, without lighting, so that colours are seen as they are.
vtkSmartPointer<vtkActor> actorOf(vtkPolyData* data);
void setData(vtkActor& actor, vtkPolyData& data); ///< of one that actorOf() made
void setColor(vtkActor& actor, const Color& color);

/// A surface in one colour, lit, so that its shape is seen. @pre viewed.surface
vtkSmartPointer<vtkActor> surfaceActor(const ViewedCloud& viewed, const Color& color);

/// Gives each point or cell a colour of its own. @param color_of called with each number below `count`
template <class ColorOf>
void setColors(vtkDataSetAttributes& parts, vtkIdType count, const ColorOf& color_of)
{
  const auto colors = vtkSmartPointer<vtkUnsignedCharArray>::New();
  colors->SetName("colors");
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(count);
  for (vtkIdType i = 0; i < count; ++i) {
    const Color color = color_of(i);
    colors->SetTypedTuple(i, color.data());
  }
  parts.SetScalars(colors);
}

/// The data moved by a pose; the data itself for the identity.
vtkSmartPointer<vtkPolyData> posed(vtkPolyData* data, const Eigen::Isometry3d& pose);

/// Parts of the picture beside the clouds, which cannot be picked.
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

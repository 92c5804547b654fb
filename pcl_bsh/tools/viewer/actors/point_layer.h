// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl_bsh/tools/viewer/options.h>

#include <Eigen/Geometry>
#include <vtkActor.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

namespace pcl_bsh::viewer {

/// Points of one size; few of them only while the picture moves. All and few are two actors, of which one is seen: what
/// the graphics card holds of the many stays there.
class PointLayer {
public:
  /// @param in_front drawn before other points of the same place
  PointLayer(vtkRenderer& renderer, float size, bool in_front);

  /// @param data of vtk::cloudData(), with an array `colors` or in the layer's colour
  void show(const vtkSmartPointer<vtkPolyData>& data);
  vtkPolyData& data() const { return *data_; }

  vtkActor& actor() const { return *all_; }
  void place(const Eigen::Isometry3d& pose);
  void setMoving(bool moving);
  void hide();                   ///< for good
  void setVisible(bool visible); ///< of a picture that does not move
  void remove(vtkRenderer& renderer);
  void cut(const Cut& plane);
  bool owns(const vtkProp* prop) const { return prop == all_.Get(); } ///< one picks while nothing moves

private:
  vtkSmartPointer<vtkPolyData> data_;
  vtkSmartPointer<vtkActor> all_, few_;
  bool few_is_old_ = true;
  bool hidden_ = false;
};

} // namespace pcl_bsh::viewer

// SPDX-License-Identifier: BSD-3-Clause
/// @class vtkBSHDistanceFilter
/// @brief how far each point of a cloud is from an obstacle, at a pose or along a path
///
/// Adds point arrays. `distance` (double) is NaN where it is more than MaximumDistance. At a single pose,
/// `closest_point` (vtkIdType) is the nearest point of the obstacle, the smallest of several; of a surface, the cell;
/// else -1. With poses (port 2), `distance` is the smallest over all of them, rounded to float, and `closest_pose`
/// (int, from 0; -1 where none) the first that has it; MaximumDistance must then be finite.
///
/// A distance is exact, rounded to the nearest double. With Solid it is negative inside of the obstacle, at a single
/// pose, however deep; along a path it is 0 there.
///
/// vtkBSHFilter has the inputs, what they mean, and what happens where something fails.
#pragma once

#include <pcl_bsh/vtk_filters/vtkBSHFilter.h>

class PCL_BSH_EXPORT vtkBSHDistanceFilter : public vtkBSHFilter {
public:
  static vtkBSHDistanceFilter* New();
  vtkTypeMacro(vtkBSHDistanceFilter, vtkBSHFilter)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Greater distances are not told, but are NaN; less is faster; without it, no limit: VTK_DOUBLE_MAX (default) or
  /// infinity. In the clouds' unit, >= 0.
  vtkSetMacro(MaximumDistance, double);
  vtkGetMacro(MaximumDistance, double);
  ///@}

protected:
  vtkBSHDistanceFilter() = default;
  ~vtkBSHDistanceFilter() override = default;

  void Ask(pcl_bsh::Question& question) const override;
  void Fill(const pcl_bsh::Question& question, const pcl_bsh::Answer& answer, vtkPolyData* output) override;

  double MaximumDistance = VTK_DOUBLE_MAX;

private:
  vtkBSHDistanceFilter(const vtkBSHDistanceFilter&) = delete;
  void operator=(const vtkBSHDistanceFilter&) = delete;
};

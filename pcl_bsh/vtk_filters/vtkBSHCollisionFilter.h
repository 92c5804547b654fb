// SPDX-License-Identifier: BSD-3-Clause
/// @class vtkBSHCollisionFilter
/// @brief which points of a cloud come within the clearance of an obstacle, at a pose or along a path
///
/// Adds the point array `collision`: 1 collides, 0 free. Two points collide if and only if their distance is at most
/// the clearance, as exact arithmetic decides it. With poses (port 2), `collision` is that of any of them, and three
/// arrays more tell about points which collide: `distance` (float, the smallest over all poses; NaN where free),
/// `first_pose` and `closest_pose` (int, from 0; -1 where free).
///
/// With the option `seen` the output's field data has three arrays. `obstacle_collision` is a verdict for each point of
/// the obstacle, or each cell of its surface (0 free, 1 collides, 2 undecided, 4 unseen; the gravest of all poses, and
/// of a cell's triangles). `unseen_at_poses` counts unseen points or triangles at each pose, and `in_shadow_at_poses`
/// those that no beam passed.
///
///     vtkNew<vtkBSHCollisionFilter> collision;
///     collision->SetInputData(scan);
///     collision->SetObstacleData(robot);
///     collision->SetClearance(0.05);
///     collision->Update();
///
/// vtkBSHFilter has the inputs, what they mean, and what happens where something fails.
#pragma once

#include <pcl_bsh/vtk_filters/vtkBSHFilter.h>

class PCL_BSH_EXPORT vtkBSHCollisionFilter : public vtkBSHFilter {
public:
  static vtkBSHCollisionFilter* New();
  vtkTypeMacro(vtkBSHCollisionFilter, vtkBSHFilter)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// Greatest distance that counts as collision, touching included; in the clouds' unit, finite and >= 0. Default 0.
  vtkSetMacro(Clearance, double);
  vtkGetMacro(Clearance, double);
  ///@}

  ///@{
  /// Above 0, the motion between the poses of a path counts, too, to this tolerance: what comes within the clearance
  /// collides, what stays beyond clearance + tolerance does not; 0: the poses alone. In the clouds' unit; needs poses.
  /// Default 0.
  vtkSetMacro(Swept, double);
  vtkGetMacro(Swept, double);
  ///@}

  /// How many points collide, of the last execution; 0 where that failed. For a cloud in blocks: of its last block.
  vtkGetMacro(NumberOfCollidingPoints, vtkIdType);

protected:
  vtkBSHCollisionFilter() = default;
  ~vtkBSHCollisionFilter() override = default;

  void Ask(pcl_bsh::Question& question) const override;
  void Fill(const pcl_bsh::Question& question, const pcl_bsh::Answer& answer, vtkPolyData* output) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  double Clearance = 0.0;
  double Swept = 0.0;
  vtkIdType NumberOfCollidingPoints = 0;

private:
  vtkBSHCollisionFilter(const vtkBSHCollisionFilter&) = delete;
  void operator=(const vtkBSHCollisionFilter&) = delete;
};

// SPDX-License-Identifier: BSD-3-Clause
/// @class vtkBSHSphereSource
/// @brief the bounding spheres of a cloud's hierarchy, of one level
///
/// The input is the cloud: all points of a vtkPolyData. The output has a point at each sphere's centre and the point
/// arrays `radius` (cloud's unit), `level`, `voxel` and `points` (how many it holds); with GenerateGlyphs, triangles
/// around each sphere, which have these arrays. The hierarchy is kept while only the settings change.
#pragma once

#include <pcl_bsh/export.h>

#include <vtkPolyDataAlgorithm.h>

#include <memory>

class PCL_BSH_EXPORT vtkBSHSphereSource : public vtkPolyDataAlgorithm {
public:
  static vtkBSHSphereSource* New();
  vtkTypeMacro(vtkBSHSphereSource, vtkPolyDataAlgorithm)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// 0 (default): the voxels' spheres; each level more is one node further down; where a tree ends before, its leaves
  /// stay.
  vtkSetClampMacro(Level, int, 0, VTK_INT_MAX);
  vtkGetMacro(Level, int);
  ///@}

  /// The deepest level of the last execution's cloud: all its spheres are those of leaves. 0 where nothing was
  /// executed.
  vtkGetMacro(DeepestLevel, int);

  ///@{
  /// Triangles instead of points. Default: off.
  vtkSetMacro(GenerateGlyphs, bool);
  vtkGetMacro(GenerateGlyphs, bool);
  vtkBooleanMacro(GenerateGlyphs, bool);
  ///@}

  ///@{
  /// Corners around the equator of a sphere's triangles, at least 3. Default 12.
  vtkSetClampMacro(Resolution, int, 3, 256);
  vtkGetMacro(Resolution, int);
  ///@}

  /// How many hierarchies this source has built.
  vtkIdType GetHierarchiesBuilt();

  /// After a failed execution, returns a time of now: the next Update() executes again, so that nobody gets an old
  /// answer.
  vtkMTimeType GetMTime() override;

protected:
  vtkBSHSphereSource();
  ~vtkBSHSphereSource() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  int Level = 0;
  bool GenerateGlyphs = false;
  int Resolution = 12;
  int DeepestLevel = 0;

private:
  vtkBSHSphereSource(const vtkBSHSphereSource&) = delete;
  void operator=(const vtkBSHSphereSource&) = delete;

  struct Kept;
  std::unique_ptr<Kept> Cloud;
  bool Failed = false; ///< the last execution
};

// SPDX-License-Identifier: BSD-3-Clause
/// @class vtkBSHFilter
/// @brief what the filters share that compare a cloud with an obstacle
///
/// Port 0 is the cloud: all points of a vtkPolyData; its cells are not looked at. Port 1 is the obstacle: the points of
/// a vtkPolyData, or, where that has lines, polygons or strips, all of its cells, as a surface. Port
/// 2, optional, is a vtkTable of poses of the obstacle, a row each: 12 or 16 numbers of its matrix, row by row, or time
/// tx ty tz qx qy qz qw. A cloud may come in blocks: each is answered as a cloud of its own, and only the last one's
/// hierarchy is kept. Obstacle or poses in blocks are refused.
///
/// The output is the cloud with all its arrays and those that the filter adds. A failure is told by vtkErrorMacro in
/// one line, a port without a connection too. After a failure or an abort the output is empty and the execution failed,
/// so that nothing looks like an answer. All warnings are told by vtkWarningMacro: clouds without a finite point,
/// coarse float32 coordinates, holes that may hide a collision, frames that differ, points of a surface that no cell
/// has. Progress is told, and an abort heeded, along poses and of distances; the flags at a single pose are one step.
/// VTK 9.3 keeps AbortExecute set after an abort, 9.1 does not: call SetAbortExecute(0) before the next Update().
/// Points that are not finite are no points: they have the values of free points.
///
/// The hierarchies of cloud and obstacle are kept: nothing is built again when only settings, the transform or the
/// poses change, nor when the input has other arrays at the same points. All calls by one thread at a time, as VTK has
/// it. Processes that share the data are refused: none of them would see all of the obstacle.
#pragma once

#include <pcl_bsh/export.h>

#include <vtkPolyDataAlgorithm.h>

#include <map>
#include <memory>
#include <string>

namespace pcl_bsh {
struct Answer;
struct Question;
} // namespace pcl_bsh
class vtkLinearTransform;
class vtkTable;

class PCL_BSH_EXPORT vtkBSHFilter : public vtkPolyDataAlgorithm {
public:
  vtkAbstractTypeMacro(vtkBSHFilter, vtkPolyDataAlgorithm)
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// The obstacle: port 1.
  void SetObstacleData(vtkPolyData* obstacle);
  void SetObstacleConnection(vtkAlgorithmOutput* obstacle);
  ///@}

  ///@{
  /// The obstacle's poses: port 2. Null: none, the obstacle stands at the transform alone.
  void SetPosesData(vtkTable* poses);
  void SetPosesConnection(vtkAlgorithmOutput* poses);
  ///@}

  ///@{
  /// From the obstacle's frame to that of the cloud; of a path, from the frame of its poses. Rigid within 1e-6; a
  /// matrix that few printed digits have left within 1e-4 stands for its nearest rotation, with a warning. Default:
  /// null, the identity.
  virtual void SetTransform(vtkLinearTransform* transform);
  vtkGetObjectMacro(Transform, vtkLinearTransform);
  ///@}

  ///@{
  /// 0: all of the machine's; the result is the same for any number. Default 1.
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /// Any other option of a question, by its name in the table that all faces share (pipelines' STAGES.md lists it), and
  /// its value as text: SetOption("solid", "true"). Empty text: its default. A wrong one is told by vtkErrorMacro on
  /// execution.
  void SetOption(const char* name, const char* value);
  void ClearOptions();
  ///@}

  ///@{
  /// The option `solid` as a switch, for panels: an obstacle with faces counts with what they enclose.
  void SetSolid(bool solid);
  bool GetSolid() const;
  vtkBooleanMacro(Solid, bool);
  ///@}

  /// How many hierarchies this filter has built, of both inputs.
  vtkIdType GetHierarchiesBuilt();

  /// Returns the later of the filter's time and the transform's. After a failed execution, the filter's time is now:
  /// the next Update() executes again, so that nobody gets an old answer.
  vtkMTimeType GetMTime() override;

protected:
  vtkBSHFilter();
  ~vtkBSHFilter() override;

  /// Sets the question; this class sets both inputs and the poses.
  virtual void Ask(pcl_bsh::Question& question) const = 0;

  /// Fills the output, which has the cloud's points and arrays. Whatever it throws is told in one line.
  /// @param answer its distances.a.closest_point names points of the obstacle or, of a surface, cells
  virtual void Fill(const pcl_bsh::Question& question, const pcl_bsh::Answer& answer, vtkPolyData* output) = 0;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestUpdateExtent(vtkInformation* request, vtkInformationVector** inputs,
                          vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

  vtkLinearTransform* Transform = nullptr;
  int NumberOfThreads = 1;
  std::map<std::string, std::string> Options; ///< by name

private:
  vtkBSHFilter(const vtkBSHFilter&) = delete;
  void operator=(const vtkBSHFilter&) = delete;

  struct Kept;
  std::unique_ptr<Kept> Inputs;
  bool Failed = false; ///< the last execution
};

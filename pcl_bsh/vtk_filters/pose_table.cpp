// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk_filters/pose_table.h>

#include <pcl_bsh/io/poses/pose_file.h>
#include <pcl_bsh/io/poses/rigid_pose.h>
#include <pcl_bsh/io/text/number_text.h>

#include <vtkDataArray.h>

#include <stdexcept>

namespace pcl_bsh::vtk {

std::vector<Eigen::Isometry3d> posesOf(vtkTable& table, std::vector<std::string>& warnings)
{
  std::vector<vtkDataArray*> columns;
  for (vtkIdType c = 0; c < table.GetNumberOfColumns(); ++c) {
    auto* const column = vtkDataArray::SafeDownCast(table.GetColumn(c));
    if (!column || column->GetNumberOfComponents() != 1)
      throw std::invalid_argument("poses: column " + std::to_string(c) + " holds no numbers: give a table of numbers");
    columns.push_back(column);
  }
  std::string text; // the reader of files has all the checks
  for (vtkIdType row = 0; row < table.GetNumberOfRows(); ++row) {
    for (vtkDataArray* const column : columns) text += io::numberText(column->GetTuple1(row)) + ' ';
    text += '\n';
  }
  try {
    return io::parsePoses(text, &warnings);
  }
  catch (const std::runtime_error& error) {
    throw std::invalid_argument("poses: " + std::string(error.what()) +
                                ": give 12 or 16 columns of a matrix, row by row, or time tx ty tz qx qy qz qw");
  }
}

Eigen::Isometry3d poseOf(vtkMatrix4x4* matrix, std::vector<std::string>& warnings)
{
  Eigen::Isometry3d given = Eigen::Isometry3d::Identity();
  if (!matrix) return given;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) given.matrix()(row, column) = matrix->GetElement(row, column);
  const io::RigidPose rigid = io::nearestRigid(given);
  if (rigid.deviation > 0.0) warnings.push_back("transform: " + io::nearestRotationWarning(rigid.deviation));
  return rigid.pose;
}

} // namespace pcl_bsh::vtk

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk_filters/vtkBSHDistanceFilter.h>

#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/vtk_filters/point_array.h>

#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkObjectFactory.h>

vtkStandardNewMacro(vtkBSHDistanceFilter);

void vtkBSHDistanceFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MaximumDistance: " << this->MaximumDistance << '\n';
}

void vtkBSHDistanceFilter::Ask(pcl_bsh::Question& question) const
{
  if (!(this->MaximumDistance >= VTK_DOUBLE_MAX)) question.max_distance = this->MaximumDistance;
  question.wanted.distances = true;
}

void vtkBSHDistanceFilter::Fill(const pcl_bsh::Question& question, const pcl_bsh::Answer& answer, vtkPolyData* output)
{
  using pcl_bsh::vtk::addPointArray;
  if (question.path) {
    addPointArray<vtkDoubleArray>(*output, "distance", answer.collisions.distance);
    addPointArray<vtkIntArray>(*output, "closest_pose", answer.collisions.closest_pose);
  }
  else {
    const pcl_bsh::PointDistances& found = answer.distances.a;
    addPointArray<vtkDoubleArray>(*output, "distance", found.distance);
    addPointArray<vtkIdTypeArray>(*output, "closest_point", [&](std::size_t i) -> vtkIdType {
      const std::uint32_t record = found.closest_point[i];
      return record == pcl_bsh::kNothing ? -1 : static_cast<vtkIdType>(record);
    });
  }
  output->GetPointData()->SetActiveScalars("distance");
}

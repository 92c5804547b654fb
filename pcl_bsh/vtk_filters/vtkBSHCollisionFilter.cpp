// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk_filters/vtkBSHCollisionFilter.h>

#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/vtk_filters/point_array.h>

#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkUnsignedCharArray.h>

#include <utility>

vtkStandardNewMacro(vtkBSHCollisionFilter);

void vtkBSHCollisionFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Clearance: " << this->Clearance << '\n'
     << indent << "Swept: " << this->Swept << '\n'
     << indent << "NumberOfCollidingPoints: " << this->NumberOfCollidingPoints << '\n';
}

int vtkBSHCollisionFilter::RequestData(vtkInformation* request, vtkInformationVector** inputs,
                                       vtkInformationVector* outputs)
{
  this->NumberOfCollidingPoints = 0;
  return this->Superclass::RequestData(request, inputs, outputs);
}

void vtkBSHCollisionFilter::Ask(pcl_bsh::Question& question) const
{
  question.clearance = this->Clearance;
  question.swept = this->Swept;
  question.wanted.flags = true;
  question.wanted.contacts = question.path.has_value();
}

void vtkBSHCollisionFilter::Fill(const pcl_bsh::Question& question, const pcl_bsh::Answer& answer, vtkPolyData* output)
{
  using pcl_bsh::vtk::addPointArray;
  const pcl_bsh::TrajectoryResult& found = answer.collisions;
  if (question.path) {
    addPointArray<vtkFloatArray>(*output, "distance", found.distance);
    addPointArray<vtkIntArray>(*output, "first_pose", found.first_pose);
    addPointArray<vtkIntArray>(*output, "closest_pose", found.closest_pose);
  }
  addPointArray<vtkUnsignedCharArray>(*output, "collision", [&](std::size_t i) { return bytesOf(found.flags)[i]; });
  output->GetPointData()->SetActiveScalars("collision");
  this->NumberOfCollidingPoints = static_cast<vtkIdType>(found.colliding);
  if (!question.seen) return;
  vtkNew<vtkUnsignedCharArray> verdicts;
  verdicts->SetName("obstacle_collision");
  for (const pcl_bsh::Verdict verdict : answer.obstacle_flags)
    verdicts->InsertNextValue(static_cast<unsigned char>(verdict));
  output->GetFieldData()->AddArray(verdicts);
  for (const auto& [name, counts] : {std::pair{"unseen_at_poses", &answer.unseen.at_poses},
                                     {"in_shadow_at_poses", &answer.unseen.shadow_at_poses}}) {
    vtkNew<vtkIntArray> at_poses;
    at_poses->SetName(name);
    for (const std::size_t count : *counts) at_poses->InsertNextValue(static_cast<int>(count));
    output->GetFieldData()->AddArray(at_poses);
  }
}

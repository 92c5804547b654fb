// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk_filters/vtkBSHCollisionFilter.h>

#include <pcl_bsh/flags/collision_flags.h>
#include <pcl_bsh/trajectory/trajectory.h>
#include <pcl_bsh/vtk_filters/bsh_question.h>

#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkObjectFactory.h>
#include <vtkUnsignedCharArray.h>

#include <stdexcept>

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

void vtkBSHCollisionFilter::Answer(const Question& question, vtkPolyData* output)
{
  using pcl_bsh::vtk::addPointArray;
  const auto threads = static_cast<unsigned>(this->NumberOfThreads);
  const pcl_bsh::Placed cloud(question.cloud);
  std::vector<std::uint8_t> flags;
  std::size_t colliding = 0;
  if (question.poses) {
    pcl_bsh::TrajectoryRequest request;
    request.clearance = this->Clearance;
    request.distances = request.first_poses = request.closest_poses = true;
    if (this->Swept != 0.0) request.swept = this->Swept;
    request.threads = threads;
    request.progress = question.progress;
    const pcl_bsh::TrajectoryResult run = pcl_bsh::collideAlong(cloud, question.obstacle, *question.poses, request);
    // A surface's balls hold the surface: within one, 0 is as true as a negative distance.
    addPointArray<vtkFloatArray>(*output, "distance", [&](std::size_t i) {
      return question.is_surface && run.distance[i] < 0.0f ? 0.0f : run.distance[i];
    });
    addPointArray<vtkIntArray>(*output, "first_pose", [&](std::size_t i) { return run.first_pose[i]; });
    addPointArray<vtkIntArray>(*output, "closest_pose", [&](std::size_t i) { return run.closest_pose[i]; });
    flags = run.flags;
    colliding = run.colliding;
  }
  else {
    if (this->Swept != 0.0) throw std::invalid_argument("Swept is set, and there are no poses: connect them to port 2");
    pcl_bsh::FlagsRequest request;
    request.clearance = this->Clearance;
    request.threads = threads;
    pcl_bsh::FlagsResult found = pcl_bsh::collisionFlags(cloud, {question.obstacle, question.pose}, request);
    flags = std::move(found.a);
    colliding = found.colliding_a;
  }
  this->Warn(question, &this->Clearance);
  addPointArray<vtkUnsignedCharArray>(*output, "collision", [&](std::size_t i) { return flags[i]; });
  output->GetPointData()->SetActiveScalars("collision");
  this->NumberOfCollidingPoints = static_cast<vtkIdType>(colliding);
}

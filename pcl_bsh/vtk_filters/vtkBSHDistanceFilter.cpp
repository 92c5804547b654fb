// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk_filters/vtkBSHDistanceFilter.h>

#include <pcl_bsh/distances/point_distances.h>
#include <pcl_bsh/trajectory/trajectory.h>
#include <pcl_bsh/vtk_filters/bsh_question.h>

#include <vtkDoubleArray.h>
#include <vtkIdTypeArray.h>
#include <vtkIntArray.h>
#include <vtkObjectFactory.h>

#include <limits>
#include <stdexcept>

vtkStandardNewMacro(vtkBSHDistanceFilter);

void vtkBSHDistanceFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MaximumDistance: " << this->MaximumDistance << '\n';
}

void vtkBSHDistanceFilter::Answer(const Question& question, vtkPolyData* output)
{
  using pcl_bsh::vtk::addPointArray;
  // Within a ball of a surface's cover, 0 is as true as a negative distance.
  const auto told = [&](double distance) { return question.is_surface && distance < 0.0 ? 0.0 : distance; };
  const pcl_bsh::Placed cloud(question.cloud);
  const bool unlimited = this->MaximumDistance >= VTK_DOUBLE_MAX;
  if (question.poses) {
    if (unlimited) throw std::invalid_argument("MaximumDistance is without limit: along poses, give a finite one");
    pcl_bsh::TrajectoryRequest request;
    request.clearance = this->MaximumDistance;
    request.flags = false;
    request.distances = request.closest_poses = true;
    request.threads = static_cast<unsigned>(this->NumberOfThreads);
    request.progress = question.progress;
    const pcl_bsh::TrajectoryResult run = pcl_bsh::collideAlong(cloud, question.obstacle, *question.poses, request);
    addPointArray<vtkDoubleArray>(*output, "distance",
                                  [&](std::size_t i) { return told(static_cast<double>(run.distance[i])); });
    addPointArray<vtkIntArray>(*output, "closest_pose", [&](std::size_t i) { return run.closest_pose[i]; });
  }
  else {
    pcl_bsh::PointDistancesRequest request;
    request.max_distance = unlimited ? std::numeric_limits<double>::infinity() : this->MaximumDistance;
    request.threads = static_cast<unsigned>(this->NumberOfThreads);
    request.progress = question.progress;
    const pcl_bsh::PointDistances found = pcl_bsh::pointDistances(cloud, {question.obstacle, question.pose}, request);
    addPointArray<vtkDoubleArray>(*output, "distance", [&](std::size_t i) { return told(found.distance[i]); });
    addPointArray<vtkIdTypeArray>(*output, "nearest", [&](std::size_t i) -> vtkIdType {
      const std::uint32_t record = found.nearest[i];
      if (record == pcl_bsh::PointDistances::kNoPoint) return -1;
      return question.is_surface ? question.kept_obstacle.cell(record) : static_cast<vtkIdType>(record);
    });
  }
  this->Warn(question, nullptr);
  output->GetPointData()->SetActiveScalars("distance");
}

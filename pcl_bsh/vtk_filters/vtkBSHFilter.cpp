// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk_filters/vtkBSHFilter.h>

#include <pcl_bsh/base/cancelled.h>
#include <pcl_bsh/question/ask.h>
#include <pcl_bsh/question/options.h>
#include <pcl_bsh/vtk_filters/kept_shape.h>
#include <pcl_bsh/vtk_filters/pose_table.h>

#include <vtkCompositeDataSet.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkLinearTransform.h>
#include <vtkMultiProcessController.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkTable.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace {

/// The data of a port, null where nothing is connected. @throws std::invalid_argument where it is of another type
template <class Data>
Data* dataOf(vtkInformationVector& input, const std::string& what, const std::string& wanted)
{
  vtkDataObject* const given = vtkDataObject::GetData(&input);
  auto* const data = Data::SafeDownCast(given);
  if (given && !data) {
    const std::string advice = vtkCompositeDataSet::SafeDownCast(given)
                                   ? "merge its blocks (vtkAppendPolyData; in ParaView, Merge Blocks)"
                                   : "give " + wanted;
    throw std::invalid_argument(what + " is a " + given->GetClassName() + ": " + advice);
  }
  return data;
}

} // namespace

struct vtkBSHFilter::Kept {
  pcl_bsh::vtk::KeptShape cloud{"the cloud"}, obstacle{"the obstacle"};
};

vtkCxxSetObjectMacro(vtkBSHFilter, Transform, vtkLinearTransform);

vtkBSHFilter::vtkBSHFilter() : Inputs(std::make_unique<Kept>())
{
  this->SetNumberOfInputPorts(3);
}

vtkBSHFilter::~vtkBSHFilter()
{
  this->SetTransform(nullptr);
}

void vtkBSHFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Transform: " << static_cast<void*>(this->Transform) << '\n'
     << indent << "NumberOfThreads: " << this->NumberOfThreads << '\n'
     << indent << "Options:";
  for (const auto& [name, value] : this->Options) os << ' ' << name << '=' << value;
  os << '\n' << indent << "HierarchiesBuilt: " << this->GetHierarchiesBuilt() << '\n';
}

void vtkBSHFilter::SetOption(const char* name, const char* value)
{
  if (!name || !*name) return;
  if (value && *value)
    this->Options[name] = value;
  else
    this->Options.erase(name);
  this->Modified();
}

void vtkBSHFilter::SetSolid(bool solid)
{
  if (solid != this->GetSolid()) this->SetOption("solid", solid ? "true" : "");
}

bool vtkBSHFilter::GetSolid() const
{
  const auto found = this->Options.find("solid");
  return found != this->Options.end() && found->second == "true";
}

void vtkBSHFilter::ClearOptions()
{
  this->Options.clear();
  this->Modified();
}

void vtkBSHFilter::SetObstacleData(vtkPolyData* obstacle)
{
  this->SetInputData(1, obstacle);
}

void vtkBSHFilter::SetObstacleConnection(vtkAlgorithmOutput* obstacle)
{
  this->SetInputConnection(1, obstacle);
}

void vtkBSHFilter::SetPosesData(vtkTable* poses)
{
  this->SetInputData(2, poses);
}

void vtkBSHFilter::SetPosesConnection(vtkAlgorithmOutput* poses)
{
  this->SetInputConnection(2, poses);
}

vtkIdType vtkBSHFilter::GetHierarchiesBuilt()
{
  return static_cast<vtkIdType>(this->Inputs->cloud.made() + this->Inputs->obstacle.made());
}

vtkMTimeType vtkBSHFilter::GetMTime()
{
  // VTK would take the empty output for an up-to-date one. So the time is now, and the next Update() executes again.
  // MTime is set without an event, whose observers may ask for the time.
  if (this->Failed) this->MTime.Modified();
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->Transform ? std::max(own, this->Transform->GetMTime()) : own;
}

int vtkBSHFilter::FillInputPortInformation(int port, vtkInformation* info)
{
  // VTK would execute once for each block of an obstacle, and no answer would be about all of it. So RequestData()
  // refuses an obstacle in blocks. A cloud may come in blocks.
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port == 0 ? "vtkPolyData" : "vtkDataObject");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1); // else VTK would leave the last answer where an input is gone
  return 1;
}

// Asks for one piece of the cloud, and for all of the obstacle and its poses: else a near part would be missed.
int vtkBSHFilter::RequestUpdateExtent(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*)
{
  for (int port = 1; port < 3; ++port) {
    vtkInformation* const info = inputs[port]->GetInformationObject(0);
    if (!info) continue;
    info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER(), 0);
    info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_PIECES(), 1);
    info->Set(vtkStreamingDemandDrivenPipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  }
  return 1;
}

int vtkBSHFilter::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPolyData* const output = vtkPolyData::GetData(outputs);
  output->Initialize();
  this->Failed = true;
  try {
    auto* const controller = vtkMultiProcessController::GetGlobalController();
    if (controller && controller->GetNumberOfProcesses() > 1)
      throw std::invalid_argument(std::to_string(controller->GetNumberOfProcesses()) +
                                  " processes share the data, and none sees all of the obstacle: use one process");
    vtkPolyData* const cloud = vtkPolyData::GetData(inputs[0]);
    auto* const obstacle = dataOf<vtkPolyData>(*inputs[1], "the obstacle", "a vtkPolyData");
    if (!cloud || !obstacle) throw std::invalid_argument("an input is missing: connect a cloud and an obstacle");
    auto* const table = dataOf<vtkTable>(*inputs[2], "the list of poses", "a vtkTable");

    const auto report = [this](double fraction) {
      this->UpdateProgress(fraction);
      return this->GetAbortExecute() == 0;
    };
    std::vector<std::string> warnings;
    pcl_bsh::Question question;
    question.pose = pcl_bsh::vtk::poseOf(this->Transform ? this->Transform->GetMatrix() : nullptr, warnings);
    if (table) {
      question.path = pcl_bsh::vtk::posesOf(*table, warnings);
      for (Eigen::Isometry3d& placed : *question.path) placed.matrix() = question.pose.matrix() * placed.matrix();
    }
    for (const std::string& warning : warnings) vtkWarningMacro(<< warning);
    question.threads = static_cast<unsigned>(this->NumberOfThreads);
    for (const auto& [name, value] : this->Options) pcl_bsh::setOption(question, name, value);
    this->Ask(question);
    question.wanted.spacings = question.wanted.collisions();

    const bool is_surface = pcl_bsh::vtk::isSurface(*obstacle) && !question.vertices_only;
    question.progress = report;
    pcl_bsh::vtk::KeptShape& kept = this->Inputs->obstacle;
    pcl_bsh::Shape& other = is_surface ? kept.ofSurface(*obstacle) : kept.ofPoints(*obstacle);
    pcl_bsh::Shape& points = this->Inputs->cloud.ofPoints(*cloud);
    if (!report(0.0)) throw pcl_bsh::Cancelled();
    output->ShallowCopy(cloud);
    pcl_bsh::Answer answer = pcl_bsh::ask(question, points, other);
    if (is_surface) {
      for (std::uint32_t& nearest : answer.distances.a.closest_point)
        if (nearest != pcl_bsh::kNothing) nearest = kept.cells()[nearest];
    }
    if (is_surface && question.seen) {
      std::vector<pcl_bsh::Verdict> of_cells(static_cast<std::size_t>(obstacle->GetNumberOfCells()));
      for (std::size_t i = 0; i < answer.obstacle_flags.size(); ++i) {
        pcl_bsh::Verdict& of_cell = of_cells[kept.cells()[i]];
        of_cell = pcl_bsh::graver(of_cell, answer.obstacle_flags[i]);
      }
      answer.obstacle_flags = std::move(of_cells);
    }
    for (const pcl_bsh::Warning& warning : answer.warnings) vtkWarningMacro(<< warning.text);
    this->Fill(question, answer, output);
    this->Failed = false;
    return 1;
  }
  catch (const pcl_bsh::Cancelled&) {
    vtkDebugMacro(<< "aborted");
  }
  catch (const std::exception& error) {
    vtkErrorMacro(<< error.what());
  }
  output->Initialize();
  return 0; // filters that depend on this output do not execute either
}

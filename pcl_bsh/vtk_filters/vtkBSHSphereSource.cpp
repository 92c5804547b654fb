// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk_filters/vtkBSHSphereSource.h>

#include <pcl_bsh/vtk/hierarchy_data.h>
#include <pcl_bsh/vtk_filters/kept_shape.h>

#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>

#include <stdexcept>

struct vtkBSHSphereSource::Kept {
  pcl_bsh::vtk::KeptShape shape{"the cloud"};
};

vtkStandardNewMacro(vtkBSHSphereSource);

vtkBSHSphereSource::vtkBSHSphereSource() : Cloud(std::make_unique<Kept>())
{
}
vtkBSHSphereSource::~vtkBSHSphereSource() = default;

void vtkBSHSphereSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Level: " << this->Level << '\n'
     << indent << "GenerateGlyphs: " << this->GenerateGlyphs << '\n'
     << indent << "Resolution: " << this->Resolution << '\n'
     << indent << "DeepestLevel: " << this->DeepestLevel << '\n'
     << indent << "HierarchiesBuilt: " << this->GetHierarchiesBuilt() << '\n';
}

vtkIdType vtkBSHSphereSource::GetHierarchiesBuilt()
{
  return static_cast<vtkIdType>(this->Cloud->shape.made());
}

vtkMTimeType vtkBSHSphereSource::GetMTime()
{
  if (this->Failed) this->MTime.Modified(); // as vtkBSHFilter has it
  return this->Superclass::GetMTime();
}

int vtkBSHSphereSource::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  return 1;
}

int vtkBSHSphereSource::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPolyData* const output = vtkPolyData::GetData(outputs);
  this->DeepestLevel = 0;
  this->Failed = true;
  try {
    vtkPolyData* const cloud = vtkPolyData::GetData(inputs[0]);
    if (!cloud) throw std::invalid_argument("the input is missing: connect a cloud");
    const pcl_bsh::SphereHierarchy& hierarchy = this->Cloud->shape.ofPoints(*cloud).hierarchy({}, 1);
    vtkSmartPointer<vtkPolyData> spheres = pcl_bsh::vtk::sphereData(hierarchy, static_cast<unsigned>(this->Level));
    if (this->GenerateGlyphs) spheres = pcl_bsh::vtk::sphereGlyphs(*spheres, this->Resolution);
    output->ShallowCopy(spheres);
    this->DeepestLevel = static_cast<int>(pcl_bsh::vtk::deepestLevel(hierarchy));
    this->Failed = false;
    return 1;
  }
  catch (const std::exception& error) {
    vtkErrorMacro(<< error.what());
  }
  output->Initialize();
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk/contact_data.h>

#include <vtkArrowSource.h>
#include <vtkDoubleArray.h>
#include <vtkGlyph3D.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>

namespace pcl_bsh::vtk {

vtkSmartPointer<vtkPolyData> contactData(const std::vector<Contact>& contacts)
{
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> normal, gap, opposite;
  vtkNew<vtkIntArray> id, patch;
  normal->SetName("normal");
  normal->SetNumberOfComponents(3);
  gap->SetName("gap");
  opposite->SetName("place_a");
  opposite->SetNumberOfComponents(3);
  id->SetName("id");
  patch->SetName("patch");
  for (const Contact& contact : contacts) {
    places->InsertNextPoint(contact.place_b.data());
    normal->InsertNextTuple(contact.normal.data());
    gap->InsertNextValue(contact.distance);
    opposite->InsertNextTuple(contact.place_a.data());
    id->InsertNextValue(static_cast<int>(contact.id));
    patch->InsertNextValue(static_cast<int>(contact.patch));
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(places);
  for (vtkDataArray* const array : {static_cast<vtkDataArray*>(gap), static_cast<vtkDataArray*>(opposite),
                                    static_cast<vtkDataArray*>(id), static_cast<vtkDataArray*>(patch)})
    data->GetPointData()->AddArray(array);
  data->GetPointData()->SetVectors(normal);
  return data;
}

vtkSmartPointer<vtkPolyData> contactArrows(vtkPolyData& contacts, double length)
{
  vtkNew<vtkArrowSource> arrow;
  arrow->SetTipResolution(16);
  arrow->SetShaftResolution(12);
  vtkNew<vtkGlyph3D> glyphs;
  glyphs->SetInputData(&contacts);
  glyphs->SetSourceConnection(arrow->GetOutputPort());
  glyphs->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "normal");
  glyphs->SetVectorModeToUseVector();
  glyphs->SetScaleModeToScaleByVector(); // normals have a length of 1, or 0 where there is no direction
  glyphs->SetScaleFactor(length);
  glyphs->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  glyphs->Update();
  return glyphs->GetOutput();
}

} // namespace pcl_bsh::vtk

// SPDX-License-Identifier: BSD-3-Clause
#include "actors.h"
#include "cloud_actor.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

namespace pcl_bsh::viewer {
namespace {

/// The flagged triangles, each with corners of its own, so that bounds are those of the flagged ones alone.
vtkSmartPointer<vtkPolyData> someOf(vtkPolyData& data, const std::vector<std::uint8_t>& flags)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkIdList> corners;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] == 0) continue;
    data.GetCellPoints(static_cast<vtkIdType>(i), corners);
    cells->InsertNextCell(3);
    for (vtkIdType k = 0; k < 3; ++k) cells->InsertCellPoint(points->InsertNextPoint(data.GetPoint(corners->GetId(k))));
  }
  auto some = vtkSmartPointer<vtkPolyData>::New();
  some->SetPoints(points);
  some->SetPolys(cells);
  return some;
}

class TrianglesActor final : public CloudActor {
public:
  TrianglesActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color, const Color& marked)
  : CloudActor(renderer),
    faces_(surfaceActor(viewed, color)),
    marked_color_(marked),
    colors_(viewed.parts(), color)
  {
    all_ = data_ = vtkPolyDataMapper::SafeDownCast(faces_->GetMapper())->GetInput();
    marked_ = vtkSmartPointer<vtkPolyData>::New();
    outlines_ = actorOf(marked_);
    outlines_->GetProperty()->SetRepresentationToWireframe();
    outlines_->GetProperty()->SetLineWidth(2.5f);
    outlines_->PickableOff();
    for (vtkActor* actor : {faces_.Get(), outlines_.Get()}) draw(*actor);
    show();
  }

  void paint(const std::vector<Color>& colors) override
  {
    colors_ = colors;
    show();
  }

  void paint(const Color& color, const ColorRange* /*heights*/) override
  {
    paint(std::vector<Color>(colors_.size(), color));
  }

  void mark(const std::vector<std::uint8_t>& flags, const std::vector<Color>& colors) override
  {
    flags_ = flags;
    marked_colors_ = colors;
    show();
  }

  void setVisible(bool visible) override
  {
    for (vtkActor* actor : {faces_.Get(), outlines_.Get()}) actor->SetVisibility(visible);
  }

  void offerTo(vtkPicker& /*points*/, vtkPicker& triangles) const override { triangles.AddPickList(faces_); }

  std::optional<std::uint32_t> partOf(const vtkProp* prop, vtkIdType id) const override
  {
    if (prop != faces_.Get() || id < 0 || id >= data_->GetNumberOfCells()) return std::nullopt;
    return static_cast<std::uint32_t>(id);
  }

private:
  void show()
  {
    std::vector<Color> shown = colors_, outlined;
    for (std::size_t i = 0; i < flags_.size(); ++i) {
      if (flags_[i] == 0) continue;
      shown[i] = marked_colors_.empty() ? marked_color_ : marked_colors_[i];
      outlined.push_back(shown[i]);
    }
    marked_ = someOf(*data_, flags_);
    setCellColors(*data_, shown);
    setCellColors(*marked_, outlined);
    setData(*outlines_, *marked_);
  }

  static void setCellColors(vtkPolyData& data, const std::vector<Color>& colors)
  {
    setColors(*data.GetCellData(), static_cast<vtkIdType>(colors.size()),
              [&](vtkIdType i) { return colors[static_cast<std::size_t>(i)]; });
  }

  vtkSmartPointer<vtkActor> faces_, outlines_;
  Color marked_color_;
  std::vector<Color> colors_, marked_colors_;
  std::vector<std::uint8_t> flags_;
};

} // namespace

std::unique_ptr<CloudActor> makeTrianglesActor(const ViewedCloud& viewed, vtkRenderer& renderer, const Color& color,
                                               const Color& marked)
{
  return std::make_unique<TrianglesActor>(viewed, renderer, color, marked);
}

} // namespace pcl_bsh::viewer

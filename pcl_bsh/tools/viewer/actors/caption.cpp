// SPDX-License-Identifier: BSD-3-Clause
#include "caption.h"

#include <vtkNew.h>
#include <vtkPlaneSource.h>
#include <vtkTextProperty.h>

#include <algorithm>

namespace pcl_bsh::viewer {
namespace {

vtkSmartPointer<vtkTextActor> textAt(double x, double y)
{
  auto text = vtkSmartPointer<vtkTextActor>::New();
  text->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  text->SetPosition(x, y);
  setLook(*text->GetTextProperty(), text_size);
  setBacking(*text->GetTextProperty());
  return text;
}

} // namespace

void setLook(vtkTextProperty& look, int size)
{
  look.SetFontSize(size);
  look.SetFontFamilyToArial();
  look.BoldOff(); // a bar's words are bold by default
  look.ItalicOff();
  look.ShadowOff();
  look.SetLineSpacing(1.25);
  const std::array<double, 3> c = fractions(text_color);
  look.SetColor(c[0], c[1], c[2]);
}

void setBacking(vtkTextProperty& look)
{
  const std::array<double, 3> c = fractions(ground);
  look.SetBackgroundColor(c[0], c[1], c[2]);
  constexpr double mostly = 0.9;
  look.SetBackgroundOpacity(mostly);
}

Caption::Caption(vtkRenderer& renderer, int width, int height)
: title_(textAt(0.012, 0.985)),
  note_(textAt(0.5, 0.02)),
  legend_(vtkSmartPointer<vtkLegendBoxActor>::New()),
  width_(width),
  height_(height)
{
  title_->GetTextProperty()->SetVerticalJustificationToTop();
  note_->GetTextProperty()->SetVerticalJustificationToBottom();
  note_->GetTextProperty()->SetJustificationToCentered();
  legend_->BorderOff();
  setBacking(*legend_->GetEntryTextProperty()); // VTK draws the box's own background over its entries
  legend_->SetPadding(4);
  legend_->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
  legend_->GetPosition2Coordinate()->SetCoordinateSystemToNormalizedViewport();
  renderer.AddActor2D(title_);
  renderer.AddActor2D(note_);
  renderer.AddActor2D(legend_);
}

void Caption::setLegend(const std::vector<LegendEntry>& entries)
{
  vtkNew<vtkPlaneSource> square;
  square->Update();
  std::size_t longest = 8;
  legend_->SetNumberOfEntries(static_cast<int>(entries.size()));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    std::array<double, 3> c = fractions(entries[i].color);
    legend_->SetEntry(static_cast<int>(i), square->GetOutput(), entries[i].text.c_str(), c.data());
    longest = std::max(longest, entries[i].text.size());
  }
  legend_->SetPosition(0.01, 0.015);
  legend_->SetPosition2(std::min(0.6, (40.0 + 9.0 * static_cast<double>(longest)) / width_),
                        26.0 * static_cast<double>(entries.size()) / height_);
  legend_->SetVisibility(!entries.empty());
}

} // namespace pcl_bsh::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "value_bar.h"

#include "caption.h"

#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::viewer {

namespace {

/// The bar's share of a picture's width. Letters have one size in pixels, so a small picture gives them a larger share.
double shareOf(int width)
{
  constexpr double usual = 0.115, pixels = 120.0, most = 0.4;
  return std::clamp(pixels / width, usual, most);
}

constexpr int usual_labels = 5;

} // namespace

std::string labelFormat(double low, double high, int labels)
{
  constexpr int least = 3, most = 17;
  const double step = (high - low) / (labels - 1);
  const double digits = std::ceil(std::log10(std::max(std::abs(low), std::abs(high)) / step)) + 1.0;
  return "%-." + std::to_string(digits > least ? static_cast<int>(std::min<double>(digits, most)) : least) + "g";
}

ValueBar::ValueBar(vtkRenderer& renderer, int width)
: share_(shareOf(width)),
  bar_(vtkSmartPointer<vtkScalarBarActor>::New())
{
  bar_->UnconstrainedFontSizeOn();
  bar_->SetPosition(1.0 - share_, 0.3);
  bar_->SetWidth(0.74 * share_);
  bar_->SetHeight(0.45);
  bar_->SetVerticalTitleSeparation(10);
  for (vtkTextProperty* look : {bar_->GetTitleTextProperty(), bar_->GetLabelTextProperty()}) {
    setLook(*look, text_size - 2);
    setBacking(*look);
    look->SetVerticalJustificationToTop();
  }
  hide();
  renderer.AddActor2D(bar_);
}

void ValueBar::show(vtkLookupTable& table, const std::string& title, bool counts)
{
  bar_->SetLookupTable(&table);
  bar_->SetTitle(title.c_str());
  const double* const range = table.GetTableRange();
  bar_->SetLabelFormat(counts ? "%.0f" : labelFormat(range[0], range[1], usual_labels).c_str());
  bar_->SetNumberOfLabels(counts ? static_cast<int>(std::clamp(range[1] - range[0] + 1.0, 2.0, 1.0 * usual_labels))
                                 : usual_labels);
  bar_->VisibilityOn();
}

std::optional<ColorRange> ValueBar::range() const
{
  if (bar_->GetVisibility() == 0) return std::nullopt;
  const double* const ends = bar_->GetLookupTable()->GetRange();
  return ColorRange{ends[0], ends[1]};
}

} // namespace pcl_bsh::viewer

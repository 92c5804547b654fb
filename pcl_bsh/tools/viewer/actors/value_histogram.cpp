// SPDX-License-Identifier: BSD-3-Clause
#include "value_histogram.h"

#include "caption.h"
#include "text.h"

#include <pcl_bsh/distances/statistics.h>

#include <vtkAxis.h>
#include <vtkBrush.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkPen.h>
#include <vtkPlotBar.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include <algorithm>

namespace pcl_bsh::viewer {
namespace {

/// The chart's place: a share of the picture, but so many pixels at least that letters fit. VTK draws the title above.
vtkRectf placeOf(int width, int height)
{
  const double wide = std::min(0.5 * width, std::max(0.3 * width, 260.0));
  const double tall = std::min(0.35 * height, std::max(0.2 * height, 150.0));
  return {static_cast<float>(width - wide - 8.0), 6.0f, static_cast<float>(wide), static_cast<float>(tall)};
}

void setColors(vtkAxis& axis, const std::string& title)
{
  constexpr Color faint = {90, 98, 108};
  setLook(*axis.GetTitleProperties(), text_size - 4);
  setLook(*axis.GetLabelProperties(), text_size - 5);
  axis.SetTitle(title);
  axis.SetGridVisible(false);
  axis.GetPen()->SetColor(faint[0], faint[1], faint[2]);
}

} // namespace

ValueHistogram::ValueHistogram(vtkRenderer& renderer, int width, int height)
{
  chart_->SetAutoSize(false);
  chart_->SetSize(placeOf(width, height));
  chart_->SetShowLegend(false);
  chart_->SetBarWidthFraction(0.9f);
  chart_->GetBackgroundBrush()->SetColor(ground[0], ground[1], ground[2], 200);
  setLook(*chart_->GetTitleProperties(), text_size - 4);
  actor_->GetScene()->AddItem(chart_);
  hide();
  renderer.AddActor2D(actor_);
}

void ValueHistogram::show(const std::vector<double>& distances, vtkLookupTable& colors, const std::string& axis_title,
                          const ViewContent& content)
{
  const std::string &unit = content.options().unit, parts = content.partsName(2);
  constexpr std::size_t most_bars = 40;
  const DistanceStatistics statistics = statisticsOf(distances);
  const DistanceHistogram histogram = histogramOf(distances, colors.GetTableRange()[1], most_bars);
  vtkNew<vtkDoubleArray> middles, counts;
  middles->SetName("distance");
  counts->SetName(parts.c_str());
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    middles->InsertNextValue((static_cast<double>(i) + 0.5) * histogram.width);
    counts->InsertNextValue(static_cast<double>(histogram.counts[i]));
  }
  vtkNew<vtkTable> table;
  table->AddColumn(middles);
  table->AddColumn(counts);

  chart_->ClearPlots();
  auto* const bars = vtkPlotBar::SafeDownCast(chart_->AddPlot(vtkChart::BAR));
  bars->SetInputData(table, 0, 1);
  bars->SetLookupTable(&colors);
  bars->SelectColorArray("distance");
  bars->ScalarVisibilityOn();
  bars->GetPen()->SetLineType(vtkPen::NO_PEN);
  setColors(*chart_->GetAxis(vtkAxis::BOTTOM), axis_title);
  setColors(*chart_->GetAxis(vtkAxis::LEFT), parts);
  vtkAxis& across = *chart_->GetAxis(vtkAxis::BOTTOM);
  across.SetBehavior(vtkAxis::FIXED);
  across.SetRange(0.0, histogram.end());

  std::string title = "mean " + lengthOf(statistics.mean, unit) + ", RMS " + lengthOf(statistics.rms, unit) +
                      "\nmedian " + lengthOf(statistics.median, unit) + ", greatest " +
                      lengthOf(statistics.maximum, unit);
  if (histogram.above > 0)
    title += "\n" + grouped(histogram.above) + ' ' + content.partsName(histogram.above) + " beyond the axis";
  chart_->SetTitle(title);
  actor_->SetVisibility(statistics.count > 0);
}

} // namespace pcl_bsh::viewer

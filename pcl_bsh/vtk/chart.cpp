// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk/chart.h>
#include <pcl_bsh/vtk/offscreen_window.h>

#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotLine.h>
#include <vtkRenderer.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::vtk {
namespace {

/// What is this much smaller than the largest value is drawn as 0.
constexpr double kSmallest = 1e-10;

/// Whole decades that hold all values worth telling from 0, and one below for those that are not.
struct Decades {
  double low = 1.0, high = 10.0;
};

Decades decadesOf(const Chart& chart, const std::vector<double> Curve::*values)
{
  double most = 0.0;
  for (const Curve& curve : chart.curves)
    for (const double value : curve.*values)
      if (std::isfinite(value)) most = std::max(most, value);
  double least = most;
  bool zero = false;
  for (const Curve& curve : chart.curves) {
    for (const double value : curve.*values) {
      if (value > kSmallest * most)
        least = std::min(least, value);
      else
        zero = true;
    }
  }
  if (most == 0.0) return {};
  const double low = std::floor(std::log10(least)) - (zero ? 1.0 : 0.0);
  return {std::pow(10.0, low), std::pow(10.0, std::max(std::ceil(std::log10(most)), low + 1.0))};
}

void setAxis(vtkChartXY& chart, int which, const std::string& label, const Decades& decades)
{
  vtkAxis* const axis = chart.GetAxis(which);
  axis->SetTitle(label);
  axis->GetTitleProperties()->SetFontSize(15);
  axis->GetTitleProperties()->SetBold(0);
  axis->GetLabelProperties()->SetFontSize(13);
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetLogScale(true);
  axis->SetUnscaledRange(decades.low, decades.high);
}

vtkNew<vtkTable> tableOf(const Curve& curve, const Decades& x_decades, const Decades& y_decades)
{
  vtkNew<vtkTable> table;
  vtkNew<vtkDoubleArray> x, y;
  x->SetName("x");
  y->SetName(curve.name.c_str());
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    x->InsertNextValue(std::max(curve.x[i], x_decades.low));
    y->InsertNextValue(std::max(curve.y[i], y_decades.low));
  }
  table->AddColumn(x);
  table->AddColumn(y);
  return table;
}

vtkNew<vtkChartXY> draw(const Chart& content)
{
  const Decades x_decades = decadesOf(content, &Curve::x), y_decades = decadesOf(content, &Curve::y);
  vtkNew<vtkChartXY> chart;
  chart->SetTitle(content.title);
  chart->GetTitleProperties()->SetFontSize(17);
  chart->SetShowLegend(true);
  chart->GetLegend()->SetHorizontalAlignment(vtkChartLegend::RIGHT);
  chart->GetLegend()->SetVerticalAlignment(vtkChartLegend::TOP);
  chart->GetLegend()->SetInline(false); // beside the curves, never on them
  chart->GetLegend()->SetLabelSize(13);
  setAxis(*chart, vtkAxis::BOTTOM, content.x_label, x_decades);
  setAxis(*chart, vtkAxis::LEFT, content.y_label, y_decades);
  int mark = vtkPlotPoints::SQUARE;
  for (const Curve& curve : content.curves) {
    const vtkNew<vtkTable> table = tableOf(curve, x_decades, y_decades);
    auto* const plot = vtkPlotLine::SafeDownCast(chart->AddPlot(vtkChart::LINE));
    plot->SetInputData(table, 0, 1);
    plot->SetColor(curve.color[0], curve.color[1], curve.color[2], 255);
    plot->SetWidth(2.0f);
    plot->GetPen()->SetLineType(!curve.line ? vtkPen::NO_PEN : curve.dashed ? vtkPen::DASH_LINE : vtkPen::SOLID_LINE);
    plot->SetMarkerStyle(curve.dashed && curve.line ? vtkPlotPoints::PLUS : mark);
    plot->SetMarkerSize(9.0f);
    mark = mark == vtkPlotPoints::DIAMOND ? vtkPlotPoints::SQUARE : mark + 1;
  }
  return chart;
}

} // namespace

std::array<unsigned char, 3> distinctColor(std::size_t i)
{
  static constexpr std::array<std::array<unsigned char, 3>, 7> colors = {
      {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}, {0, 0, 0}}};
  return colors[i % colors.size()];
}

void writeChartsPng(const std::vector<Chart>& charts, int width, int height_each, const std::filesystem::path& path)
{
  const vtkSmartPointer<vtkRenderWindow> window =
      makeOffscreenWindow(width, height_each * static_cast<int>(charts.size()));
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const double top = 1.0 - static_cast<double>(i) / static_cast<double>(charts.size());
    const double bottom = top - 1.0 / static_cast<double>(charts.size());
    vtkNew<vtkRenderer> renderer;
    renderer->SetBackground(1.0, 1.0, 1.0);
    renderer->SetViewport(0.0, bottom, 1.0, top);
    vtkNew<vtkContextActor> actor;
    actor->GetScene()->AddItem(draw(charts[i]));
    renderer->AddActor(actor);
    window->AddRenderer(renderer);
  }
  writePng(*window, path);
}

} // namespace pcl_bsh::vtk

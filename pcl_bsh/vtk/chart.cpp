// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/vtk/chart.h>
#include <pcl_bsh/vtk/label_layout.h>
#include <pcl_bsh/vtk/offscreen_window.h>

#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkContextActor.h>
#include <vtkContextItem.h>
#include <vtkContextScene.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>
#include <vtkRenderer.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::vtk {
namespace {

using Color = std::array<unsigned char, 3>;

constexpr Color ink = {40, 44, 52}, grid = {225, 228, 232}, lowest_ground = {232, 244, 236};
constexpr double mark_radius = 9.0;
constexpr int title_size = 32, text_size = 25, label_size = 23;

/// Texts and marks by VTK's painter, in pixels from the lower left.
class Pencil {
public:
  explicit Pencil(vtkContext2D& painter) : painter_(painter) {}

  void text(double x, double y, const std::string& words, int size, const Color& color, double across = 0.5,
            bool upward = false)
  {
    set(size, color);
    vtkTextProperty& look = *painter_.GetTextProp();
    look.SetOrientation(upward ? 90.0 : 0.0);
    look.SetVerticalJustificationToCentered();
    if (across == 0.0)
      look.SetJustificationToLeft();
    else if (across == 1.0)
      look.SetJustificationToRight();
    else
      look.SetJustificationToCentered();
    painter_.DrawString(static_cast<float>(x), static_cast<float>(y), words.c_str());
  }

  std::array<double, 2> sizeOf(const std::string& words, int size)
  {
    set(size, ink);
    painter_.GetTextProp()->SetOrientation(0.0);
    float bounds[4] = {};
    painter_.ComputeStringBounds(words.c_str(), bounds);
    return {bounds[2], bounds[3]};
  }

  void line(const PixelSegment& s, const Color& color, float width)
  {
    painter_.GetPen()->SetLineType(vtkPen::SOLID_LINE);
    painter_.GetPen()->SetColor(color[0], color[1], color[2], 255);
    painter_.GetPen()->SetWidth(width);
    painter_.DrawLine(static_cast<float>(s.from[0]), static_cast<float>(s.from[1]), static_cast<float>(s.to[0]),
                      static_cast<float>(s.to[1]));
  }

  void fill(const PixelBox& box, const Color& color)
  {
    polygon({{box.left, box.bottom}, {box.right, box.bottom}, {box.right, box.top}, {box.left, box.top}}, color);
  }

  /// With a white rim, so that it stands apart from lines and from marks below.
  void mark(const std::array<double, 2>& at, Mark shape, const Color& color, bool filled, double radius)
  {
    polygon(corners(at, shape, radius + 2.0), {255, 255, 255});
    polygon(corners(at, shape, radius), color);
    if (!filled) polygon(corners(at, shape, radius - 4.0), {255, 255, 255});
  }

private:
  using Corners = std::vector<std::array<double, 2>>;

  void set(int size, const Color& color)
  {
    vtkTextProperty& look = *painter_.GetTextProp();
    look.SetFontFamilyToArial();
    look.SetFontSize(size);
    look.SetBold(0);
    look.SetItalic(0);
    look.SetShadow(0);
    look.SetColor(color[0] / 255.0, color[1] / 255.0, color[2] / 255.0);
  }

  static Corners corners(const std::array<double, 2>& at, Mark shape, double radius)
  {
    const int count = shape == Mark::circle ? 32 : shape == Mark::triangle ? 3 : 4;
    const double turn = shape == Mark::square ? 0.25 * pi : 0.5 * pi;
    const double reach = radius * (shape == Mark::circle ? 1.0 : shape == Mark::triangle ? 1.35 : 1.25);
    Corners all;
    for (int i = 0; i < count; ++i) {
      const double angle = turn + 2.0 * pi * i / count;
      all.push_back({at[0] + reach * std::cos(angle), at[1] + reach * std::sin(angle)});
    }
    return all;
  }

  void polygon(const Corners& corners, const Color& color)
  {
    painter_.GetPen()->SetLineType(vtkPen::NO_PEN);
    painter_.GetBrush()->SetColor(color[0], color[1], color[2], 255);
    std::vector<float> flat;
    for (const auto& corner : corners)
      for (const double number : corner) flat.push_back(static_cast<float>(number));
    painter_.DrawPolygon(flat.data(), static_cast<int>(corners.size()));
  }

  static constexpr double pi = 3.14159265358979323846;
  vtkContext2D& painter_;
};

/// One chart in its part of the picture.
class Panel {
public:
  Panel(const Chart& chart, const PixelBox& part)
  : chart_(chart),
    part_left_(part.left),
    frame_{part.left, part.bottom + 100, part.right - 52, part.top - 70},
    lowest_top_(frame_.bottom + (chart.lowest.empty() ? 0 : 66))
  {
  }

  void draw(Pencil& pencil)
  {
    double widest = pencil.sizeOf(chart_.lowest, text_size)[0];
    for (const Tick& tick : chart_.y.ticks) widest = std::max(widest, pencil.sizeOf(tick.text, text_size)[0]);
    frame_.left += widest + tick_gap + title_width;
    drawAxes(pencil);
    LabelSpace space;
    space.frame = {frame_.left, frame_.bottom, frame_.right, frame_.top};
    space.mark_radius = mark_radius;
    for (const Series& series : chart_.series) drawLine(pencil, series, space);
    for (const Series& series : chart_.series) drawSpreads(pencil, series, space);
    for (const Span& span : chart_.spans) drawSpan(pencil, span, space);
    for (const Series& series : chart_.series) drawMarks(pencil, series, space);
    drawLabels(pencil, space);
  }

private:
  double xOf(double x) const { return at(chart_.x, x, frame_.left, frame_.right); }

  double yOf(double y) const
  {
    const double middle = 0.5 * (frame_.bottom + lowest_top_);
    return y <= chart_.lowest_y ? middle : at(chart_.y, y, lowest_top_, frame_.top);
  }

  static double at(const Axis& axis, double value, double low, double high)
  {
    const double first = std::log(axis.ticks.front().value), last = std::log(axis.ticks.back().value);
    const double share = value > 0.0 ? (std::log(value) - first) / (last - first) : 0.0;
    return low + std::clamp(share, 0.0, 1.0) * (high - low);
  }

  std::array<double, 2> placeOf(const ChartPoint& point) const { return {xOf(point.x), yOf(point.y)}; }

  void drawAxes(Pencil& pencil) const
  {
    pencil.fill({frame_.left, frame_.bottom, frame_.right, lowest_top_}, lowest_ground);
    for (const Tick& tick : chart_.x.ticks) {
      const double x = xOf(tick.value);
      pencil.line({{x, frame_.bottom}, {x, frame_.top}}, grid, 1.0f);
      pencil.text(x, frame_.bottom - 24, tick.text, text_size, ink);
    }
    for (const Tick& tick : chart_.y.ticks) {
      const double y = yOf(tick.value);
      pencil.line({{frame_.left, y}, {frame_.right, y}}, grid, 1.0f);
      pencil.text(frame_.left - tick_gap, y, tick.text, text_size, ink, 1.0);
    }
    pencil.text(frame_.left - tick_gap, 0.5 * (frame_.bottom + lowest_top_), chart_.lowest, text_size, ink, 1.0);
    pencil.line({{frame_.left, frame_.bottom}, {frame_.right, frame_.bottom}}, ink, 2.0f);
    pencil.line({{frame_.left, frame_.bottom}, {frame_.left, frame_.top}}, ink, 2.0f);
    const double middle = 0.5 * (frame_.left + frame_.right);
    pencil.text(middle, frame_.top + 38, chart_.title, title_size, ink);
    pencil.text(middle, frame_.bottom - 68, chart_.x.title, text_size, ink);
    pencil.text(part_left_ + 26, 0.5 * (frame_.bottom + frame_.top), chart_.y.title, text_size, ink, 0.5, true);
  }

  void drawLine(Pencil& pencil, const Series& series, LabelSpace& space) const
  {
    for (std::size_t i = 1; series.joined && i < series.points.size(); ++i) {
      const PixelSegment segment = {placeOf(series.points[i - 1]), placeOf(series.points[i])};
      pencil.line(segment, series.color, 4.0f);
      space.lines.push_back(segment);
    }
  }

  void drawSpreads(Pencil& pencil, const Series& series, LabelSpace& space) const
  {
    for (const ChartPoint& point : series.points) {
      if (point.spread == std::array<double, 2>{}) continue;
      constexpr double cap = 6.0;
      const double y = yOf(point.y), low = xOf(point.spread[0]), high = xOf(point.spread[1]);
      pencil.line({{low, y}, {high, y}}, series.color, 2.0f);
      for (const double x : {low, high}) pencil.line({{x, y - cap}, {x, y + cap}}, series.color, 2.0f);
      space.taken.push_back({low, y - cap, high, y + cap});
    }
  }

  void drawMarks(Pencil& pencil, const Series& series, LabelSpace& space) const
  {
    const double radius = series.faint ? 4.0 : mark_radius;
    for (const ChartPoint& point : series.points) {
      const std::array<double, 2> at = placeOf(point);
      pencil.mark(at, series.mark, series.color, series.filled, radius);
      space.taken.push_back({at[0] - radius, at[1] - radius, at[0] + radius, at[1] + radius});
    }
  }

  void drawSpan(Pencil& pencil, const Span& span, LabelSpace& space) const
  {
    constexpr double head = 9.0;
    const double y = yOf(chart_.lowest_y);
    const double from = xOf(span.from) + mark_radius + 8.0, to = xOf(span.to) - mark_radius - 8.0;
    const std::array<double, 2> size = pencil.sizeOf(span.text, label_size);
    if (to - from < size[0] + 4.0 * head) return;
    pencil.line({{from, y}, {to, y}}, ink, 2.0f);
    for (const double side : {-head, head}) {
      pencil.line({{from, y}, {from + head, y + side}}, ink, 2.0f);
      pencil.line({{to, y}, {to - head, y + side}}, ink, 2.0f);
    }
    const double middle = widestGap(from, to);
    pencil.fill({middle - 0.5 * size[0] - 8.0, y - 14.0, middle + 0.5 * size[0] + 8.0, y + 14.0}, lowest_ground);
    pencil.text(middle, y, span.text, label_size, ink);
    space.taken.push_back({from, y - 14.0, to, y + 14.0});
  }

  /// The middle of the widest part of a span without marks of the lowest row.
  double widestGap(double from, double to) const
  {
    std::vector<double> stops = {from, to};
    for (const Series& series : chart_.series)
      for (const ChartPoint& point : series.points)
        if (point.y <= chart_.lowest_y && xOf(point.x) > from && xOf(point.x) < to) stops.push_back(xOf(point.x));
    std::sort(stops.begin(), stops.end());
    std::size_t widest = 1;
    for (std::size_t i = 2; i < stops.size(); ++i)
      if (stops[i] - stops[i - 1] > stops[widest] - stops[widest - 1]) widest = i;
    return 0.5 * (stops[widest - 1] + stops[widest]);
  }

  void drawLabels(Pencil& pencil, const LabelSpace& space) const
  {
    std::vector<Label> labels;
    std::vector<std::pair<std::string, Color>> texts;
    for (const Series& series : chart_.series) {
      for (const ChartPoint& point : series.points) {
        if (series.faint || point.label.empty()) continue;
        const std::array<double, 2> size = pencil.sizeOf(point.label, label_size);
        labels.push_back({placeOf(point), size[0], size[1]});
        texts.emplace_back(point.label, series.color);
      }
    }
    const std::vector<std::optional<PixelBox>> places = placeLabels(labels, space);
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!places[i]) continue;
      const PixelBox& box = *places[i];
      pencil.text(0.5 * (box.left + box.right), 0.5 * (box.bottom + box.top), texts[i].first, label_size,
                  texts[i].second);
    }
  }

  static constexpr double tick_gap = 12.0, title_width = 56.0; ///< left of the axis
  const Chart& chart_;
  double part_left_;
  PixelBox frame_;
  double lowest_top_;
};

/// The charts and their legend.
class Picture : public vtkContextItem {
public:
  vtkTypeMacro(Picture, vtkContextItem)
  static Picture* New() { VTK_STANDARD_NEW_BODY(Picture); }

  const std::vector<Chart>* charts = nullptr;
  double width = 0.0, height = 0.0;

  bool Paint(vtkContext2D* painter) override
  {
    constexpr double legend_height = 64.0;
    Pencil pencil(*painter);
    drawLegend(pencil, height - 0.55 * legend_height);
    const double part = width / static_cast<double>(charts->size());
    for (std::size_t i = 0; i < charts->size(); ++i) {
      const double left = part * static_cast<double>(i);
      Panel((*charts)[i], {left, 0.0, left + part, height - legend_height}).draw(pencil);
    }
    return true;
  }

private:
  void drawLegend(Pencil& pencil, double y) const
  {
    constexpr double before = 18.0, after = 44.0;
    std::vector<const Series*> named;
    double total = 0.0;
    for (const Chart& chart : *charts) {
      for (const Series& series : chart.series) {
        const auto same = [&](const Series* known) { return known->name == series.name; };
        if (series.name.empty() || std::any_of(named.begin(), named.end(), same)) continue;
        named.push_back(&series);
        total += before + pencil.sizeOf(series.name, text_size)[0] + after;
      }
    }
    double x = 0.5 * (width - total + after);
    for (const Series* series : named) {
      pencil.mark({x, y}, series->mark, series->color, series->filled, mark_radius);
      pencil.text(x + before, y, series->name, text_size, series->color, 0.0);
      x += before + pencil.sizeOf(series->name, text_size)[0] + after;
    }
  }
};

} // namespace

std::array<unsigned char, 3> distinctColor(std::size_t i)
{
  static constexpr std::array<Color, 7> colors = {
      {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}, {0, 0, 0}}};
  return colors[i % colors.size()];
}

void writeChartsPng(const std::vector<Chart>& charts, int width, int height, const std::filesystem::path& path)
{
  const vtkSmartPointer<vtkRenderWindow> window = makeOffscreenWindow(width, height);
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1.0, 1.0, 1.0);
  vtkNew<Picture> picture;
  picture->charts = &charts;
  picture->width = width;
  picture->height = height;
  vtkNew<vtkContextActor> actor;
  actor->GetScene()->AddItem(picture);
  renderer->AddActor(actor);
  window->AddRenderer(renderer);
  writePng(*window, path);
}

} // namespace pcl_bsh::vtk

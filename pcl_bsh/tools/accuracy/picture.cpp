// SPDX-License-Identifier: BSD-3-Clause
#include "picture.h"

#include <pcl_bsh/base/plain_text.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pcl_bsh::accuracy {
namespace {

std::string timeText(double seconds)
{
  if (seconds >= 1.0) return plainText(seconds) + " s";
  if (seconds >= 1e-3) return plainText(1e3 * seconds) + " ms";
  if (seconds >= 1e-6) return plainText(1e6 * seconds) + " \xc2\xb5s";
  return plainText(1e9 * seconds) + " ns";
}

std::string lengthText(double length, const std::string& unit)
{
  if (unit == "m" && length >= 1e3) return plainText(1e-3 * length) + " km";
  if (unit == "m" && length < 1e-2) return plainText(1e3 * length) + " mm";
  if (unit == "m" && length < 1.0) return plainText(1e2 * length) + " cm";
  return unit.empty() ? plainText(length) : plainText(length) + ' ' + unit;
}

/// Whole decades that hold the values, two ticks at least.
template <class Text>
std::vector<vtk::Tick> decades(const std::vector<double>& values, const Text& text)
{
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const double value : values) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(high > 0.0)) low = high = 1.0;
  // A value just beyond a decade needs no decade more.
  const int first = static_cast<int>(std::floor(std::log10(low) + 0.02));
  const int last = std::max(first + 1, static_cast<int>(std::ceil(std::log10(high) - 0.02)));
  std::vector<vtk::Tick> ticks;
  for (int decade = first; decade <= last; ++decade) {
    const double value = std::pow(10.0, decade);
    ticks.push_back({value, text(value)});
  }
  return ticks;
}

/// A query, and how its errors become heights.
struct View {
  std::string query;
  double scale = 1.0;      ///< of the errors
  double negligible = 0.0; ///< scaled errors up to here are in the lowest row
};

double errorOf(const Measurement& m, const View& view)
{
  return view.scale * (m.peer ? m.actual_error : m.certified_error);
}

/// Which times a series has: of a query whose hierarchies were built before, or with all that is built for it.
enum class Timing { again, once };

vtk::ChartPoint pointOf(const Measurement& m, const View& view, Timing asked)
{
  const Spread& time = asked == Timing::once ? m.once : m.seconds;
  return {time.median, errorOf(m, view), m.setting, {time.low, time.high}};
}

vtk::Series oursOf(const Study& study, const View& view, Timing asked)
{
  const bool once = asked == Timing::once;
  vtk::Series series{
      once ? "" : "pcl_bsh, guaranteed", vtk::distinctColor(0), vtk::Mark::circle, true, !once, once, {}};
  for (const Measurement* m : frontier(study, view.query, view.negligible / view.scale))
    series.points.push_back(pointOf(*m, view, asked));
  std::reverse(series.points.begin(), series.points.end()); // exact comes first, so its label is placed first
  return series;
}

/// A way of PCL's: its name, and how it is drawn.
struct Way {
  const char* knob;
  std::size_t color;
  vtk::Mark mark;
};

constexpr std::array ways = {Way{"k-d tree", 6, vtk::Mark::diamond}, Way{"VoxelGrid + k-d tree", 1, vtk::Mark::square},
                             Way{"octree", 2, vtk::Mark::triangle}};

vtk::Series peerOf(const Study& study, const View& view, const Way& way, Timing asked)
{
  const bool once = asked == Timing::once;
  const std::string name = std::string("PCL ") + way.knob + (way.mark == vtk::Mark::diamond ? "" : ", no guarantee");
  vtk::Series series{once ? "" : name, vtk::distinctColor(way.color), way.mark, false, false, once, {}};
  for (const Measurement& m : study.measurements)
    if (m.query == view.query && m.knob == way.knob) series.points.push_back(pointOf(m, view, asked));
  return series;
}

/// A span that tells how much faster the exact answer is than that of PCL's k-d tree.
std::vector<vtk::Span> spansOf(const vtk::Series& ours, const vtk::Series& tree)
{
  if (ours.points.empty() || tree.points.empty()) return {};
  const double from = ours.points.front().x, to = tree.points.front().x;
  if (!(to > 1.5 * from)) return {};
  const double digits = std::pow(10.0, std::floor(std::log10(to / from)) - 1.0); // two digits: others vary
  return {{from, to, plainText(std::round(to / from / digits) * digits) + " x faster"}};
}

vtk::Chart chartOf(const Study& study, const View& view)
{
  vtk::Chart chart;
  chart.lowest_y = view.negligible;
  for (const Timing asked : {Timing::again, Timing::once}) {
    chart.series.push_back(oursOf(study, view, asked));
    for (const Way& way : ways) chart.series.push_back(peerOf(study, view, way, asked));
  }
  chart.spans = spansOf(chart.series[0], chart.series[1]);
  const auto isEmpty = [](const vtk::Series& series) { return series.points.empty(); };
  chart.series.erase(std::remove_if(chart.series.begin(), chart.series.end(), isEmpty), chart.series.end());
  return chart;
}

std::vector<double> timesOf(const std::vector<vtk::Chart>& charts)
{
  std::vector<double> times;
  for (const vtk::Chart& chart : charts)
    for (const vtk::Series& series : chart.series)
      for (const vtk::ChartPoint& point : series.points) times.push_back(point.x);
  return times;
}

std::vector<double> errorsOf(const vtk::Chart& chart)
{
  std::vector<double> errors;
  for (const vtk::Series& series : chart.series)
    for (const vtk::ChartPoint& point : series.points)
      if (point.y > chart.lowest_y) errors.push_back(point.y);
  return errors;
}

} // namespace

std::vector<const Measurement*> frontier(const Study& study, const std::string& query, double negligible)
{
  std::vector<const Measurement*> all;
  const Measurement* exact = nullptr;
  for (const Measurement& m : study.measurements) {
    if (m.query != query || m.peer || !m.certified) continue;
    if (m.knob == "exact")
      exact = &m;
    else if (m.certified_error > negligible)
      all.push_back(&m);
  }
  std::sort(all.begin(), all.end(),
            [](const Measurement* x, const Measurement* y) { return x->seconds.median < y->seconds.median; });
  std::vector<const Measurement*> best;
  for (const Measurement* m : all) {
    if (exact && m->seconds.median >= exact->seconds.median) break;
    if (best.empty() || m->certified_error < best.back()->certified_error) best.push_back(m);
  }
  if (exact) best.push_back(exact);
  return best;
}

std::vector<vtk::Chart> chartsOf(const Subject& subject, const Study& study)
{
  const double colliding_share = static_cast<double>(std::max<std::size_t>(study.colliding, 1)) /
                                 static_cast<double>(subject.poses.size() * std::max<std::size_t>(subject.a.size(), 1));
  vtk::Chart distance = chartOf(study, {"distance", 1.0, 1e-7 * subject.diameter});
  vtk::Chart flags = chartOf(study, {"flags", 1.0 / colliding_share, 0.0});
  const std::vector<vtk::Tick> times = decades(timesOf({distance, flags}), timeText);
  distance.title = "How far apart are the clouds?";
  const std::string time = "time of a query, quartiles (small: asked once)";
  distance.x = {time, times};
  distance.y = {"error of the distance",
                decades(errorsOf(distance), [&](double length) { return lengthText(length, subject.unit); })};
  distance.lowest = "exact";
  flags.title = "Which points collide?";
  flags.x = {time, times};
  flags.y = {"wrong or undecided / colliding", decades(errorsOf(flags), [](double share) {
               return share > 1.0 ? plainText(share) + " x" : plainText(100.0 * share) + " %";
             })};
  flags.lowest = "exact";
  return {distance, flags};
}

} // namespace pcl_bsh::accuracy

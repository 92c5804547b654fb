// SPDX-License-Identifier: BSD-3-Clause
#include "coloring.h"

#include <pcl_bsh/tools/cli/program.h>

#include <pcl_bsh/distances/statistics.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pcl_bsh::viewer {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Values that the colours show, one per part; NaN: no value.
struct Values {
  std::vector<float> values;
  std::string title;
  bool reversed = false; ///< the smallest is the brightest
  bool counts = false;
};

/// The range of the values without the share `share` at either end: a few outliers should not take all colours.
ColorRange rangeOf(std::vector<float> values, double share)
{
  values.erase(std::remove_if(values.begin(), values.end(), [](float value) { return !std::isfinite(value); }),
               values.end());
  if (values.empty()) return {};
  const auto at = [&](double where) {
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(where * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), nth, values.end());
    return static_cast<double>(*nth);
  };
  return {at(share), at(1.0 - share)};
}

std::string lengthTitle(const std::string& name, const Options& options)
{
  return name + "\n[" + (options.unit.empty() ? "cloud's unit" : options.unit) + "]";
}

Values heights(const ViewedCloud& scan, const Options& options)
{
  Values heights{{}, lengthTitle("height z", options)};
  heights.values.reserve(scan.parts());
  for (std::uint32_t i = 0; i < scan.parts(); ++i) heights.values.push_back(static_cast<float>(scan.placeOf(i)[2]));
  return heights;
}

Values firstPoses(const ViewContent& content)
{
  Values first{{}, "first pose\n[number]", false, true};
  for (const std::int32_t pose : content.firstPoses())
    first.values.push_back(pose < 0 ? nan : static_cast<float>(pose));
  return first;
}

std::vector<Color> colorsOf(const Values& shown, vtkLookupTable& table)
{
  std::vector<Color> colors(shown.values.size(), scan_color);
  for (std::size_t i = 0; i < shown.values.size(); ++i) {
    if (!std::isfinite(shown.values[i])) continue;
    const unsigned char* const c = table.MapValue(shown.values[i]);
    colors[i] = {c[0], c[1], c[2]};
  }
  return colors;
}

/// The colour range of the whole cloud of which the content is a part; null where it is no part, or the whole has no
/// range.
const ColorRange* sharedRange(const ViewContent& content)
{
  const SharedColors* const alike = content.sharedColors();
  return alike && alike->values ? &*alike->values : nullptr;
}

void paintValues(CloudActor& cloud, ValueBar& bar, const ViewContent& content, const Values& shown)
{
  const ColorRange* const shared = sharedRange(content);
  const ColorRange range = shared ? *shared : rangeOf(shown.values, 0.005);
  const auto table = colorTable(range.low, range.high, false);
  cloud.paint(colorsOf(shown, *table));
  if (!shared) bar.show(*table, shown.title, false);
}

/// The colour of a verdict other than free.
Color colorOfFlag(Verdict flag)
{
  if (flag == Verdict::undecided) return undecided_color;
  if (flag == Verdict::unseen) return unseen_color;
  return flag == Verdict::sparse ? sparse_color : colliding_color;
}

/// Marks the points that have a value.
/// @param colliding per part, drawn in the colour of collisions; empty: none
void markValues(CloudActor& cloud, ValueBar& bar, const ViewContent& content, const Values& shown,
                const ColorRange& own_range, const std::vector<Verdict>& colliding = {})
{
  const ColorRange* const shared = sharedRange(content);
  const ColorRange range = shared ? *shared : own_range;
  const auto table = colorTable(range.low, range.high, shown.reversed);
  std::vector<std::uint8_t> known;
  known.reserve(shown.values.size());
  for (const float value : shown.values) known.push_back(std::isfinite(value) ? 1 : 0);
  std::vector<Color> colors = colorsOf(shown, *table);
  for (std::size_t i = 0; i < colliding.size(); ++i)
    if (colliding[i] != Verdict::free) colors[i] = colorOfFlag(colliding[i]);
  cloud.mark(known, colors);
  if (shared) return;
  if (std::find(known.begin(), known.end(), 1) != known.end())
    bar.show(*table, shown.title, shown.counts);
  else
    bar.hide();
}

/// Returns the colours of flags, one per part.
std::vector<Color> colorsOfVerdicts(const std::vector<Verdict>& flags)
{
  std::vector<Color> colors;
  colors.reserve(flags.size());
  for (const Verdict flag : flags) colors.push_back(colorOfFlag(flag));
  return colors;
}

template <class Value>
const Value& required(const std::optional<Value>& value, const ViewContent& content, const std::string& what)
{
  if (!value)
    throw cli::UsageError("--color: " + content.scan().file.string() + " has no " + what + ": give another colour");
  return *value;
}

void requireCollisions(const StepCollisions& collisions, const std::string& option)
{
  if (!collisions.known)
    throw cli::UsageError("--color: it is not known what collides: give an obstacle and --clearance, or a cloud with "
                          "the field 'collision', for " +
                          option);
}

void paintScan(CloudActor& cloud, ValueBar& bar, const ViewContent& content, Coloring coloring)
{
  const ViewedCloud& scan = content.scan();
  switch (coloring) {
  case Coloring::collision:
  case Coloring::distance:
  case Coloring::first_pose:
    cloud.paint(plainColor(scan), content.sharedColors() ? &content.sharedColors()->heights : nullptr);
    return;
  case Coloring::height:
    paintValues(cloud, bar, content, heights(scan, content.options()));
    return;
  case Coloring::intensity:
    paintValues(cloud, bar, content,
                {required(scan.field("intensity"), content, "field 'intensity'"), "intensity\n[as given]"});
    return;
  case Coloring::rgb:
    cloud.paint(required(scan.colors(), content, "colours (fields rgb, rgba or red, green, blue)"));
  }
}

} // namespace

Color plainColor(const ViewedCloud& viewed)
{
  return viewed.role == ViewedCloud::Role::scan ? scan_color : named_colors[viewed.number % named_colors.size()];
}

Coloring coloringOf(const ViewContent& content, const StepCollisions& collisions)
{
  if (content.options().color) return *content.options().color;
  if (collisions.known) return Coloring::collision;
  // Formats with a place for colours are used without them: all is black then.
  const auto colors = content.scan().colors();
  const bool seen = colors && std::any_of(colors->begin(), colors->end(), [](const auto& c) { return c != Color{}; });
  return seen ? Coloring::rgb : Coloring::height;
}

void paint(CloudActors clouds, ValueBar& bar, const ViewContent& content, Coloring coloring)
{
  paintScan(*clouds[0], bar, content, coloring);
  for (std::size_t i = 1; i < clouds.size(); ++i) clouds[i]->paint(plainColor(content.viewedClouds()[i]));
}

bool paintDistances(CloudActors clouds, ValueBar& bar, ValueHistogram& histogram, const ViewContent& content,
                    Coloring coloring, std::size_t step)
{
  if (coloring != Coloring::distance) return false;
  const std::vector<double> distances = content.allDistances(step);
  if (distances.empty()) return false;
  const Options& options = content.options();
  const DistanceStatistics statistics = statisticsOf(distances);
  // Outliers should not take all colours for themselves.
  const double own_end = options.range.value_or(statistics.count > 0 ? statistics.percentiles.back() : 1.0);
  const ColorRange* const shared = sharedRange(content);
  const auto deepest = std::min_element(distances.begin(), distances.end(), [](double l, double r) {
    return std::isnan(r) ? !std::isnan(l) : l < r; // what is no number is greater than all
  });
  const double low = *deepest < 0.0 ? *deepest : 0.0;
  const auto table = colorTable(low, shared ? shared->high : own_end, false);
  const std::string title = lengthTitle(low < 0.0 ? "signed distance" : "distance", options);
  std::vector<Color> colors(distances.size(), scan_color);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (std::isnan(distances[i])) continue;
    const unsigned char* const c = table->MapValue(distances[i]);
    colors[i] = {c[0], c[1], c[2]};
  }
  clouds[0]->paint(colors);
  for (std::size_t i = 1; i < clouds.size(); ++i) clouds[i]->paint(compared_color);
  if (shared) return true;
  bar.show(*table, title, false);
  if (low < 0.0) return true; // a histogram begins at 0
  histogram.show(distances, *table, "distance [" + (options.unit.empty() ? "cloud's unit" : options.unit) + "]",
                 content);
  return true;
}

void mark(CloudActors clouds, ValueBar& bar, const ViewContent& content, const StepCollisions& collisions,
          Coloring coloring, std::size_t step)
{
  const Options& options = content.options();
  if (coloring == Coloring::distance) {
    requireCollisions(collisions, "distance");
    const Values shown{content.distances(step), lengthTitle("distance", options), true};
    if (options.range)
      markValues(*clouds[0], bar, content, shown, {0.0, *options.range}, collisions.flags[0]);
    else
      markValues(*clouds[0], bar, content, shown,
                 {0.0, options.question.clearance.value_or(rangeOf(shown.values, 0.0).high)});
  }
  else if (coloring == Coloring::first_pose) {
    requireCollisions(collisions, "first_pose");
    const Values shown = firstPoses(content);
    markValues(*clouds[0], bar, content, shown, rangeOf(shown.values, 0.0));
  }
  else {
    if (coloring == Coloring::collision) requireCollisions(collisions, "collision");
    const std::vector<Verdict>& flags = collisions.flags[0];
    clouds[0]->mark(maskOf(flags, false), collisions.undecided + collisions.sparse + collisions.unseen > 0
                                              ? colorsOfVerdicts(flags)
                                              : std::vector<Color>());
  }
  for (std::size_t i = 1; i < clouds.size(); ++i) {
    const std::vector<Verdict>& flags = collisions.flags[i];
    std::vector<Color> colors;
    if (countOf(flags, Verdict::unseen) > 0)
      for (const Verdict flag : flags)
        colors.push_back(flag == Verdict::unseen ? unseen_color : obstacle_colliding_color);
    clouds[i]->mark(maskOf(flags, false), colors);
  }
}

} // namespace pcl_bsh::viewer

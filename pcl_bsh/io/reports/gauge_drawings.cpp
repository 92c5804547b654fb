// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/reports/gauge_drawings.h>
#include <pcl_bsh/io/reports/page_text.h>

#include <pcl_bsh/base/counted.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace pcl_bsh::io {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
constexpr std::size_t most_columns = 480; ///< of a drawing by chainage
constexpr std::array<const char*, 6> envelope_colors = {"#1f6feb", "#8250df", "#0a7f7f",
                                                        "#b26a00", "#57606a", "#a0227a"};

std::string placeText(double value)
{
  return numberText(value, std::chars_format::fixed, 1);
}

std::string attributesOf(std::initializer_list<std::pair<const char*, std::string>> values)
{
  std::string text;
  for (const auto& [name, value] : values) text += std::string(" ") + name + "=\"" + value + '"';
  return text;
}

std::string lineOf(double x1, double y1, double x2, double y2, const std::string& stroke, const std::string& more = {})
{
  return "<line" +
         attributesOf({{"x1", placeText(x1)},
                       {"y1", placeText(y1)},
                       {"x2", placeText(x2)},
                       {"y2", placeText(y2)},
                       {"stroke", stroke}}) +
         more + "/>\n";
}

std::string frameOf(double x, double y, double width, double height)
{
  return "<rect" +
         attributesOf({{"x", placeText(x)},
                       {"y", placeText(y)},
                       {"width", placeText(width)},
                       {"height", placeText(height)},
                       {"fill", "none"},
                       {"stroke", "#dde3ea"}}) +
         "/>\n";
}

std::string textOfDrawing(double x, double y, const std::string& anchor, const std::string& content,
                          const std::string& fill = "#667484")
{
  std::string safe;
  for (const char c : plain(content)) safe += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return "<text" + attributesOf({{"x", placeText(x)}, {"y", placeText(y)}, {"text-anchor", anchor}, {"fill", fill}}) +
         ">" + safe + "</text>\n";
}

std::string drawing(double width, double height, const std::string& label, const std::string& inside)
{
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(width) + ' ' + number(height) +
         "\" role=\"img\" aria-label=\"" + label +
         "\" font-family=\"system-ui, DejaVu Sans, sans-serif\" font-size=\"11\">\n"
         "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
         inside + "</svg>\n";
}

std::string lengthText(const GaugeReport& report, double length)
{
  return numberText(length, std::chars_format::fixed, 3) + (report.unit.empty() ? "" : ' ' + report.unit);
}

/// From red at the limit over orange to green a metre above; grey where there is no data.
std::string clearanceColor(double clearance, double limit, double range)
{
  if (!std::isfinite(clearance)) return "#e6eaef";
  if (clearance <= limit) return "#b0122b";
  constexpr std::array<std::array<double, 3>, 3> stops = {{{240, 140, 40}, {236, 214, 90}, {60, 150, 95}}};
  return colorBetween(stops, std::clamp((clearance - limit) / range, 0.0, 1.0));
}

/// Where a drawing by chainage has its columns, and its axis below.
struct AlongAxis {
  const Axis& axis;
  const GaugeTable& table;
  const std::string& unit;
  double left = 70, width = 970;
  std::size_t columns = std::min(most_columns, table.parts());

  std::pair<std::size_t, std::size_t> partsOf(std::size_t column) const
  {
    const std::size_t parts = table.parts();
    return {column * parts / columns, (column + 1) * parts / columns};
  }
  double smallest(std::size_t column, const std::function<double(std::size_t)>& of) const
  {
    const auto [from, to] = partsOf(column);
    double least = unbounded;
    for (std::size_t part = from; part < to; ++part) least = std::min(least, of(part));
    return least;
  }
  double x(std::size_t column) const { return left + width * table.from(partsOf(column).first) / axis.length(); }
  double xOf(double distance) const { return left + width * distance / axis.length(); }

  /// Ticks at round distances, which say the chainage there.
  std::string ticks(double top, double bottom) const
  {
    std::string all;
    const double step = roundLength(axis.length() / 5);
    for (double distance = 0; distance <= axis.length() * (1 + 1e-9); distance += step) {
      const double tick = xOf(std::min(distance, axis.length()));
      all += lineOf(tick, top, tick, bottom + 4, "#dde3ea");
      all +=
          textOfDrawing(tick, bottom + 16, "middle", numberText(axis.chainage(distance), std::chars_format::fixed, 1));
    }
    return all + textOfDrawing(left + width / 2, bottom + 32, "middle",
                               "chainage" + (unit.empty() ? std::string() : " [" + unit + "]"));
  }
};

constexpr double map_top = 12;

/// Rows of colours by chainage, which go up round an envelope, and the names of its four sectors.
std::string mapOf(const AlongAxis& along, std::size_t rows, double row,
                  const std::function<std::string(std::size_t, std::size_t)>& colorOf)
{
  const double bottom = map_top + row * static_cast<double>(rows);
  std::string inside = "<g shape-rendering=\"crispEdges\">\n";
  for (std::size_t cell = 0; cell < rows; ++cell) {
    const double y = bottom - row * static_cast<double>(cell + 1);
    for (std::size_t column = 0; column < along.columns;) {
      const std::size_t first = column;
      const std::string color = colorOf(first, cell);
      while (++column < along.columns && colorOf(column, cell) == color) {
      }
      const double end = column == along.columns ? along.left + along.width : along.x(column);
      inside += "<path fill=\"" + color + "\" d=\"M" + placeText(along.x(first)) + ' ' + placeText(y) + 'H' +
                placeText(end) + 'V' + placeText(y + row) + 'H' + placeText(along.x(first)) +
                "z\"/>\n"; // edges are those of neighbours
    }
  }
  inside += "</g>\n";
  constexpr std::array names = {"left", "above", "right", "below"};
  const double of_sector = row * static_cast<double>(rows / names.size());
  for (std::size_t sector = 0; sector < names.size(); ++sector) {
    const double y = bottom - of_sector * static_cast<double>(sector);
    inside += lineOf(along.left - 6, y, along.left + along.width, y, "#fff");
    inside += textOfDrawing(along.left - 10, y - of_sector / 2 + 4, "end", names[sector]);
  }
  return inside;
}

/// Values and their names, below a map.
std::string legendOf(double bottom, const std::vector<std::pair<double, std::string>>& values, double limit)
{
  std::string inside;
  double x = 690;
  for (const auto& [value, name] : values) {
    inside += "<rect" +
              attributesOf({{"x", placeText(x)},
                            {"y", placeText(bottom + 26)},
                            {"width", "12"},
                            {"height", "12"},
                            {"fill", clearanceColor(value, limit, 1.0)}}) +
              "/>\n";
    inside += textOfDrawing(x + 16, bottom + 36, "start", name);
    x += 74;
  }
  return inside;
}

/// A section's own scale: offset to the right, height up.
struct SectionView {
  double left, top, scale, middle_offset, high;
  double width, height;

  double x(double offset) const { return left + width / 2 + scale * (offset - middle_offset); }
  double y(double above) const { return top + scale * (high - above); }
  bool holds(const SectionPoint& p) const
  {
    const double px = x(p.offset), py = y(p.height);
    return px >= left && px <= left + width && py >= top && py <= top + height;
  }
};

} // namespace

std::string sectionDrawing(const GaugeReport& report, const GaugeSection& section)
{
  constexpr double width = 640, height = 560, margin = 1.2; // beside the envelopes
  const Track& track = report.tracks[section.track];
  const double chainage = track.axis.chainage(section.distance);
  std::vector<std::pair<std::size_t, std::vector<SectionPoint>>> outlines;
  SectionPoint low{unbounded, unbounded}, high{-unbounded, -unbounded};
  const auto extend = [&](const SectionPoint& p) {
    low = {std::min(low.offset, p.offset), std::min(low.height, p.height)};
    high = {std::max(high.offset, p.offset), std::max(high.height, p.height)};
  };
  for (std::size_t e = 0; e < track.envelopes.size(); ++e) {
    if (!track.envelopes[e].countsAt(chainage)) continue;
    std::vector<SectionPoint> room;
    const auto& outline = track.envelopes[e].outlineAt(track.axis, section.distance, room);
    outlines.emplace_back(e, outline);
    for (const SectionPoint& corner : outline) extend(corner);
  }
  if (section.worst) extend({section.worst->place.offset, section.worst->place.height});
  if (outlines.empty() && !section.worst) extend({0, 0});
  SectionView view{20, 44, 1, 0.5 * (low.offset + high.offset), high.height + margin, width - 40, height - 110};
  view.scale = std::min(view.width / (high.offset - low.offset + 2 * margin),
                        view.height / (high.height - low.height + 2 * margin));

  std::string inside = textOfDrawing(20, 24, "start",
                                     section.name + (report.named() ? ", track " + track.name : "") + ", chainage " +
                                         lengthText(report, chainage),
                                     "#1c2530");
  inside += frameOf(view.left, view.top, view.width, view.height);
  if (view.holds({0, view.high - 0.01}))
    inside += lineOf(view.x(0), view.top, view.x(0), view.top + view.height, "#dde3ea");
  if (view.holds({view.middle_offset, 0}))
    inside += lineOf(view.left, view.y(0), view.left + view.width, view.y(0), "#dde3ea");
  std::string clear, near;
  for (const SectionPoint& p : section.points) {
    if (!view.holds(p)) continue;
    double least = unbounded;
    for (const auto& [e, outline] : outlines) least = std::min(least, signedDistance(outline, p));
    const bool infringes = least <= report.limit;
    (infringes ? near : clear) += 'M' + placeText(view.x(p.offset) - 0.8) + ' ' + placeText(view.y(p.height) - 0.8) +
                                  (infringes ? "h2.4v2.4h-2.4z" : "h1.6v1.6h-1.6z");
  }
  inside += "<path fill=\"#57606a\" d=\"" + clear + "\"/>\n<path fill=\"#c62f3b\" d=\"" + near + "\"/>\n";
  double legend = 20;
  for (const auto& [e, outline] : outlines) {
    const std::string color = envelope_colors[e % envelope_colors.size()];
    std::string path;
    for (const SectionPoint& corner : outline)
      path += (path.empty() ? 'M' : 'L') + placeText(view.x(corner.offset)) + ' ' + placeText(view.y(corner.height));
    inside += "<path fill=\"none\" stroke-width=\"1.4\" stroke=\"" + color + "\" d=\"" + path + "z\"/>\n";
    inside += textOfDrawing(legend, height - 46, "start", track.envelopes[e].name(), color);
    legend += 16 + 7.0 * static_cast<double>(track.envelopes[e].name().size());
  }
  if (section.worst) {
    const SectionPoint worst{section.worst->place.offset, section.worst->place.height};
    for (const auto& [e, outline] : outlines) {
      if (static_cast<std::int32_t>(e) != section.worst->envelope) continue;
      OutlinePlace nearest;
      signedDistance(outline, worst, &nearest);
      inside += lineOf(view.x(worst.offset), view.y(worst.height), view.x(nearest.at.offset), view.y(nearest.at.height),
                       "#c62f3b", " stroke-width=\"1.4\"");
    }
    inside +=
        "<circle fill=\"none\" stroke=\"#c62f3b\"" +
        attributesOf({{"cx", placeText(view.x(worst.offset))}, {"cy", placeText(view.y(worst.height))}, {"r", "6"}}) +
        "/>\n";
    const bool to_left = view.x(worst.offset) > width / 2; // away from the drawing's edge
    inside += textOfDrawing(view.x(worst.offset) + (to_left ? -10 : 10), view.y(worst.height) - 9,
                            to_left ? "end" : "start", lengthText(report, section.worst->clearance), "#c62f3b");
  }
  const double bar = roundLength(view.width / view.scale / 5), end = 20 + bar * view.scale;
  inside += "<path fill=\"none\" stroke=\"#667484\" d=\"M20 " + placeText(height - 26) + "v4h" +
            placeText(bar * view.scale) + "v-4\"/>\n";
  inside += textOfDrawing(end + 8, height - 22, "start", number(bar) + (report.unit.empty() ? "" : ' ' + report.unit));
  inside +=
      textOfDrawing(width - 20, height - 22, "end",
                    section.points.empty() ? std::string("no data: no point within ") + number(report.thickness / 2)
                                           : counted(section.points.size(), "point") + " within " +
                                                 number(report.thickness / 2) + " of the section; seen along the axis");
  return drawing(width, height, "section", inside);
}

std::string clearanceMap(const GaugeReport& report, std::size_t track, std::size_t envelope)
{
  const GaugeTable& table = report.tables[track];
  const AlongAxis along{report.tracks[track].axis, table, report.unit};
  constexpr double row = 5, bottom = map_top + row * static_cast<double>(cells_around), range = 1.0;
  std::string inside = mapOf(along, cells_around, row, [&](std::size_t column, std::size_t cell) {
    return clearanceColor(along.smallest(column, [&](std::size_t part) { return table.cell(part, envelope, cell); }),
                          report.limit, range);
  });
  inside += along.ticks(bottom, bottom);
  inside += legendOf(bottom,
                     {{report.limit, "to " + number(report.limit)},
                      {report.limit + 0.01, number(report.limit + 0.01, 3)},
                      {report.limit + range / 2, number(report.limit + range / 2, 3)},
                      {report.limit + range, number(report.limit + range, 3)},
                      {unbounded, "no data"}},
                     report.limit);
  return drawing(1080, bottom + 46, "map of clearances", inside);
}

std::string seenMap(const GaugeReport& report, std::size_t track, std::size_t envelope)
{
  const GaugeTable& table = report.tables[track];
  const Track& of = report.tracks[track];
  const AlongAxis along{of.axis, table, report.unit};
  constexpr double row = 15, bottom = map_top + 4 * row;
  const auto shareOf = [&](std::size_t part, std::size_t sector) {
    const double middle = of.axis.chainage(0.5 * (table.from(part) + table.to(part)));
    if (!of.envelopes[envelope].countsAt(middle)) return unbounded;
    return report.seen[track].share(part, envelope, static_cast<Sector>(sector));
  };
  std::string inside = mapOf(along, 4, row, [&](std::size_t column, std::size_t sector) {
    return clearanceColor(along.smallest(column, [&](std::size_t part) { return shareOf(part, sector); }), 0.0, 1.0);
  });
  inside += along.ticks(bottom, bottom);
  inside += legendOf(bottom, {{0.0, "unseen"}, {0.01, "1 %"}, {0.5, "50 %"}, {1.0, "100 %"}}, 0.0);
  return drawing(1080, bottom + 46, "map of what was seen", inside);
}

std::string clearanceChart(const GaugeReport& report, std::size_t track, std::size_t envelope)
{
  const GaugeTable& table = report.tables[track];
  const AlongAxis along{report.tracks[track].axis, table, report.unit};
  constexpr double top = 12, height = 200, bottom = top + height;
  constexpr std::array drawn = {std::pair{Sector::left, "#1f6feb"}, std::pair{Sector::above, "#8250df"},
                                std::pair{Sector::right, "#b26a00"}, std::pair{Sector::below, "#0a7f7f"}};
  constexpr std::array names = {"left", "above", "right", "below"};
  std::vector<double> all;
  double low = report.limit;
  for (std::size_t part = 0; part < table.parts(); ++part)
    for (const auto& [sector, color] : drawn) {
      const double least = table.smallest(part, envelope, sector);
      if (std::isfinite(least)) all.push_back(least);
      low = std::min(low, least);
    }
  std::sort(all.begin(), all.end());
  double high = all.empty() ? report.limit + 1 : std::max(all[(all.size() - 1) * 9 / 10], report.limit + 0.1);
  const double room = 0.06 * (high - low);
  low -= room;
  high += room;
  const auto y = [&](double clearance) {
    return bottom - height * (std::clamp(clearance, low, high) - low) / (high - low);
  };
  std::string inside = along.ticks(top, bottom);
  const double step = roundLength((high - low) / 4);
  for (double value = std::ceil(low / step) * step; value <= high; value += step) {
    inside += lineOf(along.left, y(value), along.left + along.width, y(value), "#eef1f5");
    inside +=
        textOfDrawing(along.left - 8, y(value) + 4, "end", number(std::abs(value) < 1e-9 * step ? 0.0 : value, 3));
  }
  inside += frameOf(along.left, top, along.width, height);
  for (std::size_t s = 0; s < drawn.size(); ++s) {
    std::string path;
    bool goes_on = false;
    for (std::size_t column = 0; column < along.columns; ++column) {
      const double least =
          along.smallest(column, [&](std::size_t part) { return table.smallest(part, envelope, drawn[s].first); });
      const double end = column + 1 == along.columns ? along.left + along.width : along.x(column + 1);
      if (std::isfinite(least))
        path += (goes_on ? 'L' : 'M') + placeText(along.x(column)) + ' ' + placeText(y(least)) + 'H' + placeText(end);
      goes_on = std::isfinite(least);
    }
    inside += "<path fill=\"none\" stroke-width=\"1.3\" stroke=\"" + std::string(drawn[s].second) + "\" d=\"" + path +
              "\"/>\n";
    inside += textOfDrawing(720 + 70 * static_cast<double>(s), bottom + 32, "start", names[s], drawn[s].second);
  }
  inside += lineOf(along.left, y(report.limit), along.left + along.width, y(report.limit), "#c62f3b",
                   " stroke-dasharray=\"4 3\"");
  inside += textOfDrawing(along.left + along.width - 4, y(report.limit) - 4, "end", "limit " + number(report.limit),
                          "#c62f3b");
  return drawing(1080, bottom + 42, "clearances by chainage", inside);
}

} // namespace pcl_bsh::io

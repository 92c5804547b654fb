// SPDX-License-Identifier: BSD-3-Clause
// The numbers of the page; distance_page.html has the page itself.
#include <pcl_bsh/base/counted.h>
#include <pcl_bsh/io/reports/distance_report.h>
#include <pcl_bsh/io/reports/page_text.h>

#include "distance_page.html.h"

#include <array>
#include <utility>

namespace pcl_bsh::io {
namespace {

class DistancePage {
public:
  explicit DistancePage(const DistanceReport& report)
  : report_(report),
    unit_(report.question.unit.empty() ? "the clouds' unit" : plain(report.question.unit)),
    end_(endOf(report)),
    scale_(histogramOf({}, end_, most_bars).end())
  {
  }

  std::string html() const { return rendered("distance_page.html", distance_page_html, contents()); }

private:
  static constexpr std::size_t most_bars = 60, shades = 24, most_dots = 6000, rings = 10;
  static constexpr double bar_left = 70, bar_top = 12, bar_width = 994, bar_height = 140;
  static constexpr Area view_area{6, 6, 1068, 458};

  /// Both histograms end where nearly all distances do: a few outliers should not take the axis for themselves.
  static double endOf(const DistanceReport& report)
  {
    const double p99 = std::fmax(report.input.statistics.percentiles[4], report.obstacle.statistics.percentiles[4]);
    return std::isnan(p99) ? 0.0 : p99;
  }

  static std::string length(double value)
  {
    if (std::isnan(value)) return "\xe2\x80\x93"; // a dash
    return number(value);
  }

  /// The count with its noun; false for a count of 0.
  static Data countedIfAny(std::size_t count, const char* one, const char* many)
  {
    return count > 0 ? Data(counted(count, one, many)) : Data(false);
  }

  Data contents() const
  {
    const std::size_t farther = report_.input.farther() + report_.obstacle.farther();
    const DistanceQuestion& question = report_.question;
    const std::string promise =
        question.surface != nullptr ? question.surfaceToTell()["promise"].get<std::string>() : "";
    Object page = pageAbout(question, question.coordinate_system, question.request.accuracy.text(), promise);
    page.insert(
        {{"unit", unit_},
         {"in", question.unit.empty() ? "" : " " + unit_},
         {"hausdorff", length(report_.hausdorff)},
         {"interval", false},
         {"input_meaning", report_.input.meaning()},
         {"obstacle_meaning", report_.obstacle.meaning()},
         {"pair", false},
         {"max_distance", numberOrNone(question.request.max_distance)},
         {"input_part", report_.input.part},
         {"part", report_.obstacle.part},
         {"farther", countedIfAny(farther, "point has", "points have")},
         {"statistics", statistics()},
         {"sides", List{side(report_.input, report_.obstacle.name), side(report_.obstacle, report_.input.name)}}});
    if (report_.isHausdorffAnInterval())
      page["interval"] = Object{{"lower", length(report_.hausdorff_interval.lower)},
                                {"upper", length(report_.hausdorff_interval.upper)}};
    if (const auto& pair = report_.hausdorff_pair)
      page["pair"] = Object{{"a", std::to_string(pair->a)}, {"b", std::to_string(pair->b)}};
    return page;
  }

  List statistics() const
  {
    const DistanceSide &a = report_.input, &b = report_.obstacle;
    List rows;
    const auto add = [&](const std::string& name, const std::string& of, const std::string& x, const std::string& y) {
      rows.push_back(Object{{"name", name}, {"of", of}, {"input", x}, {"obstacle", y}});
    };
    const auto addLength = [&](const std::string& name, double x, double y) { add(name, unit_, length(x), length(y)); };
    const DistanceStatistics &s = a.statistics, &t = b.statistics;
    const std::string parts =
        std::string(a.part) + (a.part == std::string(b.part) ? "s" : std::string("s, ") + b.part + 's');
    add(parts, "", std::to_string(a.points), std::to_string(b.points));
    add(parts + " with a distance", "", std::to_string(s.count), std::to_string(t.count));
    addLength("mean", s.mean, t.mean);
    addLength("RMS", s.rms, t.rms);
    addLength("median", s.median, t.median);
    for (std::size_t i = 0; i < s.percents.size(); ++i)
      addLength("percentile " + std::to_string(s.percents[i]), s.percentiles[i], t.percentiles[i]);
    addLength("maximum", s.maximum, t.maximum);
    return rows;
  }

  Data side(const DistanceSide& from, const std::string& to) const
  {
    Object side = {{"from", plain(from.name)},
                   {"to", plain(to)},
                   {"parts", std::string(from.part) + 's'},
                   {"points", counted(from.points, from.part)},
                   {"beyond", length(from.beyond)},
                   {"view", from.points > 0 ? view(from) : Data(false)},
                   {"places", places(from)}};
    addHistogram(side, from);
    return side;
  }

  void addHistogram(Object& side, const DistanceSide& from) const
  {
    const DistanceHistogram histogram = histogramOf(from.found.distance, end_, most_bars);
    const std::size_t most = *std::max_element(histogram.counts.begin(), histogram.counts.end());
    const double width = bar_width / static_cast<double>(histogram.counts.size());
    std::string bars, ticks;
    for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
      if (histogram.counts[i] == 0) continue;
      const double height =
          std::max(1.0, bar_height * static_cast<double>(histogram.counts[i]) / static_cast<double>(most));
      bars += "<rect x=\"" + coordinate(bar_left + width * static_cast<double>(i)) + "\" y=\"" +
              coordinate(bar_top + bar_height - height) + "\" width=\"" + coordinate(std::max(1.0, width - 1)) +
              "\" height=\"" + coordinate(height) + "\" fill=\"" +
              colorOf(histogram.width * (static_cast<double>(i) + 0.5)) + "\"/>\n";
    }
    constexpr int tick_count = 5;
    for (int i = 0; i <= tick_count; ++i) {
      const double share = static_cast<double>(i) / tick_count;
      ticks += "<text x=\"" + coordinate(bar_left + bar_width * share) + "\" y=\"168\" text-anchor=\"" +
               (i == 0            ? "start"
                : i == tick_count ? "end"
                                  : "middle") +
               "\">" + number(histogram.end() * share) + "</text>\n";
    }
    side["bars"] = bars;
    side["ticks"] = ticks;
    side["most"] = std::to_string(most);
    side["width"] = number(histogram.width);
    side["above"] = countedIfAny(histogram.above, "point is", "points are");
    side["without"] = countedIfAny(from.farther(), "point has", "points have");
    side["axis_end"] = number(histogram.end());
  }

  /// From pale grey where clouds are one, over orange, to deep red.
  static std::string shade(double share)
  {
    constexpr std::array<std::array<double, 3>, 4> stops = {
        {{176, 190, 205}, {244, 196, 80}, {224, 98, 36}, {140, 8, 38}}};
    return colorBetween(stops, std::clamp(share, 0.0, 1.0));
  }

  std::string colorOf(double distance) const { return shade(distance / scale_); }

  /// The number of the colour of a record, from 0 for near ones. Records without a distance have the last colour.
  std::size_t shadeOf(const DistanceSide& from, std::uint32_t record) const
  {
    const double distance = from.found.distance[record];
    if (std::isnan(distance)) return shades - 1;
    return static_cast<std::size_t>(std::clamp(distance / scale_, 0.0, 1.0) * (shades - 1));
  }

  /// At most most_dots finite records, evenly picked.
  static std::vector<std::uint32_t> shownOf(const DistanceSide& from)
  {
    std::vector<std::uint32_t> finite;
    finite.reserve(from.points);
    for (std::size_t i = 0; i < from.cloud.size(); ++i) {
      if (isFinite(from.cloud.point(from.cloud.record(i)))) finite.push_back(from.cloud.record(i));
    }
    const std::size_t count = std::min(finite.size(), most_dots);
    std::vector<std::uint32_t> shown;
    for (std::size_t i = 0; i < count; ++i) shown.push_back(finite[i * finite.size() / count]);
    return shown;
  }

  Data view(const DistanceSide& from) const
  {
    const std::vector<std::uint32_t> shown = shownOf(from);
    std::vector<Eigen::Vector3d> at;
    Eigen::AlignedBox2d box;
    for (const std::uint32_t record : shown) {
      at.push_back(from.placeOf(record));
      box.extend(at.back().head<2>());
    }
    Eigen::Vector2d size = box.sizes() * 1.04;
    if (!(size.maxCoeff() > 0)) size.setOnes();
    const ViewFromAbove seen{view_area, box.center(), size.cwiseMax(1e-300)};

    std::array<std::string, shades> paths; // far points are drawn over near ones
    for (std::size_t i = 0; i < shown.size(); ++i) {
      paths[shadeOf(from, shown[i])] += 'M' + numberText(seen.x(at[i].x()), std::chars_format::fixed, 1) + ' ' +
                                        numberText(seen.y(at[i].y()), std::chars_format::fixed, 1) + "h2v2h-2z";
    }
    std::string dots, circles, legend;
    for (std::size_t i = 0; i < shades; ++i) {
      const std::string color = shade(static_cast<double>(i) / (shades - 1));
      if (!paths[i].empty()) dots += "<path fill=\"" + color + "\" d=\"" + paths[i] + "\"/>\n";
      legend += "<rect x=\"" + coordinate(570 + 12.5 * static_cast<double>(i)) +
                "\" y=\"478\" width=\"12.5\" height=\"12\" fill=\"" + color + "\"/>\n";
    }
    for (std::size_t i = 0; i < std::min(from.places.size(), rings); ++i) {
      const Eigen::Vector3d p = from.placeOf(from.places[i].point);
      const double x = seen.x(p.x()), y = seen.y(p.y());
      circles += "<circle class=\"closest\" cx=\"" + coordinate(x) + "\" cy=\"" + coordinate(y) +
                 "\" r=\"9\"/><text x=\"" + coordinate(x + 12) + "\" y=\"" + coordinate(y + 4) + "\">" +
                 std::to_string(i + 1) + "</text>\n";
    }
    return Object{{"dots", dots},
                  {"rings", circles},
                  {"legend", legend},
                  {"shown", std::to_string(shown.size())},
                  {"end", number(scale_)},
                  {"scale_width", coordinate(seen.bar * seen.scale)},
                  {"scale_end", coordinate(24 + seen.bar * seen.scale)},
                  {"scale_length", number(seen.bar)}};
  }

  /// Returns the text of the distance of a place. Infinity: there is no point within the greatest distance.
  std::string distanceText(double distance) const
  {
    if (!std::isinf(distance)) return number(distance);
    const double most = report_.question.request.max_distance;
    return std::isinf(most) ? "no point there" : "more than " + number(most);
  }

  Data places(const DistanceSide& from) const
  {
    if (from.places.empty()) return false;
    List rows;
    for (std::size_t i = 0; i < std::min(from.places.size(), most_far_places); ++i) {
      const FarPlace& place = from.places[i];
      const Eigen::Vector3d at = from.placeOf(place.point);
      double size = 0;
      for (std::size_t k = 0; k < 3; ++k) size = std::max(size, place.high[k] - place.low[k]);
      const bool known = place.closest_point != kNothing;
      rows.push_back(Object{{"rank", std::to_string(i + 1)},
                            {"at", coordinates(at)},
                            {"distance", distanceText(place.distance)},
                            {"points", std::to_string(place.records.size())},
                            {"size", number(size, 3)},
                            {"point", std::to_string(place.point)},
                            {"closest_point", known ? std::to_string(place.closest_point) : std::string("none")}});
    }
    const std::size_t more = from.places.size() - std::min(from.places.size(), most_far_places);
    return Object{{"rows", rows}, {"more", more > 0 ? Data(std::to_string(more)) : Data(false)}};
  }

  const DistanceReport& report_;
  const std::string unit_;
  const double end_;   ///< of the histograms' axis, before it is rounded
  const double scale_; ///< where colours end
};

} // namespace

std::string distancePage(const DistanceReport& report)
{
  return DistancePage(report).html();
}

} // namespace pcl_bsh::io

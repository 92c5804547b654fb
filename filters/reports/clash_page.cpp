// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/cloud_files/number_text.h>
#include <pcl_bsh/filters/json/json_document.h>
#include <pcl_bsh/filters/reports/clash_report.h>

#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <string>

namespace pcl_bsh::io {
namespace {

/// Builds the page. Pictures thin out clashes of many points; beyond so many clashes there is only the table.
class ClashPage {
public:
  static constexpr std::size_t most_pictures = 200, most_dots = 500;

  explicit ClashPage(const ClashReport& report) : report_(report) {}

  std::string html() const
  {
    std::ostringstream out;
    out.imbue(std::locale::classic()); // the host's language is not the page's
    out << "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>Clashes: "
        << escaped(report_.input) << "</title>\n<style>" << style << "</style></head>\n<body>\n";
    head(out);
    path(out);
    table(out);
    cards(out);
    out << "</body></html>\n";
    return out.str();
  }

private:
  static constexpr auto style = R"(
:root{--ink:#1c2530;--soft:#667484;--line:#dde3ea;--paper:#fff;--ground:#f4f6f9;--new:#c62f3b;--persisting:#b26a00;--resolved:#2b8a57;--accent:#1f6feb}
*{box-sizing:border-box}
body{margin:0 auto;max-width:1120px;padding:28px 24px 60px;font:15px/1.5 system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;color:var(--ink);background:var(--ground)}
h1{font-size:26px;margin:0 0 4px}h2{font-size:18px;margin:34px 0 10px}
.sub{color:var(--soft);margin:0 0 18px;overflow-wrap:anywhere}
.tiles+.sub{margin-top:12px}
.tiles{display:flex;flex-wrap:wrap;gap:12px}
.tile{background:var(--paper);border:1px solid var(--line);border-radius:10px;padding:10px 18px;min-width:120px}
.tile b{display:block;font-size:22px;font-variant-numeric:tabular-nums}.tile span{color:var(--soft);font-size:13px}
.panel,.card{background:var(--paper);border:1px solid var(--line);border-radius:10px;padding:14px 16px}
table{border-collapse:collapse;width:100%;background:var(--paper);border:1px solid var(--line);font-variant-numeric:tabular-nums}
th,td{padding:6px 12px;text-align:right;border-bottom:1px solid var(--line)}th{color:var(--soft);font-weight:600;font-size:13px}
th:first-child,td:first-child,th:nth-child(2),td:nth-child(2){text-align:left}
a{color:var(--accent);text-decoration:none}
.badge{display:inline-block;border-radius:99px;padding:1px 10px;font-size:12.5px;color:#fff}
.new{background:var(--new)}.persisting{background:var(--persisting)}.resolved{background:var(--resolved)}
.card{margin:14px 0}.card h3{margin:0 0 4px;font-size:16px;display:flex;gap:10px;align-items:center}
.facts{color:var(--soft);margin:0 0 10px}.facts b{color:var(--ink)}
.pictures{display:flex;flex-wrap:wrap;gap:16px}figure{margin:0;flex:1 1 420px}figcaption{color:var(--soft);font-size:13px;margin-top:2px}
svg{width:100%;height:auto;display:block}svg text{font:11px system-ui,"DejaVu Sans",sans-serif;fill:var(--soft)}
.frame{fill:none;stroke:var(--line)}.limit{stroke:var(--new);stroke-dasharray:4 3}.curve{fill:none;stroke:var(--accent);stroke-width:1.5}
@media print{body{background:#fff}.card{break-inside:avoid}})";

  /// Text of files and their names, harmless within an element or a quoted attribute.
  static std::string escaped(const std::string& text)
  {
    std::string safe;
    for (const char c : validUtf8(text)) {
      if (c == '<')
        safe += "&lt;";
      else if (c == '>')
        safe += "&gt;";
      else if (c == '&')
        safe += "&amp;";
      else if (c == '"')
        safe += "&quot;";
      else if (c == '\'')
        safe += "&#39;";
      else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
        safe += "\xef\xbf\xbd"; // HTML knows no control characters
      else
        safe += c;
    }
    return safe;
  }

  /// So many significant digits, and no exponent where that is readable.
  static std::string number(double value, int digits = 4)
  {
    return numberText(value, std::chars_format::general, digits);
  }

  /// A coordinate: millimetres if the unit is a metre.
  static std::string place(double value) { return numberText(value, std::chars_format::fixed, 3); }

  static std::string places(const Eigen::Vector3d& p)
  {
    return place(p.x()) + ", " + place(p.y()) + ", " + place(p.z());
  }

  void tile(std::ostream& out, const std::string& value, const std::string& what) const
  {
    out << "<div class=\"tile\"><b>" << value << "</b><span>" << what << "</span></div>";
  }

  void head(std::ostream& out) const
  {
    const std::size_t resolved = report_.count(ClashStatus::resolved);
    out << "<h1>" << report_.clashes.size() - resolved << " clashes</h1>\n<p class=\"sub\">"
        << escaped(report_.obstacle) << " along " << report_.poses.size() << " poses through " << escaped(report_.input)
        << "</p>\n<div class=\"tiles\">";
    tile(out, number(report_.clearance), "clearance");
    tile(out, std::to_string(report_.found.colliding), "colliding points of the input");
    if (report_.count(ClashStatus::fresh) + report_.count(ClashStatus::persisting) > 0) {
      tile(out, number(report_.clashes.front().distance), "smallest distance");
    }
    if (report_.swept) tile(out, number(*report_.swept), "tolerance, swept");
    tile(out, number(report_.cluster_distance), "points farther apart are two clashes");
    if (report_.previous) {
      for (const auto& [status, name] : status_names) tile(out, std::to_string(report_.count(status)), name);
    }
    out << "</div>\n";
    if (report_.previous) out << "<p class=\"sub\">compared with " << escaped(*report_.previous) << "</p>\n";
  }

  // A drawing's inside: from (left, top), so wide and high.
  struct Area {
    double left, top, width, height;
  };

  /// Pictures are drawn at these coordinates and scaled by the browser.
  static void begin(std::ostream& out, double width, double height, const std::string& label)
  {
    out << "<svg viewBox=\"0 0 " << width << ' ' << height << "\" role=\"img\" aria-label=\"" << label << "\">";
  }

  static void frame(std::ostream& out, const Area& area)
  {
    out << "<rect class=\"frame\" x=\"" << area.left << "\" y=\"" << area.top << "\" width=\"" << area.width
        << "\" height=\"" << area.height << "\"/>";
  }

  static void text(std::ostream& out, double x, double y, const std::string& what, const char* anchor = "start")
  {
    out << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\">" << what << "</text>";
  }

  static void dot(std::ostream& out, double x, double y, const std::string& color, double radius = 2)
  {
    out << "<circle cx=\"" << place(x) << "\" cy=\"" << place(y) << "\" r=\"" << radius << "\" fill=\"" << color
        << "\"/>";
  }

  /// From deep red where clouds touch to pale yellow at the clearance.
  std::string colorOf(double distance) const
  {
    const double share = report_.clearance > 0 ? std::clamp(distance / report_.clearance, 0.0, 1.0) : 0.0;
    const auto mix = [&](int from, int to) { return std::to_string(static_cast<int>(from + share * (to - from))); };
    return "rgb(" + mix(150, 245) + ',' + mix(10, 190) + ',' + mix(40, 66) + ')';
  }

  /// The smallest distance at each pose, infinity where nothing collides. Swept, it is known of each point's closest
  /// pose only.
  std::vector<double> nearestAtPoses() const
  {
    std::vector<double> nearest(report_.poses.size(), std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < report_.found.poses.size(); ++k) nearest[k] = report_.found.poses[k].distance;
    for (const Clash& clash : report_.clashes) {
      for (const std::uint32_t record : clash.records) {
        double& at_pose = nearest[static_cast<std::size_t>(report_.found.closest_pose[record])];
        at_pose = std::min(at_pose, static_cast<double>(report_.found.distance[record]));
      }
    }
    return nearest;
  }

  /// Along the path: the smallest distance at each pose, where it is within the clearance.
  void path(std::ostream& out) const
  {
    const std::vector<double> poses = nearestAtPoses();
    if (poses.size() < 2) return;
    const Area area{54, 12, 1010, 130};
    // No more columns than can be told apart.
    const std::size_t columns = std::min<std::size_t>(poses.size(), 1000);
    out << "<h2>Along the path</h2>\n<div class=\"panel\">";
    begin(out, 1080, 172, "smallest distance along the path");
    frame(out, area);
    const double floor = report_.found.colliding > 0 ? lowest() : 0;
    for (std::size_t c = 0; c < columns; ++c) {
      const std::size_t first = c * poses.size() / columns, last = (c + 1) * poses.size() / columns;
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t k = first; k < last; ++k) nearest = std::min(nearest, poses[k]);
      if (!std::isfinite(nearest)) continue;
      const double share = span(floor) > 0 ? (report_.clearance - nearest) / span(floor) : 1;
      const double height = std::max(2.0, area.height * std::clamp(share, 0.0, 1.0));
      const double width = area.width / static_cast<double>(columns);
      out << "<rect x=\"" << place(area.left + static_cast<double>(c) * width) << "\" y=\"" << area.top << "\" width=\""
          << place(std::max(width, 1.0)) << "\" height=\"" << place(height) << "\" fill=\"" << colorOf(nearest)
          << "\"/>";
    }
    text(out, area.left - 6, area.top + 10, number(report_.clearance, 3), "end");
    text(out, area.left - 6, area.top + area.height, number(floor, 3), "end");
    text(out, area.left, area.top + area.height + 16, "pose 0");
    text(out, area.left + area.width, area.top + area.height + 16, "pose " + std::to_string(poses.size() - 1), "end");
    text(out, area.left + area.width / 2, area.top + area.height + 16,
         "bars hang from the clearance down to the smallest distance of the pose", "middle");
    out << "</svg></div>\n";
  }

  /// Where the scale of distances ends: 0, or below where radii overlap.
  double lowest() const { return std::min(0.0, report_.clashes.front().distance); }
  double span(double floor) const { return report_.clearance - floor; }

  void table(std::ostream& out) const
  {
    if (report_.clashes.empty()) {
      out << "<h2>Nothing collides</h2>\n";
      return;
    }
    out << "<h2>By severity</h2>\n<table><tr><th>clash</th><th>status</th><th>smallest distance</th><th>points</th>"
           "<th>first pose</th><th>closest pose</th><th>size</th></tr>\n";
    std::size_t shown = 0;
    for (const Clash& clash : report_.clashes) {
      const bool card = clash.status != ClashStatus::resolved && shown++ < most_pictures;
      out << "<tr><td>" << (card ? "<a href=\"#" + escaped(clash.id) + "\">" : "") << escaped(clash.id)
          << (card ? "</a>" : "") << "</td><td>" << badge(clash) << "</td><td>" << number(clash.distance) << "</td><td>"
          << clash.points << "</td><td>" << clash.first_pose << "</td><td>" << clash.closest_pose << "</td><td>"
          << number(sizeOf(clash), 3) << "</td></tr>\n";
    }
    out << "</table>\n";
  }

  static std::string badge(const Clash& clash)
  {
    return std::string("<span class=\"badge ") + nameOf(clash.status) + "\">" + nameOf(clash.status) + "</span>";
  }

  /// The longest side of its box.
  static double sizeOf(const Clash& clash)
  {
    double size = 0;
    for (std::size_t k = 0; k < 3; ++k) size = std::max(size, clash.high[k] - clash.low[k]);
    return size;
  }

  void cards(std::ostream& out) const
  {
    std::size_t shown = 0;
    for (const Clash& clash : report_.clashes) {
      if (clash.status == ClashStatus::resolved) continue;
      if (shown++ == 0) out << "<h2>One by one</h2>\n";
      if (shown > most_pictures) {
        out << "<p class=\"sub\">The " << most_pictures << " most severe have pictures; the table lists all.</p>\n";
        return;
      }
      card(out, clash);
    }
  }

  void card(std::ostream& out, const Clash& clash) const
  {
    out << "<section class=\"card\" id=\"" << escaped(clash.id) << "\"><h3>" << escaped(clash.id) << ' ' << badge(clash)
        << "</h3>\n<p class=\"facts\"><b>" << number(clash.distance) << "</b> at the closest, at pose <b>"
        << clash.closest_pose << "</b>, between point " << clash.scan_point << " of the input at ("
        << places(report_.scanPoint(clash)) << ") and point " << clash.model_point << " of the obstacle; <b>"
        << clash.points << "</b> points; first at pose <b>" << clash.first_pose << "</b></p>\n<div class=\"pictures\">";
    out << "<figure>";
    topView(out, clash);
    out << "<figcaption>From above: points by distance, dark red the nearest; the circle is the closest pair."
           "</figcaption></figure>\n<figure>";
    approach(out, clash);
    out << "<figcaption>Closest approach of each point: at which pose, how "
           "near.</figcaption></figure></div></section>\n";
  }

  /// Some of its points, evenly picked.
  template <typename Use>
  static void eachDot(const Clash& clash, const Use& use)
  {
    const std::size_t dots = std::min(clash.records.size(), most_dots);
    for (std::size_t i = 0; i < dots; ++i) use(clash.records[i * clash.records.size() / dots]);
  }

  void topView(std::ostream& out, const Clash& clash) const
  {
    const Area area{6, 6, 508, 268};
    const Eigen::Vector3d model = report_.modelPoint(clash);
    Eigen::AlignedBox2d box(Eigen::Vector2d(clash.low[0], clash.low[1]), Eigen::Vector2d(clash.high[0], clash.high[1]));
    box.extend(model.head<2>());
    const double least = std::max({box.sizes().maxCoeff() * 0.1, report_.cluster_distance, 1e-9});
    const Eigen::Vector2d middle = box.center(), size = box.sizes().array() + least;
    const double scale = std::min(area.width / size.x(), area.height / size.y());
    const auto x = [&](double value) { return area.left + area.width / 2 + scale * (value - middle.x()); };
    const auto y = [&](double value) { return area.top + area.height / 2 - scale * (value - middle.y()); };
    begin(out, 520, 280, "the clash from above");
    frame(out, area);
    eachDot(clash, [&](std::uint32_t record) {
      const Point3 p = report_.scan.point(record);
      dot(out, x(p[0]), y(p[1]), colorOf(static_cast<double>(report_.found.distance[record])));
    });
    const Eigen::Vector3d scan = report_.scanPoint(clash);
    out << "<line x1=\"" << place(x(scan.x())) << "\" y1=\"" << place(y(scan.y())) << "\" x2=\"" << place(x(model.x()))
        << "\" y2=\"" << place(y(model.y())) << "\" stroke=\"#1f6feb\" stroke-width=\"1.5\"/>";
    dot(out, x(model.x()), y(model.y()), "#1f6feb", 2.5);
    out << "<circle cx=\"" << place(x(scan.x())) << "\" cy=\"" << place(y(scan.y()))
        << "\" r=\"8\" fill=\"none\" stroke=\"#1f6feb\" stroke-width=\"1.5\"/>";
    scaleBar(out, area, scale);
    out << "</svg>";
  }

  /// A round length, a fifth of the picture or so.
  static void scaleBar(std::ostream& out, const Area& area, double scale)
  {
    const double wish = area.width / scale / 5;
    const double decade = std::pow(10.0, std::floor(std::log10(wish)));
    const double length = decade * (wish / decade >= 5 ? 5 : wish / decade >= 2 ? 2 : 1);
    const double left = area.left + 10, bottom = area.top + area.height - 10;
    out << "<path d=\"M" << left << ' ' << bottom - 4 << "v4h" << place(length * scale)
        << "v-4\" fill=\"none\" stroke=\"#667484\"/>";
    text(out, left + length * scale + 6, bottom, number(length));
  }

  void approach(std::ostream& out, const Clash& clash) const
  {
    const Area area{54, 10, 456, 236};
    std::int32_t first = clash.closest_pose, last = clash.closest_pose;
    for (const std::uint32_t record : clash.records) {
      first = std::min(first, report_.found.closest_pose[record]);
      last = std::max(last, report_.found.closest_pose[record]);
    }
    const double floor = lowest(), poses = std::max(1, last - first);
    const auto x = [&](double pose) {
      return first == last ? area.left + area.width / 2 : area.left + 6 + (area.width - 12) * (pose - first) / poses;
    };
    const auto y = [&](double distance) {
      const double share = span(floor) > 0 ? (distance - floor) / span(floor) : 0;
      return area.top + area.height - 4 - (area.height - 12) * std::clamp(share, 0.0, 1.0);
    };
    begin(out, 520, 280, "closest approaches along the path");
    frame(out, area);
    const auto limit = y(report_.clearance);
    out << "<line class=\"limit\" x1=\"" << area.left << "\" y1=\"" << limit << "\" x2=\"" << area.left + area.width
        << "\" y2=\"" << limit << "\"/>";
    eachDot(clash, [&](std::uint32_t record) {
      const double distance = static_cast<double>(report_.found.distance[record]);
      dot(out, x(report_.found.closest_pose[record]), y(distance), colorOf(distance));
    });
    out << "<circle cx=\"" << place(x(clash.closest_pose)) << "\" cy=\"" << place(y(clash.distance))
        << "\" r=\"8\" fill=\"none\" stroke=\"#1f6feb\" stroke-width=\"1.5\"/>";
    text(out, area.left - 6, limit + 4, number(report_.clearance, 3), "end");
    text(out, area.left - 6, y(floor) + 2, number(floor, 3), "end");
    const double below = area.top + area.height + 16;
    text(out, x(first), below, std::to_string(first), first == last ? "middle" : "start");
    if (first != last) text(out, x(last), below, std::to_string(last), "end");
    text(out, area.left + area.width / 2, below + 14, "pose", "middle");
    out << "</svg>";
  }

  const ClashReport& report_;
};

} // namespace

std::string clashPage(const ClashReport& report)
{
  return ClashPage(report).html();
}

} // namespace pcl_bsh::io

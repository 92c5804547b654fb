// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/tracks/axis_file.h>

#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <pugixml.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pcl_bsh::io {
namespace {

/// x y in the axis' order: LandXML writes northing before easting.
struct XmlPlace {
  double x, y;
};

class LandXml {
public:
  LandXml(std::string_view text, const AxisSettings& settings, std::vector<std::string>& remarks)
  : text_(text),
    settings_(settings),
    remarks_(remarks)
  {
    const pugi::xml_parse_result parsed = document_.load_buffer(text.data(), text.size());
    if (!parsed)
      throw FormatError(lineAt(parsed.offset) + " is no XML: " + parsed.description(), "export LandXML again");
  }

  AxisDescription read()
  {
    const pugi::xml_node root = document_.child("LandXML");
    if (!root) throw FormatError("has no element LandXML", "export the alignment as LandXML");
    requireMetres(root);
    const pugi::xml_node alignment = chosen(root);
    start_ = attribute(alignment, "staStart", 0.0);
    readPlan(alignment.child("CoordGeom"), alignment);
    readProfile(alignment.child("Profile").child("ProfAlign"));
    readCant(alignment.child("Cant"));
    readEquations(alignment);
    return std::move(axis_);
  }

private:
  std::string lineAt(std::ptrdiff_t offset) const
  {
    const auto end = text_.begin() + std::clamp<std::ptrdiff_t>(offset, 0, static_cast<std::ptrdiff_t>(text_.size()));
    return "line " + std::to_string(1 + std::count(text_.begin(), end, '\n'));
  }

  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& wrong, const std::string& remedy) const
  {
    throw FormatError(lineAt(node.offset_debug()) + ", " + node.name() + ": " + wrong, remedy);
  }

  std::vector<double> numbersOf(const pugi::xml_node& node, std::size_t least) const
  {
    std::vector<double> numbers;
    TextCursor cursor(node.text().get());
    while (cursor.nextLine())
      while (!cursor.line().empty()) {
        const std::string_view word = cursor.word();
        const auto number = numberOf<double>(word);
        if (!number) fail(node, "'" + std::string(word) + "' is no number", "export LandXML again");
        numbers.push_back(*number);
      }
    if (numbers.size() < least)
      fail(node, "has " + std::to_string(numbers.size()) + " numbers, not " + std::to_string(least),
           "export coordinates, not references to points");
    return numbers;
  }

  double attribute(const pugi::xml_node& node, const char* name, std::optional<double> otherwise = std::nullopt) const
  {
    const pugi::xml_attribute found = node.attribute(name);
    if (!found) {
      if (otherwise) return *otherwise;
      fail(node, std::string("has no ") + name, "export LandXML with it");
    }
    const std::string value = found.value();
    if (inSmallLetters(value) == "inf") return INFINITY;
    const auto number = numberOf<double>(value);
    if (!number) fail(node, std::string(name) + "=\"" + value + "\" is no number", "export LandXML again");
    return *number;
  }

  XmlPlace place(const pugi::xml_node& node, const char* name) const
  {
    const pugi::xml_node child = node.child(name);
    if (!child) fail(node, std::string("has no ") + name, "export LandXML with it");
    const std::vector<double> numbers = numbersOf(child, 2);
    return {numbers[1], numbers[0]};
  }

  /// 1 for a turn to the right, -1 for one to the left.
  double turn(const pugi::xml_node& node, const char* name) const
  {
    const std::string rot = node.attribute(name).value();
    if (rot == "cw") return 1.0;
    if (rot == "ccw") return -1.0;
    fail(node, std::string(name) + "=\"" + rot + "\" is no turn", "give cw or ccw");
  }

  void requireMetres(const pugi::xml_node& root) const
  {
    const pugi::xml_node units = root.child("Units").first_child();
    const std::string unit = units.attribute("linearUnit").value();
    if (units && unit != "meter") fail(units, "lengths are in '" + unit + "'", "export LandXML in metres");
  }

  pugi::xml_node chosen(const pugi::xml_node& root) const
  {
    std::vector<pugi::xml_node> all;
    std::string names;
    for (const pugi::xml_node& group : root.children("Alignments"))
      for (const pugi::xml_node& alignment : group.children("Alignment")) {
        if (!settings_.alignment.empty() && settings_.alignment == alignment.attribute("name").value())
          return alignment;
        names += std::string(all.empty() ? "" : ", ") + alignment.attribute("name").value();
        all.push_back(alignment);
      }
    if (all.empty()) throw FormatError("holds no Alignment", "export the alignment, too");
    if (!settings_.alignment.empty())
      throw FormatError("holds no alignment '" + settings_.alignment + "'", "give one of " + names);
    if (all.size() > 1)
      throw FormatError("holds " + std::to_string(all.size()) + " alignments", "choose one of " + names);
    return all.front();
  }

  /// Each element starts where the file says, so that rounding in the file does not add up.
  void readPlan(const pugi::xml_node& plan, const pugi::xml_node& alignment)
  {
    if (!plan) fail(alignment, "has no CoordGeom", "export its geometry");
    for (const pugi::xml_node& node : plan.children()) {
      const std::string name = node.name();
      if (name == "Line")
        addLine(node);
      else if (name == "Curve")
        addCurve(node);
      else if (name == "Spiral")
        addSpiral(node);
      else if (name == "IrregularLine" || name == "Chain")
        fail(node, "is no line, curve or spiral", "export it as such elements");
    }
    if (axis_.plan.empty()) fail(plan, "holds no element", "export its geometry");
  }

  void add(double length, double from, double to, const XmlPlace& start, double dx, double dy)
  {
    axis_.plan.push_back({length, from, to, AxisStart{start.x, start.y, std::atan2(dy, dx)}});
  }

  void addLine(const pugi::xml_node& node)
  {
    const XmlPlace start = place(node, "Start"), end = place(node, "End");
    const double dx = end.x - start.x, dy = end.y - start.y;
    add(std::hypot(dx, dy), 0.0, 0.0, start, dx, dy);
  }

  void addCurve(const pugi::xml_node& node)
  {
    const double right = turn(node, "rot");
    const XmlPlace start = place(node, "Start"), centre = place(node, "Center"), end = place(node, "End");
    const double sx = start.x - centre.x, sy = start.y - centre.y, ex = end.x - centre.x, ey = end.y - centre.y;
    const double radius = std::hypot(sx, sy);
    if (!(radius > 0.0)) fail(node, "its centre is its start", "export the curve again");
    double angle = right * std::atan2(sy * ex - sx * ey, sx * ex + sy * ey); // clockwise from start to end
    if (angle < 0.0) angle += 2.0 * std::numbers::pi;
    add(radius * angle, right / radius, right / radius, start, right * sy, -right * sx);
  }

  void addSpiral(const pugi::xml_node& node)
  {
    const std::string type = node.attribute("spiType").value();
    if (type != "clothoid") fail(node, "spiType=\"" + type + "\" is no clothoid", "export clothoids");
    const double right = turn(node, "rot"), from = attribute(node, "radiusStart"), to = attribute(node, "radiusEnd");
    const XmlPlace start = place(node, "Start"), corner = place(node, "PI");
    add(attribute(node, "length"), right / from, right / to, start, corner.x - start.x, corner.y - start.y);
  }

  void readProfile(const pugi::xml_node& profile)
  {
    for (const pugi::xml_node& node : profile.children()) {
      const std::string name = node.name();
      if (name == "PVI" || name == "ParaCurve") {
        const std::vector<double> numbers = numbersOf(node, 2);
        axis_.grades.push_back({numbers[0] - start_, numbers[1], name == "PVI" ? 0.0 : attribute(node, "length")});
      }
      else if (name == "CircCurve" || name == "UnsymParaCurve") {
        fail(node, "is no symmetric parabola", "export ParaCurve");
      }
    }
  }

  void readCant(const pugi::xml_node& cant)
  {
    if (!cant) return;
    const double gauge = attribute(cant, "gauge", axis_.gauge);
    axis_.gauge = gauge > 10.0 ? 0.001 * gauge : gauge;
    const std::string pivot = cant.attribute("rotationPoint").value();
    const auto known = cantPivotOf(pivot == "center" ? "centre" : pivot == "insideRail" ? "low_rail" : pivot);
    if (known)
      axis_.pivot = *known;
    else if (!pivot.empty() && !settings_.pivot)
      fail(cant, "rotationPoint=\"" + pivot + "\" is not known", "say what cant turns about: low_rail or centre");
    for (const pugi::xml_node& station : cant.children("CantStation")) {
      const double applied = attribute(station, "appliedCant");
      axis_.cants.push_back(
          {attribute(station, "station") - start_, applied == 0.0 ? 0.0 : turn(station, "curvature") * applied});
    }
    if (!settings_.cant_unit && !axis_.cants.empty()) remarks_.push_back("its cant is taken for millimetres");
  }

  void readEquations(const pugi::xml_node& alignment)
  {
    axis_.chainages.push_back({0.0, start_});
    for (const pugi::xml_node& node : alignment.children("StaEquation")) {
      const double at = attribute(node, "staInternal") - start_;
      const Knot last = axis_.chainages.back();
      axis_.chainages.push_back({at, attribute(node, "staBack", last.value + (at - last.at))});
      axis_.chainages.push_back({at, attribute(node, "staAhead")});
    }
    if (axis_.chainages.size() == 1) return;
    const Knot last = axis_.chainages.back(); // an interval says how fast chainage grows behind the jump
    axis_.chainages.push_back({last.at + 1.0, last.value + 1.0});
  }

  std::string_view text_;
  const AxisSettings& settings_;
  std::vector<std::string>& remarks_;
  pugi::xml_document document_;
  AxisDescription axis_;
  double start_ = 0.0;
};

} // namespace

AxisDescription parseLandXml(std::string_view text, const AxisSettings& settings, std::vector<std::string>& remarks)
{
  return LandXml(text, settings, remarks).read();
}

} // namespace pcl_bsh::io

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/clouds/e57/contents.h>
#include <pcl_bsh/io/clouds/las/notes.h>
#include <pcl_bsh/io/clouds/scan_origins_of.h>
#include <pcl_bsh/io/text/parse_number.h>

#include <pugixml.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace pcl_bsh::io {

namespace {

using Kind = E57Value::Kind;

constexpr std::size_t most_values = 256; ///< of a point; files have some twenty

/// Values that are no fields as they stand, and what the cloud calls them.
struct KnownValue {
  const char* name;
  E57Column column;
  const char* field;
};
constexpr std::array known_values = {
    KnownValue{"cartesianX", E57Column::x, ""},
    KnownValue{"cartesianY", E57Column::y, ""},
    KnownValue{"cartesianZ", E57Column::z, ""},
    KnownValue{"cartesianInvalidState", E57Column::state, "cartesianInvalidState"},
    KnownValue{"sphericalRange", E57Column::x, ""},
    KnownValue{"sphericalAzimuth", E57Column::y, ""},
    KnownValue{"sphericalElevation", E57Column::z, ""},
    KnownValue{"sphericalInvalidState", E57Column::state, "sphericalInvalidState"},
    KnownValue{"colorRed", E57Column::red, "red"},
    KnownValue{"colorGreen", E57Column::green, "green"},
    KnownValue{"colorBlue", E57Column::blue, "blue"},
    KnownValue{"nor:normalX", E57Column::normal_x, "normal_x"},
    KnownValue{"nor:normalY", E57Column::normal_y, "normal_y"},
    KnownValue{"nor:normalZ", E57Column::normal_z, "normal_z"},
};

const KnownValue* knownValue(std::string_view name)
{
  const auto* const found = std::find_if(known_values.begin(), known_values.end(),
                                         [&](const KnownValue& known) { return name == known.name; });
  return found == known_values.end() ? nullptr : found;
}

/// A number of the XML; where nothing is said, the default.
template <typename T>
T numberOr(std::string_view text, T otherwise)
{
  constexpr auto blanks = " \t\r\n";
  const std::size_t from = text.find_first_not_of(blanks);
  if (from == std::string_view::npos) return otherwise;
  const auto number = io::numberOf<T>(text.substr(from, text.find_last_not_of(blanks) + 1 - from));
  if (!number) throw FormatError("has XML with '" + std::string(text.substr(0, 40)) + "' in place of a number");
  return *number;
}

double elementOr(const pugi::xml_node& parent, const char* name, double otherwise)
{
  return numberOr<double>(parent.child(name).child_value(), otherwise);
}

template <typename T>
T attributeOr(const pugi::xml_node& node, const char* name, T otherwise)
{
  return numberOr<T>(node.attribute(name).value(), otherwise);
}

E57Value e57ValueOf(const pugi::xml_node& node)
{
  using Limits = std::numeric_limits<std::int64_t>;
  E57Value value;
  value.name = std::string(node.name()).substr(0, 256);
  const std::string type = node.attribute("type").value();
  if (type == "String") return value;
  value.field = value.name;
  std::replace(value.field.begin(), value.field.end(), ':', '_');
  for (const char* taken : {"x", "y", "z", "rgb", scan_field_name})
    if (value.field == taken) value.field += "_2";
  if (isBeamField(value.field)) value.field += "_2";
  if (const KnownValue* const known = knownValue(value.name)) value.column = known->column;
  if (type == "Float") {
    const bool is_single = node.attribute("precision").value() == std::string_view("single");
    value.kind = is_single ? Kind::single_float : Kind::double_float;
    if (node.attribute("minimum") && node.attribute("maximum"))
      value.bounds = {attributeOr(node, "minimum", 0.0), attributeOr(node, "maximum", 0.0)};
    return value;
  }
  value.kind = type == "Integer" ? Kind::integer : Kind::scaled;
  if (type != "Integer" && type != "ScaledInteger")
    throw FormatError("has points with '" + value.name + "', which is no number");
  value.minimum = attributeOr(node, "minimum", Limits::min());
  value.maximum = attributeOr(node, "maximum", Limits::max());
  if (value.maximum < value.minimum) throw FormatError("has '" + value.name + "' with a maximum below its minimum");
  if (value.kind == Kind::scaled) {
    value.scale = attributeOr(node, "scale", 1.0);
    value.offset = attributeOr(node, "offset", 0.0);
    if (!std::isfinite(value.scale) || !std::isfinite(value.offset))
      throw FormatError("has '" + value.name + "' with a scale or an offset that is not finite");
  }
  const auto meant = [&](std::int64_t stored) { return static_cast<double>(stored) * value.scale + value.offset; };
  value.bounds = {meant(value.minimum), meant(value.maximum)};
  return value;
}

/// Whether a scan has all three values of a group: those of the three columns from `first` on whose names have the
/// prefix.
bool isWhole(const E57Scan& scan, std::string_view prefix, E57Column first)
{
  std::size_t count = 0;
  for (const E57Value& value : scan.values) {
    const auto place = static_cast<std::size_t>(value.column) - static_cast<std::size_t>(first);
    if (place < 3 && value.name.starts_with(prefix)) ++count;
  }
  return count >= 3; // four or more: sortValues() refuses a value that is there twice
}

/// The values of a colour that become 0 and 255: these themselves for bytes, else the limits of the scan or, without
/// them, of the value.
std::array<double, 2> colourLimits(const E57Value& value, const pugi::xml_node& limits)
{
  if (value.kind == Kind::integer && value.minimum == 0 && value.maximum == 255) return {0, 255};
  const std::array said = {elementOr(limits, (value.name + "Minimum").c_str(), 0),
                           elementOr(limits, (value.name + "Maximum").c_str(), 0)};
  return said[0] < said[1] ? said : value.bounds.value_or(std::array{0.0, 1.0});
}

/// Decides what each value is for.
void sortValues(E57Scan& scan, const pugi::xml_node& limits)
{
  const bool is_cartesian = isWhole(scan, "cartesian", E57Column::x);
  scan.is_spherical = isWhole(scan, "spherical", E57Column::x) && !is_cartesian;
  if (scan.points > 0 && !is_cartesian && !scan.is_spherical)
    throw FormatError("has points with neither cartesianX, Y, Z nor sphericalRange, Azimuth, Elevation",
                      "export it with three coordinates of each point");
  scan.has_colours = isWhole(scan, "color", E57Column::red);
  scan.has_normals = isWhole(scan, "nor:", E57Column::normal_x);
  const std::string_view coordinates = scan.is_spherical ? "spherical" : "cartesian";
  for (E57Value& value : scan.values) {
    if (value.column == E57Column::none) continue;
    const bool of_place = value.column <= E57Column::state, of_colour = value.column <= E57Column::blue;
    if (of_place ? !value.name.starts_with(coordinates) : of_colour ? !scan.has_colours : !scan.has_normals) {
      if (value.column < E57Column::state) value.kind = Kind::unread;
      value.column = E57Column::none;
      continue;
    }
    value.field = knownValue(value.name)->field;
    if (of_place || !of_colour) continue;
    scan.colour_limits[static_cast<std::size_t>(value.column) - static_cast<std::size_t>(E57Column::red)] =
        colourLimits(value, limits);
    if (value.kind == Kind::integer && value.minimum >= 0 && value.maximum <= 255) value.field.clear(); // rgb has it
  }
  for (const E57Value& value : scan.values)
    for (const E57Value* other = &value + 1; other < scan.values.data() + scan.values.size(); ++other)
      if (value.name == other->name || (value.field == other->field && !value.field.empty()))
        throw FormatError("has points with two values '" + value.name + "'");
}

void readPose(const pugi::xml_node& pose, E57Scan& scan)
{
  scan.has_pose = static_cast<bool>(pose);
  const auto translation = pose.child("translation"), rotation = pose.child("rotation");
  scan.place = {elementOr(translation, "x", 0), elementOr(translation, "y", 0), elementOr(translation, "z", 0)};
  if (!scan.place.allFinite()) throw FormatError("has a pose whose translation is not finite");
  if (!rotation) return;
  scan.turn = {elementOr(rotation, "w", 0), elementOr(rotation, "x", 0), elementOr(rotation, "y", 0),
               elementOr(rotation, "z", 0)};
  if (!(std::abs(scan.turn.norm() - 1) <= 1e-3))
    throw FormatError("has a pose whose quaternion has a length of " + std::to_string(scan.turn.norm()) + ", not 1",
                      "export it again with the scanner's pose, a rotation and a position");
  scan.turn.normalize();
}

E57Scan e57ScanOf(const pugi::xml_node& node)
{
  E57Scan scan;
  const auto points = node.child("points");
  scan.points = attributeOr(points, "recordCount", std::uint64_t{0});
  scan.section_at = attributeOr(points, "fileOffset", std::uint64_t{0});
  for (const auto& value : points.child("prototype").children()) {
    if (value.type() != pugi::node_element) continue;
    if (scan.values.size() == most_values)
      throw FormatError("has points with more than " + std::to_string(most_values) + " values",
                        "export it with fewer values");
    scan.values.push_back(e57ValueOf(value));
  }
  sortValues(scan, node.child("colorLimits"));
  readPose(node.child("pose"), scan);
  return scan;
}

} // namespace

E57Contents parseE57Contents(const std::string& xml)
{
  pugi::xml_document document; // which expands no entities but the five of XML, and follows nothing
  const pugi::xml_parse_result parsed = document.load_buffer(xml.data(), xml.size());
  const auto root = document.child("e57Root");
  if (!parsed || !root)
    throw FormatError(std::string("has XML that cannot be read: ") +
                      (parsed ? "there is no e57Root" : parsed.description()));
  E57Contents contents;
  contents.coordinate_system.definition = root.child("coordinateMetadata").child_value();
  contents.coordinate_system.name = nameOfWkt(contents.coordinate_system.definition);
  for (const auto& scan : root.child("data3D").children()) {
    if (scan.type() != pugi::node_element) continue;
    try {
      contents.scans.push_back(e57ScanOf(scan));
    }
    catch (const FormatError& error) {
      throw FormatError("scan " + std::to_string(contents.scans.size()) + " " + error.what(), error.remedy());
    }
  }
  return contents;
}

} // namespace pcl_bsh::io

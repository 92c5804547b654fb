// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/tracks/axis_file.h>

#include <pcl_bsh/io/files/file_error.h>
#include <pcl_bsh/io/text/file_bytes.h>
#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/io/text/small_letters.h>
#include <pcl_bsh/io/tracks/number_table.h>

#include <pcl_bsh/base/invalid_input.h>

#include <cmath>
#include <numbers>

namespace pcl_bsh::io {
namespace {

constexpr auto forms_of_an_axis =
    "give points as .csv with columns chainage, x, y, z; an alignment of LandXML as .xml; or elements as text";

std::string shortNumber(double value)
{
  return numberText(value, std::chars_format::general, 3);
}

void applySettings(AxisDescription& description, const AxisSettings& settings)
{
  if (settings.gauge) description.gauge = *settings.gauge;
  if (settings.pivot) description.pivot = *settings.pivot;
}

Axis axisOfPoints(std::string_view text, const AxisSettings& settings, std::vector<std::string>& remarks)
{
  const NumberTable table =
      numberTable(text, {{{"chainage", "station"}}, x_column, y_column, z_column, {{"cant"}, false}}, false);
  std::vector<AxisPoint> points;
  for (const std::vector<double>& row : table.rows)
    points.push_back(
        {row[0], {row[1], row[2], row[3]}, std::isnan(row[4]) ? 0.0 : row[4] * settings.cant_unit.value_or(1.0)});
  AxisDescription rest;
  applySettings(rest, settings);
  try {
    Axis axis = settings.fit ? Axis::fitted(points, *settings.fit, rest) : Axis::through(points, rest);
    remarks.push_back(settings.fit
                          ? "its " + std::to_string(axis.description().plan.size()) + " arcs are within " +
                                shortNumber(axis.fit().deviation) + " of its " + std::to_string(points.size()) +
                                " points, the smallest radius is " + shortNumber(axis.smallestRadius())
                          : "its arcs through " + std::to_string(points.size()) + " points are within " +
                                shortNumber(axis.fit().deviation) + " of straight lines between them");
    if (axis.fit().stretch > 0.01)
      remarks.push_back("its length between two points differs from their chainages by " +
                        shortNumber(100 * axis.fit().stretch) + " percent at most: are units and order right?");
    return axis;
  }
  catch (const InvalidInput& error) {
    if (error.index()) table.lines[*error.index()].fail("is no point of an axis: " + error.wrong(), error.remedy());
    throw;
  }
}

/// The unit of angles, in radians.
double angleUnit(std::string_view word)
{
  if (word == "deg") return std::numbers::pi / 180;
  if (word == "gon") return std::numbers::pi / 200;
  if (word == "rad") return 1.0;
  throw FormatError("'" + std::string(word) + "' is no unit of angles", "give deg, gon or rad");
}

CantPivot pivotOf(std::string_view word)
{
  if (const auto pivot = cantPivotOf(word)) return *pivot;
  throw FormatError("cant turns about no '" + std::string(word) + "'", "give low_rail or centre");
}

/// Reads lines of elements; chainages become distances at the end, when the start's is known.
class ElementText {
public:
  explicit ElementText(std::string_view text) : line_(text, '#') {}

  AxisDescription read()
  {
    while (line_.nextLine()) {
      const std::string word(line_.word());
      readLine(word);
      line_.requireEndOfLine();
    }
    if (axis_.plan.empty()) throw FormatError("holds no element", "give lines such as 'straight 100'");
    if (!has_start_) throw FormatError("has no start", "give a line 'start X Y BEARING'");
    axis_.plan.front().start = AxisStart{start_x_, start_y_, std::numbers::pi / 2 - bearing_ * angle_};
    for (GradeChange& grade : axis_.grades) grade.distance -= chainage_;
    for (Knot& cant : axis_.cants) cant.at -= chainage_;
    axis_.chainages.push_back({0.0, chainage_});
    for (const Knot& equation : equations_) {
      const double distance = equation.at - chainage_, passed = distance - axis_.chainages.back().at;
      axis_.chainages.push_back({distance, axis_.chainages.back().value + passed});
      axis_.chainages.push_back({distance, equation.value});
    }
    if (!equations_.empty()) { // a last interval says how fast chainage grows behind the jump
      const Knot last = axis_.chainages.back();
      axis_.chainages.push_back({last.at + 1.0, last.value + 1.0});
    }
    return std::move(axis_);
  }

private:
  double number() { return line_.number<double>(); }
  double curvature()
  {
    const double radius = number();
    if (std::isnan(radius)) line_.fail("has a radius that is no number", "give a length, or inf");
    return radius == 0.0 || std::isinf(radius) ? 0.0 : 1.0 / radius;
  }
  void readLine(const std::string& word)
  {
    if (word == "start") {
      start_x_ = number();
      start_y_ = number();
      bearing_ = number();
      has_start_ = true;
    }
    else if (word == "straight") {
      axis_.plan.push_back({number()});
    }
    else if (word == "arc") {
      const double length = number(), k = curvature();
      axis_.plan.push_back({length, k, k});
    }
    else if (word == "clothoid") {
      const double length = number(), from = curvature(), to = curvature();
      axis_.plan.push_back({length, from, to});
    }
    else if (word == "height") {
      const double at = number(), height = number();
      axis_.grades.push_back({at, height, line_.line().empty() ? 0.0 : number()});
    }
    else if (word == "cant") {
      const double at = number();
      axis_.cants.push_back({at, number()});
    }
    else if (word == "equation") {
      const double at = number();
      equations_.push_back({at, number()});
    }
    else if (word == "chainage") {
      chainage_ = number();
    }
    else if (word == "gauge") {
      axis_.gauge = number();
    }
    else if (word == "angle") {
      angle_ = line_.parseWord(angleUnit);
    }
    else if (word == "pivot") {
      axis_.pivot = line_.parseWord(pivotOf);
    }
    else {
      line_.fail(
          "begins with '" + word.substr(0, 40) + "'",
          "begin it with start, chainage, straight, arc, clothoid, height, cant, equation, gauge, angle or pivot");
    }
  }

  TextCursor line_;
  AxisDescription axis_;
  std::vector<Knot> equations_;
  double start_x_ = 0.0, start_y_ = 0.0, bearing_ = 0.0, chainage_ = 0.0, angle_ = std::numbers::pi / 180;
  bool has_start_ = false;
};

} // namespace

std::optional<CantPivot> cantPivotOf(std::string_view word)
{
  for (const auto& [name, pivot] : cant_pivots)
    if (word == name) return pivot;
  return std::nullopt;
}

AxisDescription parseElements(std::string_view text)
{
  return ElementText(text).read();
}

Axis readAxis(const std::filesystem::path& path, const AxisSettings& settings, std::vector<std::string>* remarks)
{
  const FileBytes file(path);
  const std::string extension = inSmallLetters(path.extension().string());
  std::vector<std::string> found;
  try {
    if (extension == ".csv") {
      Axis axis = axisOfPoints(file.view(), settings, found);
      if (remarks) *remarks = std::move(found);
      return axis;
    }
    if (settings.fit) throw FormatError("holds elements, and arcs are fitted to points alone", "leave the fit out");
    const bool xml = extension == ".xml";
    AxisDescription description = xml ? parseLandXml(file.view(), settings, found) : parseElements(file.view());
    for (Knot& cant : description.cants) cant.value *= settings.cant_unit.value_or(xml ? 0.001 : 1.0);
    applySettings(description, settings);
    Axis axis(description);
    if (axis.fit().gap > 1e-6)
      found.push_back("its elements leave gaps of up to " + shortNumber(axis.fit().gap) + ", the largest at chainage " +
                      numberText(axis.chainage(axis.fit().gap_at), std::chars_format::fixed, 3));
    if (remarks) *remarks = std::move(found);
    return axis;
  }
  catch (const FormatError& error) {
    const bool own = error.remedy() != remedy_for_damage;
    throw files::FileError(path, error.what(), own ? error.remedy() : forms_of_an_axis);
  }
  catch (const InvalidInput& error) {
    const std::string all = error.what();
    const std::size_t end = all.size() - (error.remedy().empty() ? 0 : error.remedy().size() + 2);
    throw files::FileError(path, all.substr(0, end), error.remedy().empty() ? forms_of_an_axis : error.remedy());
  }
}

} // namespace pcl_bsh::io

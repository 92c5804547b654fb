// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/tracks/profile_file.h>

#include <pcl_bsh/io/text/number_text.h>
#include <pcl_bsh/io/text/text_cursor.h>

#include <pcl_bsh/base/counted.h>

#include <algorithm>
#include <cmath>

namespace pcl_bsh::io {
namespace {

using Line = std::vector<SectionPoint>;

constexpr double most_apart = 1e-6; // ends that meet, in the drawing's unit

bool isAt(const SectionPoint& a, const SectionPoint& b)
{
  return std::hypot(a.offset - b.offset, a.height - b.height) <= most_apart;
}

/// A text of groups: a code in one line, its value in the next.
class Dxf {
public:
  explicit Dxf(std::string_view text) : text_(text) {}

  Line outline(std::optional<double>& unit, std::vector<std::string>& remarks)
  {
    if (text_.starts_with("AutoCAD Binary DXF")) throw FormatError("is a binary DXF", "save it as an ASCII DXF");
    while (next()) {
      if (code_ == 9 && value_ == "$INSUNITS" && next()) unit = unitOf(number());
      if (code_ == 2 && value_ == "ENTITIES") readEntities();
    }
    if (others_ > 0) remarks.push_back(counted(others_, "other entity is", "other entities are") + " not read");
    return joined();
  }

private:
  bool readLine(std::string_view& line)
  {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    const std::size_t first = std::min(line.find_first_not_of(" \t\r"), line.size());
    line = line.substr(first, line.find_last_not_of(" \t\r") + 1 - first);
    return true;
  }

  /// The next group.
  bool next()
  {
    std::string_view code;
    if (!readLine(code) || (code.empty() && at_ >= text_.size())) return false;
    const auto number = numberOf<int>(code);
    if (!number) fail("'" + std::string(code.substr(0, 40)) + "' is no group code");
    if (!readLine(value_)) fail("ends within a group");
    code_ = *number;
    return true;
  }

  [[noreturn]] void fail(const std::string& wrong, const std::string& remedy = "save it as an ASCII DXF") const
  {
    throw FormatError("line " + std::to_string(line_) + ": " + wrong, remedy);
  }

  double number() const
  {
    const auto number = numberOf<double>(value_);
    if (!number || !std::isfinite(*number)) fail("'" + std::string(value_.substr(0, 40)) + "' is no finite number");
    return *number;
  }

  static std::optional<double> unitOf(double code)
  {
    return code == 1   ? std::optional(0.0254)
           : code == 2 ? std::optional(0.3048)
           : code == 4 ? std::optional(0.001)
           : code == 5 ? std::optional(0.01)
           : code == 6 ? std::optional(1.0)
                       : std::nullopt;
  }

  /// Groups of the entities, until their section ends.
  void readEntities()
  {
    std::string kind;
    Line line;
    bool closed = false, is_old = false; // an old POLYLINE, whose VERTEX entities follow
    const auto finish = [&] {
      if (line.size() > 1 && closed) line.push_back(line.front());
      if (line.size() > 1) lines_.push_back(line);
      line.clear();
      closed = false;
    };
    while (next()) {
      if (code_ == 0) {
        const bool goes_on = is_old && value_ == "VERTEX";
        if (!goes_on) finish();
        is_old = value_ == "POLYLINE" || goes_on;
        kind = value_;
        if (kind == "ENDSEC") return;
        if (kind == "ARC" || kind == "CIRCLE" || kind == "SPLINE" || kind == "ELLIPSE")
          fail("holds a curve, " + kind, "draw the outline with lines or straight polylines");
        if (kind != "LINE" && kind != "LWPOLYLINE" && kind != "POLYLINE" && kind != "VERTEX" && kind != "SEQEND")
          ++others_;
        continue;
      }
      const bool old_header = kind == "POLYLINE"; // its 10 and 20 are no vertex
      const bool is_outline = kind == "LINE" || kind == "LWPOLYLINE" || kind == "VERTEX";
      if ((kind == "LWPOLYLINE" || old_header) && code_ == 70) closed = std::fmod(std::trunc(number()), 2.0) != 0.0;
      if (!is_outline) continue;
      if (code_ == 10 || (kind == "LINE" && code_ == 11)) line.push_back({number(), 0.0});
      if ((code_ == 20 || (kind == "LINE" && code_ == 21)) && !line.empty()) line.back().height = number();
      if (code_ == 42 && kind != "LINE" && number() != 0.0)
        fail("holds an arc, a bulge of " + std::string(value_), "draw the outline with straight segments");
    }
    fail("ends within its entities");
  }

  /// All lines as one that closes.
  Line joined()
  {
    if (lines_.empty()) throw FormatError("holds no outline", "draw it as LINE, LWPOLYLINE or POLYLINE");
    Line outline = lines_.front();
    lines_.erase(lines_.begin());
    while (!isAt(outline.front(), outline.back())) {
      const auto follows = std::find_if(lines_.begin(), lines_.end(), [&](const Line& line) {
        return isAt(line.front(), outline.back()) || isAt(line.back(), outline.back());
      });
      if (follows == lines_.end())
        throw FormatError("its outline ends at (" + numberText(outline.back().offset) + ", " +
                              numberText(outline.back().height) + "), where no other line begins",
                          "close it");
      if (!isAt(follows->front(), outline.back())) std::reverse(follows->begin(), follows->end());
      outline.insert(outline.end(), follows->begin() + 1, follows->end());
      lines_.erase(follows);
    }
    if (!lines_.empty())
      throw FormatError("holds more than one outline, " + counted(lines_.size(), "line is", "lines are") + " left over",
                        "keep the lines of one closed outline");
    outline.pop_back();
    return outline;
  }

  std::string_view text_, value_;
  std::size_t at_ = 0, line_ = 0, others_ = 0;
  int code_ = 0;
  std::vector<Line> lines_;
};

} // namespace

std::vector<SectionPoint> parseDxf(std::string_view text, std::optional<double>& unit,
                                   std::vector<std::string>& remarks)
{
  return Dxf(text).outline(unit, remarks);
}

} // namespace pcl_bsh::io

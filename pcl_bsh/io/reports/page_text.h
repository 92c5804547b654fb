// SPDX-License-Identifier: BSD-3-Clause
// The parts that all pages share: their head, texts and numbers, and clouds seen from above.
#pragma once

#include <pcl_bsh/io/json/json_document.h>
#include <pcl_bsh/io/reports/report_origin.h>
#include <pcl_bsh/io/text/number_text.h>

#include "drawing_style.css.h"
#include "page_style.css.h"

#include <Eigen/Geometry>
#include <kainjow/mustache.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace pcl_bsh::io {

using Data = kainjow::mustache::data;
using List = kainjow::mustache::list;
using Object = kainjow::mustache::object;

/// Text of files and their names; the template escapes it. HTML has no control characters.
inline std::string plain(const std::string& text)
{
  std::string safe;
  for (const char c : validUtf8(text)) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      safe += "\xef\xbf\xbd"; // U+FFFD
    else
      safe += c;
  }
  return safe;
}

/// Writes so many significant digits, without an exponent where that is readable.
inline std::string number(double value, int digits = 4)
{
  return numberText(value, std::chars_format::general, digits);
}

/// A distance; one below 0 is a depth.
inline std::string distanceText(double distance, int digits = 4)
{
  return distance < 0.0 ? number(-distance, digits) + " deep" : number(distance, digits);
}

/// A coordinate with three decimals: to the millimetre if the unit is a metre.
inline std::string coordinate(double value)
{
  return numberText(value, std::chars_format::fixed, 3);
}

/// The three coordinates of a place.
template <typename Place>
std::string coordinates(const Place& place)
{
  return coordinate(place[0]) + ", " + coordinate(place[1]) + ", " + coordinate(place[2]);
}

/// A colour between stops, which lie evenly apart. @param share from 0 to 1
template <std::size_t stop_count>
std::string colorBetween(const std::array<std::array<double, 3>, stop_count>& stops, double share)
{
  const double at = share * (stop_count - 1.0);
  const auto from = std::min(static_cast<std::size_t>(at), stop_count - 2);
  std::string color;
  for (std::size_t k = 0; k < 3; ++k) {
    const double mixed = std::lerp(stops[from][k], stops[from + 1][k], at - static_cast<double>(from));
    color += (k == 0 ? "rgb(" : ",") + std::to_string(static_cast<int>(mixed));
  }
  return color + ')';
}

/// The greatest of 1, 2 and 5 times a power of ten that is not above the wish. @param wish > 0
inline double roundLength(double wish)
{
  const double decade = std::pow(10.0, std::floor(std::log10(wish)));
  return decade * (wish / decade >= 5 ? 5 : wish / decade >= 2 ? 2 : 1);
}

/// Returns the text, or false for an empty one: the template then leaves its section out.
inline Data textOrNone(const std::string& text)
{
  return text.empty() ? Data(false) : Data(plain(text));
}

/// Returns the number as text, or false where it is not finite.
inline Data numberOrNone(double value)
{
  return std::isfinite(value) ? Data(number(value)) : Data(false);
}

/// Returns the styles of pages and of the drawings on them.
inline std::string pageStyle()
{
  return std::string(page_style_css) + std::string(drawing_style_css);
}

/// Returns the facts that each page states about two clouds and an answer about them.
template <typename Question>
Object pageAbout(const Question& question, const std::string& coordinate_system, const std::string& accuracy,
                 const std::string& promise)
{
  return {{"style", pageStyle()},
          {"input", plain(question.input)},
          {"obstacle", plain(question.obstacle)},
          {"program", reportProgram()},
          {"date", reportDate()},
          {"coordinate_system", textOrNone(coordinate_system)},
          {"accuracy", accuracy},
          {"promise", promise.empty() ? Data(false) : Data(promise)}};
}

inline std::string rendered(const char* name, std::string_view text, const Data& contents)
{
  kainjow::mustache::mustache page{std::string(text)};
  if (!page.is_valid()) throw std::logic_error(std::string(name) + ": " + page.error_message());
  return page.render(contents);
}

/// The inside of a drawing, as the template frames it.
struct Area {
  double left, top, width, height;
};

/// Where points lie in a drawing that looks down on them.
struct ViewFromAbove {
  Area area;
  Eigen::Vector2d middle, size; ///< of what is seen; size > 0
  double scale = std::min(area.width / size.x(), area.height / size.y());
  double bar = roundLength(area.width / scale / 5); ///< the scale bar's length, a fifth of the drawing or so

  double x(double value) const { return area.left + area.width / 2 + scale * (value - middle.x()); }
  double y(double value) const { return area.top + area.height / 2 - scale * (value - middle.y()); }
};

} // namespace pcl_bsh::io

// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/io/text/format_error.h>
#include <pcl_bsh/io/text/length_unit.h>

#include <array>
#include <cmath>
#include <numeric>

namespace pcl_bsh::io {
namespace {

struct Row {
  const char* name;
  std::int64_t metres, parts; ///< one is metres / parts of a metre
};

constexpr std::array rows = {Row{"mm", 1, 1000}, Row{"cm", 1, 100}, Row{"m", 1, 1}, Row{"ft", 381, 1250},
                             Row{"us-ft", 1200, 3937}};

const Row& rowOf(LengthUnit unit)
{
  return rows[static_cast<std::size_t>(unit)];
}

} // namespace

LengthUnit lengthUnitOf(std::string_view text)
{
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (text == rows[i].name) return static_cast<LengthUnit>(i);
  throw FormatError("'" + std::string(text) + "' is no unit", std::string("give ") + length_units);
}

const char* nameOf(LengthUnit unit)
{
  return rowOf(unit).name;
}

std::optional<LengthUnit> lengthUnitOfMetres(double metres)
{
  constexpr double printed = 2e-7; // ft and us-ft differ by ten times as much
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double length = static_cast<double>(rows[i].metres) / static_cast<double>(rows[i].parts);
    if (std::abs(metres - length) <= printed * length) return static_cast<LengthUnit>(i);
  }
  return std::nullopt;
}

LengthScale::LengthScale(LengthUnit from, LengthUnit to)
{
  const std::int64_t times = rowOf(from).metres * rowOf(to).parts, by = rowOf(from).parts * rowOf(to).metres;
  const std::int64_t common = std::gcd(times, by);
  times_ = static_cast<double>(times / common);
  by_ = static_cast<double>(by / common);
}

} // namespace pcl_bsh::io

// SPDX-License-Identifier: BSD-3-Clause
// Units of lengths in files, and the way from one to another.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace pcl_bsh::io {

/// us-ft: the survey foot of the United States, 1200 / 3937 m; ft: the international one, 0.3048 m.
enum class LengthUnit : std::uint8_t { mm, cm, m, ft, us_ft };

inline constexpr auto length_units = "mm, cm, m, ft or us-ft"; ///< as users write them

/// @throws FormatError quoting another text
LengthUnit lengthUnitOf(std::string_view text);

/// The name that lengthUnitOf() reads as this unit.
const char* nameOf(LengthUnit unit);

/// The unit that is so many metres long, to the seven digits that files print at least. None where no unit is so long.
std::optional<LengthUnit> lengthUnitOfMetres(double metres);

/// Converts lengths from one unit to another. A length is multiplied by a whole number, then divided by a whole number.
/// Each of the two steps rounds once, and a division by 1 does not round: 1500 mm are the double 1.5, and 1 mm is the
/// double nearest to 0.001.
class LengthScale {
public:
  LengthScale() = default; ///< all lengths stay as they are
  LengthScale(LengthUnit from, LengthUnit to);

  bool isOne() const noexcept { return times_ == by_; } ///< whether nothing changes
  double operator()(double length) const noexcept { return length * times_ / by_; }

private:
  double times_ = 1.0, by_ = 1.0;
};

} // namespace pcl_bsh::io

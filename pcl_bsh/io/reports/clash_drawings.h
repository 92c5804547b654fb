// SPDX-License-Identifier: BSD-3-Clause
// Drawings of clashes: on pages, and as pictures.
#pragma once

#include <pcl_bsh/io/reports/clash_report.h>

#include <cstddef>
#include <string>

namespace pcl_bsh::io {

inline constexpr std::size_t most_clash_pictures = 200; ///< at most so many clashes have drawings: the most severe

/// Draws the clashes of lists, all by one scale of distances. Borrows the lists.
class ClashDrawings {
public:
  explicit ClashDrawings(const ClashLists& lists);

  double clearance() const noexcept { return clearance_; } ///< the greatest of all obstacles
  double closest() const noexcept { return closest_; }     ///< the smallest distance, infinity without clashes
  double lowest() const noexcept { return lowest_; }       ///< where the scale of distances ends

  /// From deep red where clouds touch to pale yellow at the clearance.
  std::string colorOf(double distance) const;

  /// The place of a distance on a scale, from 0 at lowest(), which is negative where radii overlap, to 1 at the
  /// clearance.
  double shareOf(double distance) const;

  /// The inside of a drawing of 520 x 280: the clash from above. @pre the clash is present, here and below
  std::string topView(const ClashReport& report, const Clash& clash) const;

  /// The inside of a drawing of that size: distances (up) by poses (across).
  std::string approach(const ClashReport& report, const Clash& clash) const;

  /// Both as one SVG document, with a title.
  std::string picture(const ClashReport& report, const Clash& clash, const std::string& title) const;

private:
  template <typename X, typename Y>
  std::string dotsOf(const Clash& clash, const X& x, const Y& y) const;

  double clearance_, closest_, lowest_, range_;
};

} // namespace pcl_bsh::io

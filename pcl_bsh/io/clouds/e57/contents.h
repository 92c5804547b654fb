// SPDX-License-Identifier: BSD-3-Clause
// The XML of an E57 file: which scans there are, how their points are stored, where their scanners stood.
#pragma once

#include <pcl_bsh/io/clouds/systems/coordinate_system.h>

#include <Eigen/Geometry>

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// Values that are read as numbers, and put into the cloud together.
enum class E57Column : std::uint8_t { x, y, z, state, red, green, blue, normal_x, normal_y, normal_z, none };

/// A value of each point of a scan, which has a stream of its own.
struct E57Value {
  enum class Kind : std::uint8_t { integer, scaled, single_float, double_float, unread };

  std::string name;                                 ///< of the file; `nor:normalX` of an extension
  Kind kind = Kind::unread;                         ///< texts and second coordinates are not read
  std::int64_t minimum = 0, maximum = 0;            ///< of integers: what is stored is the integer less `minimum`
  double scale = 1, offset = 0;                     ///< of scaled integers
  std::optional<std::array<double, 2>> bounds = {}; ///< least and greatest number; none: a float without limits
  E57Column column = E57Column::none;
  std::string field = {}; ///< the cloud's; empty: none

  bool isInteger() const noexcept { return kind == Kind::integer || kind == Kind::scaled; }
  std::uint64_t range() const noexcept
  {
    return static_cast<std::uint64_t>(maximum) - static_cast<std::uint64_t>(minimum);
  }

  /// Bits stored for each point; 0: all values are `minimum`, or are not read.
  unsigned bits() const noexcept
  {
    if (isInteger()) return static_cast<unsigned>(std::bit_width(range()));
    return kind == Kind::single_float ? 32 : kind == Kind::double_float ? 64 : 0;
  }
};

struct E57Scan {
  std::uint64_t points = 0;
  std::uint64_t section_at = 0; ///< physical offset in the file
  std::vector<E57Value> values; ///< in the order of their streams
  bool is_spherical = false, has_colours = false, has_normals = false, has_pose = false;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity(); ///< from the scanner's frame to the common one
  Eigen::Vector3d place = Eigen::Vector3d::Zero();          ///< of the scanner
  std::array<std::array<double, 2>, 3> colour_limits{};     ///< what 0 and 255 stand for, of red, green, blue
};

struct E57Contents {
  std::vector<E57Scan> scans;
  CoordinateSystem coordinate_system; ///< its WKT, and the name in it
};

/// @throws FormatError naming the scan
E57Contents parseE57Contents(const std::string& xml);

} // namespace pcl_bsh::io

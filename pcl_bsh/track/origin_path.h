// SPDX-License-Identifier: BSD-3-Clause
// Where a scanner that moves was at which time.
//
//   const OriginPath path({{0.0, {0, 0, 2}}, {10.0, {150, 0, 2}}});
//   if (const auto origin = path.at(time_of_point)) use(*origin);
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/hierarchy/points_view.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// A place of a scanner. Times are in the unit of the points' times.
struct TimedOrigin {
  double time = 0.0;
  Point3 at = {};
};

/// A scanner's places by time; it goes straight, at constant speed, from one to the next. Never changes.
class OriginPath {
public:
  /// @throws InvalidInput, with the number of the place as its index: fewer than two, a value that is not finite, times
  ///   that do not rise
  explicit OriginPath(std::vector<TimedOrigin> places);

  double from() const { return places_.front().time; } ///< the first time
  double to() const { return places_.back().time; }    ///< the last one

  /// The scanner's place at a time. None before the first time, after the last one, and for NaN.
  std::optional<Point3> at(double time) const;

private:
  std::vector<TimedOrigin> places_;
};

/// Where records of points hold the time at which they were measured.
struct TimeField {
  std::size_t offset = 0; ///< bytes from a record's start
  Scalar scalar = Scalar::float64;
};

/// Points whose time is before or after all times of a path.
struct OutsidePath {
  std::size_t points = 0;
  std::uint64_t first = 0; ///< the number of the first one
  double time = 0.0;       ///< its time
};

/// Where the scanner was for each point; NaN where the path has no place at the point's time.
/// @param first_record number in the whole scan of the view's record 0 @param outside such points are added to it
std::vector<Point3> originsOf(const PointsView& points, const TimeField& field, const OriginPath& path,
                              std::uint64_t first_record, OutsidePath& outside);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

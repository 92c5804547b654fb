// SPDX-License-Identifier: BSD-3-Clause
// Coordinates from one system to another, by PROJ.
#pragma once

#include <pcl_bsh/geometry/point3.h>
#include <pcl_bsh/io/clouds/systems/coordinate_system.h>
#include <pcl_bsh/io/text/length_unit.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace pcl_bsh::io {

/// One operation of PROJ's for a whole cloud: the best for the middle of its box whose grids are there. No grid is
/// fetched, and no rough ("ballpark") operation is taken. x is east and y is north (or the longitude and the latitude).
/// Heights are transformed where both systems have heights. Elsewhere they stay, in the unit of the target's places.
class SystemTransform {
public:
  /// @param to a projected system, as coordinateSystemNamed() takes it
  /// @param box of the cloud's finite points, in `from`; empty where it has none
  /// @param told unit of its lengths, as its file names it
  /// @throws FormatError where PROJ does not know a system; for a target without lengths; where no operation leads
  ///   there, or a grid is missing for each; where `told` is not the unit of `from`
  SystemTransform(const CoordinateSystem& from, const std::string& to, const Eigen::AlignedBox3d& box,
                  std::optional<LengthUnit> told);
  ~SystemTransform();
  SystemTransform(const SystemTransform&) = delete;
  SystemTransform& operator=(const SystemTransform&) = delete;

  const CoordinateSystem& target() const noexcept { return target_; }
  LengthUnit unit() const noexcept { return unit_; } ///< of x y z, transformed

  /// Whether both systems are one: nothing changes.
  bool isIdentity() const noexcept { return !proj_; }

  /// Remarks for users: the operation and its accuracy, a better one whose grid is missing, heights, the scale of
  /// the projection at the middle of the box. None of an identity.
  const std::vector<std::string>& remarks() const noexcept { return remarks_; }

  /// Transforms places; those that are not finite stay. @param first the number of the first, for errors
  /// @throws FormatError naming a record that PROJ cannot transform
  void operator()(std::span<Point3> places, std::uint64_t first) const;

private:
  struct Proj;

  std::unique_ptr<const Proj> proj_; ///< null where nothing changes
  CoordinateSystem target_;
  LengthUnit unit_ = LengthUnit::m;
  double height_scale_ = 1.0;
  std::vector<std::string> remarks_;
};

} // namespace pcl_bsh::io

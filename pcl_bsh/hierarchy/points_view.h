// SPDX-License-Identifier: BSD-3-Clause
// The caller's points, seen in place: any array of records that holds x, y, z as float32 or float64.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/geometry/point3.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The type of coordinates.
enum class Scalar : std::uint8_t { float32, float64 };

struct TrianglesView;

/// A read-only view of `count` records. Records need not be aligned. The memory must stay unchanged while anything that
/// was built on it is in use, since exact decisions return to the original coordinates. It must outlive that, or
/// `owner` must keep it alive: a hierarchy holds its view, and with it the owner.
struct PointsView {
  const void* data = nullptr;                    ///< first byte of record 0; may be null only when count is 0
  std::size_t count = 0;                         ///< records; at most 2^31 - 1, so that pcl::Indices can name them
  std::size_t stride = 0;                        ///< bytes from one record to the next
  std::array<std::size_t, 3> offset = {0, 0, 0}; ///< bytes from a record's start to its x, y, z
  Scalar scalar = Scalar::float32;
  const std::int32_t* indices = nullptr;       ///< optional subset (restrictTo()): only these records are points
  std::size_t index_count = 0;                 ///< length of `indices`; ignored when that is null
  const float* radii = nullptr;                ///< optional, one per record (not per index): finite and >= 0
  std::shared_ptr<const void> owner = nullptr; ///< optional: keeps alive whatever the pointers here point to

  /// How far each point may truly be from where it was measured, in the clouds' unit; finite and >= 0. Queries that
  /// give verdicts then say what is so wherever the points truly are; distances are those of the measured places.
  double uncertainty = 0.0;
  const float* uncertainties = nullptr; ///< optional, one per record, added to `uncertainty`; finite and >= 0

  /// Optional: the triangles that are the records; points and radii are then balls that hold them (triangles_view.h).
  const TrianglesView* triangles = nullptr;
  double off_middle = 0.0; ///< how far such a ball's middle may be from its triangle, by rounding

  /// Only these records are points; none where there are no records, wherever the pointer points to.
  void restrictTo(const std::int32_t* records, std::size_t record_count) noexcept
  {
    static constexpr std::int32_t kNone = 0; // for null means all
    indices = record_count == 0 ? &kNone : records;
    index_count = record_count;
  }

  /// Whether records are balls. The balls of triangles are not records: they only bound them.
  bool areBalls() const noexcept { return radii && !triangles; }

  /// How many points the view names (a subset counts its indices).
  std::size_t size() const noexcept { return indices ? index_count : count; }

  /// The record of the i-th point, 0 <= i < size().
  std::uint32_t record(std::size_t i) const noexcept
  {
    return indices ? static_cast<std::uint32_t>(indices[i]) : static_cast<std::uint32_t>(i);
  }

  /// Coordinates of a record, as given.
  Point3 point(std::uint32_t record) const noexcept
  {
    const auto* base = static_cast<const unsigned char*>(data) + stride * record;
    Point3 p;
    for (std::size_t k = 0; k < 3; ++k) {
      if (scalar == Scalar::float32) {
        float value;
        std::memcpy(&value, base + offset[k], sizeof value);
        p[k] = value;
      }
      else {
        std::memcpy(&p[k], base + offset[k], sizeof(double));
      }
    }
    return p;
  }

  double radius(std::uint32_t record) const noexcept
  {
    return radii ? radii[record] : 0.0;
  } ///< 0 where points have none

  /// How far a record reaches beyond its point or its triangle: 0 for triangles, whose ball only bounds them.
  double ownRadius(std::uint32_t record) const noexcept { return triangles ? 0.0 : radius(record); }

  bool isUncertain() const noexcept { return uncertainty > 0.0 || uncertainties; } ///< some verdicts may be undecided

  /// The uncertainty of a record beside `uncertainty`, which all share.
  double ownUncertainty(std::uint32_t record) const noexcept { return uncertainties ? uncertainties[record] : 0.0; }
};

/// View of `count` float32 points, x y z in a row, `stride` bytes apart.
inline PointsView viewOf(const float* xyz, std::size_t count, std::size_t stride = 3 * sizeof(float)) noexcept
{
  return {xyz, count, stride, {0, sizeof(float), 2 * sizeof(float)}, Scalar::float32};
}

/// View of `count` float64 points, x y z in a row, `stride` bytes apart.
inline PointsView viewOf(const double* xyz, std::size_t count, std::size_t stride = 3 * sizeof(double)) noexcept
{
  return {xyz, count, stride, {0, sizeof(double), 2 * sizeof(double)}, Scalar::float64};
}

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

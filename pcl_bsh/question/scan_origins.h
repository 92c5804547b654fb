// SPDX-License-Identifier: BSD-3-Clause
// The places where the scanners of an input stood.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/question/uncertainty.h>

#include <array>
#include <string>
#include <string_view>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

struct ScanBeams;

/// One origin for all points, or a table of them by a number that each point has in a field. In the input's frame.
struct ScanOrigins {
  /// The origin of one scan.
  struct Entry {
    double scan = 0.0;         ///< the number; of no meaning without a field
    Point3 origin = {0, 0, 0}; ///< where its scanner stood
    bool operator==(const Entry& other) const { return scan == other.scan && origin == other.origin; } ///< alike
  };

  std::string field;          ///< empty: there is one scan
  std::vector<Entry> entries; ///< empty: it is not known

  bool empty() const noexcept { return entries.empty(); } ///< nothing is known
  /// Whether both say the same.
  bool operator==(const ScanOrigins& other) const { return field == other.field && entries == other.entries; }

  static ScanOrigins of(const Point3& origin) { return {{}, {{0.0, origin}}}; } ///< one for all

  /// `X,Y,Z`, or `FIELD:N=X,Y,Z;N=X,Y,Z;...`; empty: not known. @throws InvalidInput quoting the text
  static ScanOrigins parse(const std::string& text);
  std::string text() const; ///< what parse() reads
};

/// The fields of a record without coordinates that tell the direction of a beam without a return, in the cloud's frame.
/// Any length but 0 is a direction.
inline constexpr std::array<std::string_view, 3> beam_field_names = {"beam_x", "beam_y", "beam_z"};

/// The scans of a cloud. @param view with uncertainties, which shorten beams. @param cloud its name in errors
/// @param misses_beyond ScanBeams::misses_beyond of all; 0: beams without a return say nothing
/// @throws InvalidInput when there is no origin, a field that is missing or holds several numbers a point, and for the
///   first point whose scan has no origin; where a range is given, and there are no fields of directions
std::vector<ScanBeams> scansOf(const PointsView& view, const std::vector<RecordField>& fields, const std::string& cloud,
                               const ScanOrigins& origins, double misses_beyond = 0.0);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

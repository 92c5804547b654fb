// SPDX-License-Identifier: BSD-3-Clause
// Which points of a cloud do not count: the floor under a machine, say. Nothing collides with them, and nothing has a
// distance from them. Their beams have seen what they saw, and the density guard knows them as neighbours.
//
//   question.ignore_points = IgnoredPoints::parse("classification=2,9;plane=0,0,1,0.12,0.03");
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/question/uncertainty.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// Points that meet any of these terms. Coordinates are in the cloud's frame and unit.
struct IgnoredPoints {
  /** By a field, by place, or one by one. */ enum class Kind : std::uint8_t { values, box, plane, mask };
  /// Points of some values, in a box, near a plane, or marked.
  struct Term {
    Kind kind = Kind::values;
    std::string field; ///< of values; the file of a mask
    /// Values of the field. A box has its least x, y, z, then the greatest, inclusive. A plane has nx, ny,
    /// nz, d and t: points with |n p - d| <= t |n|, as double computes it.
    std::vector<double> numbers;
    std::shared_ptr<const std::vector<std::uint8_t>> mask =
        nullptr; ///< one a record, not 0: it does not count; null: not read

    std::string text() const; ///< as parse() reads it
    /** All members. */ bool operator==(const Term& other) const
    {
      return kind == other.kind && field == other.field && numbers == other.numbers &&
             (mask == other.mask || (mask && other.mask && *mask == *other.mask));
    }
  };

  std::vector<Term> terms;

  bool empty() const noexcept { return terms.empty(); } ///< all points count
  /** All terms. */ bool operator==(const IgnoredPoints& other) const { return terms == other.terms; }

  /// `FIELD=N,N;box=X,Y,Z,X,Y,Z;plane=NX,NY,NZ,D,T;mask=FILE`, in any order and number; empty: none. Files are not
  /// read (io::readMasks()). A field of the name `mask` has numbers behind it, a file has not.
  /// @throws InvalidInput quoting the text
  static IgnoredPoints parse(const std::string& text);
  std::string text() const; ///< what parse() reads
};

/// The points of a cloud that count.
struct CountedPoints {
  std::vector<std::int32_t> records; ///< that count, in the view's order
  std::vector<std::size_t> ignored;  ///< how many each term ignores; a point counts for the first term that it meets
  std::size_t all = 0;               ///< how many are ignored
};

/// @param fields of the view's records. @param cloud its name in errors
/// @throws InvalidInput for a field that is missing or holds several numbers a point, and for a mask that is not read
///   or has another number of records. A value, box, plane or mask that ignores no point is refused, too: no point
///   meets it, or earlier terms ignore all that do
CountedPoints countedPoints(const PointsView& view, const std::vector<RecordField>& fields, const std::string& cloud,
                            const IgnoredPoints& ignored);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

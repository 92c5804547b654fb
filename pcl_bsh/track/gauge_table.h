// SPDX-License-Identifier: BSD-3-Clause
// A gauging run by chainage: the smallest clearances of each part of the axis, and where they are too small.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/track/gauge.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// The sides of an envelope, as Envelope::aroundOf() divides them.
enum class Sector : std::uint8_t { left, above, right, below };

/// Cells of each sector of an envelope.
inline constexpr std::size_t cells_of_sector = 12;
/// Cells of all four sectors.
inline constexpr std::size_t cells_around = 4 * cells_of_sector;

/// Smallest clearances in parts of an axis, gathered batch by batch. A part or a sector without points has no data, and
/// is not clear.
class GaugeTable {
public:
  /// @param step length of a part; the last one may be shorter
  /// @throws InvalidInput when it is no length, or makes more than 10^7 parts times envelopes
  GaugeTable(const Axis& axis, std::size_t envelopes, double step);

  /// Takes the answer of gauge() for some points. @param envelopes the same each time
  void add(const GaugedPoints& found, const std::vector<Envelope>& envelopes);

  /// Merges what several processes have gathered. Each process calls it, and then holds the table of all.
  /// @param all takes this process' vector, and returns the vectors of all processes, one after the other
  template <class All>
  void join(const All& all)
  {
    const std::vector<std::size_t> points = all(points_);
    const std::vector<double> cells = all(cells_);
    std::fill(points_.begin(), points_.end(), 0);
    for (std::size_t i = 0; i < points.size(); ++i) points_[i % points_.size()] += points[i];
    for (std::size_t i = 0; i < cells.size(); ++i)
      cells_[i % cells_.size()] = std::min(cells_[i % cells_.size()], cells[i]);
  }

  /// How many parts the axis has.
  std::size_t parts() const { return points_.size(); }
  /// Distance along the axis where a part begins.
  double from(std::size_t part) const { return step_ * static_cast<double>(part); }
  /// Distance where it ends.
  double to(std::size_t part) const { return std::min(length_, step_ * static_cast<double>(part + 1)); }
  /// Points that have their place in a part.
  std::size_t points(std::size_t part) const { return points_[part]; }
  /// The part that a distance along the axis is in.
  std::size_t partOf(double distance) const;

  /// The smallest clearance in a cell, 0 <= around < cells_around; infinity where there is no data.
  double cell(std::size_t part, std::size_t envelope, std::size_t around) const
  {
    return cells_[(part * envelopes_ + envelope) * cells_around + around];
  }
  /// The smallest clearance of a sector; infinity where there is no data.
  double smallest(std::size_t part, std::size_t envelope, Sector sector) const;
  /// The smallest clearance of all sectors.
  double smallest(std::size_t part, std::size_t envelope) const;

private:
  double length_, step_;
  std::size_t envelopes_;
  std::vector<std::size_t> points_;
  std::vector<double> cells_;
};

/// A point that is too near, or inside.
struct Infringing {
  Point3 at = {};
  std::uint64_t record = 0; ///< of the whole scan
  AxisPlace place = {};
  double clearance = 0.0;
  std::int32_t envelope = -1; ///< its number in its track
  std::uint32_t track = 0;    ///< its number, where there are several
};

/// Points too near to one track that lie together.
struct Infringement {
  Infringing worst;                 ///< the smallest clearance, of equal ones the first record
  double from = 0.0, to = 0.0;      ///< distances along the axis
  std::vector<std::size_t> members; ///< numbers in the list
};

/// Appends points whose clearance is at most `limit` to the list.
/// @param first_record number in the whole scan of the view's record 0
/// @param track number of the track that was gauged
void addInfringing(const PointsView& points, const GaugedPoints& found, double limit, std::uint64_t first_record,
                   std::vector<Infringing>& list, std::uint32_t track = 0);

/// Clusters of each track's points whose neighbours are `distance` apart at most, the worst first, of equal ones that
/// of the first track. @throws InvalidInput as euclideanClusters()
std::vector<Infringement> infringementsOf(const std::vector<Infringing>& list, double distance);

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

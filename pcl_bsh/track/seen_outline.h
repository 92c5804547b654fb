// SPDX-License-Identifier: BSD-3-Clause
// Which parts of an envelope's outline a moving scanner has seen: the cells that a beam crossed.
//
//   SeenOutline seen(axis, envelopes, {1.0, 0.1});
//   seen.add(points, origins, {});                    // a beam from each origin to its point
//   if (seen.share(part, 0, Sector::left) == 0.0) tell(part); // no beam passed there: it is not clear
//
// A beam is free from its origin up to its return. Where it crosses the outline, nothing was at that time. The outline
// along the axis is a surface, which is cut into cells. Their edges are at most as long as the spacing, along the axis
// and round the profile as it is before it widens. A thing that fills a whole cell stops all beams there, so it fills
// no cell that a beam crossed. A thing that reaches into the envelope over a square of twice the spacing fills one.
//
// Nothing is said of things that reach in between beams of one cell, or that float inside and touch no outline.
#pragma once

#include <pcl_bsh/export.h>
#include <pcl_bsh/hierarchy/points_view.h>
#include <pcl_bsh/track/gauge_table.h>

#include <cstddef>
#include <cstdint>
#include <vector>

PCL_BSH_EXPORT_BEGIN
namespace pcl_bsh {

/// How an outline is divided.
struct SeenCells {
  double step = 1.0;    ///< length of a part of the axis, as GaugeTable has it
  double spacing = 0.1; ///< the longest edge of a cell
};

/// The cells of envelopes' outlines that beams crossed, gathered batch by batch.
class SeenOutline {
public:
  /// @throws InvalidInput where the spacing is no length > 0, or makes more than 2^33 cells
  SeenOutline(const Axis& axis, const std::vector<Envelope>& envelopes, const SeenCells& cells);

  /// Takes a beam for each point. A beam counts at the nearest place of the axis, where that is within reach. It does
  /// not count where its origin has no place. The cells do not depend on the number of threads.
  /// @param origins one per point of the view, NaN where it has none
  void add(const PointsView& points, const std::vector<Point3>& origins, const GaugeRequest& request);

  /// Merges the cells that several processes have gathered. Each process calls it, with `all` as GaugeTable::join()
  /// takes it.
  template <class All>
  void join(const All& all)
  {
    std::vector<std::uint8_t> bits((crossed_.size() + 7) / 8);
    for (std::size_t cell = 0; cell < crossed_.size(); ++cell)
      if (crossed_[cell]) bits[cell / 8] = static_cast<std::uint8_t>(bits[cell / 8] | 1U << cell % 8);
    const std::vector<std::uint8_t> of_all = all(bits);
    for (std::size_t i = 0; i < of_all.size(); ++i)
      for (std::size_t bit = 0; bit < 8; ++bit)
        if ((of_all[i] >> bit & 1U) != 0) crossed_[i % bits.size() * 8 + bit] = true;
  }

  /// The share of a sector's cells that beams crossed, in a part of the axis; NaN where the outline has none there.
  double share(std::size_t part, std::size_t envelope, Sector sector) const;
  /// The share of the cells of all four sectors.
  double share(std::size_t part, std::size_t envelope) const;
  /// Whether a sector of the outline has cells in a part, and none was crossed.
  bool isUnseen(std::size_t part, std::size_t envelope) const;

  std::size_t rows() const { return rows_; } ///< of cells along the axis
  std::size_t columns(std::size_t envelope) const { return outlines_[envelope].columns.size(); } ///< of cells round it
  /** Whether a beam crossed it. */ bool isCrossed(std::size_t envelope, std::size_t row, std::size_t column) const
  {
    return crossed_[cellOf(outlines_[envelope], row, column)];
  }
  /// The middle of a cell.
  AxisPlace middleOf(std::size_t envelope, std::size_t row, std::size_t column) const;

private:
  struct Column {
    std::size_t edge;
    double share; ///< of the edge, up to the column's middle
    Sector sector;
  };
  struct Outline {
    std::vector<Column> columns;
    std::vector<std::size_t> first; ///< the first column of each edge, and the number of all
    std::size_t begin;              ///< number of its first cell among the cells of all outlines
  };
  class Beams;

  static std::size_t cellOf(const Outline& outline, std::size_t row, std::size_t column)
  {
    return outline.begin + row * outline.columns.size() + column;
  }
  template <class Counts>
  double shareOf(std::size_t part, std::size_t envelope, const Counts& counts) const;

  Axis axis_;
  std::vector<Envelope> envelopes_;
  double edge_;      ///< of a cell along the axis
  double tolerance_; ///< how far off a crossing is placed
  std::size_t rows_of_part_, rows_;
  std::vector<Outline> outlines_;
  std::vector<bool> crossed_;
};

} // namespace pcl_bsh
PCL_BSH_EXPORT_END

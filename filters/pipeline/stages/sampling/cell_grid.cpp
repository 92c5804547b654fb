// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/filters/pipeline/stages/sampling/cell_grid.h>

#include <pcl_bsh/base/plain_text.h>
#include <pcl_bsh/clashes/extent.h>

#include <boost/sort/spreadsort/integer_sort.hpp>

#include <algorithm>
#include <utility>

namespace pcl_bsh::pipeline {
namespace {

constexpr double float_counts_to = 16777216;          // 2^24
constexpr double double_counts_to = 9007199254740992; // 2^53

std::int64_t floorOf(double coordinate, double edge, bool in_float)
{
  if (!in_float) return static_cast<std::int64_t>(std::floor(coordinate / edge));
  const float inverse = 1.0F / static_cast<float>(edge);
  return static_cast<std::int64_t>(std::floor(static_cast<float>(coordinate) * inverse));
}

std::string sizeOf(const Cell& cells)
{
  return plainText(cells[0], " x ", cells[1], " x ", cells[2]);
}

} // namespace

CellGrid::CellGrid(const PointsView& points, const Numbers<3>& edge, std::string option)
: edge_(edge),
  option_(std::move(option))
{
  const auto [least, most] = extentOf(points).value_or(Extent());
  double farthest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    farthest = std::max({farthest, std::abs(least[k] / edge[k]), std::abs(most[k] / edge[k])});
  }
  if (!(farthest < double_counts_to)) {
    refuse("cells of this size cannot be counted from the origin to these points: give larger "
           "ones, or move the cloud to the origin");
  }
  in_float_ = points.scalar == Scalar::float32 && farthest < float_counts_to;
  least_ = cellOf(least);
  most_ = cellOf(most);
}

Cell CellGrid::cellOf(const Point3& p) const
{
  return {floorOf(p[0], edge_[0], in_float_), floorOf(p[1], edge_[1], in_float_), floorOf(p[2], edge_[2], in_float_)};
}

Point3 CellGrid::centreOf(const Cell& cell) const
{
  Point3 centre;
  for (std::size_t k = 0; k < 3; ++k) centre[k] = (static_cast<double>(cell[k]) + 0.5) * edge_[k];
  return centre;
}

SortedCells::SortedCells(const PointsView& points, const CellGrid& grid)
{
  Cell cells;
  long double total = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    cells[k] = grid.most()[k] - grid.least()[k] + 1;
    total *= static_cast<long double>(cells[k]);
  }
  if (total > 9.2e18L) {
    grid.refuse("a grid of " + sizeOf(cells) + " cells is too large to be numbered: give larger cells");
  }
  constexpr long double narrow_counts_to = 4294967296; // 2^32
  if (total > narrow_counts_to) entries_.emplace<std::vector<WideEntry>>();

  const auto numberOf = [&](const Cell& cell) {
    return static_cast<std::uint64_t>(cell[0] - grid.least()[0] +
                                      cells[0] * (cell[1] - grid.least()[1] + cells[1] * (cell[2] - grid.least()[2])));
  };
  std::visit(
      [&](auto& entries) {
        entries.reserve(points.count);
        for (std::uint32_t i = 0; i < points.count; ++i) {
          const Point3 p = points.point(i);
          if (isFinite(p)) entries.emplace_back(numberOf(grid.cellOf(p)), i);
        }
        boost::sort::spreadsort::integer_sort(
            entries.begin(), entries.end(), [](const auto& entry, unsigned shift) { return entry.cell() >> shift; },
            [](const auto& a, const auto& b) { return a.cell() < b.cell(); });
      },
      entries_);
}

std::size_t SortedCells::count() const
{
  return std::visit(
      [](const auto& entries) {
        std::size_t cells = entries.empty() ? 0 : 1;
        for (std::size_t i = 1; i < entries.size(); ++i) cells += entries[i].cell() != entries[i - 1].cell() ? 1 : 0;
        return cells;
      },
      entries_);
}

void SortedCells::forEach(const std::function<void(const std::vector<std::uint32_t>&)>& use) const
{
  std::visit(
      [&](const auto& entries) {
        std::vector<std::uint32_t> records;
        for (std::size_t begin = 0; begin < entries.size();) {
          records.clear();
          std::size_t end = begin;
          for (; end < entries.size() && entries[end].cell() == entries[begin].cell(); ++end)
            records.push_back(entries[end].record);
          std::sort(records.begin(), records.end());
          use(records);
          begin = end;
        }
      },
      entries_);
}

} // namespace pcl_bsh::pipeline

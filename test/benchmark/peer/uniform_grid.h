// SPDX-License-Identifier: BSD-3-Clause
// The honest simple baseline: a dense uniform grid over one cloud, its points counting-sorted by cell.
#pragma once

#include "peer.h"

#include <array>
#include <vector>

namespace pcl_bsh::bench {

/// plain: cells in the order x, y, z, visited in that order. crafted: cells run fastest along the cloud's shortest
/// extent, so that the cells in reach are a few contiguous runs of points. The run through the query's own cell comes
/// first.
enum class GridCraft { plain, crafted };

struct GridTuning {
  GridCraft craft = GridCraft::crafted;
  double edge_per_d = 1.0;      ///< cell edge as a multiple of d
  double cells_per_point = 4.0; ///< the edge grows until there are at most so many cells
};

/// The first point near enough ends a search. (Comparing eight points at a time over structure-of-arrays runs was tried
/// and is slower: most answers are among the first points.)
class UniformGrid : public ExistencePeer {
public:
  explicit UniformGrid(const GridTuning& tuning = {}) : tuning_(tuning) {}

  void build(const Points& points, float d) override;
  void release() override;
  void flag(const Points& queries, std::size_t begin, std::size_t end, float d, std::uint8_t* out) const override;
  bool any(const Point* queries, std::size_t count, float d) const override;

  /// Calls visit(place, squared distance) for every point within d; places number the points in the grid's order.
  template <typename Visit>
  void visitNear(const Point& point, float d, const Visit& visit) const;

  double edge() const { return edge_; }
  std::size_t cells() const { return start_.empty() ? 0 : start_.size() - 1; }

private:
  /// The cells in reach, per axis.
  struct Reach {
    std::array<std::array<int, 2>, 3> cell = {}; ///< first and last along slow, middle, fast
    std::array<int, 3> home = {};                ///< the point's own, or the nearest to it
    bool empty = false;
  };
  Reach reachOf(const Point& point, float d) const;

  bool near(const Point& query, float d, float squared_d) const;
  bool columnHasNear(std::size_t column, const std::array<int, 2>& fast_range, const Point& query,
                     float squared_d) const;

  GridTuning tuning_;
  std::array<int, 3> axis_ = {2, 1, 0}; // slow, middle, fast: indices into x, y, z
  std::array<int, 3> size_ = {0, 0, 0}; // cells along slow, middle, fast
  std::array<float, 3> origin_ = {0, 0, 0};
  double edge_ = 0.0;
  float inverse_edge_ = 0.0f;
  std::vector<std::uint32_t> start_; // first point of each cell, and one past the last
  Points sorted_;                    // by cell
};

template <typename Visit>
void UniformGrid::visitNear(const Point& point, float d, const Visit& visit) const
{
  const Reach reach = reachOf(point, d);
  if (reach.empty) return;
  for (int s = reach.cell[0][0]; s <= reach.cell[0][1]; ++s) {
    for (int m = reach.cell[1][0]; m <= reach.cell[1][1]; ++m) {
      const std::size_t column =
          static_cast<std::size_t>(s) * static_cast<std::size_t>(size_[1]) + static_cast<std::size_t>(m);
      const std::uint32_t* start = start_.data() + column * static_cast<std::size_t>(size_[2]);
      for (std::uint32_t i = start[reach.cell[2][0]]; i < start[reach.cell[2][1] + 1]; ++i) {
        const float squared = squaredDistance(sorted_[i], point);
        if (squared <= d * d) visit(i, squared);
      }
    }
  }
}

/// The tuning that builds and queries fastest, by trying: an edge of 0.25 to 4 d and 1 to 64 cells a point.
GridTuning tuneGrid(GridCraft craft, const Points& indexed, const Points& queries, float d);

} // namespace pcl_bsh::bench

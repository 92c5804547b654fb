// SPDX-License-Identifier: BSD-3-Clause
// The tree of a voxel, without its spheres. One of two ways makes it. One counting sort orders points by cell, and the
// cells' tree is cut into wide nodes with leaves of sixteen points at most. Or the voxel is an octree, and the points
// of each small enough cube are split at medians.

#if defined(PCL_BSH_HIERARCHY_BUILD_CELL_TREE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_HIERARCHY_BUILD_CELL_TREE_INL_H_
#undef PCL_BSH_HIERARCHY_BUILD_CELL_TREE_INL_H_
#else
#define PCL_BSH_HIERARCHY_BUILD_CELL_TREE_INL_H_
#endif

#include <pcl_bsh/base/pulse.h>
#include <pcl_bsh/hierarchy/build/cell_codes-inl.h>
#include <pcl_bsh/hierarchy/build/crowded_cell.h>
#include <pcl_bsh/hierarchy/build/point_bounds-inl.h>
#include <pcl_bsh/simd/rank_sort-inl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

constexpr unsigned kFinerBits = 4;       // further bits, at most, because many cells are empty
constexpr unsigned kCoarseBits = 9;      // bits, at most, of the coarse cells that tell how many cells are empty
constexpr unsigned kWorthJudging = 6;    // from so many bits on, empty cells are counted
constexpr unsigned kMostRecursions = 40; // cells within cells: each of them tells at least two places apart
constexpr std::uint32_t kCellPoints = 3; // cells hold this many on average: fine enough to cut leaves at good places
constexpr std::uint32_t kFewPoints = 2 * kMaxLeafPoints; // at most, which rankSort() sorts faster than nth_element()
constexpr std::uint32_t kFullNode = 96;                  // points that eight leaves hold, cut between cells
constexpr double kRoundedOutside = 0x1p-8; // of a cube's edge: points so near outside were put there by rounding

/// Memory for sorting a voxel's points into cells; a thread keeps it from voxel to voxel.
struct CellScratch {
  std::size_t bytes() const noexcept
  {
    std::size_t sum = codes.capacity() * sizeof(std::uint16_t);
    for (const std::vector<std::uint32_t>& s : starts) sum += s.capacity() * sizeof(std::uint32_t);
    return sum;
  }

  std::vector<std::uint16_t> codes;
  std::array<std::vector<std::uint32_t>, kMostRecursions> starts;
};

/// Sorts a voxel's points into cells, and makes the nodes above them: ranges of points and child nodes, no spheres yet.
class CellTree {
public:
  /// @param voxel not built, its points in its block. @param sorted room for its points, which end there in the order
  /// of the leaves.
  /// @param nodes empty
  CellTree(Voxel& voxel, const PointsView& view, CellScratch& scratch, std::vector<PointRecord>& sorted,
           std::vector<Node>& nodes)
  : voxel_(voxel),
    view_(view),
    scratch_(scratch),
    sorted_(sorted),
    nodes_(nodes),
    given_(reinterpret_cast<PointRecord*>(voxel.block)),
    crowded_extent_(kCrowdedExtent * *std::max_element(voxel.frame.reach.begin(), voxel.frame.reach.end()))
  {
    scratch_.codes.resize(voxel.count);
  }

  /// @param cube of the voxel in the grid, in the cloud's unit
  void build(CellSplit split, const Cube& cube)
  {
    if (voxel_.count <= kMaxLeafPoints) {
      std::copy_n(given_, voxel_.count, sorted_.data());
      moved_ = true;
      nodes_[newNode()].addChild(0, voxel_.count, Node::kLeaf);
      return;
    }
    if (split == CellSplit::octants) {
      std::copy_n(given_, voxel_.count, sorted_.data());
      moved_ = true;
      divide(0, voxel_.count, localCube(cube), 0);
      return;
    }
    PointBounds bounds;
    for (std::size_t k = 0; k < 3; ++k) {
      bounds.low[k] = static_cast<float>(-voxel_.frame.reach[k]);
      bounds.high[k] = static_cast<float>(voxel_.frame.reach[k]);
    }
    sortRange(0, voxel_.count, bounds, 0);
  }

  /// Whether any cell is crowded.
  bool hasCrowdedCells() const { return crowded_; }

  /// Whether all points are in `sorted`, also after build() has thrown. The block may have lost some of them then.
  bool hasMoved() const { return moved_; }

private:
  /// The voxel's cube in the voxel's frame. It is a cube around the points instead where they have left the voxel's
  /// since they were sorted, or where they are so close together that the cube's edge overflows in their unit.
  Cube localCube(const Cube& cube) const
  {
    const LocalFrame& frame = voxel_.frame;
    const PointBounds bounds = boundsOf(sorted_.data(), sorted_.size());
    Cube local{{}, cube.edge / frame.unit};
    const double outside = kRoundedOutside * local.edge;
    bool holds = std::isfinite(local.edge);
    for (std::size_t k = 0; k < 3; ++k) {
      local.low[k] = (cube.low[k] - frame.origin[k]) / frame.unit;
      holds = holds && static_cast<double>(bounds.low[k]) >= local.low[k] - outside &&
              static_cast<double>(bounds.high[k]) <= local.low[k] + local.edge + outside;
    }
    if (holds) return local;
    const double reach = *std::max_element(frame.reach.begin(), frame.reach.end());
    return {{-reach, -reach, -reach}, 2 * reach};
  }

  /// The octree of a cube, of points [begin, end) in sorted_, more than a leaf's. @return the node above them.
  std::uint32_t divide(std::uint32_t begin, std::uint32_t end, Cube cube, unsigned depth)
  {
    if (end - begin <= kNodeChildren * kMaxLeafPoints) return halveCell(begin, end);
    // Cubes that have all points in one octant make no node.
    const PointBounds bounds = boundsOf(sorted_.data() + begin, end - begin);
    std::array<float, 3> middle;
    for (;;) {
      if (cube.edge <= crowded_extent_ || depth == kMostRecursions) return growCrowded(begin, end);
      std::uint32_t octant = 0;
      bool alone = true;
      for (std::size_t k = 0; k < 3; ++k) {
        middle[k] = static_cast<float>(cube.low[k] + 0.5 * cube.edge);
        if (bounds.low[k] >= middle[k])
          octant |= 1u << k;
        else
          alone = alone && bounds.high[k] < middle[k];
      }
      if (!alone) break;
      cube = cube.octant(octant);
    }
    const auto octantOf = [&](const PointRecord& p) {
      return (p.x >= middle[0] ? 1u : 0u) | (p.y >= middle[1] ? 2u : 0u) | (p.z >= middle[2] ? 4u : 0u);
    };
    std::array<std::uint32_t, kNodeChildren + 1> starts = {begin};
    for (std::uint32_t i = begin; i < end; ++i) ++starts[octantOf(sorted_[i]) + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::copy(sorted_.begin() + begin, sorted_.begin() + end, given_ + begin);
    std::array<std::uint32_t, kNodeChildren + 1> next = starts;
    for (std::uint32_t i = begin; i < end; ++i) sorted_[next[octantOf(given_[i])]++] = given_[i];

    const std::uint32_t node = newNode();
    for (std::uint32_t octant = 0; octant < kNodeChildren; ++octant) {
      const std::uint32_t from = starts[octant], to = starts[octant + 1];
      if (from == to) continue;
      const std::uint32_t below =
          to - from <= kMaxLeafPoints ? Node::kLeaf : divide(from, to, cube.octant(octant), depth + 1);
      nodes_[node].addChild(from, to, below);
    }
    return node;
  }

  /// Moves points [begin, end), more than a leaf's, from given_ to sorted_ in the order of their cells.
  /// @return the node above the cells.
  std::uint32_t sortRange(std::uint32_t begin, std::uint32_t end, const PointBounds& bounds, unsigned recursion)
  {
    if (bounds.extent(longestAxis(bounds)) <= crowded_extent_ || recursion == kMostRecursions) {
      std::copy(given_ + begin, given_ + end, sorted_.begin() + begin);
      moved_ = true;
      return growCrowded(begin, end);
    }
    const auto [computed, bits] = codeCells(begin, end, bounds);
    const unsigned dropped = computed - bits;

    // Counts stand two entries further on, so that after the points are moved, each cell's entry is its start.
    std::vector<std::uint32_t>& starts = scratch_.starts[recursion];
    starts.assign((std::size_t{1} << bits) + 2, 0);
    for (std::uint32_t i = begin; i < end; ++i) ++starts[(scratch_.codes[i] >> dropped) + 2u];
    starts[1] = begin;
    for (std::size_t cell = 2; cell < starts.size(); ++cell) starts[cell] += starts[cell - 1];
    for (std::uint32_t i = begin; i < end; ++i) sorted_[starts[(scratch_.codes[i] >> dropped) + 1u]++] = given_[i];
    moved_ = true;
    starts[0] = begin;
    return cutCells(starts, {0, bits}, recursion);
  }

  struct CodeBits {
    unsigned computed;
    unsigned worth; ///< the first of them, by which to sort: cells in use hold kCellPoints points on average
  };

  /// Codes of points [begin, end), into scratch_.codes. Scans are surfaces: they leave most cells of a cube empty, the
  /// more the finer the cells are. So the share of coarse cells in use says how fine cells have to be.
  CodeBits codeCells(std::uint32_t begin, std::uint32_t end, const PointBounds& bounds)
  {
    const double wanted = static_cast<double>(end - begin) / kCellPoints;
    unsigned even = 1; // bits that would do if no cell were empty
    while (even < CellCodes::kMostBits && (end - begin) >> even > kCellPoints) ++even;
    const bool few = even < kWorthJudging;
    const CellCodes codes(bounds, few ? even : std::min(even + kFinerBits, CellCodes::kMostBits));
    const unsigned fine = codes.bits(), coarse = few ? 1 : std::min({even - 2, fine, kCoarseBits});
    std::array<std::uint8_t, 1u << kCoarseBits> seen{}; // coarse cells in use
    for (std::uint32_t i = begin; i < end; i += CellCodes::kBlock) {
      const std::uint32_t count = std::min<std::uint32_t>(CellCodes::kBlock, end - i);
      PointRecord last[CellCodes::kBlock];
      const PointRecord* points = given_ + i;
      if (count < CellCodes::kBlock) { // whole vectors are read
        std::fill(std::copy_n(points, count, last), std::end(last), points[count - 1]);
        points = last;
      }
      std::uint16_t* const next = scratch_.codes.data() + i;
      codes(points, count, next);
      for (std::uint32_t k = 0; k < count; ++k) seen[next[k] >> (fine - coarse)] = 1;
    }
    const auto used = std::accumulate(seen.begin(), seen.end(), 0u);
    // Each bit multiplies the cells in use by the same factor.
    const double bits = used > 1 ? coarse * std::log2(wanted) / std::log2(static_cast<double>(used)) : fine;
    return {fine, std::clamp(static_cast<unsigned>(bits + 0.5), std::min(even, fine), fine)};
  }

  /// The cells whose codes begin at `first` and differ in their last `bits` bits only.
  struct CellRange {
    std::uint32_t first;
    unsigned bits;
  };

  /// Halves the fullest child until each is small enough, or eight are reached.
  std::uint32_t cutCells(const std::vector<std::uint32_t>& starts, const CellRange& all, unsigned recursion)
  {
    const auto beginOf = [&](const CellRange& c) { return starts[c.first]; };
    const auto endOf = [&](const CellRange& c) { return starts[c.first + (1u << c.bits)]; };
    const auto count = [&](const CellRange& c) { return endOf(c) - beginOf(c); };

    // Children of this size fill one node each, or a tree of full nodes.
    std::uint32_t wanted = kMaxLeafPoints;
    for (std::uint32_t full = kFullNode; count(all) > full && full < 1u << 28; full *= kNodeChildren) wanted = full;

    std::array<CellRange, kNodeChildren> children = {all};
    std::size_t used = 1;
    for (;;) {
      std::size_t fullest = kNodeChildren;
      for (std::size_t i = 0; i < used; ++i)
        if (children[i].bits > 0 && count(children[i]) > wanted &&
            (fullest == kNodeChildren || count(children[i]) > count(children[fullest])))
          fullest = i;
      if (fullest == kNodeChildren) break;
      const unsigned bits = children[fullest].bits - 1;
      const CellRange low = {children[fullest].first, bits}, high = {children[fullest].first + (1u << bits), bits};
      if (count(low) == 0 || count(high) == 0) {
        children[fullest] = count(low) == 0 ? high : low;
        continue;
      }
      if (used == kNodeChildren) break;
      std::copy_backward(children.begin() + static_cast<std::ptrdiff_t>(fullest) + 1,
                         children.begin() + static_cast<std::ptrdiff_t>(used),
                         children.begin() + static_cast<std::ptrdiff_t>(used) + 1);
      children[fullest] = low;
      children[fullest + 1] = high;
      ++used;
    }
    if (used == 1) return sortAgain(beginOf(children[0]), endOf(children[0]), recursion);

    const std::uint32_t node = newNode();
    for (std::size_t i = 0; i < used; ++i) {
      const CellRange& child = children[i];
      if (count(child) <= kMaxLeafPoints) {
        nodes_[node].addChild(beginOf(child), endOf(child), Node::kLeaf);
      }
      else {
        const std::uint32_t below =
            child.bits > 0 ? cutCells(starts, child, recursion) : sortAgain(beginOf(child), endOf(child), recursion);
        nodes_[node].addChild(beginOf(child), endOf(child), below);
      }
    }
    return node;
  }

  /// A node for one cell that holds more points than a leaf.
  std::uint32_t sortAgain(std::uint32_t begin, std::uint32_t end, unsigned recursion)
  {
    if (end - begin <= kNodeChildren * kMaxLeafPoints) return halveCell(begin, end);
    std::copy(sorted_.begin() + begin, sorted_.begin() + end, given_ + begin);
    return sortRange(begin, end, boundsOf(given_ + begin, end - begin), recursion + 1);
  }

  /// A node for points that eight leaves can hold: halved at their median along the longest edge of their bounds, the
  /// fullest part first, which is cheaper than finer cells are.
  std::uint32_t halveCell(std::uint32_t begin, std::uint32_t end)
  {
    struct Part {
      std::uint32_t begin, end;
      bool crowded;

      std::uint32_t open() const { return crowded || end - begin <= kMaxLeafPoints ? 0 : end - begin; }
    };
    std::array<Part, kNodeChildren> parts = {{{begin, end, false}}};
    std::size_t used = 1;
    for (;;) {
      Part* const fullest = std::max_element(parts.begin(), parts.begin() + used,
                                             [](const Part& l, const Part& r) { return l.open() < r.open(); });
      if (fullest->open() == 0) break;
      PointRecord* const first = sorted_.data() + fullest->begin;
      const std::uint32_t count = fullest->end - fullest->begin, half = count / 2;
      const PointBounds bounds = boundsOf(first, count);
      const int axis = longestAxis(bounds);
      if (bounds.extent(axis) <= crowded_extent_) {
        fullest->crowded = true;
        continue;
      }
      if (count <= kFewPoints)
        sortFew(first, count, axis);
      else
        std::nth_element(first, first + half, first + count, [axis](const PointRecord& l, const PointRecord& r) {
          return axis == 0 ? l.x < r.x : axis == 1 ? l.y < r.y : l.z < r.z;
        });
      std::copy_backward(fullest + 1, parts.begin() + used, parts.begin() + used + 1);
      const Part upper = {fullest->begin + half, fullest->end, false};
      fullest->end = upper.begin;
      fullest[1] = upper;
      ++used;
    }
    if (used == 1) return growCrowded(begin, end);
    const std::uint32_t node = newNode();
    for (std::size_t i = 0; i < used; ++i) {
      const Part& part = parts[i];
      const std::uint32_t below = part.crowded ? growCrowded(part.begin, part.end) : Node::kLeaf;
      nodes_[node].addChild(part.begin, part.end, below);
    }
    return node;
  }

  /// Sorts kFewPoints points at most along an axis.
  static void sortFew(PointRecord* points, std::uint32_t count, int axis)
  {
    float keys[kFewPoints + kLanes], sorted_keys[kFewPoints];
    std::uint32_t places[kFewPoints], sorted_places[kFewPoints];
    PointRecord copies[kFewPoints];
    for (std::uint32_t i = 0; i < count; ++i) {
      copies[i] = points[i];
      keys[i] = axis == 0 ? points[i].x : axis == 1 ? points[i].y : points[i].z;
      places[i] = i;
    }
    rankSort(keys, places, count, sorted_keys, sorted_places);
    for (std::uint32_t i = 0; i < count; ++i) points[i] = copies[sorted_places[i]];
  }

  std::uint32_t growCrowded(std::uint32_t begin, std::uint32_t end)
  {
    crowded_ = true;
    return growCrowdedCell(view_, sorted_.data(), begin, end, nodes_);
  }

  std::uint32_t newNode()
  {
    pulse_.count(kOfNode);
    nodes_.emplace_back();
    nodes_.back().count = 0;
    return static_cast<std::uint32_t>(nodes_.size() - 1);
  }

  const Voxel& voxel_;
  const PointsView& view_;
  CellScratch& scratch_;
  std::vector<PointRecord>& sorted_;
  std::vector<Node>& nodes_;
  PointRecord* given_; // the voxel's block
  double crowded_extent_;
  static constexpr std::uint64_t kOfNode = 32; ///< a new node takes as long as so many pairs of nodes
  Pulse pulse_;
  bool crowded_ = false;
  bool moved_ = false;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

// SPDX-License-Identifier: BSD-3-Clause
// A voxel's octree cells and bounding spheres, built on the voxel's first visit:
// sort the points by cell, cut the cells' tree into wide nodes with leaves of sixteen points at most, fit the spheres.
#include <pcl_bsh/geometry/enclosing_sphere.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/sphere_radius.h>
#include <pcl_bsh/hierarchy/crowded_cell.h>
#include <pcl_bsh/hierarchy/kept_scratch.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/hierarchy/voxel_building.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/hierarchy/cell_codes-inl.h>
#include <pcl_bsh/simd/point_lanes-inl.h>
#include <pcl_bsh/simd/quad-inl.h>
#include <pcl_bsh/simd/rank_sort-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

constexpr unsigned kFinerBits = 4;       // spent at most on cells that hold nothing
constexpr unsigned kCoarseBits = 9;      // of the cells by which to judge how many those are
constexpr unsigned kWorthJudging = 6;    // bits from which on that is done
constexpr unsigned kMostRecursions = 40; // cells within cells: each of them tells at least two places apart
constexpr std::uint32_t kCellPoints = 3; // cells hold this many on average: fine enough to cut leaves at good places
constexpr std::uint32_t kFewPoints = 2 * kMaxLeafPoints; // that are quicker sorted by counting who comes before whom
constexpr std::uint32_t kFullNode = 96;                  // points that eight leaves hold, cut between cells

/// The point's coordinates, and its record number taken for a float.
Quad quadOf(const PointRecord& p)
{
  return Quad::load(reinterpret_cast<const float*>(&p));
}

Box boxOf(const PointRecord* records, std::size_t count)
{
  Quad low = quadOf(records[0]), high = low;
  for (std::size_t i = 1; i < count; ++i) {
    const Quad p = quadOf(records[i]);
    low = min(low, p);
    high = max(high, p);
  }
  Box box;
  low.store(box.low);
  high.store(box.high);
  return box;
}

int longestAxis(const Box& box)
{
  const int axis = box.extent(1) > box.extent(0) ? 1 : 0;
  return box.extent(2) > box.extent(axis) ? 2 : axis;
}

void merge(Box& box, const Box& other)
{
  min(Quad::load(box.low), Quad::load(other.low)).store(box.low);
  max(Quad::load(box.high), Quad::load(other.high)).store(box.high);
}

/// Scratch that a thread keeps from voxel to voxel.
struct Scratch {
  std::size_t bytes() const noexcept
  {
    std::size_t sum = sorted.capacity() * sizeof(PointRecord) + codes.capacity() * sizeof(std::uint16_t) +
                      boxes.capacity() * sizeof(Box) + nodes.capacity() * sizeof(Node);
    for (const std::vector<std::uint32_t>& s : starts) sum += s.capacity() * sizeof(std::uint32_t);
    return sum;
  }

  std::vector<PointRecord> sorted;
  std::vector<std::uint16_t> codes;
  std::array<std::vector<std::uint32_t>, kMostRecursions> starts;
  std::vector<Box> boxes;
  std::vector<Node> nodes;
};

class VoxelBuilder {
public:
  VoxelBuilder(Voxel& voxel, const PointsView& view, SphereFit fit, Scratch& scratch)
  : voxel_(voxel),
    view_(view),
    fit_(fit),
    scratch_(scratch),
    nodes_(scratch.nodes),
    given_(reinterpret_cast<PointRecord*>(voxel.block)),
    crowded_extent_(kCrowdedExtent * *std::max_element(voxel.frame.reach.begin(), voxel.frame.reach.end()))
  {
  }

  void build()
  {
    scratch_.sorted.resize(voxel_.count);
    scratch_.codes.resize(voxel_.count);
    nodes_.clear();
    try {
      sortIntoCells();
      fitBoxes();
      storeAsArrays();
      fitSpheres();
      voxel_.nodes.assign(nodes_.begin(), nodes_.end());
      if (crowded_) voxel_.given = givenSpheres(voxel_, view_);
    }
    catch (...) { // out of memory: the block has to be what a voxel that is not built has, in the cloud's order
      if (moved_) std::copy(scratch_.sorted.begin(), scratch_.sorted.end(), given_);
      std::sort(given_, given_ + voxel_.count,
                [](const PointRecord& l, const PointRecord& r) { return l.record < r.record; });
      voxel_.nodes.clear();
      throw;
    }
  }

  /// The same tree for points that have moved.
  void refit(const PointRecord* points)
  {
    scratch_.sorted.assign(points, points + voxel_.count);
    nodes_.assign(voxel_.nodes.begin(), voxel_.nodes.end());
    fitBoxes();
    storeAsArrays();
    fitSpheres();
    voxel_.nodes.assign(nodes_.begin(), nodes_.end());
  }

private:
  void sortIntoCells()
  {
    if (voxel_.count <= kMaxLeafPoints) {
      std::copy_n(given_, voxel_.count, scratch_.sorted.data());
      moved_ = true;
      nodes_[newNode()].addChild(0, voxel_.count, Node::kLeaf);
      return;
    }
    Box box;
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = static_cast<float>(-voxel_.frame.reach[k]);
      box.high[k] = static_cast<float>(voxel_.frame.reach[k]);
    }
    sortRange(0, voxel_.count, box, 0);
  }

  /// Moves points [begin, end), more than a leaf's, from given_ to scratch_.sorted in the order of their cells.
  /// @return the node above the cells.
  std::uint32_t sortRange(std::uint32_t begin, std::uint32_t end, const Box& box, unsigned recursion)
  {
    if (box.extent(longestAxis(box)) <= crowded_extent_ || recursion == kMostRecursions) {
      std::copy(given_ + begin, given_ + end, scratch_.sorted.begin() + begin);
      moved_ = true;
      return growCrowded(begin, end);
    }
    const auto [computed, bits] = codeCells(begin, end, box);
    const unsigned dropped = computed - bits;

    // Counts go one entry beyond the next cell's, so that they end up as the cells' starts.
    std::vector<std::uint32_t>& starts = scratch_.starts[recursion];
    starts.assign((std::size_t{1} << bits) + 2, 0);
    for (std::uint32_t i = begin; i < end; ++i) ++starts[(scratch_.codes[i] >> dropped) + 2u];
    starts[1] = begin;
    for (std::size_t cell = 2; cell < starts.size(); ++cell) starts[cell] += starts[cell - 1];
    for (std::uint32_t i = begin; i < end; ++i)
      scratch_.sorted[starts[(scratch_.codes[i] >> dropped) + 1u]++] = given_[i];
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
  CodeBits codeCells(std::uint32_t begin, std::uint32_t end, const Box& box)
  {
    const double wanted = static_cast<double>(end - begin) / kCellPoints;
    unsigned even = 1; // bits that would do if no cell were empty
    while (even < CellCodes::kMostBits && (end - begin) >> even > kCellPoints) ++even;
    const bool few = even < kWorthJudging;
    const CellCodes codes(box, few ? even : std::min(even + kFinerBits, CellCodes::kMostBits));
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
    std::copy(scratch_.sorted.begin() + begin, scratch_.sorted.begin() + end, given_ + begin);
    return sortRange(begin, end, boxOf(given_ + begin, end - begin), recursion + 1);
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
      PointRecord* const first = scratch_.sorted.data() + fullest->begin;
      const std::uint32_t count = fullest->end - fullest->begin, half = count / 2;
      const Box box = boxOf(first, count);
      const int axis = longestAxis(box);
      if (box.extent(axis) <= crowded_extent_) {
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
    return growCrowdedCell(view_, scratch_.sorted.data(), begin, end, nodes_);
  }

  std::uint32_t newNode()
  {
    nodes_.emplace_back();
    nodes_.back().count = 0;
    return static_cast<std::uint32_t>(nodes_.size() - 1);
  }

  /// Boxes and smallest record numbers, children before parents.
  void fitBoxes()
  {
    scratch_.boxes.assign(nodes_.size() * kNodeChildren, Box{});
    for (std::size_t n = nodes_.size(); n-- > 0;) {
      Node& node = nodes_[n];
      for (std::uint32_t i = 0; i < node.count; ++i) {
        Box& box = scratch_.boxes[n * kNodeChildren + i];
        std::uint32_t lowest = 0xffffffffu;
        if (node.isLeaf(i)) {
          const PointRecord* points = scratch_.sorted.data() + node.begin[i];
          box = boxOf(points, node.points(i));
          for (std::uint32_t k = 0; k < node.points(i); ++k) lowest = std::min(lowest, points[k].record);
        }
        else {
          const Node& below = nodes_[node.child[i]];
          for (std::uint32_t k = 0; k < below.count; ++k) {
            merge(box, scratch_.boxes[node.child[i] * kNodeChildren + k]);
            lowest = std::min(lowest, below.lowest[k]);
          }
        }
        node.lowest[i] = lowest;
      }
    }
  }

  /// The points' final form: x, y, z and record numbers, each in an array of its own.
  void storeAsArrays()
  {
    const std::size_t count = voxel_.count;
    float* x = voxel_.block;
    float *y = x + count, *z = y + count, *records = z + count;
    const auto* from = reinterpret_cast<const float*>(scratch_.sorted.data());
    const LaneTag d;
    const std::size_t step = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + step <= count; i += step) {
      LaneVector vx, vy, vz, vr;
      hn::LoadInterleaved4(d, from + 4 * i, vx, vy, vz, vr);
      hn::StoreU(vx, d, x + i);
      hn::StoreU(vy, d, y + i);
      hn::StoreU(vz, d, z + i);
      hn::StoreU(vr, d, records + i);
    }
    for (; i < count; ++i) {
      const PointRecord& p = scratch_.sorted[i];
      x[i] = p.x, y[i] = p.y, z[i] = p.z;
      std::memcpy(records + i, &p.record, sizeof p.record);
    }
    if (voxel_.radii)
      for (std::size_t k = 0; k < count; ++k) voxel_.radii[k] = view_.radii[scratch_.sorted[k].record];
  }

  void fitSpheres()
  {
    const double slack = storedSlack(voxel_.frame);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      Node& node = nodes_[n];
      alignas(32) float squared[kNodeChildren] = {};
      for (std::uint32_t i = 0; i < node.count; ++i) {
        const std::uint32_t begin = node.begin[i], end = node.begin[i + 1];
        const std::array<float, 3> c = center(begin, end, scratch_.boxes[n * kNodeChildren + i]);
        node.x[i] = c[0], node.y[i] = c[1], node.z[i] = c[2];
        if (voxel_.radii)
          node.r[i] = radiusOverBalls(begin, end, c, slack);
        else
          squared[i] = farthestSquared(voxel_.x() + begin, voxel_.y() + begin, voxel_.z() + begin, end - begin, c[0],
                                       c[1], c[2]);
      }
      if (!voxel_.radii) storeRadii(squared, roundUp(slack), node.r);
      node.clearUnused();
    }
  }

  /// At least radiusOver(squared, slack), in float arithmetic.
  static void storeRadii(const float* squared, float slack, float* radii)
  {
    const LaneTag d;
    for (std::size_t i = 0; i < kNodeChildren; i += hn::Lanes(d)) {
      const LaneVector root = hn::Sqrt(hn::Load(d, squared + i));
      const LaneVector over = hn::Mul(root, hn::Set(d, 1.0f + kRadiusMargin));
      hn::StoreU(hn::Add(over, hn::Set(d, slack * (1.0f + kRadiusMargin))), d, radii + i);
    }
  }

  std::array<float, 3> center(std::uint32_t begin, std::uint32_t end, const Box& box) const
  {
    const PointArrays points{voxel_.x() + begin, voxel_.y() + begin, voxel_.z() + begin, end - begin};
    if (fit_ == SphereFit::ritter) return ritterCenter(points);
    if (fit_ == SphereFit::minimal) return minimalCenter(points);
    return {0.5f * box.low[0] + 0.5f * box.high[0], 0.5f * box.low[1] + 0.5f * box.high[1],
            0.5f * box.low[2] + 0.5f * box.high[2]};
  }

  /// Of a sphere around points [begin, end) with their own radii; rounded outward.
  float radiusOverBalls(std::uint32_t begin, std::uint32_t end, const std::array<float, 3>& c, double slack) const
  {
    double farthest = 0.0;
    for (std::uint32_t i = begin; i < end; ++i) {
      const float squared = farthestSquared(voxel_.x() + i, voxel_.y() + i, voxel_.z() + i, 1, c[0], c[1], c[2]);
      const double ball = static_cast<double>(voxel_.radii[i]) / voxel_.frame.unit;
      farthest = std::max(farthest, radiusOver(squared, ball));
    }
    return roundUp(farthest * (1.0 + kFewDoubleRoundings) + slack);
  }

  Voxel& voxel_;
  const PointsView& view_;
  SphereFit fit_;
  Scratch& scratch_;
  std::vector<Node>& nodes_;
  PointRecord* given_;
  double crowded_extent_;
  bool crowded_ = false; // any cell of it
  bool moved_ = false;   // all points are in scratch_.sorted, whatever throws; some perhaps no longer in given_
};

} // namespace

void buildVoxelOnTarget(Voxel& voxel, const PointsView& view, SphereFit fit)
{
  const ScratchLease<Scratch> scratch;
  VoxelBuilder(voxel, view, fit, *scratch).build();
}

void refitVoxelOnTarget(Voxel& voxel, const PointRecord* points, const PointsView& view, SphereFit fit)
{
  const ScratchLease<Scratch> scratch;
  VoxelBuilder(voxel, view, fit, *scratch).refit(points);
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(buildVoxelOnTarget);
HWY_EXPORT(refitVoxelOnTarget);

void buildVoxel(Voxel& voxel, const PointsView& view, SphereFit fit)
{
  HWY_DYNAMIC_DISPATCH(buildVoxelOnTarget)(voxel, view, fit);
}

void refitVoxel(Voxel& voxel, const PointRecord* points, const PointsView& view, SphereFit fit)
{
  HWY_DYNAMIC_DISPATCH(refitVoxelOnTarget)(voxel, points, view, fit);
}

} // namespace pcl_bsh
#endif

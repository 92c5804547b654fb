// SPDX-License-Identifier: BSD-3-Clause
// A voxel's octree cells and bounding spheres, built on the voxel's first visit: sort the points by cell, fit the
// spheres.
#include <pcl_bsh/base/kept_scratch.h>
#include <pcl_bsh/base/pulse.h>
#include <pcl_bsh/geometry/enclosing_sphere.h>
#include <pcl_bsh/geometry/rounding.h>
#include <pcl_bsh/geometry/sphere_radius.h>
#include <pcl_bsh/hierarchy/build/crowded_cell.h>
#include <pcl_bsh/hierarchy/storage.h>

#include <algorithm>
#include <array>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/hierarchy/build/voxel_building.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/hierarchy/build/cell_tree-inl.h>
#include <pcl_bsh/hierarchy/build/local_points-inl.h>
#include <pcl_bsh/simd/point_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

/// Memory that a thread keeps from voxel to voxel.
struct BuildScratch {
  std::size_t bytes() const noexcept
  {
    return cells.bytes() + sorted.capacity() * sizeof(PointRecord) + bounds.capacity() * sizeof(PointBounds) +
           nodes.capacity() * sizeof(Node);
  }

  CellScratch cells;
  std::vector<PointRecord> sorted; ///< in the order of the leaves
  std::vector<PointBounds> bounds; ///< of child i of node n at [kNodeChildren * n + i]
  std::vector<Node> nodes;
};

class VoxelBuilder {
public:
  VoxelBuilder(Voxel& voxel, const PointsView& view, SphereFit fit, BuildScratch& scratch)
  : voxel_(voxel),
    view_(view),
    fit_(fit),
    scratch_(scratch),
    nodes_(scratch.nodes)
  {
  }

  void build(CellSplit split, const Cube& cube)
  {
    scratch_.sorted.resize(voxel_.count);
    nodes_.clear();
    CellTree cells(voxel_, view_, scratch_.cells, scratch_.sorted, nodes_);
    try {
      Pulse pulse;
      const auto goOn = [&] { pulse.count(voxel_.count); };
      if (voxel_.isListed()) readPoints(voxel_, view_);
      goOn();
      cells.build(split, cube);
      goOn();
      fitBounds();
      storeAsArrays();
      goOn();
      fitSpheres();
      voxel_.nodes.assign(nodes_.begin(), nodes_.end());
      if (cells.hasCrowdedCells()) voxel_.given = givenSpheres(voxel_, view_);
    }
    catch (...) { // out of memory, or stopped: the block has to hold the points as before, in the cloud's order
      if (!voxel_.isListed()) {
        auto* const points = reinterpret_cast<PointRecord*>(voxel_.block);
        if (cells.hasMoved()) std::copy(scratch_.sorted.begin(), scratch_.sorted.end(), points);
        std::sort(points, points + voxel_.count,
                  [](const PointRecord& l, const PointRecord& r) { return l.record < r.record; });
      }
      voxel_.nodes.clear();
      throw;
    }
    voxel_.list = nullptr;
  }

  /// Fits the tree to points that have moved.
  void refit(const PointRecord* points)
  {
    scratch_.sorted.assign(points, points + voxel_.count);
    nodes_.assign(voxel_.nodes.begin(), voxel_.nodes.end());
    fitBounds();
    storeAsArrays();
    fitSpheres();
    voxel_.nodes.assign(nodes_.begin(), nodes_.end());
  }

private:
  /// Bounds and smallest record numbers, children before parents.
  void fitBounds()
  {
    scratch_.bounds.assign(nodes_.size() * kNodeChildren, PointBounds{});
    for (std::size_t n = nodes_.size(); n-- > 0;) {
      Node& node = nodes_[n];
      for (std::uint32_t i = 0; i < node.count; ++i) {
        PointBounds& bounds = scratch_.bounds[n * kNodeChildren + i];
        std::uint32_t lowest = 0xffffffffu;
        if (node.isLeaf(i)) {
          const PointRecord* points = scratch_.sorted.data() + node.begin[i];
          bounds = boundsOf(points, node.points(i));
          for (std::uint32_t k = 0; k < node.points(i); ++k) lowest = std::min(lowest, points[k].record);
        }
        else {
          const Node& below = nodes_[node.child[i]];
          for (std::uint32_t k = 0; k < below.count; ++k) {
            merge(bounds, scratch_.bounds[node.child[i] * kNodeChildren + k]);
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
    // Where all balls have one radius, their middles are measured, and the radius is added.
    const bool of_one_size = !voxel_.radii || std::equal(voxel_.radii + 1, voxel_.radii + voxel_.count, voxel_.radii);
    const double ball = voxel_.radii ? static_cast<double>(voxel_.radii[0]) / voxel_.frame.unit : 0.0;
    const double slack = storedSlack(voxel_.frame);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      Node& node = nodes_[n];
      alignas(32) float squared[kNodeChildren] = {};
      for (std::uint32_t i = 0; i < node.count; ++i) {
        const std::uint32_t begin = node.begin[i], end = node.begin[i + 1];
        const std::array<float, 3> c = center(begin, end, scratch_.bounds[n * kNodeChildren + i]);
        node.x[i] = c[0], node.y[i] = c[1], node.z[i] = c[2];
        if (!of_one_size)
          node.r[i] = radiusOverBalls(begin, end, c, slack);
        else
          squared[i] = farthestSquared(voxel_.x() + begin, voxel_.y() + begin, voxel_.z() + begin, end - begin, c[0],
                                       c[1], c[2]);
      }
      if (of_one_size) storeRadii(squared, roundUp((slack + ball) * (1.0 + kFewDoubleRoundings)), node.r);
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

  std::array<float, 3> center(std::uint32_t begin, std::uint32_t end, const PointBounds& bounds) const
  {
    const PointArrays points{voxel_.x() + begin, voxel_.y() + begin, voxel_.z() + begin, end - begin};
    if (fit_ == SphereFit::ritter) return ritterCenter(points);
    if (fit_ == SphereFit::minimal) return minimalCenter(points);
    return {0.5f * bounds.low[0] + 0.5f * bounds.high[0], 0.5f * bounds.low[1] + 0.5f * bounds.high[1],
            0.5f * bounds.low[2] + 0.5f * bounds.high[2]};
  }

  /// Radius of a sphere around points [begin, end) with their own radii; rounded outward.
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
  BuildScratch& scratch_;
  std::vector<Node>& nodes_;
};

} // namespace

void buildVoxelOnTarget(Voxel& voxel, const PointsView& view, const HierarchyOptions& options, const Cube& cube)
{
  const ScratchLease<BuildScratch> scratch;
  VoxelBuilder(voxel, view, options.fit, *scratch).build(options.cells, cube);
}

void refitVoxelOnTarget(Voxel& voxel, const PointRecord* points, const PointsView& view, SphereFit fit)
{
  const ScratchLease<BuildScratch> scratch;
  VoxelBuilder(voxel, view, fit, *scratch).refit(points);
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(buildVoxelOnTarget);
HWY_EXPORT(refitVoxelOnTarget);

void buildVoxel(Voxel& voxel, const PointsView& view, const HierarchyOptions& options, const Cube& cube)
{
  HWY_DYNAMIC_DISPATCH(buildVoxelOnTarget)(voxel, view, options, cube);
}

void refitVoxel(Voxel& voxel, const PointRecord* points, const PointsView& view, SphereFit fit)
{
  HWY_DYNAMIC_DISPATCH(refitVoxelOnTarget)(voxel, points, view, fit);
}

} // namespace pcl_bsh
#endif

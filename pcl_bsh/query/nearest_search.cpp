// SPDX-License-Identifier: BSD-3-Clause
// The k nearest points: nearest children first, until nothing left can be nearer than the k-th. Float arithmetic keeps
// whatever may be among them; who is, the original coordinates say at the end.
#include <pcl_bsh/geometry/point_frame.h>
#include <pcl_bsh/query/neighbor_scratch.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/query/nearest_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/simd/point_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The query in one frame, and what a squared float distance s there says of the squared distance in the cloud's frame:
/// it is within [s * below - slack, s * above + slack].
///
/// With rho the frame's error and any e > 0, (sqrt(s) + rho)^2 <= s (1 + e) + rho^2 (1 + 1/e), and likewise below.
/// Here e = 2^-20, and 2^-19 pays for float arithmetic as well.
struct NearFrame {
  NearFrame(const LocalFrame& frame, const Point3& query, double cloud_unit)
  : point(frame, query),
    unit(static_cast<float>(point.unit / cloud_unit)),
    error(static_cast<float>(point.error) * (1.0f + 0x1p-20f))
  {
    const double scale = (point.unit / cloud_unit) * (point.unit / cloud_unit);
    below = static_cast<float>(scale) * (1.0f - 0x1p-19f);
    above = static_cast<float>(scale) * (1.0f + 0x1p-19f);
    slack = static_cast<float>(scale * point.error * point.error * 0x1p20) * (1.0f + 0x1p-15f) + 0x1p-100f;
    if (!(point.inRange() && scale > 0x1p-60 && scale < 0x1p60)) error = slack = kInfinity;
  }

  /// Squared float distances above this are beyond `bound`.
  float miss(float bound) const { return (bound + slack) / below * (1.0f + 0x1p-20f); }

  PointFrame point;
  float unit, error, below, above, slack;
};

class NearestWalk {
public:
  NearestWalk(const SphereHierarchy::Storage& cloud, const Point3& query, std::size_t k, double radius,
              NeighborScratch& scratch, Work& work)
  : cloud_(cloud),
    query_(query),
    k_(std::min(k, cloud.size)),
    radius_(radius),
    candidates_(scratch.candidates),
    entries_(scratch.entries),
    records_(scratch.records),
    work_(work)
  {
    candidates_.clear();
    entries_.clear();
    records_.clear();
  }

  void run()
  {
    if (k_ == 0) return;
    const double reach = radius_ / cloud_.frame.unit;
    lower(roundUp(reach * reach * (1.0 + 0x1p-50) + 0x1p-140));
    wanted_ = k_;
    const NearFrame frame(cloud_.frame, query_, cloud_.frame.unit);
    if (frame.point.separates(cloud_.frame, reach)) return;
    open(frame, cloud_.top[0]);
    while (entries_.size() > 0) {
      const NearEntry entry = entries_.back();
      entries_.pop();
      if (entry.gap > distance_) continue;
      if (entry.count == NearEntry::kNode)
        open(frame, cloud_.top[entry.index]);
      else
        visitVoxel(entry.index);
    }
    collect();
  }

private:
  void visitVoxel(std::uint32_t index)
  {
    const Voxel& voxel = cloud_.voxels[index];
    const NearFrame frame(voxel.frame, query_, cloud_.frame.unit);
    if (frame.point.separates(voxel.frame, static_cast<double>(distance_) / static_cast<double>(frame.unit))) return;
    cloud_.built(index, work_.voxels_built);
    const std::size_t floor = entries_.size();
    open(frame, voxel.nodes[0]);
    while (entries_.size() > floor) {
      const NearEntry entry = entries_.back();
      entries_.pop();
      if (entry.gap > distance_) continue;
      if (entry.count == NearEntry::kNode)
        open(frame, voxel.nodes[entry.index]);
      else
        compare(frame, voxel, entry.index, entry.count);
    }
  }

  /// Puts the children that may matter on the pile, the nearest one on top.
  void open(const NearFrame& frame, const Node& node)
  {
    work_.node_pairs += node.count;
    alignas(32) float gaps[kLanes];
    std::uint32_t near = sphereGaps({node.x, node.y, node.z, node.r, 1.0f}, frame.point.at[0], frame.point.at[1],
                                    frame.point.at[2], frame.error, frame.unit, distance_, gaps) &
                         firstBits(node.count);
    entries_.room(kLanes);
    NearEntry* const from = entries_.end();
    NearEntry* end = from;
    for (; near != 0; near &= near - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(near));
      const NearEntry entry = node.isLeaf(i) ? NearEntry{gaps[i], node.begin[i], node.points(i)}
                                             : NearEntry{gaps[i], node.child[i], NearEntry::kNode};
      NearEntry* place = end++;
      for (; place > from && place[-1].gap < entry.gap; --place) *place = place[-1];
      *place = entry;
    }
    entries_.resize(entries_.size() + static_cast<std::size_t>(end - from));
  }

  void compare(const NearFrame& frame, const Voxel& voxel, std::uint32_t begin, std::uint32_t count)
  {
    ++work_.leaf_pairs;
    alignas(64) float squared[kLeafPoints];
    leafSquaredDistances(voxel.x() + begin, voxel.y() + begin, voxel.z() + begin, frame.point.at[0], frame.point.at[1],
                         frame.point.at[2], squared);
    // Of a crowded place one point answers for all; among equals the smallest record numbers count, and come first.
    const bool coincident = count > kMaxLeafPoints;
    const std::uint32_t near = ~above(squared, frame.miss(bound_)) & firstBits(coincident ? 1 : count);
    if (near == 0) return;
    const std::uint32_t* const records = voxel.records() + begin;
    if (coincident) {
      const std::size_t same = std::min<std::size_t>(count, k_);
      candidates_.room(same);
      for (std::size_t i = 0; i < same; ++i) candidates_.push(candidate(frame, squared[0], records[i]));
    }
    else {
      candidates_.room(kLeafPoints);
      for (std::uint32_t bits = near; bits != 0; bits &= bits - 1) {
        const int i = std::countr_zero(bits);
        candidates_.push(candidate(frame, squared[i], records[i]));
      }
    }
    if (candidates_.size() >= wanted_) tighten();
  }

  static NearCandidate candidate(const NearFrame& frame, float squared, std::uint32_t record)
  {
    if (frame.slack == kInfinity) return {0.0f, kInfinity, record};
    return {squared * frame.below - frame.slack, squared * frame.above + frame.slack, record};
  }

  /// Drops candidates that k others are surely nearer than.
  void tighten()
  {
    NearCandidate* const begin = candidates_.data();
    NearCandidate* const end = candidates_.end();
    NearCandidate* const kth = begin + (k_ - 1);
    const auto by_high = [](const NearCandidate& x, const NearCandidate& y) { return x.high < y.high; };
    if (k_ == 1)
      std::iter_swap(begin, std::min_element(begin, end, by_high));
    else
      std::nth_element(begin, kth, end, by_high);
    if (kth->high < bound_) lower(kth->high);
    const auto kept = std::partition(kth, end, [this](const NearCandidate& c) { return !(c.low > bound_); });
    candidates_.resize(static_cast<std::size_t>(kept - begin));
    wanted_ = candidates_.size() + std::max<std::size_t>(k_ / 2, k_ == 1 ? 1 : 8);
  }

  void lower(float bound)
  {
    bound_ = bound;
    distance_ = std::sqrt(bound) * (1.0f + 0x1p-20f);
  }

  void collect()
  {
    if (candidates_.size() > k_) tighten();
    const double reach = radius_ / cloud_.frame.unit;
    const float surely = roundDown(std::min(reach * reach * (1.0 - 0x1p-50), 0x1p120));
    const std::size_t count = candidates_.size();
    records_.room(count);
    for (std::size_t i = 0; i < count; ++i) {
      const NearCandidate& c = candidates_[i];
      const bool within = c.high < surely || radius_ == std::numeric_limits<double>::infinity() ||
                          (!(c.low > bound_) && isWithin(cloud_.view.point(c.record), query_, radius_, work_));
      if (within) records_.push(c.record);
    }
  }

  const SphereHierarchy::Storage& cloud_;
  const Point3& query_;
  const std::size_t k_;
  const double radius_;
  Pile<NearCandidate>& candidates_;
  Pile<NearEntry>& entries_;
  Pile<std::uint32_t>& records_;
  Work& work_;
  float bound_ = kInfinity;    ///< squared; candidates that are farther do not count
  float distance_ = kInfinity; ///< at least its root
  std::size_t wanted_ = 0;     ///< when so many candidates have come together, most can go
};

} // namespace

void findNearestOnTarget(const SphereHierarchy::Storage& cloud, const Point3& query, std::size_t k, double radius,
                         NeighborScratch& scratch, Work& work)
{
  NearestWalk(cloud, query, k, radius, scratch, work).run();
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(findNearestOnTarget);

void findNearest(const SphereHierarchy::Storage& cloud, const Point3& query, std::size_t k, double radius,
                 NeighborScratch& scratch, Work& work)
{
  HWY_DYNAMIC_DISPATCH(findNearestOnTarget)(cloud, query, k, radius, scratch, work);
}

} // namespace pcl_bsh
#endif

// SPDX-License-Identifier: BSD-3-Clause
// The k nearest points: a guess bounds their distance, then a descent shrinks the bound as it finds points within.
// Float arithmetic keeps whatever may be among them; who is, the original coordinates say at the end.
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
  NearFrame(const PointFrame& point, double cloud_unit)
  : at{point.at[0], point.at[1], point.at[2]},
    error(static_cast<float>(point.error))
  {
    const double unit = point.unit == cloud_unit ? 1.0 : point.unit / cloud_unit;
    const double scale = unit * unit;
    inverse_unit = static_cast<float>(1.0 / unit);
    below = static_cast<float>(scale) * (1.0f - 0x1p-19f);
    above = static_cast<float>(scale) * (1.0f + 0x1p-19f);
    slack = static_cast<float>(scale * point.error * point.error * 0x1p20) * (1.0f + 0x1p-15f) + 0x1p-100f;
    if (!(point.inRange() && scale > 0x1p-60 && scale < 0x1p60)) error = slack = kInfinity;
  }

  /// Squared float distances above this are beyond `bound`.
  float miss(float bound) const { return (bound + slack) / below * (1.0f + 0x1p-20f); }

  /// Spheres farther than this and their radius are beyond `distance`.
  Ball ball(float distance) const
  {
    return {at.x, at.y, at.z, (distance * inverse_unit + error) * (1.0f + 0x1p-20f), -1.0f};
  }

  Point at;
  float error, inverse_unit, below, above, slack;
};

class NearestWalk {
public:
  NearestWalk(const SphereHierarchy::Storage& cloud, const Point3& query, std::size_t k, double radius,
              NeighborScratch& scratch, Work& work)
  : cloud_(cloud),
    query_(query),
    k_(std::min(k, cloud.size)),
    radius_(radius),
    records_(scratch.records),
    highs_(scratch.squared),
    work_(work)
  {
    records_.clear();
    highs_.clear();
  }

  void run()
  {
    if (k_ == 0) return;
    wanted_ = k_;
    const double reach = radius_ / cloud_.frame.unit;
    lower(roundUp(reach * reach * (1.0 + 0x1p-50) + 0x1p-140));
    const PointFrame point(cloud_.frame, query_);
    if (point.separates(cloud_.frame, reach)) return;
    const NearFrame frame(point, cloud_.frame.unit);
    guess(frame);
    visitAbove(frame, 0);
    collect();
  }

private:
  static SphereLanes spheresOf(const Node& node) { return {node.x, node.y, node.z, node.r, 1.0f}; }

  /// Goes straight down to where the nearest points most likely are, and bounds their distances by those of at least k
  /// points found there.
  void guess(const NearFrame& above)
  {
    std::uint32_t index = 0, child = likeliestSphere(spheresOf(cloud_.top[0]), above.at);
    while (!cloud_.top[index].isLeaf(child)) {
      index = cloud_.top[index].child[child];
      child = likeliestSphere(spheresOf(cloud_.top[index]), above.at);
    }
    const Voxel& voxel = cloud_.built(cloud_.top[index].begin[child], work_.voxels_built);
    const NearFrame frame(PointFrame(voxel.frame, query_), cloud_.frame.unit);
    std::uint32_t begin = 0, end = voxel.count; // the smallest node around the query that holds k points
    std::uint32_t begin_of_child = begin, end_of_child = end;
    for (index = 0;;) {
      const Node& node = voxel.nodes[index];
      child = likeliestSphere(spheresOf(node), frame.at);
      begin_of_child = node.begin[child], end_of_child = node.begin[child + 1];
      if (node.points(child) < k_) break;
      begin = begin_of_child, end = end_of_child;
      if (node.isLeaf(child)) break;
      index = node.child[child];
    }
    if (end - begin < k_) return;
    // Points are in the order of their cells: those before and after the child's are near it too.
    const auto count = static_cast<std::uint32_t>(std::min<std::size_t>(end - begin, kGuessed + 2 * k_));
    const std::uint32_t middle = begin_of_child + (end_of_child - begin_of_child) / 2;
    begin = std::clamp(middle - std::min(middle, count / 2), begin, end - count);
    highs_.room(count + kLeafPoints);
    for (std::size_t i = 0; i < count; i += kLeafPoints) {
      alignas(64) float squared[kLeafPoints];
      leafSquaredDistances(voxel.x() + begin + i, voxel.y() + begin + i, voxel.z() + begin + i, frame.at.x, frame.at.y,
                           frame.at.z, squared);
      for (std::size_t j = 0; j < kLeafPoints; ++j) highs_.end()[i + j] = squared[j] * frame.above + frame.slack;
    }
    tighten(highs_.data(), count);
  }

  void visitAbove(const NearFrame& frame, std::uint32_t index)
  {
    const Node& node = cloud_.top[index];
    work_.node_pairs += node.count;
    for (std::uint32_t near = spheresNear(spheresOf(node), frame.ball(distance_), nullptr) & firstBits(node.count);
         near != 0; near &= near - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(near));
      if (node.isLeaf(i))
        visitVoxel(node.begin[i]);
      else
        visitAbove(frame, node.child[i]);
    }
  }

  void visitVoxel(std::uint32_t index)
  {
    const LocalFrame& local = cloud_.voxels[index].frame;
    const PointFrame point(local, query_);
    const NearFrame frame(point, cloud_.frame.unit);
    if (point.separates(local, static_cast<double>(distance_) * static_cast<double>(frame.inverse_unit))) return;
    most_slack_ = std::max(most_slack_, frame.slack);
    visit(frame, cloud_.built(index, work_.voxels_built), 0);
  }

  void visit(const NearFrame& frame, const Voxel& voxel, std::uint32_t index)
  {
    const Node& node = voxel.nodes[index];
    work_.node_pairs += node.count;
    for (std::uint32_t near = spheresNear(spheresOf(node), frame.ball(distance_), nullptr) & firstBits(node.count);
         near != 0; near &= near - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(near));
      if (node.isLeaf(i))
        compare(frame, voxel, node.begin[i], node.points(i));
      else
        visit(frame, voxel, node.child[i]);
    }
  }

  void compare(const NearFrame& frame, const Voxel& voxel, std::uint32_t begin, std::uint32_t count)
  {
    ++work_.leaf_pairs;
    alignas(64) float squared[kLeafPoints];
    leafSquaredDistances(voxel.x() + begin, voxel.y() + begin, voxel.z() + begin, frame.at.x, frame.at.y, frame.at.z,
                         squared);
    const std::uint32_t* const records = voxel.records() + begin;
    // Of a crowded place one point answers for all; among equals the smallest record numbers count, and come first.
    const bool coincident = count > kMaxLeafPoints;
    const std::size_t same = coincident ? std::min<std::size_t>(count, k_) : 0;
    records_.room(same + kLeafPoints);
    highs_.room(same + kLeafPoints);
    std::uint32_t near = ~above(squared, frame.miss(bound_)) & firstBits(coincident ? 1 : count);
    if (near == 0) return;
    if (coincident) {
      const float high = squared[0] * frame.above + frame.slack;
      for (std::size_t i = 0; i < same; ++i) note(records[i], high);
    }
    else {
      for (; near != 0; near &= near - 1) {
        const int i = std::countr_zero(near);
        note(records[i], squared[i] * frame.above + frame.slack);
      }
    }
    if (records_.size() >= wanted_) {
      tighten(highs_.data(), highs_.size());
      wanted_ = records_.size() + std::max<std::size_t>(1, std::min<std::size_t>(k_ / 2, 16));
    }
  }

  void note(std::uint32_t record, float high)
  {
    records_.push(record);
    highs_.push(high);
  }

  /// Lowers the bound to where k of the values lie within it: to the k-th smallest, or a little above.
  void tighten(const float* highs, std::size_t count)
  {
    if (k_ == 1) {
      const float least = *std::min_element(highs, highs + count);
      if (least < bound_) lower(least);
      return;
    }
    float enough = bound_ < kInfinity ? bound_ : largestOf(highs, count), few = 0.0f;
    if (enough == kInfinity) return;
    for (int step = 0; step < kBisections; ++step) {
      const float middle = 0.5f * (few + enough);
      const std::size_t within = countAtMost(highs, count, middle);
      (within >= k_ ? enough : few) = middle;
      if (within == k_) break;
    }
    if (enough < bound_ && countAtMost(highs, count, enough) >= k_) lower(enough);
  }

  void lower(float bound)
  {
    bound_ = bound;
    distance_ = std::sqrt(bound) * (1.0f + 0x1p-20f);
  }

  /// Keeps the candidates that may be within the bound, and of them those within the radius.
  void collect()
  {
    if (records_.size() > k_) tighten(highs_.data(), highs_.size());
    const double reach = radius_ / cloud_.frame.unit;
    const float surely = roundDown(std::min(reach * reach * (1.0 - 0x1p-50), 0x1p120));
    const bool any_distance = radius_ == std::numeric_limits<double>::infinity();
    // A candidate's lower bound is at least that: above / below is less than 1 + 2^-17.
    const float miss = (bound_ + most_slack_) * (1.0f + 0x1p-17f) + most_slack_;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < records_.size(); ++i) {
      if (highs_[i] > miss) continue;
      const std::uint32_t record = records_[i];
      if (any_distance || highs_[i] < surely || isWithin(cloud_.view.point(record), query_, radius_, work_))
        records_[kept++] = record;
    }
    records_.resize(kept);
  }

  static constexpr int kBisections = 7;       ///< of the k-th smallest bound; any that is not too low will do
  static constexpr std::size_t kGuessed = 16; ///< points that a first guess looks at, and two for each of k

  const SphereHierarchy::Storage& cloud_;
  const Point3& query_;
  const std::size_t k_;
  const double radius_;
  Pile<std::uint32_t>& records_; ///< points that may be among the nearest
  Pile<float>& highs_;           ///< upper bounds of their squared distances, in the cloud's frame
  Work& work_;
  float bound_ = kInfinity;    ///< squared; points that are farther do not count
  float distance_ = kInfinity; ///< at least its root
  float most_slack_ = 0.0f;    ///< of the frames visited
  std::size_t wanted_ = 0;     ///< candidates at which the bound is looked at again
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

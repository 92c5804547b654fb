// SPDX-License-Identifier: BSD-3-Clause
// The k nearest points: a guess bounds their distance, then a descent shrinks the bound as it finds points within.
// Float arithmetic keeps all points that may be among them; the given coordinates decide at the end.
#include <pcl_bsh/geometry/squared_distance.h>
#include <pcl_bsh/neighbors/neighbor_scratch.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/neighbors/nearest_search.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/neighbors/nearest_frame-inl.h>
#include <pcl_bsh/simd/compress-inl.h>
#include <pcl_bsh/simd/point_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace {

class NearestWalk {
public:
  NearestWalk(const SphereHierarchy::Storage& cloud, const Point3& query, std::size_t k, double radius,
              NeighborScratch& scratch, Work& work)
  : cloud_(cloud),
    query_(query),
    k_(std::min(k, cloud.size)),
    wanted_(k_),
    radius_(radius),
    places_(scratch.records),
    highs_(scratch.squared),
    voxels_(scratch.voxels),
    work_(work)
  {
    places_.clear();
    highs_.clear();
    voxels_.clear();
  }

  void run()
  {
    if (k_ == 0) return;
    place_ = cloud_.find(query_);
    if (cloud_.frame.unit != 1.0)
      unit_ = cloud_.voxels[place_.voxel != kNoVoxel ? place_.voxel : nearVoxel()].frame.unit;
    if (radius_ < std::numeric_limits<double>::infinity()) {
      const double reach = radius_ / unit_;
      lower(roundUp(reach * reach * (1.0 + kFewDoubleRoundings) + static_cast<double>(NearestFrame::kVanishing)));
    }
    if (place_.voxel != kNoVoxel) visitVoxel(place_.voxel);
    if (!(static_cast<double>(distance_) * unit_ < place_.margin)) visitTop();
    collect();
  }

private:
  static SphereLanes spheresOf(const Node& node) { return {node.x, node.y, node.z, node.r, 1.0f}; }

  /// Returns a voxel near the query, by the spheres above it: its unit suits distances there. A few points far outside
  /// make the unit of the cloud too large.
  std::uint32_t nearVoxel() const
  {
    const Node* node = cloud_.top.data();
    for (;;) {
      std::uint32_t nearest = 0;
      double least = std::numeric_limits<double>::infinity();
      const PointFrame point(cloud_.frame, query_);
      for (std::uint32_t i = 0; i < node->count; ++i) {
        const double gap = std::hypot(static_cast<double>(node->x[i]) - static_cast<double>(point.at[0]),
                                      static_cast<double>(node->y[i]) - static_cast<double>(point.at[1]),
                                      static_cast<double>(node->z[i]) - static_cast<double>(point.at[2])) -
                           static_cast<double>(node->r[i]);
        if (gap < least) least = gap, nearest = i;
      }
      if (node->isLeaf(nearest)) return node->begin[nearest];
      node = &cloud_.top[node->child[nearest]];
    }
  }

  void visitTop()
  {
    const PointFrame point(cloud_.frame, query_);
    if (point.separates(cloud_.frame, distanceIn(point))) return;
    ++work_.volumes_carried;
    visitAbove(NearestFrame(point, unit_), 0);
  }

  /// The bound in the units of a frame.
  double distanceIn(const PointFrame& point) const
  {
    const auto distance = static_cast<double>(distance_);
    return point.unit == unit_ ? distance : distance * (unit_ / point.unit);
  }

  /// Calls visit(i) for the children that may hold points within the bound, the nearest first.
  template <class Visit>
  void eachChild(const NearestFrame& frame, const Node& node, const Visit& visit)
  {
    work_.node_pairs += node.count;
    alignas(32) float squared[kLanes];
    centersSquared(spheresOf(node), frame.at, squared);
    for (std::uint32_t open = firstBits(node.count);;) {
      open &= spheresNear(squared, node.r, frame.reach(distance_));
      if (open == 0) return;
      const std::uint32_t i =
          (open & (open - 1)) == 0 ? static_cast<std::uint32_t>(std::countr_zero(open)) : smallestLane(squared, open);
      open &= ~(1u << i);
      visit(i);
    }
  }

  void visitAbove(const NearestFrame& frame, std::uint32_t index)
  {
    const Node& node = cloud_.top[index];
    eachChild(frame, node, [&](std::uint32_t i) {
      if (!node.isLeaf(i))
        visitAbove(frame, node.child[i]);
      else if (node.begin[i] != place_.voxel)
        visitVoxel(node.begin[i]);
    });
  }

  void visitVoxel(std::uint32_t index)
  {
    const LocalFrame& local = cloud_.voxels[index].frame;
    const PointFrame point(local, query_);
    if (point.separates(local, distanceIn(point))) return;
    const NearestFrame frame(point, unit_);
    most_slack_ = std::max(most_slack_, frame.slack);
    ++work_.volumes_carried;
    const Voxel& voxel = cloud_.built(index, work_);
    voxels_.reserveMore(1);
    voxels_.push(&voxel);
    visit(frame, voxel, 0);
  }

  void visit(const NearestFrame& frame, const Voxel& voxel, std::uint32_t index)
  {
    const Node& node = voxel.nodes[index];
    eachChild(frame, node, [&](std::uint32_t i) {
      // Before there are k points to go by, a few more of them cost less than a descent.
      const bool few = node.points(i) <= kScanned && places_.size() < k_;
      if (!few && !node.isLeaf(i))
        visit(frame, voxel, node.child[i]);
      else if (!few && node.isCoincident(i))
        compareOne(frame, voxel, node.begin[i], node.points(i));
      else if (k_ == 1)
        compareForOne(frame, voxel, node.begin[i], node.begin[i + 1]);
      else
        compare(frame, voxel, node.begin[i], node.begin[i + 1]);
    });
  }

  /// Points of one place: one comparison decides all. Equal points count in the order of their record numbers, smallest
  /// first.
  void compareOne(const NearestFrame& frame, const Voxel& voxel, std::uint32_t begin, std::uint32_t count)
  {
    ++work_.leaf_pairs;
    alignas(64) float squared[kLeafPoints];
    leafSquaredDistances(voxel.x() + begin, voxel.y() + begin, voxel.z() + begin, frame.at.x, frame.at.y, frame.at.z,
                         squared);
    if (squared[0] > frame.miss(bound_)) return;
    const std::size_t same = std::min<std::size_t>(count, k_);
    places_.reserveMore(same);
    highs_.reserveMore(same);
    for (std::uint32_t i = 0; i < same; ++i) {
      places_.push(voxel.begin + begin + i);
      highs_.push(squared[0] * frame.above + frame.slack);
    }
    countAndTighten();
  }

  /// Counts compared points as pairs of leaves, whether their leaves were reached one by one or not.
  void noteCompared(std::uint32_t points) { work_.leaf_pairs += (points + kMaxLeafPoints - 1) / kMaxLeafPoints; }

  /// compare() for k = 1, at most kScanned points.
  void compareForOne(const NearestFrame& frame, const Voxel& voxel, std::uint32_t begin, std::uint32_t end)
  {
    noteCompared(end - begin);
    const LaneTag d;
    const std::uint32_t count = end - begin, step = static_cast<std::uint32_t>(hn::Lanes(d));
    alignas(64) float squared[kScanned + kLanes];
    const LaneVector x = hn::Set(d, frame.at.x), y = hn::Set(d, frame.at.y), z = hn::Set(d, frame.at.z);
    LaneVector least = hn::Set(d, kInfinity);
    const auto measured = [&](std::uint32_t i) {
      const LaneVector s =
          squaredNorm(hn::Sub(hn::LoadU(d, voxel.x() + begin + i), x), hn::Sub(hn::LoadU(d, voxel.y() + begin + i), y),
                      hn::Sub(hn::LoadU(d, voxel.z() + begin + i), z));
      return s;
    };
    std::uint32_t i = 0;
    for (; i + step <= count; i += step) {
      const LaneVector s = measured(i);
      hn::Store(s, d, squared + i);
      least = hn::Min(least, s);
    }
    if (i < count) {
      const LaneVector s = hn::IfThenElse(hn::FirstN(d, count - i), measured(i), hn::Set(d, kInfinity));
      hn::Store(s, d, squared + i);
      least = hn::Min(least, s);
    }
    const float nearest = hn::GetLane(hn::MinOfLanes(d, least));
    if (nearest > frame.miss(bound_)) return;
    const float high = nearest * frame.above + frame.slack;
    if (high < bound_) lower(high);
    places_.reserveMore(count);
    highs_.reserveMore(count);
    const LaneVector miss = hn::Set(d, frame.miss(bound_));
    for (i = 0; i < count; i += 64) {
      std::uint64_t near = 0;
      for (std::uint32_t j = 0; j < 64 && i + j < count; j += step)
        near |= std::uint64_t{~bitsOf(d, hn::Gt(hn::Load(d, squared + i + j), miss)) & firstBits(step)} << j;
      if (count - i < 64) near &= (std::uint64_t{1} << (count - i)) - 1;
      for (; near != 0; near &= near - 1) {
        const std::uint32_t j = i + static_cast<std::uint32_t>(std::countr_zero(near));
        places_.push(voxel.begin + begin + j);
        highs_.push(squared[j] * frame.above + frame.slack);
        hwy::Prefetch(voxel.records() + begin + j); // asked for at the end
      }
    }
  }

  void compare(const NearestFrame& frame, const Voxel& voxel, std::uint32_t begin, std::uint32_t end)
  {
    noteCompared(end - begin);
    places_.reserveMore(end - begin + kLanes);
    highs_.reserveMore(end - begin + kLanes);
    const LaneTag d;
    const LaneVector x = hn::Set(d, frame.at.x), y = hn::Set(d, frame.at.y), z = hn::Set(d, frame.at.z);
    const LaneVector scale = hn::Set(d, frame.above), slack = hn::Set(d, frame.slack);
    const LaneVector miss = hn::Set(d, frame.miss(bound_));
    std::size_t size = places_.size();
    for (std::size_t i = begin; i < end; i += hn::Lanes(d)) {
      const LaneVector squared =
          squaredNorm(hn::Sub(hn::LoadU(d, voxel.x() + i), x), hn::Sub(hn::LoadU(d, voxel.y() + i), y),
                      hn::Sub(hn::LoadU(d, voxel.z() + i), z));
      const std::uint32_t near =
          ~bitsOf(d, hn::Gt(squared, miss)) & firstBits(std::min<std::size_t>(end - i, hn::Lanes(d)));
      const Compress kept(near);
      kept.store(hn::Add(hn::Mul(squared, scale), slack), highs_.data() + size);
      kept.storeNumbers(voxel.begin + static_cast<std::uint32_t>(i), places_.data() + size);
      size += static_cast<std::size_t>(std::popcount(near));
    }
    places_.resize(size);
    highs_.resize(size);
    countAndTighten();
  }

  /// Lowers the bound when enough candidates have come since that was last done, and forgets those beyond it. Where
  /// ties keep more than k candidates, as many as are kept beyond k have to come: so each is looked at a few times
  /// only.
  void countAndTighten()
  {
    if (places_.size() < wanted_) return;
    tighten();
    const std::size_t beyond = places_.size() - std::min(places_.size(), k_);
    wanted_ = places_.size() + std::max({kMore, k_ / 2, beyond});
  }

  /// Lowers the bound to where k candidates lie within it: to the k-th smallest, or a little above.
  void tighten()
  {
    const float* const highs = highs_.data();
    const std::size_t count = highs_.size(), enough_said = k_ + k_ / 8;
    work_.ranked += count;
    float enough = k_ == 1 ? smallestOf(highs, count) : largestOf(highs, count), few = 0.0f;
    if (count > std::max<std::size_t>(2 * kScanned, 4 * k_)) few = smallestOf(highs, count); // many of them ties
    double within = static_cast<double>(count), beyond = 0.0; // candidates at most `enough`, about those at most `few`
    for (int step = 0; k_ > 1; ++step) {
      if (step >= kSteps && (within <= 2.0 * static_cast<double>(enough_said) || missOfHighs(few) >= enough)) break;
      const double share = (static_cast<double>(k_ + enough_said) * 0.5 - beyond) / (within - beyond);
      // Interpolation, for squared distances are spread evenly on a surface; every other time halfway. In the end
      // halfway between exponents, for distances may be of all sizes.
      const float guess = step >= kSteps  ? halfwayUp(few, enough)
                          : step % 2 == 0 ? few + static_cast<float>(share) * (enough - few)
                                          : 0.5f * (few + enough);
      const float middle = std::min(std::max(guess, few), enough);
      work_.ranked += count;
      const std::size_t at_most = countAtMost(highs, count, middle);
      if (at_most >= k_) {
        enough = middle;
        within = static_cast<double>(at_most);
        if (at_most <= enough_said) break;
      }
      else {
        few = middle;
        beyond = static_cast<double>(at_most);
      }
    }
    if (enough < bound_) lower(enough);
    forgetFarther();
  }

  void lower(float bound)
  {
    bound_ = bound;
    distance_ = std::sqrt(bound) * (1.0f + kNeighborMargin);
  }

  /// A candidate whose upper bound exceeds this has a lower bound above `bound`: above * inverse_below is less than
  /// 1 + 8 kNeighborShare.
  float missOfHighs(float bound) const { return (bound + most_slack_) * (1.0f + 8 * kNeighborShare) + most_slack_; }

  void forgetFarther()
  {
    const float miss = missOfHighs(bound_);
    const LaneTag d;
    std::size_t kept = 0;
    const std::size_t count = places_.size();
    places_.reserveMore(kLanes);
    highs_.reserveMore(kLanes);
    for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
      const LaneVector highs = hn::LoadU(d, highs_.data() + i);
      const std::uint32_t near =
          bitsOf(d, hn::Le(highs, hn::Set(d, miss))) & firstBits(std::min<std::size_t>(count - i, hn::Lanes(d)));
      const Compress keep(near);
      keep.store(places_.data() + i, places_.data() + kept);
      keep.store(highs, highs_.data() + kept);
      kept += static_cast<std::size_t>(std::popcount(near));
    }
    places_.resize(kept);
    highs_.resize(kept);
  }

  /// Names and measures the candidates within the radius.
  void collect()
  {
    if (places_.size() > k_) tighten();
    const double reach = radius_ / unit_;
    const float surely = roundDown(std::min(reach * reach * (1.0 - kFewDoubleRoundings), kLargestSurely));
    std::size_t kept = 0;
    const Voxel* const* voxel = voxels_.data();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      while (places_[i] - (*voxel)->begin >= (*voxel)->count) ++voxel;
      const std::uint32_t at = places_[i] - (*voxel)->begin;
      const Point3 p = (*voxel)->point(cloud_.view, at);
      if (!(highs_[i] < surely || radius_ == std::numeric_limits<double>::infinity() ||
            isWithin(p, query_, radius_, work_)))
        continue;
      places_[kept] = (*voxel)->records()[at];
      highs_[kept++] = squaredDistanceAsFloat(p, query_);
    }
    places_.resize(kept);
    highs_.resize(kept);
  }

  static constexpr double kLargestSurely = 0x1p120; ///< above this, exact arithmetic says what is within the radius
  static constexpr int kSteps = 6;             ///< towards the k-th smallest bound; any that is not too low will do
  static constexpr std::size_t kScanned = 128; ///< points that are compared without a descent at first
  static constexpr std::size_t kMore = 4;      ///< candidates, or half of k, after which the bound is looked at again

  const SphereHierarchy::Storage& cloud_;
  const Point3& query_;
  const std::size_t k_;
  std::size_t wanted_; ///< candidates at which the bound is looked at again
  const double radius_;
  LargeArray<std::uint32_t>& places_; ///< points that may be among the nearest, counted over all voxels
  LargeArray<float>& highs_;          ///< upper bounds of their squared distances, in units of the search
  LargeArray<const Voxel*>& voxels_;  ///< visited
  Work& work_;
  double unit_ = 1.0;          ///< of lengths in the search
  float bound_ = kInfinity;    ///< squared; points that are farther do not count
  float distance_ = kInfinity; ///< at least its root
  float most_slack_ = 0.0f;    ///< of the frames visited
  SphereHierarchy::Storage::GridPlace place_ = {};
};

} // namespace

void findNearestOnTarget(const SphereHierarchy::Storage& cloud, const Point3& query, std::size_t k, double radius,
                         NeighborScratch& scratch, Work& work)
{
  NearestWalk(cloud, query, k, radius, scratch, work).run();
}

} // namespace pcl_bsh::HWY_NAMESPACE
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

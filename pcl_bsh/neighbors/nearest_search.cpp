// SPDX-License-Identifier: BSD-3-Clause
// The k nearest points: a guess bounds their distance, then a descent shrinks the bound as it finds points within.
// Float arithmetic keeps whatever may be among them; who is, the original coordinates say at the end.
#include <pcl_bsh/geometry/point_frame.h>
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

#include <pcl_bsh/simd/compress-inl.h>
#include <pcl_bsh/simd/point_lanes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The query in one frame, and what a squared float distance s there says of the squared distance in the cloud's frame:
/// it is within [s / inverse_below - slack, s * above + slack].
///
/// With rho the frame's error and any e > 0, (sqrt(s) + rho)^2 <= s (1 + e) + rho^2 (1 + 1/e), and likewise below.
/// Here e = kNeighborShare; as much again pays for float arithmetic, and twice as much below. Where floats know
/// nothing, the query is at 0, every upper bound is infinite and nothing is left out; none of these numbers is NaN, nor
/// is what the walk makes of them.
struct NearFrame {
  NearFrame(const PointFrame& point, double cloud_unit)
  {
    const double unit = point.unit == cloud_unit ? 1.0 : point.unit / cloud_unit;
    const double scale = unit * unit;
    if (!(point.inRange() && scale >= kSmallestScale && scale <= 1.0)) return;
    at = {point.at[0], point.at[1], point.at[2]};
    error = static_cast<float>(point.error);
    slack = static_cast<float>(scale * point.error * point.error / kNeighborShare) * (1.0f + 32 * kNeighborShare) +
            kVanishing;
    if (unit == 1.0) return;
    inverse_unit = static_cast<float>(1.0 / unit);
    inverse_below *= static_cast<float>(1.0 / scale);
    above *= static_cast<float>(scale);
  }

  /// Squared float distances above this are beyond `bound`.
  float miss(float bound) const { return (bound + slack) * inverse_below; }

  /// Spheres farther than this and their radius are beyond `distance`.
  float reach(float distance) const { return (distance * inverse_unit + error) * (1.0f + kNeighborMargin); }

  static constexpr float kVanishing = 0x1p-100f; ///< above what underflows, as a squared distance
  static constexpr double kSmallestScale = 0x1p-60;

  Point at = {0.0f, 0.0f, 0.0f};
  float error = kInfinity, slack = kInfinity;
  float inverse_unit = 1.0f, inverse_below = 1.0f + 4 * kNeighborShare, above = 1.0f + 2 * kNeighborShare;
};

static_assert(kSquaredDistanceError + 3 * kFloatUnit < kNeighborShare); // of a distance, a product and a sum

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
    if (radius_ < std::numeric_limits<double>::infinity()) {
      const double reach = radius_ / cloud_.frame.unit;
      lower(roundUp(reach * reach * (1.0 + kFewDoubleRoundings) + static_cast<double>(NearFrame::kVanishing)));
    }
    place_ = cloud_.find(query_);
    if (place_.voxel != SphereHierarchy::Storage::kNoVoxel) visitVoxel(place_.voxel);
    if (!(static_cast<double>(distance_) * cloud_.frame.unit < place_.margin)) visitTop();
    collect();
  }

private:
  static SphereLanes spheresOf(const Node& node) { return {node.x, node.y, node.z, node.r, 1.0f}; }

  void visitTop()
  {
    const PointFrame point(cloud_.frame, query_);
    if (point.separates(cloud_.frame, static_cast<double>(distance_))) return;
    ++work_.volumes_carried;
    visitAbove(NearFrame(point, cloud_.frame.unit), 0);
  }

  /// Calls visit(i) for the children that may hold points within the bound, the nearest first.
  template <class Visit>
  void eachChild(const NearFrame& frame, const Node& node, const Visit& visit)
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

  void visitAbove(const NearFrame& frame, std::uint32_t index)
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
    const NearFrame frame(point, cloud_.frame.unit);
    if (frame.slack < kInfinity &&
        point.separates(local, static_cast<double>(distance_) * static_cast<double>(frame.inverse_unit)))
      return;
    most_slack_ = std::max(most_slack_, frame.slack);
    ++work_.volumes_carried;
    const Voxel& voxel = cloud_.built(index, work_);
    voxels_.room(1);
    voxels_.push(&voxel);
    visit(frame, voxel, 0);
  }

  void visit(const NearFrame& frame, const Voxel& voxel, std::uint32_t index)
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

  /// A crowded place, where one point answers for all; the smallest record numbers count, and come first.
  void compareOne(const NearFrame& frame, const Voxel& voxel, std::uint32_t begin, std::uint32_t count)
  {
    ++work_.leaf_pairs;
    alignas(64) float squared[kLeafPoints];
    leafSquaredDistances(voxel.x() + begin, voxel.y() + begin, voxel.z() + begin, frame.at.x, frame.at.y, frame.at.z,
                         squared);
    if (squared[0] > frame.miss(bound_)) return;
    const std::size_t same = std::min<std::size_t>(count, k_);
    places_.room(same);
    highs_.room(same);
    for (std::uint32_t i = 0; i < same; ++i) {
      places_.push(voxel.begin + begin + i);
      highs_.push(squared[0] * frame.above + frame.slack);
    }
    countAndTighten();
  }

  /// In leaves, whether they were reached one by one or not.
  void noteCompared(std::uint32_t points) { work_.leaf_pairs += (points + kMaxLeafPoints - 1) / kMaxLeafPoints; }

  /// compare() for k = 1, at most kScanned points.
  void compareForOne(const NearFrame& frame, const Voxel& voxel, std::uint32_t begin, std::uint32_t end)
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
    places_.room(count);
    highs_.room(count);
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

  void compare(const NearFrame& frame, const Voxel& voxel, std::uint32_t begin, std::uint32_t end)
  {
    noteCompared(end - begin);
    places_.room(end - begin + kLanes);
    highs_.room(end - begin + kLanes);
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

  /// Lowers the bound when enough candidates have come since that was last done, and forgets those beyond it.
  void countAndTighten()
  {
    if (places_.size() < wanted_) return;
    tighten();
    wanted_ = places_.size() + std::max<std::size_t>(kMore, k_ / 2);
  }

  /// Lowers the bound to where k candidates lie within it: to the k-th smallest, or a little above.
  void tighten()
  {
    const float* const highs = highs_.data();
    const std::size_t count = highs_.size(), enough_said = k_ + k_ / 8;
    float enough = largestOf(highs, count), few = 0.0f;
    if (!(enough < kInfinity)) return;
    if (k_ == 1) enough = smallestOf(highs, count);
    double within = static_cast<double>(count), beyond = 0.0; // candidates at most `enough`, at most `few`
    for (int step = 0; step < kSteps && k_ > 1; ++step) {
      // Interpolation, for squared distances are spread evenly on a surface; every other time halfway.
      const double share = (static_cast<double>(k_ + enough_said) * 0.5 - beyond) / (within - beyond);
      const float guess = step % 2 == 0 ? few + static_cast<float>(share) * (enough - few) : 0.5f * (few + enough);
      const float middle = std::min(std::max(guess, few), enough);
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

  /// No candidate's lower bound is less than its upper one by more than that: above * inverse_below is less than
  /// 1 + 8 kNeighborShare.
  float missOfHighs() const { return (bound_ + most_slack_) * (1.0f + 8 * kNeighborShare) + most_slack_; }

  void forgetFarther()
  {
    const float miss = missOfHighs();
    const LaneTag d;
    std::size_t kept = 0;
    const std::size_t count = places_.size();
    places_.room(kLanes);
    highs_.room(kLanes);
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

  /// Of the candidates that may be within the bound, names and measures those within the radius.
  void collect()
  {
    if (places_.size() > k_) tighten();
    const double reach = radius_ / cloud_.frame.unit;
    const float surely = roundDown(std::min(reach * reach * (1.0 - kFewDoubleRoundings), kLargestSurely));
    std::size_t kept = 0;
    const Voxel* const* home = voxels_.data();
    for (std::size_t i = 0; i < places_.size(); ++i) {
      while (places_[i] - (*home)->begin >= (*home)->count) ++home;
      const std::uint32_t at = places_[i] - (*home)->begin;
      const Point3 p = (*home)->point(cloud_.view, at);
      if (!(highs_[i] < surely || radius_ == std::numeric_limits<double>::infinity() ||
            isWithin(p, query_, radius_, work_)))
        continue;
      places_[kept] = (*home)->records()[at];
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
  Pile<std::uint32_t>& places_; ///< points that may be among the nearest, counted over all voxels
  Pile<float>& highs_;          ///< upper bounds of their squared distances, in the cloud's frame
  Pile<const Voxel*>& voxels_;  ///< visited
  Work& work_;
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

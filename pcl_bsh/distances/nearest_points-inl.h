// SPDX-License-Identifier: BSD-3-Clause
// The nearest points of b to the points of one leaf of a, by float arithmetic: the nearest two to each of them, and
// where its error leaves open which of these is the nearer.

#if defined(PCL_BSH_DISTANCES_NEAREST_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_NEAREST_POINTS_INL_H_
#undef PCL_BSH_DISTANCES_NEAREST_POINTS_INL_H_
#else
#define PCL_BSH_DISTANCES_NEAREST_POINTS_INL_H_
#endif

#include <pcl_bsh/distances/measured_leaf-inl.h>

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

class NearestPoints {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kMargin = kSphereMargin; ///< 16 u: above what roots, radii and sums round

public:
  NearestPoints(MeasuredLeaf& leaf, DistanceScratch& scratch)
  : leaf_(leaf),
    gathered_(scratch.gathered),
    near_leaves_(scratch.near_leaves),
    own_radii_(roundUp(leaf.query.a.hierarchy().storage().largest_radius / leaf.unit)),
    balls_(roundUp(2.0 * leaf.largest_radius / leaf.unit))
  {
  }

  /// Whether findBelow() may be called, where all obstacles are plain.
  bool mayFindBelow() const
  {
    return !leaf_.of_triangles && hasBallsInRange() && leaf_.query.b.hierarchy().size() < kMostNamed;
  }

  /// Whether float distances to these leaves can be compared with each other.
  bool floatsTell(const std::vector<NearSphere>& near) const
  {
    return !leaf_.of_triangles && hasBallsInRange() && near.size() < kMostNamed &&
           std::all_of(near.begin(), near.end(), [&](const NearSphere& candidate) {
             return leaf_.obstacles[candidate.sphere.obstacle].is_plain;
           });
  }

  /// Takes the spheres that the leaves go through.
  void gather(const std::vector<NearSphere>& list) { gathered_.gather(list); }

  /// Finds what find() does among all points below the gathered spheres. Their lower bounds need not be known.
  bool findBelow(float cut)
  {
    limit_ = cut;
    boundGathered();
    return findGathered();
  }

  /// Finds the nearest of b's points to each point of the leaf, of gathered leaves whose lower bounds are known.
  /// @param cut no point of the leaf is farther from its nearest, unless that is beyond max_distance
  /// @return false where all points are known to be nearer than what was measured
  bool find(float cut)
  {
    limit_ = cut;
    return findGathered();
  }

  /// The points whose nearest may be another one than was found.
  std::uint32_t undecided() const { return leaf_.largest_radius > 0.0 ? ambiguous<true>() : ambiguous<false>(); }

  /// The point of b that float arithmetic found for point i; with a max_distance, also bounds of their distance.
  NearestFound named(std::uint32_t i) const
  {
    if (two_.name[i] < 0) return {};
    const auto name = static_cast<std::size_t>(two_.name[i]);
    const LeafRange& leaf = near_leaves_[name / kLeafPoints].range;
    NearestFound found{leaf.voxel, leaf.begin + static_cast<std::uint32_t>(name % kLeafPoints)};
    if (leaf_.max == kInfinity) return found;
    const bool balls = leaf_.largest_radius > 0.0;
    const float value = two_.first[i];
    found.least = (balls ? leastOf<true>(value) : leastOf<false>(value)) * leaf_.unit;
    found.most = (balls ? mostOf<true>(value) : mostOf<false>(value)) * leaf_.unit;
    return found;
  }

private:
  static constexpr std::size_t kMostNamed = std::size_t{1} << 27; ///< leaves whose points have names

  /// Otherwise radii would leave the range of float.
  bool hasBallsInRange() const
  {
    return leaf_.largest_radius == 0.0 || (leaf_.unit >= 0x1p-60 && leaf_.unit <= 0x1p60);
  }

  bool findGathered()
  {
    leaf_.largest_radius > 0.0 ? findNearest<true>() : findNearest<false>();
    return !leaf_.query.exceeds(limit_);
  }

  /// Finds the nearest two of b's points to each point of the leaf by their float distances. Ends early where all
  /// points are known to be nearer than what was measured.
  template <bool kBalls>
  void findNearest()
  {
    two_.clear();
    near_leaves_.clear();
    error_ = kSmallestLength;
    std::fill(std::begin(most_), std::end(most_), limit_ + own_radii_);
    if (gathered_.runs().empty()) return;
    // The nearest leaves little to the others.
    const std::uint32_t nearest = gathered_.nearest();
    float* const lower = gathered_.lower();
    const auto take = [&](std::uint32_t place) {
      if (lower[place] > farthest() || leaf_.query.exceeds(limit_)) return;
      takeSphere<kBalls>(gathered_.sphere(place), lower[place]);
    };
    if (lower[nearest] < GatheredSpheres::kDone) take(nearest);
    lower[nearest] = GatheredSpheres::kDone;
    const LaneTag d;
    for (std::uint32_t i = 0; i < gathered_.end(); i += static_cast<std::uint32_t>(hn::Lanes(d))) {
      const LaneVector reach = hn::Set(d, std::min(farthest(), std::numeric_limits<float>::max()));
      for (const std::uint32_t lane : Bits(bitsOf(d, hn::Le(hn::LoadU(d, lower + i), reach)))) take(i + lane);
    }
  }

  /// Bounds the distances from the leaf to some of eight spheres, of which each holds a point. Where only the greatest
  /// distance is asked for, what is nearer for certain need not be compared with points.
  void boundSpheres(const SphereLanes& spheres, const DistanceObstacle& obstacle, const CarriedLeaf& own,
                    std::uint32_t count, float* lower)
  {
    boundFromBox(spheres, obstacle, own.low, own.high, lower);
    if (leaf_.query.reached) limit_ = std::min(limit_, farthestFromBox(spheres, obstacle, own.low, own.high, count));
  }

  void boundGathered()
  {
    for (const GatheredSpheres::Run& run : gathered_.runs()) {
      const CarriedLeaf& own = leaf_.carried(run.obstacle);
      const DistanceObstacle& obstacle = leaf_.obstacles[run.obstacle];
      float* const lower = gathered_.lower();
      for (std::uint32_t i = run.begin; i < run.end; i += kLanes)
        boundSpheres(gathered_.lanes(i, obstacle.frame.stretch_b), obstacle, own, run.end - i, lower + i);
      std::fill(lower + run.end, lower + run.wholeVectors(), GatheredSpheres::kDone);
      leaf_.work.node_pairs += run.end - run.begin;
      leaf_.pulse.look();
    }
  }

  /// Spheres with a greater lower bound do not hold the nearest point of any point of the leaf.
  float farthest() const
  {
    const float sum = limit_ + own_radii_; // below 0 within balls; one rounding, kReachMargin is good for six
    return sum + std::abs(sum) * kReachMargin;
  }

  template <bool kBalls>
  void takeSphere(const ObstacleSphere& sphere, float lower)
  {
    const CarriedLeaf& own = leaf_.carried(sphere.obstacle);
    if (sphere.isLeaf())
      takeLeaf<kBalls>(own, sphere.obstacle, *sphere.node, sphere.lane, lower);
    else
      takeBelow<kBalls>(own, sphere.obstacle,
                        leaf_.obstacles[sphere.obstacle].voxel->nodes[sphere.node->child[sphere.lane]]);
  }

  template <bool kBalls>
  void takeBelow(const CarriedLeaf& own, std::uint32_t of, const Node& node)
  {
    const DistanceObstacle& obstacle = leaf_.obstacles[of];
    alignas(32) float lower[kLanes];
    boundSpheres({node.x, node.y, node.z, node.r, obstacle.frame.stretch_b}, obstacle, own, node.count, lower);
    leaf_.work.node_pairs += node.count;
    for (std::uint32_t lanes = firstBits(node.count); lanes != 0;) {
      const std::uint32_t lane = smallestLane(lower, lanes);
      lanes &= ~(1u << lane);
      if (lower[lane] > farthest() || leaf_.query.exceeds(limit_)) break;
      if (node.isLeaf(lane))
        takeLeaf<kBalls>(own, of, node, lane, lower[lane]);
      else
        takeBelow<kBalls>(own, of, obstacle.voxel->nodes[node.child[lane]]);
    }
  }

  template <bool kBalls>
  void takeLeaf(const CarriedLeaf& own, std::uint32_t of, const Node& node, std::uint32_t lane, float lower)
  {
    const DistanceObstacle& obstacle = leaf_.obstacles[of];
    const std::uint32_t near = pointsNearSphere(own.points, obstacle, node, lane);
    if (near == 0) return;
    ++leaf_.work.leaf_pairs;
    leaf_.pulse.look();
    const LeafRange other{obstacle.voxel, node.begin[lane], node.comparedPoints(lane)};
    std::uint32_t facing = firstBits(other.count);
    if constexpr (!kBalls) {
      const float reach = (limit_ + own_radii_) * obstacle.at_most_inside + obstacle.slack;
      facing &= pointsNearBox(other.x(), other.y(), other.z(), own.low, own.high, reach,
                              2 * kSphereMargin); // twice: the limit is rounded, too
      if (facing == 0) return;
    }
    const float* const radii = kBalls ? other.voxel->radii + other.begin : nullptr;
    takeNearestTwo<kBalls>(own.points, near, other.x(), other.y(), other.z(), radii,
                           static_cast<float>(1.0 / leaf_.unit), facing,
                           static_cast<std::int32_t>(near_leaves_.size() * kLeafPoints), two_);
    near_leaves_.push_back({of, other, lower});
    error_ = std::max(error_, static_cast<double>(obstacle.error));
    skew_ = obstacle.frame.skew();
    lowerMost<kBalls>();
  }

  static constexpr std::uint32_t kHalf = (1u << kLanes) - 1;

  /// The halves of the leaf whose points may be as near as `most_` to points in a sphere of b. Where b is far, all its
  /// points are near the box around the leaf, and yet near none of the leaf's points. Halves suit vectors of any size.
  ///
  /// A reach of terms >= 0 has three roundings (test/proof/distances.g). Within balls `most_` may be below 0: doubtOf()
  /// pays for what the terms then lose, while they cancel. A reach below 0 is near nothing; its square leaves out
  /// fewer points.
  std::uint32_t pointsNearSphere(const LeafPoints& points, const DistanceObstacle& obstacle, const Node& node,
                                 std::uint32_t lane) const
  {
    const LaneTag d;
    const LaneVector x = hn::Set(d, node.x[lane]), y = hn::Set(d, node.y[lane]), z = hn::Set(d, node.z[lane]);
    const LaneVector more = hn::Set(d, node.r[lane] * obstacle.frame.stretch_b + obstacle.slack);
    std::uint32_t far = 0;
    for (std::size_t i = 0; i < leaf_.lanes; i += hn::Lanes(d)) {
      const LaneVector squared =
          squaredNorm(hn::Sub(hn::Load(d, points.x + i), x), hn::Sub(hn::Load(d, points.y + i), y),
                      hn::Sub(hn::Load(d, points.z + i), z));
      const LaneVector reach = hn::Add(hn::Mul(hn::Load(d, most_ + i), hn::Set(d, obstacle.at_most_inside)), more);
      const LaneVector limit = hn::Mul(hn::Mul(reach, reach), hn::Set(d, 1.0f + 2 * kSphereMargin));
      far |= bitsOf(d, hn::Gt(squared, limit)) << i; // not so for NaN
    }
    const std::uint32_t near = ~far & firstBits(leaf_.range.count);
    return ((near & kHalf) != 0 ? kHalf : 0) | (near > kHalf ? kHalf << kLanes : 0);
  }

  /// Lowers `most_` and the limit to what the nearest points so far tell. The tolerance is subtracted from distances
  /// that were found, not from the cut: a point for which none was found would get none.
  template <bool kBalls>
  void lowerMost()
  {
    const LaneTag d;
    const float error = roundUp(error_), share = roundUp(2 * kMargin + 2 * skew_);
    const bool tolerant = leaf_.query.tolerance > 0.0;
    LaneVector largest = hn::Set(d, -std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < leaf_.lanes; i += hn::Lanes(d)) {
      const LaneVector first = hn::Load(d, two_.first + i), before = hn::Load(d, most_ + i);
      const LaneVector most = hn::Add(lengthOf<kBalls>(first), doubtOf<kBalls>(first, error, share));
      const LaneVector now = hn::IfThenElse(hn::Lt(most, before), most, before);
      hn::Store(now, d, most_ + i);
      largest = hn::Max(largest, hn::IfThenElse(hn::FirstN(d, leaf_.range.count - i), tolerant ? most : now, largest));
    }
    const float now = hn::GetLane(hn::MaxOfLanes(d, largest));
    limit_ = std::min(limit_, tolerant ? beyond(now) : now);
  }

  // In the walk's unit.

  /// Upper and lower bound of the distance that float arithmetic found as `value`: squared, or as that to a ball.
  template <bool kBalls>
  double mostOf(float value) const
  {
    const double length = kBalls ? std::abs(value) + 2.0 * leaf_.largest_radius / leaf_.unit : std::sqrt(double{value});
    return (kBalls ? double{value} : length) + (error_ + (kMargin + 2 * skew_) * (length + error_));
  }
  template <bool kBalls>
  double leastOf(float value) const
  {
    const double length = kBalls ? std::abs(value) + 2.0 * leaf_.largest_radius / leaf_.unit : std::sqrt(double{value});
    return (kBalls ? double{value} : length) - (error_ + (kMargin + 2 * skew_) * (length + error_));
  }

  /// Farther points of b are of no interest once all points of the leaf have one within `found`. The tolerance is taken
  /// off only where `found` is certainly within max_distance: a point must not lose the only one that it has.
  float beyond(double found) const
  {
    const bool all_within = found * leaf_.unit * (1.0 + kMargin) <= leaf_.max;
    return roundUp(all_within ? found - leaf_.query.tolerance / leaf_.unit * (1.0 - kDoubleMargin) : found);
  }

  /// The points whose second nearest may be the nearest.
  template <bool kBalls>
  std::uint32_t ambiguous() const
  {
    const LaneTag d;
    const float error = roundUp(error_), share = roundUp(2 * kMargin + 2 * skew_);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < leaf_.lanes; i += hn::Lanes(d)) {
      const LaneVector first = hn::Load(d, two_.first + i), second = hn::Load(d, two_.second + i);
      const LaneVector most = hn::Add(lengthOf<kBalls>(first), doubtOf<kBalls>(first, error, share));
      const LaneVector least = hn::Sub(lengthOf<kBalls>(second), doubtOf<kBalls>(second, error, share));
      const auto two = hn::Lt(second, hn::Set(d, std::numeric_limits<float>::infinity()));
      bits |= bitsOf(d, hn::AndNot(hn::Gt(least, most), two)) << i;
    }
    return bits & firstBits(leaf_.range.count);
  }

  /// A value that float arithmetic found as a length, less the other point's radius.
  template <bool kBalls>
  static HWY_INLINE LaneVector lengthOf(LaneVector value)
  {
    return kBalls ? value : hn::Sqrt(value);
  }

  /// The error of lengthOf(), at most: mostOf() and leastOf() in float, with twice the margin. The value takes
  /// 7 u + skew of the (32 u + 2 skew) (|value| + 2 R), R the largest of b's radii, and float arithmetic here 6 u. The
  /// rest pays for what pointsNearSphere() does with a value below 0, which is not below -R. Times 1 + 2 u + 2 skew it
  /// loses (2 u + 2 skew) |value|; products and sums of terms that cancel round by 3 u (R + |value|).
  template <bool kBalls>
  HWY_INLINE LaneVector doubtOf(LaneVector value, float error, float share) const
  {
    const LaneTag d;
    const LaneVector length = kBalls ? hn::Add(hn::Abs(value), hn::Set(d, balls_)) : hn::Sqrt(value);
    return hn::Add(hn::Set(d, error), hn::Mul(hn::Add(length, hn::Set(d, error)), hn::Set(d, share)));
  }

  MeasuredLeaf& leaf_;
  GatheredSpheres& gathered_;
  std::vector<NearLeaf>& near_leaves_;
  const float own_radii_; ///< largest radius of a's points, in the walk's unit
  const float balls_;     ///< twice the largest radius of b's points, in the walk's unit

  alignas(64) float most_[kLeafPoints]; ///< upper bounds of the distances of points, in the walk's unit
  NearestTwo two_;
  float limit_ = 0.0f; ///< no point of the leaf is farther than this from its nearest, in the walk's unit
  double error_ = 0.0; ///< of the float distances, in the walk's unit
  double skew_ = 0.0;  ///< of the poses
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

// SPDX-License-Identifier: BSD-3-Clause
// The nearest points of b to the points of one leaf of a. Float arithmetic finds the nearest two to each point; where
// its error leaves open which of them is the nearer, the point is decided by itself in exact arithmetic.

#if defined(PCL_BSH_DISTANCES_DISTANCE_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_DISTANCE_LEAF_INL_H_
#undef PCL_BSH_DISTANCES_DISTANCE_LEAF_INL_H_
#else
#define PCL_BSH_DISTANCES_DISTANCE_LEAF_INL_H_
#endif

#include <pcl_bsh/distances/distance_query.h>
#include <pcl_bsh/distances/distance_visit-inl.h>
#include <pcl_bsh/distances/rounded_lengths-inl.h>
#include <pcl_bsh/query/prefetch.h>
#include <pcl_bsh/traversal/long_triangles-inl.h>

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

class DistanceLeaf {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kMargin = kSphereMargin; ///< 16 u: above what roots, radii and sums round

public:
  DistanceLeaf(const DistancesQuery& query, const DistanceSheet& sheet, DistanceScratch& scratch, Work& work)
  : query_(query),
    sheet_(sheet),
    obstacles_(scratch.obstacles),
    leaves_(scratch.leaves),
    flat_(scratch.flat),
    maybe_(scratch.maybe_nearest),
    gathered_(scratch.gathered),
    near_leaves_(scratch.near_leaves),
    long_(scratch.long_triangles),
    of_triangles_(query.pairs.ofTriangles()),
    laid_flat_(query.b.hierarchy().view().triangles &&
               (query.a.hierarchy().view().triangles || !query.a.hierarchy().view().radii)),
    stamp_(scratch.stamp),
    work_(work),
    view_a_(query.a.hierarchy().view()),
    view_b_(query.b.hierarchy().view()),
    unit_(query.b.hierarchy().storage().frame.unit),
    largest_radius_(query.b.hierarchy().storage().largest_radius),
    own_radii_(roundUp(query.a.hierarchy().storage().largest_radius / unit_)),
    balls_(roundUp(2.0 * largest_radius_ / unit_)),
    max_(query.pairs.reach.most),
    lengths_only_(!query.pairs.haveRadii() && query.a.pose.linear() == Eigen::Matrix3d::Identity() &&
                  query.b.pose.linear() == Eigen::Matrix3d::Identity()),
    moved_only_(query.a.pose.linear() == Eigen::Matrix3d::Identity()),
    unmoved_(moved_only_ && query.a.pose.translation() == Eigen::Vector3d::Zero())
  {
    long_.forget();
    for (int k = 0; k < 3; ++k)
      shift_[static_cast<std::size_t>(k)] = twoSum(query.a.pose.translation()(k), -query.b.pose.translation()(k));
  }

  /// Whether measureBelow() may be called for what is plain.
  bool mayMeasureBelow() const
  {
    return !of_triangles_ && hasBallsInRange() && query_.b.hierarchy().size() < kMostNamed;
  }

  /// Takes the spheres that measureBelow() goes through.
  void gather(const std::vector<NearSphere>& list) { gathered_.gather(list); }

  /// Measures all points of a leaf by what is below the gathered spheres: these can hold a nearest point.
  /// @param visit of the node it is a child of @param lane the child
  /// @param cut no point of the leaf is farther from its nearest, unless that exceeds the greatest distance
  void measureBelow(const Voxel& voxel, const DistanceVisit& visit, std::uint32_t lane, float cut)
  {
    begin(voxel, visit, lane, cut);
    boundGathered();
    measureGathered(visit, lane, cut);
  }

  /// The same by leaves of b.
  /// @param near those that can hold a nearest point; left in another order
  void measure(const Voxel& voxel, const DistanceVisit& visit, std::uint32_t lane, std::vector<NearSphere>& near)
  {
    begin(voxel, visit, lane, visit.cut[lane]);
    if (floatsTell(near)) {
      gather(near);
      return measureGathered(visit, lane, visit.cut[lane]);
    }
    std::sort(near.begin(), near.end(), [](const NearSphere& x, const NearSphere& y) { return x.lower < y.lower; });
    if (laid_flat_) {
      if (!findNearestTriangles(visit, lane, near)) return;
    }
    else {
      near_leaves_.clear();
      for (const auto& [sphere, lower] : near)
        near_leaves_.push_back({sphere.obstacle, sphere.leaf(*obstacles_[sphere.obstacle].voxel), lower});
      for (std::uint32_t i = 0; i < leaf_.count; ++i) found_[i] = decide(i, Found(), visit.cut[lane]);
    }
    writeAll(visit, lane);
  }

private:
  /// The point of b that is the nearest to one of a.
  struct Found {
    const Voxel* voxel = nullptr;                ///< null: none
    std::uint32_t point = 0;                     ///< in the voxel
    double least = -kInfinity, most = kInfinity; ///< of the distance, less the radius of b's point alone
  };

  void begin(const Voxel& voxel, const DistanceVisit& visit, std::uint32_t lane, float cut)
  {
    limit_ = cut;
    leaf_ = {&voxel, visit.node->begin[lane], visit.node->comparedPoints(lane)};
    lanes_ = (leaf_.count + hn::Lanes(LaneTag()) - 1) / hn::Lanes(LaneTag()) * hn::Lanes(LaneTag());
    ++stamp_;
    for (std::uint32_t i = 0; i < leaf_.count && !query_.reached;
         ++i) { // few points are written where one is looked for
      const std::uint32_t record = leaf_.record(i);
      if (!view_a_.triangles) prefetch(view_a_, record);
      sheet_.prefetch(record);
    }
  }

  void measureGathered(const DistanceVisit& visit, std::uint32_t lane, float cut)
  {
    const bool balls = largest_radius_ > 0.0;
    balls ? findNearest<true>() : findNearest<false>();
    if (query_.exceeds(limit_, unit_)) return;
    const std::uint32_t undecided = balls ? ambiguous<true>() : ambiguous<false>();
    for (std::uint32_t i = 0; i < leaf_.count; ++i)
      found_[i] = (undecided >> i & 1) != 0 ? decide(i, named(i), cut) : named(i);
    writeAll(visit, lane);
  }

  void writeAll(const DistanceVisit& visit, std::uint32_t lane)
  {
    if (lengths_only_) measureLengths();
    for (std::uint32_t i = 0; i < leaf_.count; ++i)
      write(i, found_[i], visit.node->begin[lane], visit.node->begin[lane + 1]);
  }

  static constexpr std::size_t kMostNamed = std::size_t{1} << 27; ///< leaves whose points have names

  /// Otherwise radii would leave the range of float.
  bool hasBallsInRange() const { return largest_radius_ == 0.0 || (unit_ >= 0x1p-60 && unit_ <= 0x1p60); }

  /// Whether float distances to these leaves can be compared with each other.
  bool floatsTell(const std::vector<NearSphere>& near) const
  {
    return !of_triangles_ && hasBallsInRange() && near.size() < kMostNamed &&
           std::all_of(near.begin(), near.end(),
                       [&](const NearSphere& candidate) { return obstacles_[candidate.sphere.obstacle].is_plain; });
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
      if (lower[place] > farthest() || query_.exceeds(limit_, unit_)) return;
      takeSphere<kBalls>(gathered_.sphere(place), lower[place]);
    };
    if (lower[nearest] < GatheredSpheres::kDone) take(nearest);
    lower[nearest] = GatheredSpheres::kDone;
    const LaneTag d;
    for (std::uint32_t i = 0; i < gathered_.end(); i += static_cast<std::uint32_t>(hn::Lanes(d))) {
      const LaneVector reach = hn::Set(d, std::min(farthest(), std::numeric_limits<float>::max()));
      for (std::uint32_t near = bitsOf(d, hn::Le(hn::LoadU(d, lower + i), reach)); near != 0; near &= near - 1)
        take(i + static_cast<std::uint32_t>(std::countr_zero(near)));
    }
  }

  /// Bounds the distances from the leaf to some of eight spheres, of which each holds a point. Where only the greatest
  /// distance is asked for, what is nearer for certain need not be compared with points.
  void boundSpheres(const SphereLanes& spheres, const DistanceObstacle& obstacle, const CarriedLeaf& own,
                    std::uint32_t count, float* lower)
  {
    boundFromBox(spheres, obstacle, own.low, own.high, lower);
    if (query_.reached) limit_ = std::min(limit_, farthestFromBox(spheres, obstacle, own.low, own.high, count));
  }

  void boundGathered()
  {
    for (const GatheredSpheres::Run& run : gathered_.runs()) {
      const CarriedLeaf& own = carried(run.obstacle);
      const DistanceObstacle& obstacle = obstacles_[run.obstacle];
      float* const lower = gathered_.lower();
      for (std::uint32_t i = run.begin; i < run.end; i += kLanes)
        boundSpheres(gathered_.lanes(i, obstacle.frame.stretch_b), obstacle, own, run.end - i, lower + i);
      std::fill(lower + run.end, lower + run.wholeVectors(), GatheredSpheres::kDone);
      work_.node_pairs += run.end - run.begin;
    }
  }

  /// Spheres with a greater lower bound hold no nearest point of any.
  float farthest() const
  {
    const float sum = limit_ + own_radii_; // below 0 within balls
    return sum + std::abs(sum) * kReachMargin;
  }

  template <bool kBalls>
  void takeSphere(const ObstacleSphere& sphere, float lower)
  {
    const CarriedLeaf& own = carried(sphere.obstacle);
    if (sphere.isLeaf())
      takeLeaf<kBalls>(own, sphere.obstacle, *sphere.node, sphere.lane, lower);
    else
      takeBelow<kBalls>(own, sphere.obstacle,
                        obstacles_[sphere.obstacle].voxel->nodes[sphere.node->child[sphere.lane]]);
  }

  template <bool kBalls>
  void takeBelow(const CarriedLeaf& own, std::uint32_t of, const Node& node)
  {
    const DistanceObstacle& obstacle = obstacles_[of];
    alignas(32) float lower[kLanes];
    boundSpheres({node.x, node.y, node.z, node.r, obstacle.frame.stretch_b}, obstacle, own, node.count, lower);
    work_.node_pairs += node.count;
    for (std::uint32_t lanes = firstBits(node.count); lanes != 0;) {
      const std::uint32_t lane = smallestLane(lower, lanes);
      lanes &= ~(1u << lane);
      if (lower[lane] > farthest() || query_.exceeds(limit_, unit_)) break;
      if (node.isLeaf(lane))
        takeLeaf<kBalls>(own, of, node, lane, lower[lane]);
      else
        takeBelow<kBalls>(own, of, obstacle.voxel->nodes[node.child[lane]]);
    }
  }

  template <bool kBalls>
  void takeLeaf(const CarriedLeaf& own, std::uint32_t of, const Node& node, std::uint32_t lane, float lower)
  {
    const DistanceObstacle& obstacle = obstacles_[of];
    const std::uint32_t near = pointsNearSphere(own.points, obstacle, node, lane);
    if (near == 0) return;
    ++work_.leaf_pairs;
    const LeafRange other{obstacle.voxel, node.begin[lane], node.comparedPoints(lane)};
    std::uint32_t facing = firstBits(other.count);
    if constexpr (!kBalls) {
      const float reach = (limit_ + own_radii_) * obstacle.at_most_inside + obstacle.slack;
      facing &= pointsNearBox(other.x(), other.y(), other.z(), own.low, own.high, reach,
                              2 * kSphereMargin); // twice: the limit is rounded, too
      if (facing == 0) return;
    }
    const float* const radii = kBalls ? other.voxel->radii + other.begin : nullptr;
    takeNearestTwo<kBalls>(own.points, near, other.x(), other.y(), other.z(), radii, static_cast<float>(1.0 / unit_),
                           facing, static_cast<std::int32_t>(near_leaves_.size() * kLeafPoints), two_);
    near_leaves_.push_back({of, other, lower});
    error_ = std::max(error_, static_cast<double>(obstacle.error));
    skew_ = obstacle.frame.skew();
    lowerMost<kBalls>();
  }

  static constexpr std::uint32_t kHalf = (1u << kLanes) - 1;

  /// In which halves points of the leaf may be as near as `most_` to what is in a sphere of b: where b is far, its
  /// points are all near the box around the leaf, and yet near none of its points. Halves, for vectors of any size.
  std::uint32_t pointsNearSphere(const LeafPoints& points, const DistanceObstacle& obstacle, const Node& node,
                                 std::uint32_t lane) const
  {
    const LaneTag d;
    const LaneVector x = hn::Set(d, node.x[lane]), y = hn::Set(d, node.y[lane]), z = hn::Set(d, node.z[lane]);
    const LaneVector more = hn::Set(d, node.r[lane] * obstacle.frame.stretch_b + obstacle.slack);
    std::uint32_t far = 0;
    for (std::size_t i = 0; i < lanes_; i += hn::Lanes(d)) {
      const LaneVector squared =
          squaredNorm(hn::Sub(hn::Load(d, points.x + i), x), hn::Sub(hn::Load(d, points.y + i), y),
                      hn::Sub(hn::Load(d, points.z + i), z));
      const LaneVector reach = hn::Add(hn::Mul(hn::Load(d, most_ + i), hn::Set(d, obstacle.at_most_inside)), more);
      const LaneVector limit = hn::Mul(hn::Mul(reach, reach), hn::Set(d, 1.0f + 2 * kSphereMargin));
      far |= bitsOf(d, hn::Gt(squared, limit)) << i; // not so for NaN
    }
    const std::uint32_t near = ~far & firstBits(leaf_.count);
    return ((near & kHalf) != 0 ? kHalf : 0) | (near > kHalf ? kHalf << kLanes : 0);
  }

  /// Lowers `most_` and the limit to what the nearest points so far tell. The tolerance is taken off what was found of
  /// all points, not off their cut: a point that has none yet would be left without.
  template <bool kBalls>
  void lowerMost()
  {
    const LaneTag d;
    const float error = roundUp(error_), share = roundUp(2 * kMargin + 2 * skew_);
    const bool tolerant = query_.tolerance > 0.0;
    LaneVector largest = hn::Set(d, -std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < lanes_; i += hn::Lanes(d)) {
      const LaneVector first = hn::Load(d, two_.first + i), before = hn::Load(d, most_ + i);
      const LaneVector most = hn::Add(lengthOf<kBalls>(first), doubtOf<kBalls>(first, error, share));
      const LaneVector now = hn::IfThenElse(hn::Lt(most, before), most, before);
      hn::Store(now, d, most_ + i);
      largest = hn::Max(largest, hn::IfThenElse(hn::FirstN(d, leaf_.count - i), tolerant ? most : now, largest));
    }
    const float now = hn::GetLane(hn::MaxOfLanes(d, largest));
    limit_ = std::min(limit_, tolerant ? beyond(now) : now);
  }

  // In the walk's unit.

  /// At least, and at most, the distance that float arithmetic found to be so: squared, or that to a ball.
  template <bool kBalls>
  double mostOf(float value) const
  {
    const double length = kBalls ? std::abs(value) + 2.0 * largest_radius_ / unit_ : std::sqrt(double{value});
    return (kBalls ? double{value} : length) + (error_ + (kMargin + 2 * skew_) * (length + error_));
  }
  template <bool kBalls>
  double leastOf(float value) const
  {
    const double length = kBalls ? std::abs(value) + 2.0 * largest_radius_ / unit_ : std::sqrt(double{value});
    return (kBalls ? double{value} : length) - (error_ + (kMargin + 2 * skew_) * (length + error_));
  }

  /// What is farther than this is of no interest once all points of the leaf have one so near. Points keep theirs out
  /// of the tolerance until it is certain that they have any.
  float beyond(double found) const
  {
    const bool all_within = found * unit_ * (1.0 + kMargin) <= max_;
    return roundUp(all_within ? found - query_.tolerance / unit_ * (1.0 - kDoubleMargin) : found);
  }

  /// The points whose second nearest may be the nearest.
  template <bool kBalls>
  std::uint32_t ambiguous() const
  {
    const LaneTag d;
    const float error = roundUp(error_), share = roundUp(2 * kMargin + 2 * skew_);
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < lanes_; i += hn::Lanes(d)) {
      const LaneVector first = hn::Load(d, two_.first + i), second = hn::Load(d, two_.second + i);
      const LaneVector most = hn::Add(lengthOf<kBalls>(first), doubtOf<kBalls>(first, error, share));
      const LaneVector least = hn::Sub(lengthOf<kBalls>(second), doubtOf<kBalls>(second, error, share));
      const auto two = hn::Lt(second, hn::Set(d, std::numeric_limits<float>::infinity()));
      bits |= bitsOf(d, hn::AndNot(hn::Gt(least, most), two)) << i;
    }
    return bits & firstBits(leaf_.count);
  }

  /// What float arithmetic found, as a length, less the other point's radius.
  template <bool kBalls>
  static HWY_INLINE LaneVector lengthOf(LaneVector value)
  {
    return kBalls ? value : hn::Sqrt(value);
  }

  /// What it errs by, at most: mostOf() and leastOf() in float, with twice the margin. That pays for float arithmetic,
  /// and for what lengths below 0 lose where they are multiplied by what is above 1.
  template <bool kBalls>
  HWY_INLINE LaneVector doubtOf(LaneVector value, float error, float share) const
  {
    const LaneTag d;
    const LaneVector length = kBalls ? hn::Add(hn::Abs(value), hn::Set(d, balls_)) : hn::Sqrt(value);
    return hn::Add(hn::Set(d, error), hn::Mul(hn::Add(length, hn::Set(d, error)), hn::Set(d, share)));
  }

  const CarriedLeaf& carried(std::uint32_t obstacle)
  {
    CarriedLeaf& own = leaves_[obstacle];
    if (own.stamp == stamp_) return own;
    own.stamp = stamp_;
    carryLeaf(obstacles_[obstacle].frame, leaf_, own.points);
    float* const axes[] = {own.points.x, own.points.y, own.points.z};
    for (std::size_t k = 0; k < 3; ++k) {
      std::fill(axes[k] + leaf_.count, axes[k] + kLeafPoints, axes[k][0]);
      own.low[k] = smallestOf(axes[k], kLeafPoints);
      own.high[k] = largestOf(axes[k], kLeafPoints);
    }
    return own;
  }

  /// The nearest triangle of b to each point of the leaf: floats leave those that may be, longer numbers decide.
  /// @return false where all points are known to be nearer than what was measured
  bool findNearestTriangles(const DistanceVisit& visit, std::uint32_t lane, std::vector<NearSphere>& near)
  {
    std::sort(near.begin(), near.end(), [](const NearSphere& x, const NearSphere& y) { return x.lower < y.lower; });
    const LaneTag d;
    alignas(64) float squared[kLeafPoints], reach[kLeafPoints];
    alignas(64) float nearest[kLeafPoints]; ///< of the squared distances in one obstacle
    for (std::uint32_t i = 0; i < kLeafPoints; ++i)
      most_[i] = i < leaf_.count ? visit.cut[lane] : -std::numeric_limits<float>::infinity();
    maybe_.clear();
    for (const NearSphere& candidate : near) {
      if (candidate.lower > largestOf(most_, kLeafPoints)) break;
      const DistanceObstacle& obstacle = obstacles_[candidate.sphere.obstacle];
      const CarriedLeaf& own = carried(candidate.sphere.obstacle);
      const LeafRange other = candidate.sphere.leaf(*obstacle.voxel);
      const float stretched = stretchOf(obstacle);
      setReach(obstacle, reach);
      if (nearerPoints(own.points, obstacle.heldBy(candidate.sphere), reach) == 0) continue;
      ++work_.leaf_pairs;
      std::fill(std::begin(nearest), std::end(nearest), std::numeric_limits<float>::infinity());
      float largest_error = 0.0f;
      for (std::uint32_t j = 0; j < other.count; ++j) {
        const LaneVector radius = hn::Set(d, enough(other.radius(j) * double{stretched}));
        squaredDistances(own.points, other.x()[j], other.y()[j], other.z()[j], squared);
        bool any = false;
        for (std::size_t i = 0; i < lanes_; i += hn::Lanes(d))
          any = any || !hn::AllTrue(d, isBeyond(hn::Load(d, squared + i), hn::Load(d, reach + i), radius));
        if (!any) continue;
        const FlatRecord& triangle = flat_.of(view_b_, obstacle.voxel->frame, other.record(j));
        MaybeNearest& entry = maybe_.emplace_back();
        entry.obstacle = candidate.sphere.obstacle;
        entry.point = other.begin + j;
        entry.error = enough(triangle.error(obstacle.frame) + view_a_.off_middle / other.voxel->frame.unit);
        squaredToTriangle(triangle.flat, own.points.x, own.points.y, own.points.z, lanes_, entry.squared);
        any = false;
        for (std::size_t i = 0; i < lanes_; i += hn::Lanes(d)) {
          const LaneVector at = hn::LoadU(d, entry.squared + i);
          any = any || !hn::AllTrue(d, isBeyond(at, hn::Load(d, reach + i), hn::Set(d, entry.error)));
          hn::Store(hn::Min(at, hn::Load(d, nearest + i)), d, nearest + i);
        }
        largest_error = std::max(largest_error, entry.error);
        if (!any) maybe_.pop_back();
      }
      const float error = enough(obstacle.frame.error + double{largest_error});
      for (std::size_t i = 0; i < lanes_; i += hn::Lanes(d)) {
        LaneVector low, high;
        boundsOfFlat(d, hn::Load(d, nearest + i), hn::Zero(d), error, obstacle, low, high);
        const LaneVector before = hn::Load(d, most_ + i);
        hn::Store(hn::IfThenElse(hn::Lt(high, before), high, before), d, most_ + i);
      }
    }
    if (query_.exceeds(largestOf(most_, kLeafPoints), unit_)) return false;
    decideAmong();
    return true;
  }

  /// A float that is not below a double >= 0, nor much above it.
  static float enough(double x) { return roundToFloat(x) * (1.0f + 0x1p-22f) + 0x1p-140f; }

  /// At least what a length of the clouds' unit is in the obstacle's.
  static float stretchOf(const DistanceObstacle& obstacle)
  {
    return enough(static_cast<double>(obstacle.frame.stretch_b) / obstacle.voxel->frame.unit);
  }

  /// Sets `radii_`, and lengths in the obstacle's unit: what is farther from a point of the leaf, or from its ball, is
  /// not the nearest.
  void setReach(const DistanceObstacle& obstacle, float* reach)
  {
    const LaneTag d;
    const float stretched = stretchOf(obstacle);
    for (std::uint32_t i = 0; view_a_.radii && i < leaf_.count; ++i)
      radii_[i] = enough(leaf_.radius(i) * double{stretched});
    for (std::size_t i = 0; i < lanes_; i += hn::Lanes(d)) {
      const LaneVector scaled = hn::Mul(hn::Load(d, most_ + i), hn::Set(d, obstacle.at_most_inside));
      const LaneVector sum = hn::Add(hn::Add(scaled, hn::Load(d, radii_ + i)), hn::Set(d, obstacle.slack));
      hn::Store(hn::Mul(sum, hn::Set(d, 1.0f + kFlatMargin)), d, reach + i);
    }
  }

  /// Whether squared distances are surely above the square of a reach and what it may be short of. A reach of minus
  /// infinity is that of no point; NaN is beyond nothing.
  static HWY_INLINE hn::Mask<LaneTag> isBeyond(LaneVector squared, LaneVector reach, LaneVector more)
  {
    const LaneTag d;
    const LaneVector limit = hn::Mul(hn::Add(reach, more), hn::Set(d, 1.0f + kFlatMargin));
    return hn::Or(hn::Gt(squared, hn::Add(hn::Mul(limit, limit), hn::Set(d, kVanishingSquare))),
                  hn::Lt(limit, hn::Zero(d)));
  }

  /// Which points of the leaf may be nearer than their `reach` to what lies in a sphere of b and in its slabs.
  std::uint32_t nearerPoints(const LeafPoints& points, const CrossedSlabs& held, const float* reach) const
  {
    const LaneTag d;
    std::uint32_t far = 0;
    for (std::size_t i = 0; i < lanes_; i += hn::Lanes(d)) {
      const LaneVector length =
          lengthToSlabs(held, hn::Load(d, points.x + i), hn::Load(d, points.y + i), hn::Load(d, points.z + i));
      far |= bitsOf(d, hn::Gt(length, hn::Load(d, reach + i))) << i; // not so for NaN
    }
    return ~far & firstBits(leaf_.count);
  }

  /// What is known of the triangle that is the nearest to a point, of those that were looked at.
  struct Nearest {
    bool compared = false; ///< with another one; the following are set
    SharedPart part;
    double gap; ///< of the triangle, at most
  };

  /// Of the triangles that may be the nearest.
  void decideAmong()
  {
    const LaneTag d;
    std::uint32_t several = 0;
    alignas(64) float reach[kLeafPoints] = {};
    for (std::uint32_t i = 0; i < leaf_.count; ++i) found_[i] = Found();
    placed_ = 0;
    std::uint32_t obstacle = kNoVoxel; // that `reach` is in
    for (const MaybeNearest& entry : maybe_) {
      if (entry.obstacle != obstacle) setReach(obstacles_[obstacle = entry.obstacle], reach);
      std::uint32_t beyond = 0;
      for (std::size_t i = 0; i < lanes_; i += hn::Lanes(d))
        beyond |= bitsOf(d, isBeyond(hn::LoadU(d, entry.squared + i), hn::Load(d, reach + i), hn::Set(d, entry.error)))
                  << i;
      for (std::uint32_t bits = ~beyond & firstBits(leaf_.count); bits != 0; bits &= bits - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(bits));
        const Found found{obstacles_[obstacle].voxel, entry.point};
        if (found_[i].voxel) {
          Nearest& nearest = nearest_[i];
          if ((several >> i & 1) == 0) nearest.compared = false;
          several |= 1u << i;
          compareTriangles(i, found, nearest);
          continue;
        }
        found_[i] = found;
        if (max_ < kInfinity) setBounds(found_[i], obstacles_[obstacle], entry.squared[i], radii_[i], entry.error);
      }
    }
    for (std::uint32_t i = 0; i < leaf_.count; ++i) {
      lengths_[i] = kNotKnown;
      if (!found_[i].voxel || view_a_.radii) continue;
      LongTriangle& triangle = longOf(found_[i]);
      const LongVector& place = placeOf(i);
      lengths_[i] = (several >> i & 1) != 0 ? longDistance(triangle, nearest_[i].part, place)
                                            : longDistance(triangle, nearPartOf(triangle, place), place);
    }
  }

  /// What floats say of a distance.
  void setBounds(Found& found, const DistanceObstacle& obstacle, float squared, float radius, float error) const
  {
    const LaneTag d;
    LaneVector low, high;
    boundsOfFlat(d, hn::Set(d, squared), hn::Set(d, radius), enough(obstacle.frame.error + double{error}), obstacle,
                 low, high);
    const float most = hn::GetLane(high);
    found.least = double{orNone(hn::GetLane(low))} * unit_;
    found.most = std::isnan(most) ? kInfinity : double{most} * unit_;
  }

  /// Takes the nearer of two triangles to point i, of equals the smaller record.
  void compareTriangles(std::uint32_t i, const Found& found, Nearest& nearest)
  {
    Found& best = found_[i];
    ++work_.exact_decisions;
    const bool by_parts = !view_a_.radii;
    const auto partOf = [&](const Found& of) {
      const LongTriangle& triangle = longOf(of);
      return SharedPart(nearPartOf(triangle, placeOf(i)), triangle);
    };
    if (!nearest.compared) {
      nearest.compared = true;
      nearest.gap = double{most_[i]} * unit_;
      if (by_parts) nearest.part = partOf(best);
      best.least = -kInfinity; // of several: what floats say is not the least of them
      best.most = kInfinity;
    }
    SharedPart part;
    const auto take = [&] {
      best.voxel = found.voxel;
      best.point = found.point;
      nearest.part = part;
    };
    if (by_parts) {
      part = partOf(found);
      if (part.low > nearest.part.high) return;
      if (part.high < nearest.part.low) return take();
      if (part.isSameAs(nearest.part)) {
        if (recordOf(found) < recordOf(best)) take();
        return;
      }
    }
    const RecordDistance::Pair pair = posed(i, found), best_pair = posed(i, best);
    nearest.gap = std::min(nearest.gap, query_.pairs.distance.enclose(best_pair).high);
    if (query_.pairs.distance.isSurelyBeyond(pair, nearest.gap)) return;
    const int sign = query_.pairs.distance.compareGaps(pair, best_pair);
    if (sign < 0 || (sign == 0 && recordOf(found) < recordOf(best))) take();
  }

  LongTriangle& longOf(const Found& found) { return long_.of(*view_b_.triangles, query_.b.pose, recordOf(found)); }

  /// Where point i is in the world.
  const LongVector& placeOf(std::uint32_t i)
  {
    LongVector& place = places_[i];
    if ((placed_ >> i & 1) != 0) return place;
    placed_ |= 1u << i;
    const Point3 p = given(i);
    if (unmoved_) return place = LongVector(p);
    if (!moved_only_) return place = LongVector(placedLong(query_.a.pose, p));
    place.error = 0.0;
    place.plain = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const WithError sum = twoSum(p[k], query_.a.pose.translation()[static_cast<Eigen::Index>(k)]);
      place.value[k] = sum.value, place.tail[k] = sum.error;
    }
    return place;
  }

  Found named(std::uint32_t i) const
  {
    if (two_.name[i] < 0) return {};
    const auto name = static_cast<std::size_t>(two_.name[i]);
    const LeafRange& leaf = near_leaves_[name / kLeafPoints].range;
    Found found{leaf.voxel, leaf.begin + static_cast<std::uint32_t>(name % kLeafPoints)};
    if (max_ == kInfinity) return found;
    const bool balls = largest_radius_ > 0.0;
    const float value = two_.first[i];
    found.least = (balls ? leastOf<true>(value) : leastOf<false>(value)) * unit_;
    found.most = (balls ? mostOf<true>(value) : mostOf<false>(value)) * unit_;
    return found;
  }

  Point3 given(std::uint32_t i) const { return leaf_.voxel->point(view_a_, leaf_.begin + i); }

  RecordDistance::Pair posed(std::uint32_t i, const Found& found) const
  {
    if (of_triangles_) return query_.pairs.posed({leaf_.record(i), recordOf(found)});
    return {ExactDistance::Pair{given(i), found.voxel->point(view_b_, found.point), leaf_.radius(i),
                                found.voxel->radii ? double{found.voxel->radii[found.point]} : 0.0},
            {}};
  }

  /// The nearest to one point, of the near leaves, in exact arithmetic; of several the smallest record.
  /// @param best one that may be it, or none @param cut upper bound of its distance, unless that exceeds the greatest
  Found decide(std::uint32_t i, Found best, float cut)
  {
    const double own_radius = leaf_.radius(i);
    RecordDistance::Pair best_pair;
    double most = double{cut} * unit_; // of the distance
    const auto take = [&](const Found& found, const RecordDistance::Pair& pair) {
      best = found;
      best_pair = pair;
      const double radii = pair.radius_p + pair.radius_q, far = query_.pairs.distance.enclose(pair).high;
      most = std::min(most, far - radii + kFewDoubleRoundings * (far + radii));
    };
    if (best.voxel) take(best, posed(i, best));
    std::uint32_t band_of = kNoVoxel; // the obstacle that `miss` is of
    float miss = 0.0f;
    double within = 0.0;
    for (const NearLeaf& candidate : near_leaves_) {
      const double farthest = most + own_radius; // lower bounds may be those of the point, not of its ball
      if (double{candidate.lower} * unit_ > farthest + std::abs(farthest) * kDoubleMargin) continue;
      const DistanceObstacle& obstacle = obstacles_[candidate.obstacle];
      const LeafRange& other = candidate.range;
      const LeafPoints& points = carried(candidate.obstacle).points;
      alignas(64) float squared[kLeafPoints];
      leafSquaredDistances(other.x(), other.y(), other.z(), points.x[i], points.y[i], points.z[i], squared);
      const double reach = (most + own_radius + largest_radius_) * (1.0 + kDoubleMargin);
      if (band_of != candidate.obstacle || !(within == reach)) {
        band_of = candidate.obstacle;
        within = reach;
        miss = obstacle.frame.band(std::isnan(reach) ? kInfinity : std::max(reach, 0.0)).miss;
      }
      for (std::uint32_t bits = firstBits(other.count) & ~above(squared, miss); bits != 0; bits &= bits - 1) {
        const Found found{other.voxel, other.begin + static_cast<std::uint32_t>(std::countr_zero(bits))};
        if (found.voxel == best.voxel && found.point == best.point) continue;
        const RecordDistance::Pair pair = posed(i, found);
        if (of_triangles_ && query_.pairs.distance.isSurelyBeyond(pair, most)) continue;
        if (best.voxel) {
          ++work_.exact_decisions;
          const int sign = query_.pairs.distance.compareGaps(pair, best_pair);
          if (sign > 0 || (sign == 0 && recordOf(best) < recordOf(found))) continue;
        }
        take(found, pair);
      }
    }
    best.least = -kInfinity; // the float distance, if there is one, may be another point's
    best.most = kInfinity;
    return best;
  }

  static std::uint32_t recordOf(const Found& found) { return found.voxel->records()[found.point]; }

  /// Whether the nearest point is within max_distance.
  bool isWithin(const Found& found, const RecordDistance::Pair& pair)
  {
    if (max_ == kInfinity || found.most - pair.radius_p < max_ * (1.0 - kDoubleMargin)) return true;
    if (found.least - pair.radius_p > max_ * (1.0 + kDoubleMargin)) return false;
    ++work_.exact_decisions;
    return query_.pairs.distance.compare(pair, max_) <= 0;
  }

  /// The distances of all that were found, where poses are translations and points have no radii.
  void measureLengths()
  {
    for (std::uint32_t i = 0; i < leaf_.count; ++i) {
      const Found& found = found_[i];
      const Point3 p = given(i), q = found.voxel ? found.voxel->point(view_b_, found.point) : p;
      for (std::size_t k = 0; k < 3; ++k) given_.p[k][i] = p[k], given_.q[k][i] = q[k];
    }
    roundedLengths(given_, leaf_.count, shift_, lengths_);
  }

  /// Writes what was found of point i; of a place that many points share, for all of them.
  void write(std::uint32_t i, const Found& found, std::uint32_t begin, std::uint32_t end)
  {
    double distance = kNotKnown;
    std::uint32_t nearest = kNothing;
    Interval interval{max_, kInfinity};
    if (found.voxel) {
      const bool has_length = lengths_only_ || laid_flat_;
      const bool is_known = has_length && max_ == kInfinity && !std::isnan(lengths_[i]);
      const RecordDistance::Pair pair = is_known ? RecordDistance::Pair() : posed(i, found);
      if (is_known || isWithin(found, pair)) {
        nearest = recordOf(found);
        distance = has_length ? lengths_[i] : kNotKnown;
        if (std::isnan(distance)) distance = query_.pairs.distance.gap(pair);
        if (query_.reached) query_.reached->raise(distance);
        if (sheet_.interval) interval = intervalOf(distance);
      }
    }
    if (end - begin <= kMaxLeafPoints) return sheet_.set(leaf_.record(i), distance, nearest, interval);
    for (std::uint32_t k = begin; k < end; ++k) sheet_.set(leaf_.voxel->records()[k], distance, nearest, interval);
  }

  Interval intervalOf(double distance) const
  {
    double lower = std::nextafter(distance, -kInfinity);
    if (query_.tolerance > 0.0) lower = std::nextafter(lower - query_.tolerance, -kInfinity);
    if (!query_.pairs.mayOverlap()) lower = std::max(lower, 0.0);
    return {lower, distance == 0.0 && !query_.pairs.mayOverlap() ? 0.0 : std::nextafter(distance, kInfinity)};
  }

  const DistancesQuery& query_;
  const DistanceSheet& sheet_;
  const std::vector<DistanceObstacle>& obstacles_;
  std::vector<CarriedLeaf>& leaves_;
  FlatRecords& flat_;
  std::vector<MaybeNearest>& maybe_;
  GatheredSpheres& gathered_;
  std::vector<NearLeaf>& near_leaves_;
  LongTriangles& long_;
  const bool of_triangles_; ///< whether a cloud is
  const bool laid_flat_;    ///< whether b is, and points of a have no radii
  std::uint64_t& stamp_;
  Work& work_;
  const PointsView& view_a_;
  const PointsView& view_b_;
  const double unit_;           ///< of bounds and floats, in the clouds' unit
  const double largest_radius_; ///< of b's points, in the clouds' unit
  const float own_radii_;       ///< the largest of a's points, in the walk's unit
  const float balls_;           ///< two of the largest of b's, likewise
  const double max_;
  const bool lengths_only_; ///< whether distances are lengths of differences between given points, and a shift
  const bool moved_only_;   ///< whether a's pose turns nothing
  const bool unmoved_;      ///< whether it moves nothing, either
  std::array<WithError, 3> shift_;

  LeafRange leaf_;
  Found found_[kLeafPoints];
  GivenPairs given_ = {};
  alignas(64) double lengths_[kLeafPoints]; ///< where they are known
  LongVector places_[kLeafPoints];          ///< of the points that have their bit in placed_
  std::uint32_t placed_ = 0;
  std::size_t lanes_ = kLeafPoints;           ///< of the leaf's points, whole vectors
  alignas(64) float most_[kLeafPoints];       ///< that points are away from what is nearest, in the walk's unit
  alignas(64) float radii_[kLeafPoints] = {}; ///< of a's balls, in the obstacle's unit, at least
  Nearest nearest_[kLeafPoints];              ///< of points that several triangles may be the nearest to
  NearestTwo two_;
  float limit_ = 0.0f; ///< no point of the leaf is farther than this from its nearest, in the walk's unit
  double error_ = 0.0; ///< of the float distances, in the walk's unit
  double skew_ = 0.0;  ///< of the poses
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle

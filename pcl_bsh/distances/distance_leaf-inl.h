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

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

class DistanceLeaf {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kMargin = kSphereMargin; ///< 16 u: above what roots, radii and sums round

public:
  DistanceLeaf(const DistanceQuery& query, const DistanceSheet& sheet, DistanceScratch& scratch, Work& work)
  : query_(query),
    sheet_(sheet),
    obstacles_(scratch.obstacles),
    leaves_(scratch.leaves),
    stamp_(scratch.stamp),
    work_(work),
    view_a_(query.a.hierarchy().view()),
    view_b_(query.b.hierarchy().view()),
    unit_(query.b.hierarchy().storage().frame.unit),
    largest_radius_(query.b.hierarchy().storage().largest_radius),
    max_(query.pairs.clearance)
  {
  }

  /// Measures all points of a leaf.
  /// @param visit of the node it is a child of @param lane the child
  /// @param near the leaves of b that can hold a nearest point; left in the order of their lower bounds
  void measure(const Voxel& voxel, const DistanceVisit& visit, std::uint32_t lane, std::vector<NearSphere>& near)
  {
    leaf_ = {&voxel, visit.node->begin[lane], visit.node->comparedPoints(lane)};
    ++stamp_;
    std::sort(near.begin(), near.end(), [](const NearSphere& x, const NearSphere& y) { return x.lower < y.lower; });
    std::uint32_t undecided = firstBits(leaf_.count);
    const bool by_float = largest_radius_ > 0.0 ? findNearest<true>(visit, lane, near, undecided)
                                                : findNearest<false>(visit, lane, near, undecided);
    for (std::uint32_t i = 0; i < leaf_.count; ++i) {
      const Found found = (undecided >> i & 1) != 0 ? decide(i, near, visit.cut[lane], by_float) : named(i, near);
      write(i, found, visit.node->begin[lane], visit.node->begin[lane + 1]);
    }
  }

private:
  /// The point of b that is the nearest to one of a.
  struct Found {
    const Voxel* voxel = nullptr;         ///< null: none
    std::uint32_t point = 0;              ///< in the voxel
    double least = 0.0, most = kInfinity; ///< of the distance, less the radius of b's point alone
  };

  /// Finds the nearest two of b's points to each point of the leaf by their float distances.
  /// @param undecided receives the points whose nearest is not proven @return false when floats decide nothing
  template <bool kBalls>
  bool findNearest(const DistanceVisit& visit, std::uint32_t lane, const std::vector<NearSphere>& near,
                   std::uint32_t& undecided)
  {
    if (kBalls && !(unit_ >= 0x1p-60 && unit_ <= 0x1p60)) return false; // radii would leave the range of float
    two_.clear();
    for (std::uint32_t i = leaf_.count; i < kLeafPoints; ++i) two_.first[i] = -std::numeric_limits<float>::infinity();
    error_ = kSmallestLength;
    float limit = visit.cut[lane];
    for (std::size_t n = 0; n < near.size() && !(near[n].lower > limit); ++n) {
      const NearSphere& candidate = near[n];
      const DistanceObstacle& obstacle = obstacles_[candidate.sphere.obstacle];
      if (!obstacle.is_plain || n >= kMostNamed) return false;
      ++work_.leaf_pairs;
      const CarriedNode& own = visit.carried[candidate.sphere.obstacle];
      const LeafRange other = candidate.sphere.leaf(*obstacle.voxel);
      std::uint32_t facing = firstBits(other.count);
      if constexpr (!kBalls) {
        const float reach = own.r[lane] + limit * obstacle.at_most_inside + obstacle.prune_reach;
        facing = pointsNear(other.x(), other.y(), other.z(), other.count, own.x[lane], own.y[lane], own.z[lane], reach,
                            2 * kSphereMargin); // twice: the limit is rounded, too
        if (facing == 0) continue;
      }
      const float* const radii = kBalls && other.voxel->radii ? other.voxel->radii + other.begin : nullptr;
      takeNearestTwo<kBalls>(carried(candidate.sphere.obstacle), other.x(), other.y(), other.z(), radii,
                             static_cast<float>(1.0 / unit_), facing, static_cast<std::int32_t>(n * kLeafPoints), two_);
      error_ = std::max(error_, static_cast<double>(obstacle.error));
      skew_ = obstacle.frame.skew();
      limit = std::min(limit, beyond(mostOf<kBalls>(largestOf(two_.first, leaf_.count))));
    }
    undecided = query_.proven ? ambiguous<kBalls>() : 0;
    return true;
  }

  static constexpr std::size_t kMostNamed = std::size_t{1} << 27; ///< leaves whose points have names

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
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < leaf_.count; ++i) {
      const bool two = two_.second[i] < std::numeric_limits<float>::infinity();
      if (two && !(leastOf<kBalls>(two_.second[i]) > mostOf<kBalls>(two_.first[i]))) bits |= 1u << i;
    }
    return bits;
  }

  const LeafPoints& carried(std::uint32_t obstacle)
  {
    CarriedLeaf& own = leaves_[obstacle];
    if (own.stamp != stamp_) {
      carryLeaf(obstacles_[obstacle].frame, leaf_, own.points);
      own.stamp = stamp_;
    }
    return own.points;
  }

  Found named(std::uint32_t i, const std::vector<NearSphere>& near) const
  {
    if (two_.name[i] < 0) return {};
    const auto name = static_cast<std::size_t>(two_.name[i]);
    const ObstacleSphere& sphere = near[name / kLeafPoints].sphere;
    const bool balls = largest_radius_ > 0.0;
    const float value = two_.first[i];
    return {obstacles_[sphere.obstacle].voxel,
            sphere.node->begin[sphere.lane] + static_cast<std::uint32_t>(name % kLeafPoints),
            (balls ? leastOf<true>(value) : leastOf<false>(value)) * unit_,
            (balls ? mostOf<true>(value) : mostOf<false>(value)) * unit_};
  }

  Point3 given(std::uint32_t i) const { return leaf_.voxel->point(view_a_, leaf_.begin + i); }

  ExactDistance::Pair posed(std::uint32_t i, const Found& found) const
  {
    return {given(i), found.voxel->point(view_b_, found.point), leaf_.radius(i),
            found.voxel->radii ? double{found.voxel->radii[found.point]} : 0.0};
  }

  /// The nearest to one point in exact arithmetic, of several the smallest record.
  /// @param cut upper bound of its distance, unless that exceeds the greatest one
  Found decide(std::uint32_t i, const std::vector<NearSphere>& near, float cut, bool by_float)
  {
    Found best = by_float ? named(i, near) : Found();
    const double own_radius = leaf_.radius(i);
    ExactDistance::Pair best_pair;
    double most = double{cut} * unit_; // of the distance
    const auto take = [&](const Found& found, const ExactDistance::Pair& pair) {
      best = found;
      best_pair = pair;
      const double radii = pair.radius_p + pair.radius_q, far = query_.pairs.distance.enclose(pair.p, pair.q).high;
      most = std::min(most, far - radii + kFewDoubleRoundings * (far + radii));
    };
    if (best.voxel) take(best, posed(i, best));
    for (const NearSphere& candidate : near) {
      if (double{candidate.lower} * unit_ > most) break;
      const DistanceObstacle& obstacle = obstacles_[candidate.sphere.obstacle];
      const LeafRange other = candidate.sphere.leaf(*obstacle.voxel);
      const LeafPoints& points = carried(candidate.sphere.obstacle);
      alignas(64) float squared[kLeafPoints];
      leafSquaredDistances(other.x(), other.y(), other.z(), points.x[i], points.y[i], points.z[i], squared);
      const double within = (most + own_radius + largest_radius_) * (1.0 + kDoubleMargin);
      const float miss = obstacle.frame.band(std::isnan(within) ? kInfinity : std::max(within, 0.0)).miss;
      for (std::uint32_t bits = firstBits(other.count) & ~above(squared, miss); bits != 0; bits &= bits - 1) {
        const Found found{other.voxel, other.begin + static_cast<std::uint32_t>(std::countr_zero(bits))};
        if (found.voxel == best.voxel && found.point == best.point) continue;
        const ExactDistance::Pair pair = posed(i, found);
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

  /// Whether the nearest point is within the greatest distance.
  bool isWithin(const Found& found, const ExactDistance::Pair& pair)
  {
    if (max_ == kInfinity || found.most - pair.radius_p < max_ * (1.0 - kDoubleMargin)) return true;
    if (found.least - pair.radius_p > max_ * (1.0 + kDoubleMargin)) return false;
    ++work_.exact_decisions;
    return query_.pairs.distance.compare(pair.p, pair.q, max_, pair.radius_p, pair.radius_q) <= 0;
  }

  /// Writes what was found of point i; of a place that many points share, for all of them.
  void write(std::uint32_t i, const Found& found, std::uint32_t begin, std::uint32_t end)
  {
    double distance = std::numeric_limits<double>::quiet_NaN();
    std::uint32_t nearest = PointDistances::kNoPoint;
    Interval interval{max_, kInfinity};
    if (found.voxel) {
      const ExactDistance::Pair pair = posed(i, found);
      if (isWithin(found, pair)) {
        nearest = recordOf(found);
        const bool by_float = !query_.proven && found.most < kInfinity;
        distance = by_float ? (found.least + found.most) / 2 - pair.radius_p : query_.pairs.distance.gap(pair);
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
    if (!query_.pairs.haveRadii()) lower = std::max(lower, 0.0);
    return {lower, distance == 0.0 && !query_.pairs.haveRadii() ? 0.0 : std::nextafter(distance, kInfinity)};
  }

  const DistanceQuery& query_;
  const DistanceSheet& sheet_;
  const std::vector<DistanceObstacle>& obstacles_;
  std::vector<CarriedLeaf>& leaves_;
  std::uint64_t& stamp_;
  Work& work_;
  const PointsView& view_a_;
  const PointsView& view_b_;
  const double unit_; ///< of bounds and floats, in the clouds' unit
  const double largest_radius_;
  const double max_;

  LeafRange leaf_;
  NearestTwo two_;
  double error_ = 0.0; ///< of the float distances, in the walk's unit
  double skew_ = 0.0;
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle

// SPDX-License-Identifier: BSD-3-Clause
// Measures the points of one leaf of a. Float arithmetic finds the nearest of b's; where its error leaves open which is
// the nearest, the point is decided by itself in exact arithmetic.

#if defined(PCL_BSH_DISTANCES_DISTANCE_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_DISTANCES_DISTANCE_LEAF_INL_H_
#undef PCL_BSH_DISTANCES_DISTANCE_LEAF_INL_H_
#else
#define PCL_BSH_DISTANCES_DISTANCE_LEAF_INL_H_
#endif

#include <pcl_bsh/distances/measured_leaf-inl.h>
#include <pcl_bsh/distances/nearest_points-inl.h>
#include <pcl_bsh/distances/nearest_triangles-inl.h>
#include <pcl_bsh/distances/rounded_lengths-inl.h>
#include <pcl_bsh/distances/triangle_descent-inl.h>
#include <pcl_bsh/query/prefetch.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

class DistanceLeaf {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

public:
  DistanceLeaf(const DistancesQuery& query, const DistanceSheet& sheet, DistanceScratch& scratch, Work& work)
  : leaf_(query, scratch, work),
    points_(leaf_, scratch),
    triangles_(leaf_, scratch),
    sheet_(sheet),
    near_leaves_(scratch.near_leaves),
    laid_flat_(leaf_.view_b.triangles && !leaf_.view_a.radii),
    lengths_only_(!query.pairs.haveRadii() && query.a.pose.linear() == Eigen::Matrix3d::Identity() &&
                  query.b.pose.linear() == Eigen::Matrix3d::Identity())
  {
    if (leaf_.view_a.triangles) descent_.emplace(leaf_);
    for (int k = 0; k < 3; ++k)
      shift_[static_cast<std::size_t>(k)] = twoSum(query.a.pose.translation()(k), -query.b.pose.translation()(k));
  }

  /// Whether measureAlone() may be called. It leaves out what is not plain.
  bool mayMeasureAlone() const { return points_.mayFindBelow(); }

  /// Measures the leaves of a visit that go through its list by themselves: eight spheres at once, and the points of
  /// the nearest bound what is left better than spheres do.
  /// @param cut no point is farther from its nearest, unless that is beyond max_distance @return these leaves
  std::uint32_t measureAlone(const Voxel& voxel, const DistanceVisit& visit, const std::vector<NearSphere>& list,
                             float cut)
  {
    const std::uint32_t alone = leavesAlone(visit, list);
    if (alone != 0) points_.gather(list);
    for (const std::uint32_t lane : Bits(alone)) {
      begin(voxel, visit, lane);
      bounds_points_ = true;
      if (points_.findBelow(cut)) writePoints(visit, lane, cut);
    }
    return alone;
  }

  /// Measures all points of a leaf by leaves of b. @param visit of the node it is a child of @param lane the child
  /// @param near leaves of b that can hold a nearest point; their order changes
  void measure(const Voxel& voxel, const DistanceVisit& visit, std::uint32_t lane, std::vector<NearSphere>& near)
  {
    const float cut = visit.cut[lane];
    if (leaf_.view_a.triangles) {
      const auto none = [](const ObstacleSphere& leaf) { return leaf; };
      return measureTriangles(voxel, visit, lane, cut, near, none);
    }
    begin(voxel, visit, lane);
    bounds_points_ = false;
    if (points_.floatsTell(near)) {
      points_.gather(near);
      if (points_.find(cut)) writePoints(visit, lane, cut);
      return;
    }
    const auto nearer = [](const NearSphere& x, const NearSphere& y) { return x.lower < y.lower; };
    if (leaf_.of_triangles)
      std::sort(near.begin(), near.end(), nearer);
    else if (!near.empty()) // to sort long lists costs more than it spares; the nearest leaves little to the others
      std::iter_swap(near.begin(), std::min_element(near.begin(), near.end(), nearer));
    if (laid_flat_) {
      if (!triangles_.find(cut, near)) return;
    }
    else {
      near_leaves_.clear();
      leaf_.work.leaf_pairs += near.size();
      for (const auto& [sphere, lower] : near)
        near_leaves_.push_back({sphere.obstacle, sphere.leaf(*leaf_.obstacles[sphere.obstacle].voxel), lower});
      for (std::uint32_t i = 0; i < leaf_.range.count; ++i) leaf_.found[i] = decide(i, NearestFound(), cut);
    }
    writeAll(visit, lane);
  }

  /// Measures all triangles of a leaf. Each of them goes down from the list by itself.
  /// @param below as TriangleDescent::nearest() has it
  template <class Below>
  void measureTriangles(const Voxel& voxel, const DistanceVisit& visit, std::uint32_t lane, float cut,
                        const std::vector<NearSphere>& list, const Below& below)
  {
    begin(voxel, visit, lane);
    descent_->begin(*visit.node, lane);
    for (std::uint32_t i = 0; i < leaf_.range.count; ++i) {
      const NearestFound found = descent_->nearest(i, cut, list, below);
      if (!leaf_.query.exceeds(descent_->limit()))
        write(i, found, visit.node->begin[lane], visit.node->begin[lane + 1]);
    }
  }

private:
  /// The leaves that may go through the list by themselves: neither blunt, nor small beside a leaf of the list. There
  /// are none where a sphere of the list is above the voxels, or its obstacle is not plain.
  std::uint32_t leavesAlone(const DistanceVisit& visit, const std::vector<NearSphere>& list) const
  {
    if (visit.leaves == 0) return 0;
    float least = 0.0f;
    for (const NearSphere& near : list) {
      const ObstacleSphere& sphere = near.sphere;
      const DistanceObstacle& obstacle = leaf_.obstacles[sphere.obstacle];
      if (sphere.level == 0 || !obstacle.is_plain) return 0;
      least = std::max(least, obstacle.blunt_radius);
      if (sphere.isLeaf()) least = std::max(least, sphere.node->r[sphere.lane] * (1.0f / kLargeLeaf));
    }
    std::uint32_t alone = 0;
    for (std::uint32_t lane = 0; lane < visit.node->count; ++lane)
      alone |= (visit.node->r[lane] > least ? 1u : 0u) << lane;
    return alone & visit.leaves;
  }

  void begin(const Voxel& voxel, const DistanceVisit& visit, std::uint32_t lane)
  {
    leaf_.begin(voxel, visit, lane);
    if (leaf_.query.reached) return; // few points are written where one is looked for
    for (std::uint32_t i = 0; i < leaf_.range.count; ++i) {
      const std::uint32_t record = leaf_.range.record(i);
      if (!leaf_.view_a.triangles) prefetch(leaf_.view_a, record);
      sheet_.prefetch(record);
    }
  }

  void writePoints(const DistanceVisit& visit, std::uint32_t lane, float cut)
  {
    const std::uint32_t undecided = points_.undecided();
    for (std::uint32_t i = 0; i < leaf_.range.count; ++i)
      leaf_.found[i] = (undecided >> i & 1) != 0 ? decide(i, points_.named(i), cut) : points_.named(i);
    writeAll(visit, lane);
  }

  void writeAll(const DistanceVisit& visit, std::uint32_t lane)
  {
    if (lengths_only_) measureLengths();
    for (std::uint32_t i = 0; i < leaf_.range.count; ++i)
      write(i, leaf_.found[i], visit.node->begin[lane], visit.node->begin[lane + 1]);
  }

  /// Returns the nearest record of the near leaves to point i, in exact arithmetic; of several the smallest.
  /// @param named a record that may be it, or none
  /// @param cut upper bound of its distance, unless that is beyond max_distance
  NearestFound decide(std::uint32_t i, const NearestFound& named, float cut)
  {
    const double own_radius = leaf_.range.radius(i);
    BestRecord best(leaf_, i, cut);
    if (named.voxel) best.begin(named);
    std::uint32_t band_of = kNoVoxel; // the obstacle that `miss` is of
    float miss = 0.0f;
    double within = 0.0;
    for (const NearLeaf& candidate : near_leaves_) {
      const double farthest = bounds_points_ ? best.most() + own_radius : best.most();
      if (double{candidate.lower} * leaf_.unit > farthest + std::abs(farthest) * kDoubleMargin) continue;
      leaf_.pulse.step();
      const DistanceObstacle& obstacle = leaf_.obstacles[candidate.obstacle];
      const LeafRange& other = candidate.range;
      const LeafPoints& points = leaf_.carried(candidate.obstacle).points;
      alignas(64) float squared[kLeafPoints];
      leafSquaredDistances(other.x(), other.y(), other.z(), points.x[i], points.y[i], points.z[i], squared);
      const double reach = (best.most() + own_radius + leaf_.largest_radius) * (1.0 + kDoubleMargin);
      if (band_of != candidate.obstacle || !(within == reach)) {
        band_of = candidate.obstacle;
        within = reach;
        miss = obstacle.frame.band(std::isnan(reach) ? kInfinity : std::max(reach, 0.0)).miss;
      }
      for (const std::uint32_t j : Bits(firstBits(other.count) & ~above(squared, miss)))
        best.consider({other.voxel, other.begin + j});
    }
    return best.found();
  }

  /// Whether the nearest point is within max_distance.
  bool isWithin(const NearestFound& found, const RecordDistance::Pair& pair)
  {
    if (leaf_.max == kInfinity || found.most - pair.radius_p < leaf_.max * (1.0 - kDoubleMargin)) return true;
    if (found.least - pair.radius_p > leaf_.max * (1.0 + kDoubleMargin)) return false;
    ++leaf_.work.exact_decisions;
    return leaf_.query.pairs.distance.compare(pair, leaf_.max) <= 0;
  }

  /// The distances of all that were found, where poses are translations and points have no radii.
  void measureLengths()
  {
    for (std::uint32_t i = 0; i < leaf_.range.count; ++i) {
      const NearestFound& found = leaf_.found[i];
      const Point3 p = leaf_.given(i), q = found.voxel ? found.voxel->point(leaf_.view_b, found.point) : p;
      for (std::size_t k = 0; k < 3; ++k) given_.p[k][i] = p[k], given_.q[k][i] = q[k];
    }
    roundedLengths(given_, leaf_.range.count, shift_, leaf_.length);
  }

  /// Writes what was found of point i; of a place that many points share, for all of them.
  void write(std::uint32_t i, const NearestFound& found, std::uint32_t begin, std::uint32_t end)
  {
    double distance = kNotKnown;
    std::uint32_t nearest = kNothing;
    Interval interval{leaf_.max, kInfinity};
    if (found.voxel) {
      const bool has_length = lengths_only_ || laid_flat_;
      const bool is_known = has_length && leaf_.max == kInfinity && !std::isnan(leaf_.length[i]);
      const RecordDistance::Pair pair = is_known ? RecordDistance::Pair() : leaf_.posed(i, found);
      if (is_known || isWithin(found, pair)) {
        nearest = recordOf(found);
        distance = has_length ? leaf_.length[i] : kNotKnown;
        if (std::isnan(distance)) distance = leaf_.query.pairs.distance.gap(pair);
        if (leaf_.query.reached) leaf_.query.reached->raise(distance);
        if (sheet_.interval) interval = intervalOf(distance);
      }
    }
    if (end - begin <= kMaxLeafPoints) return sheet_.set(leaf_.range.record(i), distance, nearest, interval);
    for (std::uint32_t k = begin; k < end; ++k)
      sheet_.set(leaf_.range.voxel->records()[k], distance, nearest, interval);
  }

  Interval intervalOf(double distance) const
  {
    double lower = std::nextafter(distance, -kInfinity);
    if (leaf_.query.tolerance > 0.0) lower = std::nextafter(lower - leaf_.query.tolerance, -kInfinity);
    if (!leaf_.query.pairs.mayOverlap()) lower = std::max(lower, 0.0);
    return {lower, distance == 0.0 && !leaf_.query.pairs.mayOverlap() ? 0.0 : std::nextafter(distance, kInfinity)};
  }

  MeasuredLeaf leaf_;
  NearestPoints points_;
  NearestTriangles triangles_;
  std::optional<TriangleDescent> descent_; ///< where a is of triangles
  const DistanceSheet& sheet_;
  std::vector<NearLeaf>& near_leaves_;
  bool bounds_points_ = false; ///< whether their lower bounds are those of the leaf's points, not of its balls
  const bool laid_flat_;       ///< whether b is, and points of a have no radii
  const bool lengths_only_;    ///< whether distances are lengths of differences between given points, and a shift
  std::array<WithError, 3> shift_;

  GivenPairs given_ = {};
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

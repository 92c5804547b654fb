// SPDX-License-Identifier: BSD-3-Clause
#include <pcl_bsh/pairs/check_request.h>
#include <pcl_bsh/pairs/pairs_along.h>
#include <pcl_bsh/query/progress.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/pairs/pairs_along.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/pairs/reach_walk-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {
namespace {

/// Collects pairs of records of a on their ways and records of b. The way of a record below a lane differs from that of
/// the lane's middle by at most the norm of the turn times the lane's radius.
class PassingPairs {
public:
  static constexpr bool kHasWays = true;

  PassingPairs(const Placed& a, const StraightWays& ways, const Placed& b, const ContactsRequest& request,
               std::uint64_t most_leaf_pairs, const EndOfWays& end_of_ways, PairsWithin& result)
  : pairs(a, b, request.clearance),
    ways_(ways),
    turn_size_(ways.turn.norm() * kUp),
    beside_((request.clearance + ways.stray) * kUp),
    most_(request.most),
    most_leaf_pairs_(most_leaf_pairs),
    end_of_ways_(end_of_ways),
    result_(result)
  {
  }

  double reach() const { return reach_; }

  void enter(PairWalk& walk, const LanePair& lanes)
  {
    const Sphere of_a = sphereOf(walk, walk.a, lanes.a), of_b = sphereOf(walk, walk.b, lanes.b);
    way_ = end_ * ways_.way(of_a.center);
    near_ = beside_ + turn_size_ * of_a.radius;
    reach_ = near_ + way_.norm() * kUp + kVanishing;
    const Eigen::Vector3d place_a = walk.a.pose * of_a.center, place_b = walk.b.pose * of_b.center;
    const double radii = of_a.radius + of_b.radius;
    const double rounding = kDoubleMargin * (of_a.center.lpNorm<1>() + of_b.center.lpNorm<1>() + place_a.lpNorm<1>() +
                                             place_b.lpNorm<1>() + reach_ + radii);
    const Eigen::Vector3d apart = place_a - place_b;
    is_beyond_ = leastOnWay(apart, way_) - rounding > near_ + radii;
    if (!is_beyond_ && walk.haveSlabs(lanes.a, lanes.b))
      is_beyond_ = areSlabsBeyond(worldSlabOf(walk, walk.a, lanes.a, of_a.radius),
                                  worldSlabOf(walk, walk.b, lanes.b, of_b.radius), apart, rounding);
  }

  bool passesOver(const PairWalk&, const LanePair&) const { return is_beyond_; }

  /// Whether to compare one more pair of leaves.
  bool goesOn(const Work& work) { return result_.complete = work.leaf_pairs <= most_leaf_pairs_; }

  /// The ways of the leaf that was entered, in the frame.
  PointsWay way(const Spaces& b, const RelativeFrame& frame) const
  {
    const Eigen::Vector3f way = (b.pose.linear().transpose() * way_ / frame.unit()).cast<float>();
    const float square = way.squaredNorm();
    return {way.x(), way.y(), way.z(), square > kLeastSquare ? 1.0f / square : 0.0f};
  }

  /// Beside the way. Rounding changes a point's way and its distance by less than the second term. A way that is taken
  /// for rest is shorter than the third.
  float miss(const RelativeFrame& frame) const
  {
    return frame.band(near_ + 0x1p-20 * reach_ + 2.0 * frame.unit() * std::sqrt(double{kLeastSquare})).miss;
  }

  Added add(PointPair pair, bool, Work&)
  {
    const Added added = keepPair(pair, most_, result_);
    if (added == Added::kept && end_of_ways_) end_ = std::min(end_, end_of_ways_(pair));
    return added;
  }

  const PointPairs pairs;

private:
  static constexpr double kUp = 1.0 + kDoubleMargin;
  static constexpr float kLeastSquare = 0x1p-100f; ///< of a way, in a frame's units
  static constexpr double kVanishing = 0x1p-450;   ///< a length below it may have a square that vanishes

  struct Sphere {
    Eigen::Vector3d center; ///< in the cloud's frame
    double radius;          ///< as poses may stretch it, with the rounding of stored points
  };

  static Sphere sphereOf(const PairWalk& walk, const Spaces& side, const Lane& lane)
  {
    const Node& node = walk.nodeOf(side, lane);
    const LocalFrame& frame = side.frame(lane.space);
    const Eigen::Vector3d stored(node.x[lane.lane], node.y[lane.lane], node.z[lane.lane]);
    const double rounding = frame.slack(0) + frame.slack(1) + frame.slack(2);
    return {stored * frame.unit + Eigen::Vector3d(frame.origin[0], frame.origin[1], frame.origin[2]),
            (node.r[lane.lane] + rounding) * frame.unit * (1.0 + kPoseStretch)};
  }

  /// The least size of from + t way, t from 0 to 1.
  static double leastAlong(double from, double way)
  {
    const double to = from + way;
    return from * to <= 0.0 ? 0.0 : std::min(std::abs(from), std::abs(to));
  }

  /// Whether slabs stay farther apart than `near_` on all of the way: along the normal of either and across it. Spheres
  /// of facing surfaces overlap on most of the way; a way along the surfaces keeps their gap. kSlabMargin of all
  /// lengths pays for normals that are not of length one, as in FacingSlabs. A normal of 0 proves nothing.
  bool areSlabsBeyond(const WorldSlab& a, const WorldSlab& b, const Eigen::Vector3d& apart, double rounding) const
  {
    if (a.normal.isZero(0.0) || b.normal.isZero(0.0)) return false;
    const auto along = [&](const WorldSlab& own, const WorldSlab& other) {
      return leastAlong(own.normal.dot(apart), own.normal.dot(way_)) - own.h - other.support(own.normal);
    };
    const double along_a = along(a, b), along_b = along(b, a);
    const Eigen::Vector3d& normal = along_a > along_b ? a.normal : b.normal;
    const double radii = a.radius + b.radius;
    const double margin = kSlabMargin * (apart.lpNorm<1>() + way_.lpNorm<1>() + radii) + rounding;
    const double far_along = std::max(std::max(along_a, along_b) - margin, 0.0);
    const double across = std::max(
        leastOnWay(apart - normal.dot(apart) * normal, way_ - normal.dot(way_) * normal) - radii - margin, 0.0);
    return far_along * far_along + across * across > near_ * near_ * kUp;
  }

  const StraightWays& ways_;
  const double turn_size_;
  const double beside_; ///< how far beside their ways points may be: clearance and stray
  const std::size_t most_;
  const std::uint64_t most_leaf_pairs_;
  const EndOfWays& end_of_ways_;
  PairsWithin& result_;
  double end_ = 1.0; ///< t up to which ways are of interest

  // The lanes that were entered have these:
  Eigen::Vector3d way_ = Eigen::Vector3d::Zero(); ///< of their middle, as far as it is of interest
  double near_ = 0.0;                             ///< how far beside that way points may be
  double reach_ = std::numeric_limits<double>::infinity();
  bool is_beyond_ = false;
};

} // namespace

void pairsAlongOnTarget(const Placed& a, const StraightWays& ways, const Placed& b, const ContactsRequest& request,
                        std::uint64_t most_leaf_pairs, const EndOfWays& end_of_ways, Progress& progress,
                        PairsWithin& result)
{
  PassingPairs receiver(a, ways, b, request, most_leaf_pairs, end_of_ways, result);
  result.work = ReachWalk(a, b, receiver, progress).run();
}

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(pairsAlongOnTarget);

double leastOnWay(const Eigen::Vector3d& from, const Eigen::Vector3d& way)
{
  const double square = way.squaredNorm();
  const double share = square > 0.0 ? std::clamp(-from.dot(way) / square, 0.0, 1.0) : 0.0;
  return (from + share * way).norm();
}

PairsWithin pairsAlong(const SphereHierarchy& a, const StraightWays& ways, const Placed& b,
                       const ContactsRequest& request, std::uint64_t most_leaf_pairs, const EndOfWays& end_of_ways)
{
  const Placed start(a, ways.start);
  check(start, b, request);
  const DefaultFloatEnvironment environment;
  Progress progress(request.progress);
  PairsWithin found;
  HWY_DYNAMIC_DISPATCH(pairsAlongOnTarget)(start, ways, b, request, most_leaf_pairs, end_of_ways, progress, found);
  progress.finish();
  return found;
}

} // namespace pcl_bsh
#endif

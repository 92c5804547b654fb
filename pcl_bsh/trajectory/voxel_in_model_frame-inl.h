// SPDX-License-Identifier: BSD-3-Clause
// How the model sees a voxel of the scan that it passes: its points move nearly on parabolas.

#if defined(PCL_BSH_TRAJECTORY_VOXEL_IN_MODEL_FRAME_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_VOXEL_IN_MODEL_FRAME_INL_H_
#undef PCL_BSH_TRAJECTORY_VOXEL_IN_MODEL_FRAME_INL_H_
#else
#define PCL_BSH_TRAJECTORY_VOXEL_IN_MODEL_FRAME_INL_H_
#endif

#include <pcl_bsh/geometry/sphere_radius.h>
#include <pcl_bsh/query/length_band.h>
#include <pcl_bsh/simd/passing_points-inl.h>
#include <pcl_bsh/trajectory/query.h>
#include <pcl_bsh/traversal/leaf_pair-inl.h>

#include <array>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// How points of the scan's voxel are seen by the model: y = m x + g.
struct AffineMap {
  float m[9], g[3];
};

/// How the scan's voxel moves, as the model sees it, during an interval of poses.
struct VoxelMotion {
  const PathInterval* interval;
  AffineMap from, to, bow; ///< the bow is that of a parabola: see Segments
  double stray;            ///< of any point of the voxel from its parabola
  double line_stray;       ///< from its straight line
  float steps;             ///< poses after the first; 0 where all instants count
  float reach;             ///< a point that collides is within this of a parabola, in floats
  float near;              ///< records in a box farther than this, in floats at one pose, do not collide
  float near_squared;      ///< `near` squared
  float smallest;          ///< motion that floats distinguish from rest
  float rounding;          ///< of places in floats
  float blunt;             ///< smaller boxes are not told apart at single poses; 0 where motion is swept
  bool squares;            ///< whether squares of places, and of `smallest`, are in the range of floats
  bool at_rest;            ///< one pose, and nothing before or after it

  /// Whether it has halves, and strays farther than `stray_limit`.
  bool divides(double stray_limit) const { return interval->divided() && stray > stray_limit; }
};

/// A voxel of the scan as the model sees it.
class VoxelInModelFrame {
public:
  VoxelInModelFrame(const TrajectoryQuery& query, std::uint32_t index)
  : voxel(query.scan.hierarchy().storage().voxels[index]),
    frame(voxel.frame),
    path(query.path),
    tree(query.boxes),
    origin(carried(query.scan.pose, frame.origin)),
    radius(voxel.radius * frame.unit),
    query_(query)
  {
    double slack = 0.0;
    for (int k = 0; k < 3; ++k) slack += frame.slack(k) * frame.slack(k);
    slack = std::sqrt(slack) * (1.0 + kDoubleMargin) * frame.unit;
    const double skew = path.skew;
    placing_ = query.error(origin) + (1.0 + skew) * (slack + tree.voxel_slack);
    far = (radius + query.reach) * (1.0 + skew) + placing_ + tree.voxel_reach;
    // Per axis, of a shift up to `far` and of products that add up to the radius at most: rows are of length 1.
    const double carried = kCarriedShiftError * far + kCarriedProductError * (1.0 + skew) * radius;
    error = placing_ + kAxes * carried * (1.0 + kDoubleMargin) + kSmallestLength;
    // Pairs with reaches of their own are compared without a tolerance.
    const LengthBand length_band(query.between, query.nearestDecides() ? query.request.accuracy : Accuracy::exact());
    band = length_band.band([&](double distance) { return skewedBand(distance, error, skew); });
  }

  const Voxel& voxel; ///< sorted at least
  const LocalFrame& frame;
  const PosePath& path;
  const BoxTree& tree;
  const Point3 origin; ///< of the frame, in the world
  const double radius; ///< of the voxel, in the clouds' unit
  double far = 0.0;    ///< origins of voxels whose points collide are at most this far apart along each axis
  double error = 0.0;  ///< of distances between points of such voxels, evaluated in float
  DistanceBand band;   ///< of the clearance, for them

  /// @param from in the model, relative to the tree's origin. @param unit of the places seen.
  AffineMap mapAt(const PathPose& pose, const Point3& from, double unit) const
  {
    AffineMap map;
    const Point3 seen = pose.see(origin);
    const auto scale = static_cast<float>(frame.unit / unit);
    for (std::size_t i = 0; i < 9; ++i) map.m[i] = pose.turn[i] * scale;
    for (std::size_t i = 0; i < 3; ++i) map.g[i] = roundToFloat((seen[i] - from[i]) / unit);
    return map;
  }

  /// Leaf after leaf of a voxel divides the path into the same intervals: some motions are kept.
  VoxelMotion motionOf(std::uint32_t index) const
  {
    KeptMotion& kept = kept_[index % kKeptMotions];
    if (kept.interval != index || !kept.known) kept = {motionOf(path.intervals[index]), index, true};
    return kept.motion;
  }

  /// Returns the motion at one pose of a path that is not swept.
  /// @param interval becomes that pose, and has to outlive the motion.
  VoxelMotion motionAt(std::uint32_t k, PathInterval& interval) const
  {
    interval = PathInterval{};
    interval.first = interval.last = k;
    interval.pivot = path.poses[k].center;
    return motionOf(interval);
  }

  VoxelMotion motionOf(const PathInterval& interval) const
  {
    VoxelMotion motion;
    motion.interval = &interval;
    motion.at_rest = !path.is_swept && interval.first == interval.last;
    motion.from = mapAt(path.poses[interval.first], {0, 0, 0}, 1.0);
    motion.to = mapAt(path.poses[interval.last], {0, 0, 0}, 1.0);
    double squared = 0.0, coordinate = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      squared += (origin[axis] - interval.pivot[axis]) * (origin[axis] - interval.pivot[axis]);
      coordinate = std::max({coordinate, std::abs(static_cast<double>(motion.from.g[axis])),
                             std::abs(static_cast<double>(motion.to.g[axis]))});
    }
    const double away = (std::sqrt(squared) + radius) * (1.0 + kDoubleMargin);
    motion.stray = interval.bend_drift + interval.bend_turn * away;
    motion.line_stray = interval.drift + interval.turn * away;
    if (path.is_swept && !interval.divided()) {
      motion.stray = std::min(motion.stray, path.stray);
      motion.line_stray = std::min(motion.line_stray, path.stray);
    }
    const double bow = setBow(motion);
    motion.steps = path.is_swept ? 0.0f : static_cast<float>(interval.last - interval.first);
    const double reach = query_.reach * (1.0 + path.skew) + placing_ + motion.stray;
    // A difference from the end of a box rounds in proportion to itself: only places of points count.
    const double places = query_.of_points ? tree.radius : 0.0;
    const double rounding =
        static_cast<double>(kSegmentRounding) * (coordinate + 2.01 * radius + places + reach + 8 * bow) +
        kSmallestRounding;
    motion.reach = roundUp(reach + rounding);
    motion.rounding = roundUp(rounding);
    motion.blunt = path.is_swept ? 0.0f : motion.rounding;
    motion.near = roundUp(reach - motion.stray + 2 * rounding);
    motion.near_squared = motion.near * motion.near * (1.0f + kReachRounding) + kVanishingSquare;
    motion.smallest = motion.rounding * kSmallestMotion;
    motion.squares =
        motion.smallest >= kSmallestSquared && inFloatRange(coordinate + 2.01 * radius + tree.radius + reach + 8 * bow);
    return motion;
  }

  /// Sets the bow of the parabola through the places where the model sees a point at the first, middle and last pose.
  /// It is 0 where there are fewer than three poses.
  /// @return how far any point of the voxel bows at most
  double setBow(VoxelMotion& motion) const
  {
    const PathInterval& interval = *motion.interval;
    std::fill(motion.bow.m, motion.bow.m + 9, 0.0f);
    std::fill(motion.bow.g, motion.bow.g + 3, 0.0f);
    if (interval.last - interval.first < 2) return 0.0;
    const AffineMap middle = mapAt(path.poses[interval.middle()], {0, 0, 0}, 1.0);
    const double t = static_cast<double>(interval.middle() - interval.first) / (interval.last - interval.first);
    const double bent = 0.25 / (t * (1.0 - t));
    double squared[2] = {0.0, 0.0};
    const auto set = [&](float& bow, float from, float at, float to, double& sum) {
      const double value = bent * (at - ((1.0 - t) * from + t * to));
      bow = roundToFloat(value);
      sum += value * value;
    };
    for (std::size_t i = 0; i < 9; ++i) set(motion.bow.m[i], motion.from.m[i], middle.m[i], motion.to.m[i], squared[0]);
    for (std::size_t i = 0; i < 3; ++i) set(motion.bow.g[i], motion.from.g[i], middle.g[i], motion.to.g[i], squared[1]);
    return std::sqrt(squared[1]) + std::sqrt(squared[0]) * voxel.radius;
  }

  static Segment ballOn(const VoxelMotion& motion, const Point& center, float ball)
  {
    Segment segment = segmentOf(carryPoint(motion.from.m, motion.from.g, center),
                                carryPoint(motion.to.m, motion.to.g, center), motion.smallest);
    const Point bow = carryPoint(motion.bow.m, motion.bow.g, center);
    segment.bow[0] = bow.x;
    segment.bow[1] = bow.y;
    segment.bow[2] = bow.z;
    std::fill(segment.reach, segment.reach + 3, motion.reach + ball);
    segment.ball = motion.reach + ball;
    return segment;
  }

  /// Returns a segment around `count` arcs, each with an extent of its own along the axes. The arrays are aligned for
  /// vectors.
  template <std::size_t Count>
  static Segment aroundSegments(const VoxelMotion& motion, const float (&from)[3][Count], const float (&to)[3][Count],
                                const float (&bow)[3][Count], const float (&extent)[3][Count], std::size_t count)
  {
    const LaneTag d;
    float start[3], end[3], bent[3], reach[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float low[3], high[3];
      const float* ends[3] = {from[axis], to[axis], bow[axis]};
      for (std::size_t k = 0; k < 3; ++k) {
        LaneVector least = hn::Set(d, std::numeric_limits<float>::infinity()), most = hn::Neg(least);
        for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
          const auto some = hn::FirstN(d, count - i);
          const LaneVector at = hn::Load(d, ends[k] + i);
          const LaneVector around = k < 2 ? hn::Load(d, extent[axis] + i) : hn::Zero(d);
          least = hn::Min(least, hn::IfThenElse(some, hn::Sub(at, around), least));
          most = hn::Max(most, hn::IfThenElse(some, hn::Add(at, around), most));
        }
        low[k] = hn::GetLane(hn::MinOfLanes(d, least));
        high[k] = hn::GetLane(hn::MaxOfLanes(d, most));
      }
      start[axis] = 0.5f * (low[0] + high[0]);
      end[axis] = 0.5f * (low[1] + high[1]);
      bent[axis] = 0.5f * (low[2] + high[2]);
      const float half =
          std::max({high[0] - start[axis], start[axis] - low[0], high[1] - end[axis], end[axis] - low[1]}) +
          std::max(high[2] - bent[axis], bent[axis] - low[2]);
      reach[axis] = (motion.reach + motion.rounding + half) * (1.0f + kRadiusMargin);
    }
    Segment segment = segmentOf({start[0], start[1], start[2]}, {end[0], end[1], end[2]}, motion.smallest);
    std::copy(bent, bent + 3, segment.bow);
    segment.ball = (motion.reach + motion.rounding) * (1.0f + kRadiusMargin);
    std::copy(reach, reach + 3, segment.reach);
    return segment;
  }

  /// Returns a radius as the model sees it, in the clouds' unit. @param own the radius in the voxel's unit
  float seenRadius(float own) const
  {
    return static_cast<float>(own * frame.unit * (1.0 + path.skew) * (1.0 + kRadiusMargin));
  }

  /// The voxel as a box: along each of the model's axes, as far as its own sides reach.
  Segment aroundVoxel(const VoxelMotion& motion) const
  {
    Segment segment = ballOn(motion, {0.0f, 0.0f, 0.0f}, 0.0f);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double from = 0.0, to = 0.0, bow = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        from += std::abs(static_cast<double>(motion.from.m[3 * axis + k])) * frame.reach[k];
        to += std::abs(static_cast<double>(motion.to.m[3 * axis + k])) * frame.reach[k];
        bow += std::abs(static_cast<double>(motion.bow.m[3 * axis + k])) * frame.reach[k];
      }
      const double extent =
          (std::max(from, to) + bow + voxel.largest_radius * (1.0 + path.skew)) * (1.0 + kRadiusMargin) +
          motion.interval->turn * radius;
      const auto sphere = static_cast<double>(seenRadius(voxel.radius));
      segment.reach[axis] = roundUp((motion.reach + std::min(sphere, extent)) * (1.0 + kRadiusMargin));
    }
    return segment;
  }

  /// Returns an upper bound of the distance of a pair. @param squared its squared distance in floats
  double highOf(float squared) const
  {
    return (lengthOver(squared) + error) * (1.0 + path.skew) * (1.0 + kDoubleMargin);
  }

  /// Returns a squared distance in floats: pairs beyond it are farther apart than a pair at `squared`.
  float notBeyond(float squared) const { return skewedBand(highOf(squared), error, path.skew).miss; }

  /// No less than the distance from any point of a ball to the nearest point in a box, in the clouds' unit.
  /// @param corner squared distance from the ball's centre to the box's farthest corner, in floats at one pose
  float highOfBox(const VoxelMotion& motion, float corner, float ball) const
  {
    const double length = (std::sqrt(static_cast<double>(corner)) + ball) * (1.0 + kReachRounding);
    return roundUp((length + 2 * static_cast<double>(motion.rounding) + error) * (1.0 + path.skew) *
                   (1.0 + kDoubleMargin));
  }

  /// Returns a squared distance, in floats at one pose. Records in a box farther than its root do not collide, or are
  /// not as near as the best one.
  /// @param best no less than the best one's distance. @param own radius of the record that is compared with the box
  float nearSquared(const VoxelMotion& motion, float best, float own = 0.0f) const
  {
    const auto reach = static_cast<float>(query_.reach);
    if (!(best < reach) && own == 0.0f) return motion.near_squared;
    const float near = (motion.near + (std::min(best, reach) - reach) + own) * (1.0f + kReachRounding);
    return near * near * (1.0f + kReachRounding) + kVanishingSquare;
  }

  /// Returns how far from a line a point may be that is as near as the best one.
  /// @param own radius of the record on the line
  float reachOf(const VoxelMotion& motion, float best, float own = 0.0f) const
  {
    const float reach = best < motion.reach
                            ? (motion.reach + (best - static_cast<float>(query_.reach))) * (1.0f + kReachRounding)
                            : motion.reach;
    return own > 0.0f ? (reach + own) * (1.0f + kReachRounding) : reach;
  }

private:
  static constexpr double kAxes = 1.7321;               ///< root of 3, rounded up
  static constexpr double kSmallestRounding = 0x1p-100; ///< above underflow of products and of differences
  static constexpr float kReachRounding = 0x1p-18f;     ///< of a reach and its square in float: some ten roundings
  static constexpr float kSmallestSquared = 0x1p-63f;   ///< longer motions keep their precision when squared
  static constexpr float kSmallestMotion = 0x1p-8f;     ///< of the rounding of places

  static Segment segmentOf(const Point& from, const Point& to, float smallest)
  {
    const float start[3] = {from.x, from.y, from.z}, end[3] = {to.x, to.y, to.z};
    Segment segment;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float motion = end[axis] - start[axis];
      segment.start[axis] = start[axis];
      segment.motion[axis] = motion;
      segment.bow[axis] = 0.0f;
      segment.inverse[axis] = 1.0f / std::copysign(std::max(std::abs(motion), smallest), motion);
    }
    return segment;
  }

  static constexpr std::uint32_t kKeptMotions = 16;

  struct KeptMotion {
    VoxelMotion motion;
    std::uint32_t interval = 0;
    bool known = false;
  };

  const TrajectoryQuery& query_;
  mutable std::array<KeptMotion, kKeptMotions> kept_; // by one thread: a voxel is one task
  double placing_ = 0.0; // error of places of points, stored as floats and carried in double
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

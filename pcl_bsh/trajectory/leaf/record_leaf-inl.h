// SPDX-License-Identifier: BSD-3-Clause
// Records of a leaf of the scan against records of the model where either are triangles, or have radii: at which poses
// a pair collides, and when it is nearest.

#if defined(PCL_BSH_TRAJECTORY_LEAF_RECORD_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_LEAF_RECORD_LEAF_INL_H_
#undef PCL_BSH_TRAJECTORY_LEAF_RECORD_LEAF_INL_H_
#else
#define PCL_BSH_TRAJECTORY_LEAF_RECORD_LEAF_INL_H_
#endif

#include <pcl_bsh/trajectory/leaf/leaf_at_pose-inl.h>
#include <pcl_bsh/trajectory/leaf/leaf_visit-inl.h>
#include <pcl_bsh/trajectory/leaf/plane_beside.h>
#include <pcl_bsh/trajectory/leaf/record_course.h>
#include <pcl_bsh/traversal/long_triangles-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A pair is looked at at a pose in the middle. The direction along which it is apart there bounds how near it is at
/// the poses before and after. Ranges of poses that can matter are halved again. So a pair that passes takes a few
/// looks, however many poses there are, and one that stays at a distance takes one for each pose at which that distance
/// matters.
class RecordLeaf {
public:
  /// @param long_triangles of the model, as this walk places it
  RecordLeaf(const TrajectoryQuery& query, const VoxelInModelFrame& voxel_frame, VoxelResults& results,
             LeafAtPose& at_pose, ComparedPairs& compared, LongTriangles& long_triangles)
  : query_(query),
    voxel_frame_(voxel_frame),
    placing_(query.error(voxel_frame.origin)),
    may_overlap_(query.scan.hierarchy().view().areBalls() || query.model.view().areBalls()),
    results_(results),
    at_pose_(at_pose),
    compared_(compared),
    long_(long_triangles),
    plane_(query)
  {
  }

  /// Before a leaf is compared during a motion.
  void beginVisit()
  {
    known_ = 0;
    asked_ = 0;
  }

  /// Whether a plane beside the model shows that no record of the scan's voxel from `begin` to `end` matters during a
  /// motion.
  bool areBeside(std::uint32_t begin, std::uint32_t end, const VoxelMotion& motion)
  {
    for (std::uint32_t i = begin; i < end; ++i) {
      if (plane_.number() == 0) return false;
      ++results_.work.node_pairs;
      const RecordCourse course(query_, voxel_frame_.voxel.records()[i], *motion.interval);
      if (!plane_.isBeside(course.arcs, seenOf(query_.reach) + motion.stray)) return false;
    }
    return true;
  }

  /// Whether there is such a plane.
  bool hasPlane() const { return plane_.number() != 0; }

  /// Compares records with a leaf of the model, at the poses that bring them near. A triangle that is divided into
  /// parts is compared once, at all poses of the motion.
  void compare(LeafVisit& leaf, const PoseRanges& ranges, const ModelBox& box, const VoxelMotion& motion)
  {
    const BoxLeaf other = box.points(query_.boxes);
    for (std::uint32_t j = 0; j < other.count; ++j) {
      const MovingCorners model = restingAt(query_, other.record(j));
      std::uint32_t points = ranges.lanes & leaf.open;
      if (other.is_part) points = compared_.add(other.record(j), points);
      for (const std::uint32_t i : Bits(points)) {
        if (HWY_UNLIKELY(hasPlane()) && isBeside(leaf, i, motion)) {
          leaf.open &= ~(1u << i); // for the time of this motion
          continue;
        }
        const PointPair pair{leaf.points.record(i), other.record(j)};
        const auto [least, most] = query_.of_pairs.around(pair);
        if (most < 0.0) continue;
        const double radii = query_.scan.hierarchy().view().ownRadius(pair.a) + query_.model.view().ownRadius(pair.b);
        ++results_.work.leaf_pairs;
        const RecordCourse& course = courseOf(leaf, i, motion);
        halve({leaf, motion, course, {course.arcs, model}, pair, i, radii, least, most},
              other.is_part ? motion.interval->first : ranges.first[i],
              other.is_part ? motion.interval->last : ranges.last[i]);
      }
    }
  }

  /// Returns the points whose records may meet a box during the motion. Records larger than the box are compared with
  /// it, since their balls reach most boxes.
  std::uint32_t mayMeet(const LeafVisit& leaf, std::uint32_t points, const ModelBox& box, const VoxelMotion& motion)
  {
    if (!query_.scan.hierarchy().view().triangles) return points;
    const BoxEnds ends(box);
    double half = 0.0; // squares of tiny floats are no floats
    Point3 middle;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double low = ends.low[axis], high = ends.high[axis], side = 0.5 * (high - low);
      middle[axis] = 0.5 * (low + high);
      half += side * side;
    }
    const double radius = std::sqrt(half) * (1.0 + kFewDoubleRoundings);
    std::uint32_t met = points;
    for (const std::uint32_t i : Bits(points)) {
      if (leaf.own[i] < radius) continue;
      const RecordCourse& course = courseOf(leaf, i, motion);
      const Separation apart = separationOf(course.arcs.at(0.5), Corners::of(middle));
      const double least = MovingPair(course.arcs, restingAt(middle)).leastApart(apart.direction, 0.0, 1.0);
      ++results_.work.node_pairs;
      if (least - radius - motion.stray > seenOf(query_.reach)) met &= ~(1u << i);
    }
    return met;
  }

private:
  /// A record of the scan and one of the model.
  struct Pair {
    LeafVisit& leaf;
    const VoxelMotion& motion;
    const RecordCourse& course;
    MovingPair moving; ///< the scan's record on its arcs, the model's at rest
    PointPair records;
    std::uint32_t i;           ///< the scan's record: its place in the leaf
    double radii, least, most; ///< sum of radii; at distances up to `least` they collide, above `most` they do not

    std::uint32_t point() const { return leaf.points.begin + i; }
  };

  const RecordCourse& courseOf(const LeafVisit& leaf, std::uint32_t i, const VoxelMotion& motion)
  {
    if ((known_ >> i & 1) == 0) courses_[i] = RecordCourse(query_, leaf.points.record(i), *motion.interval);
    known_ |= 1u << i;
    return courses_[i];
  }

  /// Whether the plane beside the model shows that a record does not matter during the motion; asked once of each
  /// plane.
  bool isBeside(const LeafVisit& leaf, std::uint32_t i, const VoxelMotion& motion)
  {
    if (asked_plane_ != plane_.number()) asked_ = 0;
    asked_plane_ = plane_.number();
    if ((asked_ >> i & 1) != 0) return false;
    asked_ |= 1u << i;
    ++results_.work.node_pairs;
    return plane_.isBeside(courseOf(leaf, i, motion).arcs, seenOf(query_.reach) + motion.stray);
  }

  /// Returns a bound: records that the model sees farther apart than this are farther apart than `length`.
  double seenOf(double length) const
  {
    return (length * (1.0 + query_.path.skew) + placing_) * (1.0 + kFewDoubleRoundings);
  }
  /// Returns an upper bound of the distance of records that the model sees `seen` apart.
  double highOf(double seen) const
  {
    return (seen + placing_) * (1.0 + query_.path.skew) * (1.0 + kFewDoubleRoundings);
  }

  /// Returns the distance up to which the pair matters from a pose on.
  double mattering(const Pair& pair, std::uint32_t from) const
  {
    if (!results_.bestBounds(pair.point(), from) || !isHit(pair)) return pair.most;
    return std::min(pair.most, results_.best[pair.point()].gap + pair.radii);
  }

  bool isHit(const Pair& pair) const { return (results_.hit[pair.leaf.slot] >> pair.i & 1) != 0; }

  /// Whether nothing at these poses changes an answer. Contacts later than a known one do not, where only the first is
  /// asked for. @param last is lowered to the pose before a known contact
  bool isSettled(const Pair& pair, std::uint32_t first, std::uint32_t& last) const
  {
    if (query_.everything() || !isHit(pair)) return false;
    if (!query_.first) return true;
    const double known = results_.first[pair.point()];
    if (known <= first) return true;
    if (known <= last) last = static_cast<std::uint32_t>(known) - 1;
    return false;
  }

  void halve(const Pair& pair, std::uint32_t first, std::uint32_t last)
  {
    if (isSettled(pair, first, last)) return;
    const std::uint32_t middle = first + (last - first) / 2;
    ++results_.work.node_pairs;
    const Separation apart = separationOf(pair.course.seenAt(query_.path.poses[middle]), pair.moving.b.at(0.0));
    if (apart.low > seenOf(pair.most))
      plane_.decidedInVain(apart);
    else
      look(pair, middle, apart);
    if (middle > first && mayMatter(pair, apart.direction, first, middle - 1)) halve(pair, first, middle - 1);
    if (middle < last && mayMatter(pair, apart.direction, middle + 1, last)) halve(pair, middle + 1, last);
  }

  bool mayMatter(const Pair& pair, const Point3& direction, std::uint32_t first, std::uint32_t last) const
  {
    const double begin = pair.motion.interval->first, steps = pair.motion.interval->last - begin;
    const double least = pair.moving.leastApart(direction, (first - begin) / steps, (last - begin) / steps);
    return least - pair.motion.stray <= seenOf(mattering(pair, first));
  }

  /// Looks at a pair at pose k, at which it may collide.
  void look(const Pair& pair, std::uint32_t k, const Separation& apart)
  {
    const bool for_pose = query_.request.pose_summaries && (may_overlap_ || results_.poseReach(k) > 0.0f);
    const double low = (apart.low - placing_) * (1.0 - query_.path.skew) * (1.0 - kFewDoubleRoundings) - pair.radii;
    const double high = highOf(apart.high) - pair.radii;
    const std::uint32_t step = k - pair.motion.interval->first;
    const bool hit_before = query_.request.pose_summaries
                                ? (at_pose_.hits()[step] >> pair.i & 1) != 0
                                : isHit(pair) && (!query_.first || results_.first[pair.point()] <= k);
    const bool for_point = query_.closest && isNearer(pair, k, low);
    const bool matters_for_pose = for_pose && low <= static_cast<double>(results_.poseReach(k));
    if (hit_before && !for_point && !matters_for_pose) return;
    if (high + pair.radii > pair.least && !results_.collide(pair.records, k)) return plane_.decidedInVain(apart);
    at_pose_.noteHits(pair.leaf, 1u << pair.i, k, pair.motion);
    if (for_point) considerForPoint(pair, k, high);
    if (matters_for_pose) {
      results_.considerPose(pair.records, k);
      const bool least = isLeast(pair, k, high);
      results_.lowerPoseLimit(k, std::numeric_limits<float>::infinity(), least ? 0.0f : roundUp(std::max(0.0, high)));
    }
  }

  /// Whether the pair may be the nearest of its record.
  bool isNearer(const Pair& pair, std::uint32_t k, double low) const
  {
    const NearestPoint& best = results_.best[pair.point()];
    if (best.record == kNothing) return true;
    if (!best.meets) return low <= best.gap;
    const auto best_pose = static_cast<std::uint32_t>(best.time); // nothing is nearer
    return k < best_pose || (k == best_pose && pair.records.b < best.record);
  }

  void considerForPoint(const Pair& pair, std::uint32_t k, double high)
  {
    NearestPoint& best = results_.best[pair.point()];
    if (const std::optional<int> order = orderToBest(pair, k))
      results_.take(best, pair.records, k, *order);
    else
      results_.consider(best, pair.records, k);
    best.gap = std::min(best.gap, high);
    best.reach = std::min(best.reach, roundUp(std::max(0.0, high)));
    const bool is_best = best.record == pair.records.b && best.time == k;
    best.meets = best.meets || (is_best && isLeast(pair, k, high));
    if (results_.bestBounds(pair.point(), pair.motion.interval->first))
      pair.leaf.lowerReach(voxel_frame_, pair.i, best.reach, pair.motion);
  }

  /// Returns the sign of the pair's gap at a pose less the best gap of its point so far, where long numbers tell it. A
  /// point that stays beside a face has hundreds of poses whose gaps doubles cannot tell apart.
  std::optional<int> orderToBest(const Pair& pair, std::uint32_t k)
  {
    const NearestPoint& best = results_.best[pair.point()];
    const PointsView &scan = query_.scan.hierarchy().view(), &model = query_.model.view();
    if (best.record == kNothing || scan.triangles || !model.triangles) return std::nullopt;
    const auto best_pose = static_cast<std::uint32_t>(best.time);
    if (!LongTriangles::areApart(pair.records.b, k, best.record, best_pose)) return std::nullopt;
    const LongVector place(placedLong(query_.scan.pose, scan.point(pair.records.a)));
    const Eigen::Isometry3d &pose = query_.poseAt(k), &pose_of_best = query_.poseAt(best_pose);
    LongTriangle& here = long_.of(*model.triangles, pose, pair.records.b, k);
    LongTriangle& there = long_.of(*model.triangles, pose_of_best, best.record, best_pose);
    const NearPart part = nearPartOf(here, place), part_of_best = nearPartOf(there, place);
    if (areSameParts(here, part, pose, there, part_of_best, pose_of_best)) return 0;
    return longOrder(here, part, there, part_of_best, place);
  }

  /// Whether the pair meets, so that nothing is nearer.
  bool isLeast(const Pair& pair, std::uint32_t k, double high) const
  {
    return !may_overlap_ && high <= 4 * placing_ && results_.meet(pair.records, k);
  }

  const TrajectoryQuery& query_;
  const VoxelInModelFrame& voxel_frame_;
  const double placing_;   ///< bounds the error of a record's place as the model sees it, in double
  const bool may_overlap_; ///< balls may, so that gaps are below 0
  VoxelResults& results_;
  LeafAtPose& at_pose_;
  ComparedPairs& compared_;
  LongTriangles& long_;
  RecordCourse courses_[kLeafPoints];
  std::uint32_t known_ = 0; ///< bits of the courses that are set
  PlaneBeside plane_;
  std::uint32_t asked_ = 0, asked_plane_ = 0; ///< bits of the leaf's points that a plane was asked about; its number
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

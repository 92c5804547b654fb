// SPDX-License-Identifier: BSD-3-Clause
// Any collision on motions near each other: what is apart at the middle of a group of them by more than all of them
// move is apart on all of them. The motions that are left are looked at one by one, likely witnesses first.
#include <pcl_bsh/pairs/any_collision.h>
#include <pcl_bsh/roadmap/motion_batch.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/roadmap/any_of_motion_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/roadmap/pose_search-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

class AnyOfMotions {
public:
  AnyOfMotions(const MotionBatch& batch, bool* collides, Progress& progress)
  : batch_(batch),
    query_(batch.query),
    collides_(collides),
    progress_(progress),
    at_middle_{query_.request.clearance, {}},
    search_(query_.scan, query_.model, at_middle_, query_.places)
  {
  }

  Work run()
  {
    PoseGroups groups(batch_.middles, query_.beyond,
                      [this](std::size_t i, NodePairs& pairs, std::size_t from) { decide(i, pairs, from); });
    Work work = groups.run();
    return work += work_;
  }

private:
  void decide(std::size_t i, NodePairs& pairs, std::size_t from)
  {
    const Eigen::Isometry3d& middle = batch_.middles.poses[i];
    bool near = false;
    pairs.findNear(middle, query_.beyond + batch_.middles.extents[i], from,
                   [&near](std::size_t, double) { near = true; });
    collides_[i] = near && collides(i, {query_.model, middle}, pairs, from);
  }

  /// What collides at an instant, decided exactly, collides on the motion, too. What does not collide at the instants
  /// that are tried needs the walk.
  bool collides(std::size_t i, const Placed& at_middle, NodePairs& pairs, std::size_t from)
  {
    const RigidMotion& motion = batch_.motions[i];
    if (witness_ && collidesDuring(query_, motion, *witness_, work_)) return true;
    std::optional<PointPair> witness = search_.find(at_middle, pairs, from, work_);
    if (!witness) witness = findOnMotion(query_, motion, progress_, work_);
    if (!witness) return false;
    witness_ = witness;
    return true;
  }

  const MotionBatch& batch_;
  const MotionsQuery& query_;
  bool* collides_;
  Progress& progress_;
  const AnyRequest at_middle_;
  PoseSearch search_;
  std::optional<PointPair> witness_; ///< of the last motion that collided
  Work work_;
};

} // namespace

Work anyOfMotionBatchOnTarget(const MotionBatch& batch, bool* collides, Progress& progress)
{
  return AnyOfMotions(batch, collides, progress).run();
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(anyOfMotionBatchOnTarget);

Work anyOfMotionBatch(const MotionBatch& batch, bool* collides, Progress& progress)
{
  return HWY_DYNAMIC_DISPATCH(anyOfMotionBatchOnTarget)(batch, collides, progress);
}

} // namespace pcl_bsh
#endif

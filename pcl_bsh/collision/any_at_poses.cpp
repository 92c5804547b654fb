// SPDX-License-Identifier: BSD-3-Clause
// Any collision at many poses: neighbouring poses share the upper part of the descent.
#include <pcl_bsh/collision/collide_at_poses.h>
#include <pcl_bsh/collision/pose_batch.h>
#include <pcl_bsh/collision/pose_tasks.h>
#include <pcl_bsh/collision/uncertain.h>

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/collision/any_at_poses.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/collision/any_search-inl.h>
#include <pcl_bsh/collision/pose_groups-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

/// The verdicts at the poses of a batch.
class AnyOfBatch {
public:
  AnyOfBatch(const PoseBatch& batch, const AnyRequest& request, std::uint8_t* verdicts)
  : batch_(batch),
    request_(request),
    verdicts_(verdicts)
  {
  }

  Work run()
  {
    PoseGroups groups(batch_, request_.clearance,
                      [this](std::size_t i, NodePairs& pairs, std::size_t from) { decide(i, pairs, from); });
    Work work = groups.run();
    return work += work_;
  }

private:
  void decide(std::size_t i, NodePairs& pairs, std::size_t from)
  {
    const Placed b{batch_.b, batch_.poses[i]};
    if (witness_) {
      const PointPairs points(batch_.a, b, request_.clearance);
      if (points.collide(*witness_, work_)) {
        verdicts_[i] = flagOf(Verdict::colliding);
        return;
      }
    }
    near_.clear();
    pairs.findNear(b.pose, request_.clearance, from, [&](std::size_t k, double squared) {
      near_.push_back(pairs.lanes(k));
      near_.back().key = static_cast<float>(squared);
    });
    if (near_.empty()) return;
    nearestLast(near_, 0);
    AnySearch search(batch_.a, b, request_, NoObserver());
    if (const auto witness = search.searchBelow(near_)) {
      witness_ = witness;
      verdicts_[i] = flagOf(Verdict::colliding);
    }
    work_ += search.work();
  }

  const PoseBatch& batch_;
  const AnyRequest& request_;
  std::uint8_t* verdicts_;
  std::optional<PointPair> witness_; ///< of the last pose that collided
  std::vector<LanePair> near_;
  Work work_;
};

} // namespace

Work anyOfBatchOnTarget(const PoseBatch& batch, const AnyRequest& request, std::uint8_t* verdicts)
{
  return AnyOfBatch(batch, request, verdicts).run();
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

HWY_EXPORT(anyOfBatchOnTarget);

AnyAtPoses anyCollisionAtPoses(const Placed& a, const SphereHierarchy& b, const PoseList& T_world_b,
                               const AnyRequest& request, const PosesProgress& report)
{
  checkClearance(request.clearance);
  checkAtPoses(a, T_world_b, request.accuracy, request.threads);
  const DefaultFloatEnvironment environment;
  AnyAtPoses result;
  result.verdicts.assign(T_world_b.size(), flagOf(Verdict::free));
  if (a.hierarchy().empty() || b.empty() || T_world_b.size() == 0) return result;
  Progress progress(report);
  if (!request.accuracy.isExact() || areUncertain(a, {b})) {
    AnyRequest single = request;
    single.threads = 1;
    result.work = forEachPose(T_world_b, request.threads, progress, [&](std::size_t i, const Eigen::Isometry3d& pose) {
      const AnyResult found = anyCollision(a, {b, pose}, single);
      result.verdicts[i] = flagOf(found.verdict);
      return found.work;
    });
  }
  else {
    result.work = forEachBatch(a, b, T_world_b, request.threads, progress,
                               [&](const PoseBatch& batch, const std::uint32_t* order) {
                                 std::uint8_t verdicts[kBatchPoses] = {};
                                 const Work work = HWY_DYNAMIC_DISPATCH(anyOfBatchOnTarget)(batch, request, verdicts);
                                 for (std::size_t i = 0; i < batch.poses.size(); ++i)
                                   result.verdicts[order[i]] = verdicts[i];
                                 return work;
                               });
  }
  result.colliding =
      static_cast<std::size_t>(std::count(result.verdicts.begin(), result.verdicts.end(), flagOf(Verdict::colliding)));
  return result;
}

} // namespace pcl_bsh
#endif

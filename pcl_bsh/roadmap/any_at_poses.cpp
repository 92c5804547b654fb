// SPDX-License-Identifier: BSD-3-Clause
// Any collision at many poses: neighbouring poses share the upper part of the descent.
#include <pcl_bsh/query/uncertain.h>
#include <pcl_bsh/roadmap/collide_at_poses.h>
#include <pcl_bsh/roadmap/pose_batch.h>
#include <pcl_bsh/roadmap/pose_tasks.h>

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/roadmap/any_at_poses.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/roadmap/pose_search-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

/// At which poses of a batch points collide that are where `places` says.
class AnyOfBatch {
public:
  AnyOfBatch(const PoseBatch& batch, const AnyRequest& request, Places places, bool* collides)
  : batch_(batch),
    search_(batch.a, batch.b, request, places),
    collides_(collides)
  {
  }

  Work run()
  {
    PoseGroups groups(batch_, search_.reach,
                      [this](std::size_t i, NodePairs& pairs, std::size_t from) { decide(i, pairs, from); });
    Work work = groups.run();
    return work += work_;
  }

private:
  void decide(std::size_t i, NodePairs& pairs, std::size_t from)
  {
    const Placed b{batch_.b, batch_.poses[i]};
    collides_[i] = witness_ && search_.collides(b, *witness_, work_);
    if (collides_[i]) return;
    const std::optional<PointPair> witness = search_.find(b, pairs, from, work_);
    if (!witness) return;
    witness_ = witness;
    collides_[i] = true;
  }

  const PoseBatch& batch_;
  PoseSearch search_;
  bool* collides_;
  std::optional<PointPair> witness_; ///< of the last pose that collided
  Work work_;
};

} // namespace

Work anyOfBatchOnTarget(const PoseBatch& batch, const AnyRequest& request, Places places, bool* collides)
{
  return AnyOfBatch(batch, request, places, collides).run();
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace pcl_bsh {

namespace {

HWY_EXPORT(anyOfBatchOnTarget);

/// Some poses of a list.
struct SomePoses {
  std::size_t size() const { return indices.size(); }
  Eigen::Isometry3d operator[](std::size_t i) const { return list[indices[i]]; }

  const PoseList& list;
  std::vector<std::uint32_t> indices;
};

/// Calls collides(i) for each pose at which points collide that are where `places` says, from several threads.
template <class Collides>
Work findColliding(const Placed& a, const SphereHierarchy& b, const PoseList& poses, const AnyRequest& request,
                   Places places, Progress& progress, const Collides& collides)
{
  return forEachBatch(a, b, poses, request.threads, progress, [&](const PoseBatch& batch, const std::uint32_t* order) {
    bool found[kBatchPoses] = {};
    const Work work = HWY_DYNAMIC_DISPATCH(anyOfBatchOnTarget)(batch, request, places, found);
    for (std::size_t i = 0; i < batch.poses.size(); ++i)
      if (found[i]) collides(order[i]);
    return work;
  });
}

/// Of points that may be elsewhere than they were measured: one search for what may collide, one for what does for
/// certain, at the poses that are left.
Work findUncertain(const Placed& a, const SphereHierarchy& b, const PoseList& poses, const AnyRequest& request,
                   const PosesProgress& report, std::vector<std::uint8_t>& verdicts)
{
  const auto half = [&report](double begin) {
    return [&report, begin](double done) { return !report || report(begin + 0.5 * done); };
  };
  const PosesProgress first_half = half(0.0), second_half = half(0.5);
  Progress of_possible(first_half), of_certain(second_half);
  Work work = findColliding(a, b, poses, request, Places::possible, of_possible,
                            [&](std::size_t i) { verdicts[i] = flagOf(Verdict::undecided); });
  SomePoses left{poses, {}};
  for (std::size_t i = 0; i < verdicts.size(); ++i)
    if (verdicts[i] == flagOf(Verdict::undecided)) left.indices.push_back(static_cast<std::uint32_t>(i));
  if (left.indices.empty()) {
    of_certain.begin(1.0, 0);
    of_certain.end();
    return work;
  }
  work += findColliding(a, b, left, request, Places::certain, of_certain,
                        [&](std::size_t i) { verdicts[left.indices[i]] = flagOf(Verdict::colliding); });
  return work;
}

} // namespace

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
  if (!request.accuracy.isExact()) {
    AnyRequest single = request;
    single.threads = 1;
    result.work = forEachPose(T_world_b, request.threads, progress, [&](std::size_t i, const Eigen::Isometry3d& pose) {
      const AnyResult found = anyCollision(a, {b, pose}, single);
      result.verdicts[i] = flagOf(found.verdict);
      return found.work;
    });
  }
  else if (areUncertain(a, {b})) {
    result.work = findUncertain(a, b, T_world_b, request, report, result.verdicts);
  }
  else {
    result.work = findColliding(a, b, T_world_b, request, Places::measured, progress,
                                [&](std::size_t i) { result.verdicts[i] = flagOf(Verdict::colliding); });
  }
  result.colliding = countOf(result.verdicts, Verdict::colliding);
  result.undecided = countOf(result.verdicts, Verdict::undecided);
  return result;
}

} // namespace pcl_bsh
#endif

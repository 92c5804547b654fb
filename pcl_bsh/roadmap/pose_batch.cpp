// SPDX-License-Identifier: BSD-3-Clause
// Poses near each other: what is apart at the middle of a group by more than all of it moves is apart at all of its
// poses, and on all motions about them. Those that are left are looked at one by one, the last witness first.
#include <pcl_bsh/roadmap/pose_batch.h>

#include <pcl_bsh/query/progress.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "pcl_bsh/roadmap/pose_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <pcl_bsh/pairs/any_search-inl.h>
#include <pcl_bsh/roadmap/pose_groups-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {
namespace {

class AnyOfBatch {
public:
  AnyOfBatch(const PoseBatch& batch, const AnyRequest& request, Places places, bool* collides)
  : batch_(batch),
    request_(request),
    places_(places),
    most_(reachBetween(batch.a, {batch.b}, request.clearance, places).most),
    collides_(collides)
  {
  }

  Work run()
  {
    PoseGroups groups(batch_, reachOfMotions(),
                      [this](std::size_t i, NodePairs& pairs, std::size_t from) { decide(i, pairs, from); });
    Work work = groups.run();
    return work += work_;
  }

private:
  double reachOfMotions() const { return std::max(0.0, most_ + (batch_.motions ? batch_.motions->tolerance : 0.0)); }

  /// What collides at an instant, decided exactly, collides on the motion, too. What does not collide at the instants
  /// that are tried needs the motion's own search.
  void decide(std::size_t i, NodePairs& pairs, std::size_t from)
  {
    pulse_.look();
    const MotionsAbout* const motions = batch_.motions;
    const Placed b{batch_.b, batch_.poses[i]};
    if (motions && !comeNear(b.pose, reachOfMotions() + motions->extents[i], pairs, from)) return;
    collides_[i] =
        witness_ && (motions ? motions->collide(i, *witness_, work_)
                             : PointPairs(batch_.a, b, request_.clearance, places_).collide(*witness_, work_));
    if (collides_[i]) return;
    std::optional<PointPair> witness = find(b, pairs, from);
    if (!witness && motions) witness = motions->find(i, work_);
    if (!witness) return;
    witness_ = witness;
    collides_[i] = true;
  }

  static bool comeNear(const Eigen::Isometry3d& pose, double reach, NodePairs& pairs, std::size_t from)
  {
    bool near = false;
    pairs.findNear(pose, reach, from, [&near](std::size_t, double) { near = true; });
    return near;
  }

  /// A pair that collides at a pose, below the pairs of nodes that the group has left to it.
  std::optional<PointPair> find(const Placed& b, NodePairs& pairs, std::size_t from)
  {
    // The deepest overlap first where no group has opened nodes; of nodes of many sizes that is the largest one, and
    // the nearest centres come first.
    near_.clear();
    work_.node_pairs += pairs.size() - from;
    pairs.findNear(b.pose, std::max(0.0, most_), from, [&](std::size_t k, double squared) {
      near_.push_back(pairs.lanes(k));
      near_.back().key = static_cast<float>(from == 0 ? std::sqrt(squared) - pairs.radius(k) : squared);
    });
    if (near_.empty()) return std::nullopt;
    nearestLast(near_, 0);
    AnySearch search(batch_.a, b, request_, NoObserver(), places_);
    const std::optional<PointPair> witness = search.searchBelow(near_);
    work_ += search.work();
    return witness;
  }

  const PoseBatch& batch_;
  const AnyRequest& request_;
  const Places places_;
  const double most_; ///< of the farthest pair that collides at a pose, less its radii
  bool* collides_;
  std::vector<LanePair> near_;
  std::optional<PointPair> witness_; ///< of the last that collided
  Work work_;
  WorkPulse pulse_{work_};
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

HWY_EXPORT(anyOfBatchOnTarget);

Work anyOfBatch(const PoseBatch& batch, const AnyRequest& request, Places places, bool* collides)
{
  return HWY_DYNAMIC_DISPATCH(anyOfBatchOnTarget)(batch, request, places, collides);
}

} // namespace pcl_bsh
#endif

// SPDX-License-Identifier: BSD-3-Clause
// The search for any colliding pair at one pose of a group, below the pairs of nodes that the group has left to it.

#if defined(PCL_BSH_ROADMAP_POSE_SEARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_ROADMAP_POSE_SEARCH_INL_H_
#undef PCL_BSH_ROADMAP_POSE_SEARCH_INL_H_
#else
#define PCL_BSH_ROADMAP_POSE_SEARCH_INL_H_
#endif

#include <pcl_bsh/pairs/any_search-inl.h>
#include <pcl_bsh/roadmap/pose_groups-inl.h>
#include <pcl_bsh/traversal/point_pairs.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

class PoseSearch {
public:
  PoseSearch(const Placed& a, const SphereHierarchy& b, const AnyRequest& request, Places places)
  : reach(std::max(0.0, reachBetween(a, {b}, request.clearance, places).most)),
    a_(a),
    request_(request),
    places_(places)
  {
  }

  /// Whether a pair collides, points being where they are asked about.
  bool collides(const Placed& b, PointPair pair, Work& work) const
  {
    return PointPairs(a_, b, request_.clearance, places_).collide(pair, work);
  }

  /// @param from where the pairs begin that may meet at the pose of b
  std::optional<PointPair> find(const Placed& b, NodePairs& pairs, std::size_t from, Work& work)
  {
    // The deepest overlap first where no group has opened nodes; of nodes of many sizes that is the largest one, and
    // the nearest centres come first.
    near_.clear();
    work.node_pairs += pairs.size() - from;
    pairs.findNear(b.pose, reach, from, [&](std::size_t k, double squared) {
      near_.push_back(pairs.lanes(k));
      near_.back().key = static_cast<float>(from == 0 ? std::sqrt(squared) - pairs.radius(k) : squared);
    });
    if (near_.empty()) return std::nullopt;
    nearestLast(near_, 0);
    AnySearch search(a_, b, request_, NoObserver(), places_);
    const std::optional<PointPair> witness = search.searchBelow(near_);
    work += search.work();
    return witness;
  }

  const double reach; ///< of the farthest pair, less its radii

private:
  const Placed& a_;
  const AnyRequest& request_;
  const Places places_;
  std::vector<LanePair> near_;
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle

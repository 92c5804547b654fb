// SPDX-License-Identifier: BSD-3-Clause
// A leaf, point by point, far from a node of the other cloud for that node's size.

#if defined(PCL_BSH_TRAVERSAL_FAR_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAVERSAL_FAR_POINTS_INL_H_
#undef PCL_BSH_TRAVERSAL_FAR_POINTS_INL_H_
#else
#define PCL_BSH_TRAVERSAL_FAR_POINTS_INL_H_
#endif

#include <pcl_bsh/traversal/far_nodes.h>
#include <pcl_bsh/traversal/leaf_pair-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// A cloud as it was given, and where it stands.
struct GivenCloud {
  const Eigen::Isometry3d& pose;
  const PointsView& view;
};

/// Whether a node is apart from each point of a leaf of the other cloud that is much larger (kLargeFarLeaf): a leaf of
/// a cylinder bends by more than the points near its axis differ in their distance.
/// @param leaf_is_a the leaf is one of a, the node one of b; otherwise the other way round. @pre no radii
inline bool pointsFarApart(const ExactDistance& distance, const GivenCloud& a, const GivenCloud& b,
                           const LeafRange& leaf, bool leaf_is_a, const NodeSupport& node, double clearance, Work& work)
{
  const PointsView& view = leaf_is_a ? a.view : b.view;
  for (std::uint32_t i = 0; i < leaf.count; ++i) {
    const NodeSupport point(view.point(leaf.record(i)));
    ++work.node_pairs;
    if (!areFarNodesApart(distance, a.pose, leaf_is_a ? point : node, b.pose, leaf_is_a ? node : point, clearance,
                          work.exact_decisions))
      return false;
  }
  return true;
}

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle

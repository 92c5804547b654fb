// SPDX-License-Identifier: BSD-3-Clause
// Whether the model has a point in a small ball at a pose: one look that may settle a whole node of the scan.

#if defined(PCL_BSH_TRAJECTORY_LEAF_POINT_PROBING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_TRAJECTORY_LEAF_POINT_PROBING_INL_H_
#undef PCL_BSH_TRAJECTORY_LEAF_POINT_PROBING_INL_H_
#else
#define PCL_BSH_TRAJECTORY_LEAF_POINT_PROBING_INL_H_
#endif

#include <pcl_bsh/trajectory/boxes/model_boxes-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A ball around a place in the scan's voxel, at a pose; its reach in the clouds' unit.
struct ProbeSphere {
  Point center;
  float reach;
  std::uint32_t pose;
  float scale = 0.0f;   ///< of points' own uncertainties, which make the reach longer, or shorter
  float farther = 0.0f; ///< by this at most
};

class PointProbing {
public:
  PointProbing(const TrajectoryQuery& query, const VoxelInModelFrame& voxel_frame, ModelBoxes& model, Work& work)
  : query_(query),
    voxel_frame_(voxel_frame),
    model_(model),
    work_(work)
  {
  }

  /// Whether the candidate has a point in the probe. The nearest boxes are asked first. Where floats do not tell boxes
  /// apart during the motion, one of them alone is asked: then the answer may be false although there is a point.
  /// @param center of the probe, about where the model sees it.
  bool hasPoint(const ModelBox& candidate, const ProbeSphere& probe, const Point& center, const VoxelMotion& motion)
  {
    if (candidate.isLeaf()) {
      const Voxel& voxel = query_.boxes.storage.voxels[candidate.voxel];
      if (voxel.frame.unit != 1.0) return false;
      const BoxLeaf leaf = query_.boxes.leaf(candidate.voxel, candidate.box().leaf(candidate.lane));
      const AffineMap map =
          voxel_frame_.mapAt(query_.path.poses[probe.pose], query_.boxes.offset(candidate.voxel), 1.0);
      for (const float g : map.g)
        if (!(std::abs(g) <= voxel_frame_.far)) return false;
      const Point at = carryPoint(map.m, map.g, probe.center);
      if (leaf.lengths)
        return anyPointWithinEach(leaf.x(), leaf.y(), leaf.z(), leaf.lengths, probe.scale, leaf.count, at, probe.reach);
      return anyPointWithin(leaf.x(), leaf.y(), leaf.z(), leaf.count, at.x, at.y, at.z, probe.reach);
    }
    if (!model_.mayOpen(candidate)) return false;
    const Siblings children = model_.below(candidate);
    work_.node_pairs += static_cast<std::uint64_t>(std::popcount(children.lanes));
    float distance[kLanes];
    const float reach = probe.reach + probe.farther;
    std::uint32_t near = 0;
    for (std::uint32_t lane = 0; lane < children.box().count; ++lane) {
      distance[lane] = BoxEnds(children[lane]).squaredDistance(center);
      if (distance[lane] <= reach * reach) near |= 1u << lane;
    }
    while (near != 0) {
      auto nearest = static_cast<std::uint32_t>(std::countr_zero(near));
      for (const std::uint32_t lane : Bits(near & (near - 1)))
        if (distance[lane] < distance[nearest]) nearest = lane;
      if (hasPoint(children[nearest], probe, center, motion)) return true;
      if (model_.isBlunt(candidate, motion)) return false;
      near &= ~(1u << nearest);
    }
    return false;
  }

private:
  const TrajectoryQuery& query_;
  const VoxelInModelFrame& voxel_frame_;
  ModelBoxes& model_;
  Work& work_;
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

// SPDX-License-Identifier: BSD-3-Clause
// What a walk that flags points keeps of one node of a: its children in the frame of a voxel of b, and the spheres of b
// that each child may collide with.

#if defined(PCL_BSH_COLLISION_FLAG_VISIT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_COLLISION_FLAG_VISIT_INL_H_
#undef PCL_BSH_COLLISION_FLAG_VISIT_INL_H_
#else
#define PCL_BSH_COLLISION_FLAG_VISIT_INL_H_
#endif

#include <pcl_bsh/geometry/distance_band.h>
#include <pcl_bsh/traversal/leaf_pair-inl.h>

#include <deque>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh {
namespace HWY_NAMESPACE {

/// A voxel of b, as seen from a voxel of a.
struct ObstacleVoxel {
  const Voxel* voxel;
  RelativeFrame frame;
  float prune_reach;
  float sure_reach;   ///< what comes within it collides
  float accept_reach; ///< what comes within it may count as colliding; no less
  float blunt_radius;
  DistanceBand band;
};

/// A sphere of b that the points of some node of a may collide with: a child of `node`, in one of the obstacle voxels.
struct ObstacleSphere {
  const Node* node;
  std::uint16_t lane;
  std::uint16_t level; ///< of `node` below its voxel, from 1
  std::uint32_t obstacle;

  bool isLeaf() const { return node->isLeaf(lane); }
  ObstacleSphere below(const Node& child, std::uint32_t i) const
  {
    return {&child, static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(level + 1), obstacle};
  }
  LeafRange leaf(const ObstacleVoxel& m) const { return {m.voxel, node->begin[lane], node->comparedPoints(lane)}; }
};

/// A sphere in the frame of a's voxel.
struct BoundingSphere {
  Point center;
  float radius;
};

/// One node of a on its way through b, its children tested all at once.
struct FlagVisit {
  const Node* node = nullptr;
  std::uint32_t leaves = 0; ///< bits of the children that are leaves
  std::uint32_t open = 0;   ///< bits of the children that are not settled yet
  std::uint32_t obstacle = 0;
  alignas(32) float x[kLanes], y[kLanes], z[kLanes], r[kLanes]; ///< their spheres in the obstacle voxel's frame
  float smallest = 0.0f;                                        ///< of r
  BoundingSphere around;                                        ///< holds them all; in the frame of a's voxel
  QueryBall ball;                                               ///< likewise, in the obstacle voxel's frame
  std::vector<ObstacleSphere> near[kLanes]; ///< what each child has to be compared with; of leaves, in this obstacle

  std::uint32_t open_points[kLanes] = {}; ///< of leaves: bits of the points not flagged yet
  std::uint32_t unsure = 0;               ///< bits of leaves that met spheres which were not to be opened
};

/// Memory of one walk after another, to be had by a ScratchLease.
struct FlagScratch {
  std::deque<FlagVisit> visits; ///< by depth; a deque, for references to shallower visits stay in use
  std::vector<ObstacleVoxel> obstacles;
  std::vector<ObstacleSphere> spheres; ///< of the obstacles' roots
  std::vector<std::uint32_t> reached;  ///< voxels of b

  std::size_t bytes() const noexcept
  {
    std::size_t sum = visits.size() * sizeof(FlagVisit) + obstacles.capacity() * sizeof(ObstacleVoxel) +
                      spheres.capacity() * sizeof(ObstacleSphere) + reached.capacity() * sizeof(std::uint32_t);
    for (const FlagVisit& visit : visits)
      for (const auto& list : visit.near) sum += list.capacity() * sizeof(ObstacleSphere);
    return sum;
  }
};

} // namespace HWY_NAMESPACE
} // namespace pcl_bsh
HWY_AFTER_NAMESPACE();

#endif // toggle

// SPDX-License-Identifier: BSD-3-Clause
// The state of one node of a in a walk that flags points: its children in the frame of a voxel of b, and the spheres of
// b that each child may collide with.

#if defined(PCL_BSH_FLAGS_VISIT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_FLAGS_VISIT_INL_H_
#undef PCL_BSH_FLAGS_VISIT_INL_H_
#else
#define PCL_BSH_FLAGS_VISIT_INL_H_
#endif

#include <pcl_bsh/flags/flag_writer.h>
#include <pcl_bsh/geometry/distance_band.h>
#include <pcl_bsh/hierarchy/slabs.h>
#include <pcl_bsh/traversal/flat_records-inl.h>
#include <pcl_bsh/traversal/list_walk-inl.h>
#include <pcl_bsh/traversal/uncertain_reach.h>

#include <vector>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

/// A voxel of b, as seen from a voxel of a.
struct ObstacleVoxel {
  const Voxel* voxel;
  RelativeFrame frame;
  float reach;        ///< what is farther apart is free
  float sure_reach;   ///< what comes within it collides
  float accept_reach; ///< what comes within it may count as colliding; at least `sure_reach`
  float blunt_radius;
  DistanceBand band;                  ///< of what collides, where points are uncertain: for certain
  DistanceBand possible;              ///< of what may collide
  DistanceBand flat, possibly_flat;   ///< `band` and `possible` for triangles with FlatRecord::isUsual()
  const Slabs* slabs = nullptr;       ///< of its nodes, once asked for
  const Slabs* cross_slabs = nullptr; ///< second slabs of its nodes, where triangles are long
  bool has_long_triangles = false;    ///< about as long as the voxel is wide: balls of nodes say little about them
};

/// One node of a on its way through b, its children tested all at once. Lists of leaves are of one obstacle.
struct FlagVisit : ListVisit<ObstacleSphere> {
  std::uint32_t open = 0; ///< bits of the children that are not settled yet
  std::uint32_t obstacle = 0;
  alignas(32) float x[kLanes], y[kLanes], z[kLanes], r[kLanes]; ///< their spheres in the obstacle voxel's frame
  float smallest = 0.0f;                                        ///< of r
  float largest_leaf = 0.0f;                                    ///< of r, of leaves
  bool has_several = false;                                     ///< candidates, so that slabs are worth fitting
  bool has_slabs = false;                                       ///< whether the following are set
  alignas(32) float nx[kLanes], ny[kLanes], nz[kLanes];         ///< normals of the children's slabs, in that frame
  const Slabs* slabs = nullptr;                                 ///< the children's
  bool may_have_slabs = false;                                  ///< whether they may be asked for on the way
  alignas(32) float cx[kLanes], cy[kLanes], cz[kLanes];         ///< normals of the children's cross slabs
  const Slabs* cross_slabs = nullptr;
  std::uint32_t carried = 0; ///< bits of the leaves whose points are in `points`
  LeafPoints points[kLanes]; ///< of leaves, in the obstacle voxel's frame
  BoundingSphere around;     ///< holds them all; in the frame of a's voxel
  QueryBall ball;            ///< about it, with the reach; in the obstacle voxel's frame

  std::vector<std::uint32_t> asked; ///< set by hitMiddles(): for each of near[lane], bits of the points to compare
  std::uint32_t open_points[kLanes] = {}; ///< of leaves: bits of the points not flagged yet
  std::uint32_t perhaps[kLanes] = {};     ///< of leaves: bits of points that may collide, but were not found to
  std::uint32_t known = 0;  ///< bits of the children all of whose points may collide; it is open whether they do
  std::uint32_t unsure = 0; ///< bits of leaves that met spheres which were not to be opened

  /// @param may_collide all points below the node
  void begin(const NodeInSphere& entered, bool may_collide)
  {
    ListVisit::begin(entered.node);
    open = firstBits(node->count);
    known = may_collide ? open : 0;
    unsure = 0;
    around = entered.around;
    for (const std::uint32_t lane : Bits(leaves)) {
      open_points[lane] = firstBits(node->comparedPoints(lane));
      perhaps[lane] = may_collide ? open_points[lane] : 0;
    }
  }

  std::size_t bytes() const noexcept { return ListVisit::bytes() + asked.capacity() * sizeof(std::uint32_t); }
};

/// Tells a writer one finding for some of sixteen points. @param bits of these points
/// @param recordOf(i) returns the record of point i
template <class RecordOf>
inline void tellBits(FlagWriter& writer, Finding finding, std::uint32_t bits, const RecordOf& recordOf)
{
  if (bits == 0) return;
  std::uint32_t records[kLeafPoints], count = 0;
  for (const std::uint32_t i : Bits(bits)) records[count++] = recordOf(i);
  writer.tell(finding, records, records + count);
}

/// Finds points of b by their distance alone, for hasPointWithin().
struct MeasuredPoint {
  float stretch;

  static bool isIn(const LeafRange& leaf, const QueryBall& ball)
  {
    return anyPointWithin(leaf.x(), leaf.y(), leaf.z(), leaf.count, ball.x, ball.y, ball.z, ball.near_reach);
  }

  std::uint32_t spheresIn(const Node& node, const QueryBall& ball, float* gap) const
  {
    return spheresNear({node.x, node.y, node.z, node.r, stretch}, ball, gap);
  }
};

/// Whether the candidate has a point in the ball; the nearest spheres are asked first.
/// @param finder `isIn(leaf, ball)`: whether a point of the leaf is. `spheresIn(node, ball, gap)`: which spheres may
///   have one, and in which order
template <class Finder>
inline bool hasPointWithin(const Finder& finder, const ObstacleVoxel& obstacle, const ObstacleSphere& candidate,
                           const QueryBall& ball, Work& work)
{
  if (candidate.isLeaf()) return finder.isIn(candidate.leaf(*obstacle.voxel), ball);
  const Node& below = obstacle.voxel->nodes[candidate.node->child[candidate.lane]];
  alignas(32) float gap[kLanes];
  work.node_pairs += below.count;
  std::uint32_t near = finder.spheresIn(below, ball, gap) & firstBits(below.count);
  while (near != 0) {
    const std::uint32_t nearest = smallestLane(gap, near);
    if (hasPointWithin(finder, obstacle, candidate.below(below, nearest), ball, work)) return true;
    near &= ~(1u << nearest);
  }
  return false;
}

/// Memory that walks use one after another; a ScratchLease lends it.
struct FlagScratch {
  Visits<FlagVisit> visits;
  std::vector<ObstacleVoxel> obstacles;
  std::vector<ObstacleSphere> spheres;   ///< of the obstacles' roots
  std::vector<std::uint32_t> reached;    ///< voxels of b
  std::vector<UncertainReach> uncertain; ///< of the obstacles, where points are uncertain
  FlatRecords flat;                      ///< where b is of triangles

  std::size_t bytes() const noexcept
  {
    return visits.bytes() + obstacles.capacity() * sizeof(ObstacleVoxel) + spheres.capacity() * sizeof(ObstacleSphere) +
           reached.capacity() * sizeof(std::uint32_t) + uncertain.capacity() * sizeof(UncertainReach) + flat.bytes();
  }
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle

// SPDX-License-Identifier: BSD-3-Clause
// Slabs in a walk that flags points: the planes that hold a node's records tell which children of a visit a sphere of b
// may be near to. Spheres say little where surfaces face each other, and of triangles as long as their voxel.

#if defined(PCL_BSH_FLAGS_SLABS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PCL_BSH_FLAGS_SLABS_INL_H_
#undef PCL_BSH_FLAGS_SLABS_INL_H_
#else
#define PCL_BSH_FLAGS_SLABS_INL_H_
#endif

#include <pcl_bsh/flags/visit-inl.h>
#include <pcl_bsh/simd/crossed_lanes-inl.h>
#include <pcl_bsh/traversal/separation-inl.h>

HWY_BEFORE_NAMESPACE();
namespace pcl_bsh::HWY_NAMESPACE {

class FlagSlabs {
public:
  /// @param obstacles, reached the voxels of b that the walk has reached, and their numbers
  FlagSlabs(const Spaces& a, const Spaces& b, bool of_triangles, std::vector<ObstacleVoxel>& obstacles,
            const std::vector<std::uint32_t>& reached, Work& work)
  : a_(a),
    b_(b),
    of_triangles_(of_triangles),
    obstacles_(obstacles),
    reached_(reached),
    work_(work)
  {
  }

  /// Begins with a voxel of a, which is built. @param may_use_known whether slabs that are fitted may be used at once
  void begin(std::uint32_t voxel, const Voxel& built, bool may_use_known)
  {
    own_ = &a_.storage.voxels[voxel];
    a_voxel_ = &built;
    has_long_triangles_ = a_.storage.hasLongTriangles(voxel);
    uses_known_ = may_use_known && own_->slabs.isFitted();
  }

  /// Whether the slabs of an obstacle may be used without fitting any.
  bool areKnown(std::uint32_t obstacle) const
  {
    return uses_known_ && b_.storage.voxels[reached_[obstacle]].slabs.isFitted();
  }

  /// Fits the slabs of a voxel of b, where no query has yet.
  void fit(ObstacleVoxel& obstacle)
  {
    Voxel& voxel = b_.storage.voxels[reached_[static_cast<std::size_t>(&obstacle - obstacles_.data())]];
    if (!obstacle.slabs) obstacle.slabs = voxel.slabs.of(voxel, b_.storage.view, work_);
    if (!obstacle.cross_slabs && obstacle.has_long_triangles)
      obstacle.cross_slabs = voxel.cross_slabs.of(voxel, b_.storage.view, work_);
  }

  /// Whether slabs of the visit's children and of the obstacle can be compared, and spare work: those of points, or
  /// where one side has long triangles. Slabs of short triangles prune no more pairs than their spheres do.
  bool mayHave(const FlagVisit& visit) const
  {
    const ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    return obstacle.voxel->frame.unit == a_voxel_->frame.unit && !a_.storage.view.areBalls() &&
           !b_.storage.view.areBalls() && (!of_triangles_ || has_long_triangles_ || obstacle.has_long_triangles);
  }

  /// From now on the visit's children and the obstacle are compared by slabs, too. Where surfaces face each other
  /// across the clearance, spheres leave most of b as candidates. @pre mayHave()
  HWY_NOINLINE void take(FlagVisit& visit)
  {
    ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    const auto index = visit.node - a_voxel_->nodes.data();
    const float* const m = obstacle.frame.m.data();
    fit(obstacle);
    visit.slabs = own_->slabs.of(*a_voxel_, a_.storage.view, work_) + index;
    carry(m, kNowhere, visit.slabs->x, visit.slabs->y, visit.slabs->z, kLanes, visit.nx, visit.ny, visit.nz);
    visit.has_slabs = true;
    if (!has_long_triangles_) return;
    visit.cross_slabs = own_->cross_slabs.of(*a_voxel_, a_.storage.view, work_) + index;
    carry(m, kNowhere, visit.cross_slabs->x, visit.cross_slabs->y, visit.cross_slabs->z, kLanes, visit.cx, visit.cy,
          visit.cz);
  }

  /// The children in `near` that a sphere of b may be near to, by its slabs and the children's slabs.
  HWY_INLINE std::uint32_t nearOf(FlagVisit& visit, const ObstacleSphere& candidate, const Point& center, float radius,
                                  std::uint32_t near)
  {
    const ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    const SphereLanes spheres{visit.x, visit.y, visit.z, visit.r, 1.0f};
    const auto index = candidate.node - obstacle.voxel->nodes.data();
    const Slab slab = slabOf(obstacle.slabs[index], candidate.lane, center, radius);
    near &= ~slabsApart(spheres, {visit.nx, visit.ny, visit.nz, visit.slabs->h}, slab, obstacle.reach);
    if (near == 0 || !of_triangles_) return near;
    return nearAcross(visit, candidate, near);
  }

  /// Whether both slabs of a candidate, with which the visit's children were compared, are thinner than the reach plus
  /// the radius of the smallest child. Then the candidate's triangles tell little more than its slabs.
  bool isThin(const FlagVisit& visit, const ObstacleSphere& candidate) const
  {
    const ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    return visit.has_slabs && obstacle.cross_slabs &&
           slabsOf(obstacle, candidate).thickness() < visit.smallest + obstacle.reach;
  }

  /// Whether a is of long triangles, and this is a leaf of points.
  bool isLeafOfPoints(const ObstacleSphere& candidate) const
  {
    return has_long_triangles_ && !b_.storage.view.triangles && candidate.isLeaf();
  }

  /// Which points of a leaf of b may be near to the long triangles of a leaf of a.
  /// @pre isLeafOfPoints(), visit.has_slabs
  std::uint32_t facingLeaf(const FlagVisit& visit, std::uint32_t lane, const LeafRange& leaf) const
  {
    const CrossedSlabs held{{visit.nx[lane], visit.ny[lane], visit.nz[lane]},
                            {visit.cx[lane], visit.cy[lane], visit.cz[lane]},
                            visit.slabs->h[lane],
                            visit.cross_slabs->h[lane],
                            {visit.x[lane], visit.y[lane], visit.z[lane]},
                            visit.r[lane]};
    return pointsNearSlabs(leaf.x(), leaf.y(), leaf.z(), leaf.count, held, obstacles_[visit.obstacle].reach);
  }

  /// The children of a node of b in `near` that a sphere may be near to. @pre fit()
  std::uint32_t nearSphere(const ObstacleVoxel& obstacle, const Node& node, const SphereLanes& spheres,
                           const Point& center, float radius, std::uint32_t near) const
  {
    const auto index = &node - obstacle.voxel->nodes.data();
    const Slab sphere{{0.0f, 0.0f, 0.0f}, radius, center, radius};
    for (const Slabs* const slabs : {obstacle.slabs + index, obstacle.cross_slabs + index})
      near &= ~slabsApart(spheres, {slabs->x, slabs->y, slabs->z, slabs->h}, sphere, obstacle.reach);
    return near;
  }

  /// Points of a leaf among the children, in the frame of the obstacle.
  const LeafPoints& carriedPoints(FlagVisit& visit, std::uint32_t lane)
  {
    if ((visit.carried >> lane & 1) == 0)
      carryLeaf(obstacles_[visit.obstacle].frame, leafOf(visit, lane), visit.points[lane]);
    visit.carried |= 1u << lane;
    return visit.points[lane];
  }

  LeafRange leafOf(const FlagVisit& visit, std::uint32_t lane) const
  {
    return {a_voxel_, visit.node->begin[lane], visit.node->comparedPoints(lane)};
  }

  /// Which of a's points, carried, may be near to a candidate of triangles. @pre visit.has_slabs
  std::uint32_t facingPoints(const FlagVisit& visit, const LeafPoints& points, const ObstacleSphere& candidate) const
  {
    const ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    return pointsNearSlabs(points.x, points.y, points.z, kLeafPoints, slabsOf(obstacle, candidate), obstacle.reach);
  }

private:
  /// The slabs between which a candidate holds its records: both of them where its triangles are long.
  static CrossedSlabs slabsOf(const ObstacleVoxel& obstacle, const ObstacleSphere& candidate)
  {
    return candidate.between(*obstacle.voxel, obstacle.slabs, obstacle.cross_slabs, obstacle.frame.stretch_b);
  }

  /// Does what nearOf() does, by the cross slabs of long triangles, and for leaves of points by each point.
  HWY_NOINLINE std::uint32_t nearAcross(FlagVisit& visit, const ObstacleSphere& candidate, std::uint32_t near)
  {
    const ObstacleVoxel& obstacle = obstacles_[visit.obstacle];
    const SphereLanes spheres{visit.x, visit.y, visit.z, visit.r, 1.0f};
    const CrossedSlabs held = slabsOf(obstacle, candidate);
    static constexpr float kNone[kLanes] = {};
    near &= ~crossedSlabsApart(spheres, {visit.nx, visit.ny, visit.nz, visit.slabs->h},
                               has_long_triangles_ ? SlabLanes{visit.cx, visit.cy, visit.cz, visit.cross_slabs->h}
                                                   : SlabLanes{kNone, kNone, kNone, kNone},
                               held, obstacle.reach);
    const bool by_own_points = obstacle.has_long_triangles && !a_.storage.view.triangles;
    if (!by_own_points && !isLeafOfPoints(candidate)) return near;
    for (const std::uint32_t lane : Bits(near & visit.leaves)) {
      ++work_.node_pairs;
      bool is_near = false;
      if (by_own_points) {
        const LeafPoints& points = carriedPoints(visit, lane);
        is_near = (pointsNearSlabs(points.x, points.y, points.z, kLeafPoints, held, obstacle.reach) &
                   visit.open_points[lane]) != 0;
      }
      else {
        is_near = facingLeaf(visit, lane, candidate.leaf(*obstacle.voxel)) != 0;
      }
      if (!is_near) near &= ~(1u << lane);
    }
    return near;
  }

  const Spaces& a_;
  const Spaces& b_;
  const bool of_triangles_;
  std::vector<ObstacleVoxel>& obstacles_;
  const std::vector<std::uint32_t>& reached_;
  Work& work_;
  Voxel* own_ = nullptr; ///< of a
  const Voxel* a_voxel_ = nullptr;
  bool uses_known_ = false;
  bool has_long_triangles_ = false; ///< a's voxel
};

} // namespace pcl_bsh::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // toggle
